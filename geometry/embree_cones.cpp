#include "geometry/embree_cones.h"

#include <cmath>
#include <limits>

#include "geometry/cone.h"

namespace raytree::embree {
namespace {

void bound_cone(const RTCBoundsFunctionArguments* arguments) {
  const auto& cones = *static_cast<const ConeArray*>(arguments->geometryUserPtr);
  const Bounds3d box = bounds(cones[arguments->primID]);
  // Outward by what rounding to float may take.
  const auto low = [](double x) {
    return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
  };
  const auto high = [](double x) {
    return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
  };
  RTCBounds& result = *arguments->bounds_o;
  result.lower_x = low(box.min.x), result.lower_y = low(box.min.y), result.lower_z = low(box.min.z);
  result.upper_x = high(box.max.x), result.upper_y = high(box.max.y), result.upper_z = high(box.max.z);
}

/// The nearest crossing between the ray's begin and end; infinity: none.
float crossing_of(const ConeFrame& cone, RTCRayN* rays, unsigned count, unsigned i) {
  const Vec3d origin(RTCRayN_org_x(rays, count, i), RTCRayN_org_y(rays, count, i), RTCRayN_org_z(rays, count, i));
  const Vec3d direction(RTCRayN_dir_x(rays, count, i), RTCRayN_dir_y(rays, count, i), RTCRayN_dir_z(rays, count, i));
  // An instance's scale stretches the direction: distances count in its length.
  const double length = direction.length();
  if (!(length > 0)) return std::numeric_limits<float>::infinity();
  const ConeCrossings crossings = cone_crossings(cone, origin, direction * (1 / length));
  const float least = RTCRayN_tnear(rays, count, i), most = RTCRayN_tfar(rays, count, i);
  for (const double t : {crossings.near, crossings.far}) {
    const auto distance = static_cast<float>(t / length);
    if (distance > least && distance < most) return distance;
  }
  return std::numeric_limits<float>::infinity();
}

void intersect_cone(const RTCIntersectFunctionNArguments* arguments) {
  const auto& cones = *static_cast<const ConeArray*>(arguments->geometryUserPtr);
  const unsigned count = arguments->N;
  RTCRayN* const rays = RTCRayHitN_RayN(arguments->rayhit, count);
  RTCHitN* const hits = RTCRayHitN_HitN(arguments->rayhit, count);
  const ConeFrame cone(cones[arguments->primID]);
  for (unsigned i = 0; i < count; ++i) {
    if (arguments->valid[i] == 0) continue;
    const float distance = crossing_of(cone, rays, count, i);
    if (!(distance < std::numeric_limits<float>::infinity())) continue;
    RTCRayN_tfar(rays, count, i) = distance;
    RTCHitN_u(hits, count, i) = 0;
    RTCHitN_v(hits, count, i) = 0;
    RTCHitN_geomID(hits, count, i) = arguments->geomID;
    RTCHitN_primID(hits, count, i) = arguments->primID;
    RTCHitN_instID(hits, count, i, 0) = arguments->context->instID[0];
  }
}

void occlude_cone(const RTCOccludedFunctionNArguments* arguments) {
  const auto& cones = *static_cast<const ConeArray*>(arguments->geometryUserPtr);
  const unsigned count = arguments->N;
  const ConeFrame cone(cones[arguments->primID]);
  for (unsigned i = 0; i < count; ++i) {
    if (arguments->valid[i] == 0) continue;
    if (crossing_of(cone, arguments->ray, count, i) < std::numeric_limits<float>::infinity())
      RTCRayN_tfar(arguments->ray, count, i) = -std::numeric_limits<float>::infinity();
  }
}

}  // namespace

void set_cones(RTCGeometry geometry, const ConeArray& cones) {
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(cones.shape.size()));
  // Embree hands the pointer back to functions that only read.
  rtcSetGeometryUserData(geometry, const_cast<ConeArray*>(&cones));
  rtcSetGeometryBoundsFunction(geometry, bound_cone, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_cone);
  rtcSetGeometryOccludedFunction(geometry, occlude_cone);
}

}  // namespace raytree::embree
