#include "benchmarks/edge_rays.h"

#include <Imath/ImathBox.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "geometry/surface.h"

namespace raytree::benchmarks {
namespace {

/// A mesh, or a use of one, and how many triangles it and those before it have.
struct EdgeSource {
  const TriangleMesh* mesh;
  const Instance* instance;  ///< null: stands in the scene itself
  std::uint64_t triangles_up_to;

  Vec3f corner(std::size_t triangle, std::size_t k) const {
    const Vec3f p = mesh->positions[mesh->corners[3 * triangle + k]];
    return instance == nullptr
               ? p
               : instance->axis(0) * p.x + instance->axis(1) * p.y + instance->axis(2) * p.z + instance->origin();
  }
};

std::vector<EdgeSource> edge_sources(const ShapeSet& shapes) {
  std::vector<EdgeSource> sources;
  std::uint64_t triangles = 0;
  const auto add = [&](const BoundedShapes& list, const Instance* instance) {
    for (const MeshEntry& entry : list.meshes) {
      if (entry.mesh.corners.empty()) continue;
      triangles += entry.mesh.triangle_count();
      sources.push_back({&entry.mesh, instance, triangles});
    }
  };
  add(shapes, nullptr);
  for (const Instance& instance : shapes.instances) add(shapes.groups[instance.group], &instance);
  return sources;
}

}  // namespace

RaySet edge_aimed_rays(const ShapeSet& shapes, const Vec3f& eye, std::size_t count, std::uint64_t seed) {
  RaySet rays;
  rays.coherence = Coherence::incoherent;
  const std::vector<EdgeSource> sources = edge_sources(shapes);
  if (sources.empty()) return rays;
  std::mt19937_64 random(seed);
  const auto share = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  struct Aim {
    Vec3f from, at;
  };
  std::vector<Aim> aims;
  Imath::Box3f bounds;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t number = random() % sources.back().triangles_up_to;
    const auto source =
        std::upper_bound(sources.begin(), sources.end(), number,
                         [](std::uint64_t n, const EdgeSource& one) { return n < one.triangles_up_to; });
    const std::size_t triangle = source->mesh->triangle_count() - (source->triangles_up_to - number);
    const std::size_t k = random() % 3;
    const Vec3d a(source->corner(triangle, k)), b(source->corner(triangle, (k + 1) % 3));
    aims.push_back({eye, Vec3f(a + (b - a) * share())});
    bounds.extendBy(aims.back().at);
  }
  // Bounds of what is aimed at: of the scene, but for a few triangles.
  const Vec3d center(bounds.center()), extent(bounds.size());
  for (std::size_t i = 1; i < aims.size(); i += 2)
    aims[i].from =
        Vec3f(center + Vec3d(extent.x * (2 * share() - 1), extent.y * (2 * share() - 1), extent.z * (2 * share() - 1)));
  for (const Aim& aim : aims) {
    const Vec3f toward = aim.at - aim.from;
    if (!(toward.dot(toward) > 0)) continue;
    add_ray(rays, aim.from, unit(toward), kInfinity);
  }
  return rays;
}

}  // namespace raytree::benchmarks
