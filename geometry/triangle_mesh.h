// A triangle mesh ready for tracing: float positions about a double origin, flat index arrays that Embree can
// share, optional normals and texture coordinates, and the way back to the faces of the file.
#pragma once

#include <cstdint>

#include "geometry/buffer.h"
#include "geometry/vec.h"

namespace raytree {

struct TriangleMesh {
  Vec3d origin{0, 0, 0};          ///< added to every position
  Buffer<Vec3f> positions;        ///< [vertex_count], relative to origin
  Buffer<std::uint32_t> corners;  ///< [triangle_count][3], indices into positions, counter-clockwise from outside
  Buffer<Vec3f> normals;          ///< unit; empty: the geometric normal is used
  Buffer<std::uint32_t> normal_corners;   ///< [triangle_count][3]; empty with normals present: a normal per position
  Buffer<Vec2f> texture_coordinates;      ///< empty: none
  Buffer<std::uint32_t> texture_corners;  ///< as normal_corners
  Buffer<std::uint32_t> triangle_faces;   ///< [triangle_count] face of the polygon mesh; empty: triangle i is face i

  std::size_t triangle_count() const { return corners.size() / 3; }
};

}  // namespace raytree
