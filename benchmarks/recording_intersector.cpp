#include "benchmarks/recording_intersector.h"

#include <utility>

namespace raytree::benchmarks {

void RecordingIntersector::intersect(const RayBatch& rays, Coherence coherence, HitBatch& hits) const noexcept {
  tracer_.intersect(rays, coherence, hits);
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < rays.size; ++i) count += hits.geometry[i] != kNoGeometry;
  note(rays, coherence == Coherence::coherent ? RayClass::coherent_nearest : RayClass::incoherent_nearest, count);
}

void RecordingIntersector::occluded(const RayBatch& rays, Coherence coherence, std::uint8_t* occluded) const noexcept {
  tracer_.occluded(rays, coherence, occluded);
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < rays.size; ++i) count += occluded[i] != 0;
  note(rays, coherence == Coherence::coherent ? RayClass::coherent_occlusion : RayClass::incoherent_occlusion, count);
}

void RecordingIntersector::note(const RayBatch& rays, RayClass ray_class, std::uint64_t hits) const {
  std::lock_guard lock(mutex_);
  record_.batches.push_back({ray_class, record_.rays.size(), rays.size});
  for (std::size_t i = 0; i < rays.size; ++i)
    record_.rays.push_back({rays.origin(i), rays.direction(i), rays.max_distance[i]});
  record_.hits[static_cast<std::size_t>(ray_class)] += hits;
}

RecordedRender record_render(Scene& scene) {
  std::unique_ptr<const RayIntersector> own = std::move(scene.intersector);
  auto recorder = std::make_unique<RecordingIntersector>(*own);
  RecordingIntersector& recording = *recorder;
  scene.intersector = std::move(recorder);
  RenderOptions options;
  options.threads = 1;
  RecordedRender result;
  result.statistics = render(scene, options).statistics;
  result.record = recording.take();
  scene.intersector = std::move(own);
  return result;
}

const EmbreeIntersector& embree_of(const Scene& scene) {
  return dynamic_cast<const EmbreeIntersector&>(*scene.intersector);
}

std::unique_ptr<EmbreeIntersector> plain_embree(const Scene& scene) {
  EmbreeOptions options;
  options.most_few_shapes = 0;
  return std::make_unique<EmbreeIntersector>(*scene.shapes, options);
}

Scene with_tracer(Scene scene, const EmbreeOptions& options) {
  scene.intersector = std::make_unique<EmbreeIntersector>(*scene.shapes, options);
  return scene;
}

}  // namespace raytree::benchmarks
