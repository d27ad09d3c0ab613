// Whether a triangle mesh is closed: refraction through one that is not has no inside.
#pragma once

#include <cstdint>

#include "geometry/triangle_mesh.h"

namespace raytree {

/// Directed edges that no neighbor runs the other way (by position index): 0 for a closed, consistently wound mesh.
/// Takes 24 bytes a triangle while it runs.
std::int64_t count_open_edges(const TriangleMesh& mesh);

}  // namespace raytree
