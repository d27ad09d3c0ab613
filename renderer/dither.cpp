// The dither of 8-bit pictures: a void-and-cluster mask (Ulichney 1993, "The void-and-cluster method for dither array
// generation") computed once, in integers so that every machine gets the same one.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "renderer/display.h"

namespace raytree {
namespace {

constexpr int kSize = kDitherSize;
constexpr int kCount = kSize * kSize;
constexpr int kInitialOnes = kCount / 10;  // Ulichney: about a tenth
constexpr double kSigma = 1.5;             // Ulichney, sec. 3: the width that he found best
constexpr int kRadius = 8;                 // the Gaussian is below 2^-20 of its peak beyond it

// Which pixels are set, and how crowded each place is: the sum of a Gaussian around every set pixel, on a torus.
class Pattern {
 public:
  Pattern() {
    for (int dy = -kRadius; dy <= kRadius; ++dy)
      for (int dx = -kRadius; dx <= kRadius; ++dx)
        weight_[static_cast<std::size_t>((dy + kRadius) * kSpan + dx + kRadius)] =
            static_cast<std::int32_t>(std::lround(std::exp(-(dx * dx + dy * dy) / (2 * kSigma * kSigma)) * (1 << 20)));
  }

  bool is_set(int place) const { return set_[static_cast<std::size_t>(place)]; }

  void toggle(int place) {
    const bool now = !is_set(place);
    set_[static_cast<std::size_t>(place)] = now;
    crowding_[static_cast<std::size_t>(place)] += now ? kSetBias : -kSetBias;
    const std::int32_t sign = now ? 1 : -1;
    const int x = place % kSize, y = place / kSize;
    for (int dy = -kRadius; dy <= kRadius; ++dy)
      for (int dx = -kRadius; dx <= kRadius; ++dx)
        crowding_[static_cast<std::size_t>(((y + dy) & (kSize - 1)) * kSize + ((x + dx) & (kSize - 1)))] +=
            sign * weight_[static_cast<std::size_t>((dy + kRadius) * kSpan + dx + kRadius)];
  }

  /// The set place with the most, or the unset one with the least crowding; the first of equals.
  int tightest_cluster() const {
    std::int32_t most = crowding_[0];
    for (const std::int32_t value : crowding_) most = std::max(most, value);
    return first_of(most);
  }
  int largest_void() const {
    std::int32_t least = crowding_[0];
    for (const std::int32_t value : crowding_) least = std::min(least, value);
    return first_of(least);
  }

 private:
  static constexpr int kSpan = 2 * kRadius + 1;
  // Lifts set places above all unset ones, so that both searches are plain extremes. The Gaussian's weights sum to
  // 2 pi sigma^2 2^20 < 2^24.
  static constexpr std::int32_t kSetBias = 1 << 28;

  int first_of(std::int32_t value) const {
    return static_cast<int>(std::find(crowding_.begin(), crowding_.end(), value) - crowding_.begin());
  }

  std::array<bool, kCount> set_{};
  std::array<std::int32_t, kCount> crowding_{};
  std::array<std::int32_t, static_cast<std::size_t>(kSpan* kSpan)> weight_{};
};

std::array<float, kCount> void_and_cluster_thresholds() {
  Pattern pattern;
  std::uint32_t state = 1;
  for (int ones = 0; ones < kInitialOnes;) {
    state = state * 1664525u + 1013904223u;
    const int place = static_cast<int>(state >> 20);  // 12 bits: one of 4096
    if (pattern.is_set(place)) continue;
    pattern.toggle(place);
    ++ones;
  }
  // Move points from the tightest cluster to the largest void until that moves nothing.
  for (;;) {
    const int from = pattern.tightest_cluster();
    pattern.toggle(from);
    const int to = pattern.largest_void();
    pattern.toggle(to);
    if (to == from) break;
  }

  std::array<int, kCount> rank{};
  Pattern thinned = pattern;
  for (int r = kInitialOnes - 1; r >= 0; --r) {
    const int place = thinned.tightest_cluster();
    thinned.toggle(place);
    rank[static_cast<std::size_t>(place)] = r;
  }
  // The paper's third phase seeks clusters of unset places once half are set: on a torus those are the same places as
  // the voids of the set ones, since the crowding of both sums to a constant.
  for (int r = kInitialOnes; r < kCount; ++r) {
    const int place = pattern.largest_void();
    pattern.toggle(place);
    rank[static_cast<std::size_t>(place)] = r;
  }

  std::array<float, kCount> thresholds{};
  for (std::size_t i = 0; i < thresholds.size(); ++i)
    thresholds[i] = kDitherMargin + (1 - 2 * kDitherMargin) * (static_cast<float>(rank[i]) + 0.5f) / kCount;
  return thresholds;
}

}  // namespace

float dither_threshold(int frame_x, int frame_y) {
  static const std::array<float, kCount> thresholds = void_and_cluster_thresholds();
  return thresholds[static_cast<std::size_t>((frame_y & (kSize - 1)) * kSize + (frame_x & (kSize - 1)))];
}

}  // namespace raytree
