// Whitted's tree of rays, a batch of samples at a time: generations of rays are intersected, shaded and spawned in
// batches; weights multiply down the tree, so light is added straight to the sample and nothing recurses. Where samples
// lie and how they make pixels is left to tile_tracer.h and adaptive_sampling.h.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geometry/vec.h"
#include "renderer/color.h"
#include "renderer/render.h"
#include "renderer/scene.h"

namespace raytree {

/// What an eye ray hit.
struct FirstHit {
  float distance = 0;          ///< along the eye ray, scene units
  Vec3f normal{0, 0, 0};       ///< shading normal, unit
  Rgb albedo;                  ///< k_d
  std::uint32_t object = 0;    ///< shape's or instance's index + 1; 0: nothing was hit
  std::uint32_t material = 0;  ///< material index + 1
};

/// What is recorded of a sample beside its radiance.
struct SampleRecords {
  bool first_hits = false, ray_counts = false, truncation = false;
};

/// Of the samples traced last, in their order. Arrays that were not asked for are empty.
struct SampleResults {
  std::vector<Rgb> radiance;    ///< may be not finite where some input was not
  std::vector<Rgb> truncation;  ///< bound on what the cutoff took away
  std::vector<std::uint32_t> ray_counts;
  std::vector<FirstHit> first_hits;
};

/// Traces samples of one scene on one thread. Its queue pops kBatchSize of the newest rays and pushes at most twice as
/// many, so it never holds more than kBatchSize times the tree's depth. A rough bounce pushes 2 N for one, but once on
/// a way down the tree: such rays lie above all that may still split, and are gone before one of those splits; so they
/// add 2 N kBatchSize and what grows from the newest kBatchSize of them. What a batch of samples yields depends on the
/// scene, the settings and the batch's positions, in their order, alone.
class SampleTracer {
 public:
  /// `scene` and `stop` (null: never stopped) must outlive the tracer.
  SampleTracer(const Scene& scene, const SampleRecords& records, const std::atomic<bool>* stop);
  ~SampleTracer();
  SampleTracer(SampleTracer&&) noexcept;

  /// Traces up to kBatchSize samples at image positions as Camera::ray() takes them; neighbours in the list should be
  /// neighbours in the image, eight to a packet. Each stands for a square of `spacing` pixels about it, which patterns
  /// are filtered by. False: stopped on the way, and the results are void.
  bool trace(std::span<const Vec2f> positions, float spacing);

  const SampleResults& results() const { return *results_; }

  RenderStatistics& statistics();
  const RenderStatistics& statistics() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
  const SampleResults* results_;
};

}  // namespace raytree
