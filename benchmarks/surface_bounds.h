// How certain single precision is of a ray's meeting with one surface: error bounds of the arithmetic that the fast
// tracer does, derived operation by operation (Higham, "Accuracy and Stability of Numerical Algorithms", gamma_n = n u
// / (1 - n u)) from the numbers at hand. Nothing in them is fitted; docs/validation.md derives them.
#pragma once

#include "geometry/few_shapes.h"
#include "geometry/ray_batch.h"
#include "geometry/shape_set.h"
#include "geometry/vec.h"

namespace raytree::benchmarks {

/// A surface that rays are told to have hit.
struct SurfaceId {
  GeometryId geometry = kNoGeometry;
  std::uint32_t primitive = 0;
  InstanceId instance = kNoInstance;

  bool operator==(const SurfaceId&) const = default;
};

/// How the fast tracer reckons, where it has a choice.
struct FastArithmetic {
  enum class Triangles : std::uint8_t {
    watertight,  ///< Embree's robust mode: edge functions in Pluecker coordinates, boxes made larger
    plain        ///< its other one: Moeller and Trumbore 1997, boxes as they are
  };
  Triangles triangles = Triangles::watertight;
  std::size_t most_few_shapes = kMostFewShapes;  ///< spheres, and discs, up to which they are tested in double
};

struct SurfaceBounds {
  /// Whether the line meets the surface within its outline. Uncertain: rounding may make it either.
  enum class Side : std::uint8_t { inside, outside, uncertain };
  Side side = Side::uncertain;
  bool grazing = false;  ///< the sign of the surface's slope to the ray is lost in rounding, and so is the distance
  double distance = 0;   ///< to the surface (its plane, where the line passes it by), lengths of the direction
  double distance_error = 0;  ///< bound on how far a computed distance may be off; infinity where grazing
  double edge_distance = 0;   ///< of the line from the nearest edge or silhouette, scene units
  double edge_error = 0;      ///< bound on how far that may be off
  double u = 0, v = 0;        ///< of triangles: the weights of corner 1 and corner 2 where the line meets its plane
  double weight_error = 0;    ///< bound on how far each computed weight may be off
  double position_error = 0;  ///< the same along the triangle, scene units
  double normal_error = 0;    ///< bound on the length of the difference of unit normals
};

/// The bounds for a ray and a surface; of a surface that it meets twice, those where it is nearest to `near_distance`.
SurfaceBounds surface_bounds(const ShapeSet& shapes, const Vec3f& origin, const Vec3f& direction, const SurfaceId& id,
                             double near_distance, const FastArithmetic& arithmetic = {});

}  // namespace raytree::benchmarks
