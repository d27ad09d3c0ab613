// From a parametric surface to triangles: a number of segments for every edge, points shared between the faces that
// meet there, so that no crack opens. How many segments are enough is tessellation_rates.h's.
#pragma once

#include <array>
#include <cstdint>

#include "geometry/buffer.h"
#include "geometry/facet_pattern.h"
#include "geometry/parametric_surface.h"
#include "geometry/triangle_mesh.h"

namespace raytree {

/// How finely each face is cut: segments, from 1 to kLargestRate.
struct TessellationRates {
  Buffer<std::uint16_t> edges;                 ///< [edge_count]
  Buffer<std::array<std::uint16_t, 2>> inner;  ///< [face_count] of the face's inside; a quad's u and v, else one twice
};

/// Every edge in as many equal segments of its parameter as `rates` says. Positions of corners and edges are evaluated
/// once, by the face of the lowest number, and shared by index between all faces that meet there. So are normals, but
/// where a side or corner is sharp: there each face has its own. Texture coordinates are each face's own. Holes leave
/// nothing behind. Runs on the task arena's threads; the result does not depend on their number. triangle_faces holds
/// source_face(). Throws Error (bad_input) when the points or triangles are more than 32 bits can count, when a rate is
/// out of range, or when the surface is not finite somewhere.
TriangleMesh tessellate(const ParametricSurface& surface, const TessellationRates& rates);

/// The same with every edge and inside in `rate` segments.
TriangleMesh tessellate_uniformly(const ParametricSurface& surface, int rate);

/// The rates that tessellate_uniformly() uses. Throws Error (bad_input) when `rate` is out of range.
TessellationRates uniform_rates(const ParametricSurface& surface, int rate);

}  // namespace raytree
