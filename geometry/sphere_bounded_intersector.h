// The truth: the intersection processor of Whitted 1980, sec. 3, in double, deliberately simple. Every object has a
// bounding sphere; a ray tries one object after the other, or those that a hierarchy of spheres leaves (Clark 1976).
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "geometry/ray_intersector.h"
#include "geometry/reference_tracer.h"
#include "geometry/shape_set.h"

namespace raytree {

/// Lists of more objects than that get a hierarchy, unless told otherwise.
inline constexpr std::size_t kMostLinearObjects = 64;

/// Radius of the smallest bounding spheres about parts of curved surfaces, in pixels.
inline constexpr double kDefaultSpherePixels = 0.25;
inline constexpr double kLeastSpherePixels = 1e-6;  ///< less makes no sense of double's digits

struct SphereBoundedOptions {
  enum class Search : std::uint8_t { automatic, linear, hierarchy };
  Search search = Search::automatic;  ///< answers do not depend on it
  double sphere_pixels = kDefaultSpherePixels;
  const std::atomic<bool>* stop = nullptr;  ///< ends the build early
};

/// What an object is, and where a ray meets it:
/// - sphere (its own bound), disc, cone or cylinder: closed forms;
/// - plane: unbounded, tried by every ray;
/// - n-gon (of meshes that have their MeshSource; else triangle): the plane through the mean of its corners with
///   Newell's normal, and its outline as seen along the ray (polygon_crossing.h). For a flat one that is
///   point-in-polygon. One that is not flat is its outline from everywhere and its plane in depth: watertight with its
///   neighbors from everywhere, too, but not a point set; its depth stays within that of its corners;
/// - piece of a curved surface: by subdivision (patch_subdivision.h). Surfaces that are not made of bicubic patches
///   (Loop's scheme, Coons patches over rational curves) are the triangles that they were cut in.
/// Polygons are watertight: rays at shared edges and corners of meshes go to one of the faces there.
/// Of hits at the same distance the first counts: what stands in the scene before what stands in instances, these in
/// their order; then by geometry; then by primitive, n-gon or piece.
/// A hit on an n-gon reports the triangle of its triangulation that holds the point as seen, one on a curved surface
/// the facet that holds the point's parameters, with weights there; the distance is the true one.
class SphereBoundedIntersector final : public ReferenceTracer, public RayIntersector {
 public:
  /// Over shapes, which must outlive it. Throws Error (failure) "interrupted".
  SphereBoundedIntersector(const ShapeSet& shapes, const SphereBoundedOptions& options);
  ~SphereBoundedIntersector() override;

  ReferenceHit nearest(const Vec3d& origin, const Vec3d& direction, double max_distance) const override;
  bool is_occluded(const Vec3d& origin, const Vec3d& direction, double max_distance) const override;

  void intersect(const RayBatch& rays, Coherence coherence, HitBatch& hits) const noexcept override;
  void occluded(const RayBatch& rays, Coherence coherence, std::uint8_t* occluded) const noexcept override;
  std::size_t memory_bytes() const noexcept override;
  std::size_t peak_memory_bytes() const noexcept override;

  std::size_t object_count() const noexcept;  ///< of all lists: the scene's and each group's
  bool uses_hierarchy() const noexcept;       ///< for the scene's own list

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace raytree
