// The rays that `raytree bench` asks: what a scene gives rise to, what is aimed at its edges, what a file holds.
#include <algorithm>
#include <cmath>
#include <limits>

#include "benchmarks/bench_run.h"
#include "benchmarks/edge_rays.h"
#include "geometry/few_shapes.h"

namespace raytree::benchmarks {
namespace {

BenchRays bench_rays_of(std::string name, RaySet rays, const ShapeSet& shapes) {
  BenchRays result;
  result.name = std::move(name);
  if (!shapes.planes.empty()) {
    const FewShapes planes(shapes, 0);
    result.without_planes.coherence = rays.coherence, result.without_planes.occlusion = rays.occlusion;
    for (const RayBatch& batch : rays.batches) {
      RayBatch& copy = result.without_planes.batches.emplace_back(kBenchmarkBatch);
      std::vector<float>& distances = result.plane_distance.emplace_back();
      for (std::size_t i = 0; i < batch.size; ++i) {
        const Hit plane = intersect_few(planes, batch.origin(i), batch.direction(i), batch.max_distance[i]);
        const bool met = plane.geometry != kNoGeometry;
        distances.push_back(met ? plane.distance : kInfinity);
        copy.push(batch.origin(i), batch.direction(i), met && !rays.occlusion ? plane.distance : batch.max_distance[i]);
      }
    }
  }
  result.rays = std::move(rays);
  return result;
}

}  // namespace

std::size_t batches_for(double seconds) {
  constexpr std::size_t kLeast = 4, kMost = 256;
  if (seconds <= 0) return kBenchBatches;
  // A minute for a scene's 60 kinds of rows or so, ten passes each, asks some 0.2 million rays a row.
  std::size_t batches = kLeast;
  while (batches < kMost && static_cast<double>(2 * batches) <= 4 * seconds) batches *= 2;
  return batches;
}

std::vector<BenchRays> bench_rays(const Scene& scene, std::size_t most_batches, const std::atomic<bool>* stop) {
  std::vector<BenchRays> result;
  auto sets = benchmark_rays(scene, stop, most_batches);
  for (std::size_t k = 0; k < kBenchmarkRaysCount; ++k)
    if (sets[k].size() > 0)
      result.push_back(bench_rays_of(name_of(static_cast<BenchmarkRays>(k)), thinned(std::move(sets[k]), most_batches),
                                     *scene.shapes));
  const auto [width, height] = scene.description.image;
  Vec3f eye, direction;
  scene.camera.ray(0.5f * static_cast<float>(width), 0.5f * static_cast<float>(height), eye, direction);
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  RaySet edges = edge_aimed_rays(*scene.shapes, eye, std::min(pixels, most_batches * kBenchmarkBatch));
  if (edges.size() > 0) result.push_back(bench_rays_of("edge", std::move(edges), *scene.shapes));
  return result;
}

std::vector<BenchRays> bench_rays(const Scene& scene, const std::vector<FileRay>& file) {
  RaySet rays;
  rays.coherence = Coherence::mixed;
  for (const FileRay& ray : file) {
    const Vec3d origin = Vec3d(ray.origin) - scene.shapes->origin + Vec3d(ray.direction) * double(ray.begin);
    add_ray(rays, Vec3f(origin), ray.direction, ray.end - ray.begin);
  }
  std::vector<BenchRays> result;
  result.push_back(bench_rays_of("file", std::move(rays), *scene.shapes));
  return result;
}

}  // namespace raytree::benchmarks
