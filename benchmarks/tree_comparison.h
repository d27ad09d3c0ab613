// The ray trees of some samples, traced twice: first as the renderer traces them, with every ray noted as it was asked,
// bit for bit; then with the truth's answers to those same rays. Float error grows by 2 d / r at each convex mirror, so
// trees that run free differ without anyone's fault: here the second tree's rays are put in the place of the first's.
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <vector>

#include "benchmarks/ray_comparison.h"
#include "geometry/stopwatch.h"
#include "renderer/ray_tree.h"
#include "renderer/render.h"

namespace raytree::benchmarks {

/// A ray of a sample's tree, and what both tracers say of it.
struct TreeRay {
  ComparedRay ray;
  RayKind kind = RayKind::primary;
  std::uint16_t sample = 0;
  bool follows_shadow = false;   ///< asks for the nearest hit on the way to a light
  bool occluded = false;         ///< the fast tracer's answer
  bool is_taken = false;         ///< by the second tree
  Hit hit;                       ///< the fast tracer's answer
  Vec3f position{0}, normal{0};  ///< of the surface that the fast tracer hit
  ReferenceHit found;
  RayComparison comparison;
};

/// What it takes to answer so many rays.
struct TracerSpeed {
  std::uint64_t rays = 0;
  double seconds = 0;  ///< summed over threads

  double rays_per_second() const { return seconds > 0 ? static_cast<double>(rays) / seconds : 0; }
};

/// The trees of one chunk of samples. One thread's.
struct TreeLog {
  enum class Mode : std::uint8_t { off, record, replay } mode = Mode::off;
  std::vector<std::uint8_t> chosen;                   ///< [sample] whether its rays are noted
  std::vector<TreeRay> rays;                          ///< in the order of asking
  std::vector<std::vector<std::uint32_t>> by_sample;  ///< [sample] indices into rays
  std::vector<std::uint16_t> replayed;                ///< [sample of the second tree] -> of the first
  std::uint64_t diverged = 0;                         ///< rays of the second tree that the first has none for
  TracerSpeed fast, truth;
};

/// The fast tracer, looked at. A thread's calls go to its log; without one they pass.
class TreeTracer final : public RayIntersector {
 public:
  TreeTracer(const ShapeSet& shapes, const RayIntersector& tracer, const ReferenceTracer& truth)
      : shapes_(shapes), tracer_(tracer), truth_(truth) {}

  /// Of the calling thread; null: none.
  static void set_log(TreeLog* log);

  /// In replay, a ray of the batch that has its like in the log becomes that ray: the caller's arrays are written.
  void intersect(const RayBatch& rays, Coherence coherence, HitBatch& hits) const noexcept override;
  void occluded(const RayBatch& rays, Coherence coherence, std::uint8_t* occluded) const noexcept override;
  std::size_t memory_bytes() const noexcept override { return tracer_.memory_bytes(); }
  std::size_t peak_memory_bytes() const noexcept override { return tracer_.peak_memory_bytes(); }

 private:
  /// Notes the batch that was traced since `start`; describe(i, ray) says what it was and came to.
  template <class Describe>
  void record(TreeLog& log, const RayBatch& rays, Clock::time_point start, Describe&& describe) const;
  void note(TreeLog& log, const RayBatch& rays, std::size_t i, TreeRay ray) const;

  const ShapeSet& shapes_;
  const RayIntersector& tracer_;
  const ReferenceTracer& truth_;
};

/// The single-precision hit that stands for the truth's.
Hit rounded_hit(const ReferenceHit& found, float max_distance);

/// Samples' radiance by either tracer.
struct TreeRadiance {
  std::vector<Rgb> fast;   ///< [positions.size()]
  std::vector<Rgb> truth;  ///< the same; defined where chosen
};

/// Traces the trees of `positions` (at most kBatchSize), asks the truth about every ray of those `chosen` and judges
/// it, then shades by the truth's answers; a ray that is not agreed upon keeps the fast tracer's answer. False:
/// stopped. `samples`: of a scene whose intersector is a TreeTracer.
bool compare_trees(std::span<const Vec2f> positions, const std::vector<std::uint8_t>& chosen, const RayJudge& judge,
                   SampleTracer& samples, TreeLog& log, TreeRadiance& radiance);

}  // namespace raytree::benchmarks
