#include "benchmarks/bench_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "benchmarks/validation.h"

namespace raytree::benchmarks {
namespace {

/// The seam to no tracer: answers are judged as they were given.
class NoTracer final : public RayIntersector {
 public:
  void intersect(const RayBatch& rays, Coherence, HitBatch& hits) const noexcept override {
    for (std::size_t i = 0; i < rays.size; ++i) hits.set(i, Hit());
  }
  void occluded(const RayBatch& rays, Coherence, std::uint8_t* occluded) const noexcept override {
    std::fill_n(occluded, rays.size, std::uint8_t(0));
  }
  std::size_t memory_bytes() const noexcept override { return 0; }
  std::size_t peak_memory_bytes() const noexcept override { return 0; }
};

/// Embree's own spheres and discs are single precision; the renderer's tracer has a few in double.
FastArithmetic arithmetic_of(const BenchConfiguration& configuration) {
  FastArithmetic arithmetic;
  if (configuration.tracer == BenchTracer::naive) return arithmetic;
  if (configuration.tracer == BenchTracer::bare) arithmetic.most_few_shapes = 0;
  if (!configuration.build.robust) arithmetic.triangles = FastArithmetic::Triangles::plain;
  return arithmetic;
}

/// Whether a ray comes so near a box that rounding may take it for meeting it.
bool may_meet(const Imath::Box3f& box, const ComparedRay& ray) {
  constexpr double kSlack = 0x1p-18;  // more than any test's bound; the box is a speck beside the scene
  double enter = 0, leave = ray.max_distance;
  for (int axis = 0; axis < 3; ++axis) {
    const double slack = kSlack * (std::abs(double(ray.origin[axis])) + std::abs(double(box.max[axis])));
    const double a = (box.min[axis] - slack - ray.origin[axis]) / ray.direction[axis],
                 b = (box.max[axis] + slack - ray.origin[axis]) / ray.direction[axis];
    enter = std::max(enter, std::min(a, b)), leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave;
}

std::string answer_text(float answer, bool occlusion) {
  if (answer == kInfinity) return occlusion ? "open" : "a miss";
  return occlusion ? "occluded" : fmt::format("a hit at {}", answer);
}

}  // namespace

bool differs(float a, float b) {
  if (a == kInfinity || b == kInfinity) return a != b;
  return std::abs(a - b) > kSameDistance * std::max(a, b);
}

ComparedRay ray_of(const BenchRays& kind, std::size_t index) {
  const RayBatch& batch = kind.rays.batches[index / kBenchmarkBatch];
  const std::size_t i = index % kBenchmarkBatch;
  return {batch.origin(i), batch.direction(i), batch.max_distance[i], kind.rays.occlusion};
}

BenchCheck::BenchCheck(const ShapeSet& shapes) : shapes_(shapes), truth_(shapes_) {}

BenchCheck::BenchCheck(ShapeSet&& surface) : surface_(std::move(surface)), shapes_(*surface_), truth_(shapes_) {}

bool BenchCheck::stands(const BenchConfiguration& configuration, const BuiltTracer& tracer, const ComparedRay& ray,
                        float answer) const {
  const NoTracer none;
  RayJudge judge(shapes_, none, shapes_, truth_);
  judge.set_arithmetic(arithmetic_of(configuration));
  if (judge.is_possible(ray, answer, kSameDistance)) return true;
  const Imath::Box3f company = tracer.bare ? tracer.bare->company_bounds() : Imath::Box3f();
  return !company.isEmpty() && may_meet(company, ray);
}

CheckedAnswers BenchCheck::check(const BenchConfiguration& configuration, const BuiltTracer& tracer,
                                 const BenchRays& kind, const std::vector<float>& answers,
                                 const std::vector<std::size_t>& rays) const {
  CheckedAnswers result;
  result.checked = std::min(rays.size(), kMostChecked);
  for (std::size_t k = 0; k < result.checked; ++k) {
    const std::size_t at = rays[k * rays.size() / result.checked];
    const ComparedRay ray = ray_of(kind, at);
    if (stands(configuration, tracer, ray, answers[at])) continue;
    if (result.wrong++ > 0) continue;
    const ReferenceHit found = truth_.nearest(Vec3d(ray.origin), Vec3d(ray.direction), ray.max_distance);
    const float truth = !found.hit() ? kInfinity : ray.occlusion ? 0 : static_cast<float>(found.distance);
    result.example = fmt::format("{} {}{}: {}, in double {}", exact(ray.origin), exact(ray.direction),
                                 ray.max_distance < kInfinity ? " --end " + exact(ray.max_distance) : std::string(),
                                 answer_text(answers[at], ray.occlusion), answer_text(truth, ray.occlusion));
  }
  return result;
}

}  // namespace raytree::benchmarks
