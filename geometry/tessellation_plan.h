// The numbers of a tessellation, before any of its points is made: who evaluates a shared corner or edge, and where
// each face's own points, normals, texture coordinates and triangles begin. Faces can then be made in any order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/buffer.h"
#include "geometry/facet_pattern_set.h"
#include "geometry/parametric_surface.h"
#include "geometry/tessellation.h"

namespace raytree {

/// How many there are, or how many come before something.
struct TessellationCounts {
  std::uint64_t sides = 0;
  std::uint64_t points = 0;    ///< positions, each with a normal
  std::uint64_t normals = 0;   ///< besides: of faces' own at sharp sides
  std::uint64_t textures = 0;  ///< besides: of faces' own along their boundary
  std::uint64_t triangles = 0;

  TessellationCounts& operator+=(const TessellationCounts& other) {
    sides += other.sides, points += other.points, normals += other.normals, textures += other.textures;
    triangles += other.triangles;
    return *this;
  }
};

/// Where the points of one face's boundary are, in its pattern's order: [boundary_count] each.
struct BoundaryNumbers {
  std::vector<std::uint32_t> point, normal;
  std::vector<std::uint32_t> texture;  ///< empty without texture coordinates
  std::vector<std::uint8_t> owned;     ///< whether this face evaluates the position
};

class TessellationPlan {
 public:
  /// Points in the order of vertices, edges, insides of faces; normals and texture coordinates of faces' own behind
  /// them. Runs on the task arena's threads. Both arguments must outlive the plan. Throws Error (bad_input) as
  /// tessellate() says.
  TessellationPlan(const ParametricSurface& surface, const TessellationRates& rates);

  const TessellationCounts& total() const { return total_; }
  /// Where the face's own begin: points of its inside, and the rest.
  const TessellationCounts& first(std::size_t face) const { return faces_[face]; }
  /// The face's pattern: one that is kept, or made in `own`. Not for holes.
  const FacetPattern& pattern(std::size_t face, FacetPattern& own) const;
  void number_boundary(std::size_t face, BoundaryNumbers& numbers) const;

 private:
  TessellationCounts counts_of(std::size_t face) const;
  std::size_t flat_facets(std::size_t face) const;
  bool owns_edge(const FaceEdge& side, std::uint32_t id) const { return edge_owner_[side.edge] == id; }
  bool owns_vertex(const FaceEdge& side, std::uint32_t id) const { return vertex_owner_[side.vertex] == id; }
  bool own_normal(const FaceEdge& side, std::uint32_t id) const { return side.sharp_edge && !owns_edge(side, id); }
  bool own_corner_normal(const FaceEdge& side, std::uint32_t id) const {
    return side.sharp_vertex && !owns_vertex(side, id);
  }

  const ParametricSurface& surface_;
  const TessellationRates& rates_;
  FacetPatternSet patterns_;
  Buffer<TessellationCounts> faces_;
  Buffer<std::uint32_t> edge_owner_, vertex_owner_;  ///< number of a side, counted through all faces; kNoSide: none
  Buffer<std::uint32_t> edge_first_, vertex_index_;  ///< positions
  TessellationCounts total_;
};

}  // namespace raytree
