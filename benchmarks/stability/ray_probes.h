// What the cases and maps about rays share: random numbers, meshes to aim at, a tracer's answers to a list of rays, and
// the ways to start a ray off a surface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "benchmarks/stability/stability_case.h"
#include "geometry/ray_batch.h"
#include "geometry/ray_intersector.h"
#include "geometry/shape_set.h"
#include "geometry/surface.h"

namespace raytree::benchmarks {

/// Numbers without a pattern, the same in every run and with every standard library.
class ProbeRandom {
 public:
  explicit ProbeRandom(std::uint64_t seed) : state_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * share(); }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(share() * static_cast<double>(count)); }
  Vec3d in_cube(double reach) {
    const double x = uniform(-reach, reach), y = uniform(-reach, reach);
    return {x, y, uniform(-reach, reach)};
  }
  Vec3d direction();
  /// Unit, to `side`'s side: half of them at any height over the surface, half from upright down to 1e-7 over it.
  Vec3f leaving(const Vec3f& side);

 private:
  double share();  ///< in [0, 1)
  std::uint64_t state_;
};

/// Rays or samples to take at the run's effort, of `full`, never less than `least`.
std::size_t probe_count(const StabilityRun& run, std::size_t full, std::size_t least);

struct ProbeRay {
  Vec3f origin{0}, direction{0};
};

/// The ray from `origin`, rounded, to `target`: its direction is made in double and rounded once.
ProbeRay ray_to(const Vec3d& origin, const Vec3d& target);

/// Answers of the calls that the renderer makes for rays that have nothing in common; [rays.size()].
std::vector<Hit> hits_of(const RayIntersector& tracer, const std::vector<ProbeRay>& rays);
Hit hit_of(const RayIntersector& tracer, const ProbeRay& ray);

/// A closed ball of triangles in scene space, facing out: poles on the y axis.
ShapeSet ball_of_triangles(int sides, int stacks, double radius, const Vec3d& center);

/// One mesh of separate triangles: corners [3 n].
ShapeSet triangle_soup(const std::vector<Vec3f>& corners);

/// A quad as two triangles: place, place + a, place + a + b, place + b; facing a x b.
ShapeSet quad_of_triangles(const Vec3d& place, const Vec3d& a, const Vec3d& b);

ShapeSet spheres_at(const std::vector<Imath::V4f>& center_radius);

/// Corner `c` (taken modulo 3) of a triangle of the set's first mesh.
Vec3d corner_of(const ShapeSet& shapes, std::size_t triangle, std::size_t c);

/// How a ray gets off the surface that it leaves.
enum class Departure : std::uint8_t {
  none,              ///< it starts at the hit point
  absolute,          ///< 1e-4 along the normal, whatever the scene's scale
  waechter_binder,   ///< integer steps of the coordinates (Waechter and Binder, Ray Tracing Gems 2019, chapter 6)
  waechter_binder_t  ///< the same from origin + distance * direction instead of the barycentric point
};
inline constexpr float kAbsoluteOffset = 1e-4f;

/// `normal`: unit, geometric, to the side that the ray leaves to. `ray`: what found the point.
Vec3f departed(Departure way, const SurfacePoint& point, const Vec3f& normal, const ProbeRay& ray);

/// The renderer's own way off a surface: all cases and maps go through here, so that StabilityFaults::no_offsets shows.
Vec3f departed_as_rendered(const StabilityRun& run, const SurfacePoint& point, const Vec3f& normal);

/// A small picture, black until set: values in [0, 1] are shown as their square roots.
struct ProbeCanvas {
  DisplayImage image;
  ProbeCanvas(int width, int height);
  void set(int x, int y, double r, double g, double b);
};

}  // namespace raytree::benchmarks
