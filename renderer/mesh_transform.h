// Meshes moved by a matrix, in double until they are stored: normals by the inverse transpose, and what is mirrored
// wound the other way round.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>

#include "geometry/triangle_mesh.h"
#include "geometry/vec.h"

namespace raytree {

/// Calls function(i) for each i below count, on the task arena's threads.
template <class Function>
void for_each_index(std::size_t count, Function&& function) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, std::size_t(65536)), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) function(i);
  });
}

inline Vec3d transformed_vector(const Vec3d& vector, const Matrix44d& m) {
  Vec3d result;
  m.multDirMatrix(vector, result);
  return result;
}

inline bool mirrors(const Matrix44d& m) { return m.determinant() < 0; }

/// Moves positions and normals; of what is mirrored, corners 1 and 2 of each triangle change places.
void transform_mesh(TriangleMesh& mesh, const Matrix44d& m);

}  // namespace raytree
