// From a parametric surface to triangles: a number of segments for every edge, points shared between the faces that
// meet there, so that no crack opens. How many segments are enough is tessellation_rates.h's.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/buffer.h"
#include "geometry/facet_pattern.h"
#include "geometry/facet_record.h"
#include "geometry/parametric_surface.h"
#include "geometry/triangle_mesh.h"

namespace raytree {

/// How finely each face is cut: segments, from 1 to kLargestRate.
struct TessellationRates {
  Buffer<std::uint16_t> edges;                 ///< [edge_count]
  Buffer<std::array<std::uint16_t, 2>> inner;  ///< [face_count] of the face's inside; a quad's u and v, else one twice
};

/// Those of one face, as make_facet_pattern() takes them.
void rates_of_face(const ParametricSurface& surface, const TessellationRates& rates, std::size_t face,
                   std::vector<std::uint16_t>& face_rates);

bool has_collapsed_side(std::span<const FaceEdge> sides);

/// Numbers for the points of a face's boundary, equal where two are one point: along collapsed sides, and where a face
/// meets itself. points: [boundary points of its pattern]. Empty when no side is collapsed: no facet is without area.
void identify_boundary(std::span<const FaceEdge> sides, std::span<const std::uint16_t> rates,
                       std::vector<std::uint64_t>& points);

/// Whether two of a facet's corners, indices into a pattern's points, are one point: it is left out then.
bool has_no_area(const std::uint32_t* facet, std::span<const std::uint64_t> points);

/// Every edge in as many equal segments of its parameter as `rates` says. Positions of corners and edges are evaluated
/// once, by the face of the lowest number, and shared by index between all faces that meet there. So are normals, but
/// where a side or corner is sharp: there each face has its own. Texture coordinates are each face's own. Holes leave
/// nothing behind, and all points of a collapsed side are its corner, without the facets that have no area then. Runs
/// on the task arena's threads; the result does not depend on their number. triangle_faces holds source_face(). Throws
/// Error (bad_input) when the points or triangles are more than 32 bits can count, when a rate is out of range, or when
/// the surface is not finite somewhere.
///
/// `parameters`, where given, gets each triangle's place on the surface.
TriangleMesh tessellate(const ParametricSurface& surface, const TessellationRates& rates,
                        FacetParameters* parameters = nullptr);

/// The same with every edge and inside in `rate` segments.
TriangleMesh tessellate_uniformly(const ParametricSurface& surface, int rate);

/// The rates that tessellate_uniformly() uses. Throws Error (bad_input) when `rate` is out of range.
TessellationRates uniform_rates(const ParametricSurface& surface, int rate);

}  // namespace raytree
