// Whether the answers that configurations of `raytree bench` differ in are right, each as far as its arithmetic goes:
// every ray with two answers is asked again in double, and an answer stands if a bound on the rounding of what gave it
// allows for it. How many rays differ says nothing about right and wrong, and is not looked at.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/bench_tracers.h"
#include "benchmarks/ray_comparison.h"
#include "geometry/triangle_reference.h"

namespace raytree::benchmarks {

/// Distances farther apart than this share of them are two answers; closer ones are not told apart.
inline constexpr double kSameDistance = 0x1p-10;

/// Whether two distances (infinite: no hit) are two answers.
bool differs(float a, float b);

/// What is known of the rays whose answers differ.
struct CheckedAnswers {
  std::uint64_t checked = 0;  ///< rays that were asked again
  std::uint64_t wrong = 0;    ///< of them those whose answer no rounding makes
  std::string example;        ///< the first of these, in words; empty: none
};

/// The truth about one scene's triangles, or about those that one configuration has in their place.
class BenchCheck {
 public:
  /// Over shapes, which must outlive it. Takes about a microsecond a triangle.
  explicit BenchCheck(const ShapeSet& shapes);
  /// Over the triangles that a tracer has in place of the scene's: EmbreeBenchScene::surface().
  explicit BenchCheck(ShapeSet&& surface);

  /// Whether an answer about a ray, as BenchAnswers has them, is what the configuration's arithmetic can make of it.
  /// `tracer`: what gave it.
  bool stands(const BenchConfiguration& configuration, const BuiltTracer& tracer, const ComparedRay& ray,
              float answer) const;
  /// Looks at the answers about the rays [batch * kBenchmarkBatch + ray] given, no more than kMostChecked of them,
  /// spread evenly.
  CheckedAnswers check(const BenchConfiguration& configuration, const BuiltTracer& tracer, const BenchRays& kind,
                       const std::vector<float>& answers, const std::vector<std::size_t>& rays) const;

  static constexpr std::size_t kMostChecked = 4096;

 private:
  std::optional<ShapeSet> surface_;
  const ShapeSet& shapes_;
  const TriangleReference truth_;
};

/// A ray of a kind, as the renderer's tracer gets it.
ComparedRay ray_of(const BenchRays& kind, std::size_t index);

}  // namespace raytree::benchmarks
