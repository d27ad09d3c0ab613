#include "benchmarks/outline_difference.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <vector>

namespace raytree::benchmarks {
namespace {

constexpr int kPixelSamples = kOutlineGrid * kOutlineGrid;
static_assert(kPixelSamples <= int(kBatchSize));

/// Whether the centers of the pixels are covered: [height + 2][width + 2], from one pixel outside the frame on.
std::vector<std::uint8_t> covered_centers(const RayIntersector& tracer, const Camera& camera, int width, int height) {
  const int across = width + 2;
  std::vector<std::uint8_t> covered(static_cast<std::size_t>(across) * static_cast<std::size_t>(height + 2));
  tbb::parallel_for(tbb::blocked_range<int>(0, height + 2), [&](const auto& range) {
    RayBatch rays(kBatchSize);
    HitBatch hits(kBatchSize);
    for (int y = range.begin(); y != range.end(); ++y)
      for (int begin = 0; begin < across; begin += int(kBatchSize)) {
        const int end = std::min(across, begin + int(kBatchSize));
        rays.size = 0;
        for (int x = begin; x < end; ++x) {
          Vec3f origin, direction;
          camera.ray(float(x) - 0.5f, float(y) - 0.5f, origin, direction);
          rays.push(origin, direction, kInfinity);
        }
        tracer.intersect(rays, Coherence::incoherent, hits);
        for (int x = begin; x < end; ++x)
          covered[std::size_t(y) * std::size_t(across) + std::size_t(x)] =
              hits.geometry[x - begin] != kNoGeometry ? 1 : 0;
      }
  });
  return covered;
}

/// The two tracers' answers about one pixel at a time.
class PixelSampler {
 public:
  explicit PixelSampler(const Camera& camera) : camera_(camera) {}

  void look_at(int x, int y) {
    rays_.size = 0;
    for (int j = 0; j < kOutlineGrid; ++j)
      for (int i = 0; i < kOutlineGrid; ++i) {
        Vec3f origin, direction;
        camera_.ray(float(x) + (float(i) + 0.5f) / kOutlineGrid, float(y) + (float(j) + 0.5f) / kOutlineGrid, origin,
                    direction);
        rays_.push(origin, direction, kInfinity);
      }
  }
  int covered(const RayIntersector& tracer) {
    tracer.intersect(rays_, Coherence::incoherent, hits_);
    return static_cast<int>(
        std::count_if(hits_.geometry, hits_.geometry + rays_.size, [](GeometryId id) { return id != kNoGeometry; }));
  }

 private:
  const Camera& camera_;
  RayBatch rays_{kBatchSize};
  HitBatch hits_{kBatchSize};
};

/// In samples: sums of whole numbers, in any order.
struct SampleSums {
  std::uint64_t pixels = 0, apart = 0, over = 0;
  int largest = 0;
};

}  // namespace

OutlineDifference outline_difference(const RayIntersector& a, const RayIntersector& b, const Camera& camera, int width,
                                     int height, double bound) {
  const std::vector<std::uint8_t> centers_a = covered_centers(a, camera, width, height),
                                  centers_b = covered_centers(b, camera, width, height);
  const auto across = static_cast<std::size_t>(width + 2);
  const auto near_outline = [&](int x, int y) {
    bool any = false, all = true;
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t i = 0; i < 3; ++i)
        for (const auto* centers : {&centers_a, &centers_b}) {
          const bool covered = (*centers)[(std::size_t(y) + j) * across + std::size_t(x) + i] != 0;
          any |= covered, all &= covered;
        }
    return any && !all;
  };
  const SampleSums sums = tbb::parallel_reduce(
      tbb::blocked_range<int>(0, height), SampleSums(),
      [&](const auto& range, SampleSums so_far) {
        PixelSampler sampler(camera);
        for (int y = range.begin(); y != range.end(); ++y)
          for (int x = 0; x < width; ++x) {
            if (!near_outline(x, y)) continue;
            sampler.look_at(x, y);
            const int of_a = sampler.covered(a), of_b = sampler.covered(b), apart = std::abs(of_a - of_b);
            if (of_a + of_b == 0 || of_a + of_b == 2 * kPixelSamples) continue;
            ++so_far.pixels;
            so_far.apart += static_cast<std::uint64_t>(apart);
            so_far.over += apart > bound * kPixelSamples ? 1 : 0;
            so_far.largest = std::max(so_far.largest, apart);
          }
        return so_far;
      },
      [](SampleSums one, const SampleSums& other) {
        one.pixels += other.pixels, one.apart += other.apart, one.over += other.over;
        one.largest = std::max(one.largest, other.largest);
        return one;
      });
  OutlineDifference result;
  result.pixels = sums.pixels;
  result.over = sums.over;
  result.largest = double(sums.largest) / kPixelSamples;
  result.mean = sums.pixels == 0 ? 0 : double(sums.apart) / kPixelSamples / double(sums.pixels);
  return result;
}

double outline_bound(double distance) { return std::sqrt(2.0) * (distance + 1.0 / kOutlineGrid); }

}  // namespace raytree::benchmarks
