// Cut-off cones as an Embree geometry of our own kind. Included by EmbreeIntersector's source alone.
#pragma once

#include "geometry/embree_api.h"
#include "geometry/shape_set.h"

namespace raytree::embree {

/// Makes `geometry` (of type RTC_GEOMETRY_TYPE_USER, not committed) trace `cones`, which must outlive it.
void set_cones(RTCGeometry geometry, const ConeArray& cones);

}  // namespace raytree::embree
