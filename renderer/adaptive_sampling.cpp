#include "renderer/adaptive_sampling.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "renderer/small_objects.h"

namespace raytree {
namespace {

constexpr std::uint32_t kNoSample = SampleLattice::kNoSample;

/// Around a small object squares are divided until their edge is this share of its width: what then still falls between
/// two samples on its rim is a cap of under 1/300 of a disc.
constexpr double kEdgePerWidth = 0.25;

/// Objects narrower than so many edges of the last level's squares are weighed by their outline's area; samples decide
/// only what they look like. A disc is met for sure from sqrt(2) on.
constexpr double kTinyWidth = 2;

/// The pixel of the tile at place `i` of Morton's order, which keeps neighbours together.
constexpr int morton_coordinate(int i) {
  int x = 0;
  for (int bit = 0; bit < 5; ++bit) x |= (i >> (2 * bit) & 1) << bit;
  return x;
}
static_assert(kTileSize == 32, "five bits");

}  // namespace

Rgb display_like(const Rgb& radiance) {
  const auto shown = [](float x) { return std::sqrt(std::max(x, 0.0f) + kDisplayToe); };
  return {shown(radiance.r), shown(radiance.g), shown(radiance.b)};
}

AdaptiveSampler::AdaptiveSampler(const Scene& scene)
    : scene_(scene),
      levels_(scene.description.render.adaptive.levels),
      minimum_level_(scene.description.render.adaptive.minimum_level),
      threshold_(static_cast<float>(scene.description.render.adaptive.threshold)) {}

bool AdaptiveSampler::trace(int x0, int y0, SampleTracer& tracer, TileSums& sums) {
  begin_tile(x0, y0);
  list_small_objects();
  add_pixels();
  if (!trace_new_samples(tracer, 1)) return false;
  for (int level = 0; level < levels_ && !squares_.empty(); ++level)
    if (!divide_level(tracer)) return false;
  leaves_.insert(leaves_.end(), squares_.begin(), squares_.end());
  sort_leaves();
  if (!find_tiny_objects(tracer)) return false;
  resolve(sums);
  return true;
}

void AdaptiveSampler::begin_tile(int x0, int y0) {
  x0_ = x0, y0_ = y0;
  width_ = std::min(kTileSize, scene_.description.image.width - x0);
  height_ = std::min(kTileSize, scene_.description.image.height - y0);
  squares_.clear();
  leaves_.clear();
  near_.clear();
  positions_.clear();
  home_.clear();
  radiance_.clear();
  shown_.clear();
  truncation_.clear();
  hits_.clear();
  ray_counts_.clear();
  tiny_.clear();
}

/// The small objects of each pixel into near_.
void AdaptiveSampler::list_small_objects() {
  pixel_near_.assign(kTilePixels + 1, 0);
  const std::span<const std::uint32_t> objects = scene_.small_objects.of_tile(x0_, y0_);
  if (objects.empty()) return;
  const auto for_each_pixel = [&](std::uint32_t index, auto&& function) {
    const ImageRectangle& box = scene_.small_objects[index].box;
    const double reach_x = box.half_length * std::abs(box.along.x) + box.half_width * std::abs(box.along.y);
    const double reach_y = box.half_length * std::abs(box.along.y) + box.half_width * std::abs(box.along.x);
    const auto limited = [](double x, int count) {
      return static_cast<int>(std::clamp(std::floor(x), 0.0, count - 1.0));
    };
    const int left = limited(box.center.x - reach_x - x0_, width_),
              right = limited(box.center.x + reach_x - x0_, width_);
    const int top = limited(box.center.y - reach_y - y0_, height_),
              bottom = limited(box.center.y + reach_y - y0_, height_);
    for (int y = top; y <= bottom; ++y)
      for (int x = left; x <= right; ++x)
        if (box.overlaps({x0_ + x + 0.5, y0_ + y + 0.5}, 0.5)) function(y * kTileSize + x);
  };
  for (const std::uint32_t index : objects) for_each_pixel(index, [&](int pixel) { ++pixel_near_[pixel + 1]; });
  for (int i = 0; i < kTilePixels; ++i) pixel_near_[i + 1] += pixel_near_[i];
  near_.resize(pixel_near_.back());
  std::vector<std::uint32_t> next(pixel_near_.begin(), pixel_near_.end() - 1);
  for (const std::uint32_t index : objects) for_each_pixel(index, [&](int pixel) { near_[next[pixel]++] = index; });
}

/// The corners of the tile's pixels, in blocks of a packet, and the pixels as squares between them.
void AdaptiveSampler::add_pixels() {
  constexpr int kStride = kTileSize + 1;
  std::array<std::uint32_t, kStride * kStride> corner;
  for (int block_y = 0; block_y <= height_; block_y += kBlockHeight)
    for (int block_x = 0; block_x <= width_; block_x += kBlockWidth)
      for (int y = block_y; y < std::min(block_y + kBlockHeight, height_ + 1); ++y)
        for (int x = block_x; x < std::min(block_x + kBlockWidth, width_ + 1); ++x)
          corner[y * kStride + x] = add_sample({static_cast<float>(x0_ + x), static_cast<float>(y0_ + y)},
                                               std::min(y, height_ - 1) * kTileSize + std::min(x, width_ - 1));
  for (int i = 0; i < kTilePixels; ++i) {
    const int x = morton_coordinate(i), y = morton_coordinate(i >> 1);
    if (x >= width_ || y >= height_) continue;
    const std::uint32_t* upper = &corner[y * kStride + x];
    const int pixel = y * kTileSize + x;
    squares_.push_back({{upper[0], upper[1], upper[kStride], upper[kStride + 1]},
                        static_cast<std::uint16_t>(x << levels_),
                        static_cast<std::uint16_t>(y << levels_),
                        0,
                        pixel_near_[pixel],
                        pixel_near_[pixel + 1]});
  }
}

std::uint32_t AdaptiveSampler::add_sample(const Vec2f& position, int pixel) {
  positions_.push_back(position);
  home_.push_back(static_cast<std::uint16_t>(pixel));
  return static_cast<std::uint32_t>(positions_.size() - 1);
}

/// Traces the samples that were added since the last call, `spacing` pixels apart.
bool AdaptiveSampler::trace_new_samples(SampleTracer& tracer, double spacing) {
  while (radiance_.size() < positions_.size()) {
    const std::size_t count = std::min(kBatchSize, positions_.size() - radiance_.size());
    if (!tracer.trace({positions_.data() + radiance_.size(), count}, static_cast<float>(spacing))) return false;
    const SampleResults& results = tracer.results();
    const std::size_t first = radiance_.size();
    radiance_.resize(first + count);
    shown_.resize(first + count);
    for (std::size_t i = 0; i < count; ++i) {
      const bool finite = is_finite(results.radiance[i]);
      if (!finite) ++tracer.statistics().not_finite_samples;
      const Rgb radiance = finite ? results.radiance[i] : Rgb();
      radiance_[first + i] = radiance;
      shown_[first + i] = display_like(radiance);
    }
    const auto append = [&](auto& all, const auto& part) {
      if (!part.empty()) all.insert(all.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(count));
    };
    append(truncation_, results.truncation);
    append(hits_, results.first_hits);
    append(ray_counts_, results.ray_counts);
  }
  return true;
}

/// How much samples differ, on the display-like scale.
float AdaptiveSampler::contrast(std::span<const std::uint32_t> samples) const {
  Rgb low = shown_[samples[0]], high = low;
  for (const std::uint32_t sample : samples.subspan(1)) {
    const Rgb& c = shown_[sample];
    low = {std::min(low.r, c.r), std::min(low.g, c.g), std::min(low.b, c.b)};
    high = max(high, c);
  }
  const float difference = max_channel(high - low);
  if (difference >= kFormContrast) return difference;
  const FirstHit& first = hits_[samples[0]];
  for (const std::uint32_t sample : samples)
    if (hits_[sample].object != first.object) return kFormContrast;
  if (first.object == 0) return difference;
  for (std::size_t i = 0; i < samples.size(); ++i)
    for (std::size_t k = i + 1; k < samples.size(); ++k)
      if (hits_[samples[i]].normal.dot(hits_[samples[k]].normal) < kNormalCosine) return kFormContrast;
  return difference;
}

/// Along an edge through a pixel there are 2^level squares, each with a share of 4^-level of it, and the errors that
/// they leave differ in sign: what a square contributes shrinks faster than its edge. So large differences are followed
/// further down than small ones.
bool AdaptiveSampler::is_too_much(float contrast, int level) const {
  return contrast * static_cast<float>(edge(level)) > threshold_;
}

bool AdaptiveSampler::wants_division(const Square& square) const {
  return square.level < minimum_level_ || square.near_begin != square.near_end ||
         is_too_much(contrast(square.corners), square.level);
}

/// Whether what neighbours found on the sides of a square differs from its corners: something reaches into it that its
/// corners do not see.
bool AdaptiveSampler::differs_on_a_side(const Square& square) const {
  const int size = 1 << (levels_ - square.level), half = size / 2;
  std::array<std::uint32_t, 8> samples;
  std::copy(square.corners.begin(), square.corners.end(), samples.begin());
  std::size_t count = 4;
  for (const auto& [x, y] : {std::pair{half, 0}, {0, half}, {size, half}, {half, size}})
    if (const std::uint32_t sample = level_samples_.find(square.x + x, square.y + y); sample != kNoSample)
      samples[count++] = sample;
  return count > 4 && is_too_much(contrast({samples.data(), count}), square.level);
}

/// Divides the squares of the level under way that want it and traces the samples that this takes; the others are
/// leaves.
bool AdaptiveSampler::divide_level(SampleTracer& tracer) {
  // Five new samples a square at most. A sample of one level never lies on one of another: it is the middle of a side
  // or of a square of this level.
  const int level = squares_.front().level;
  level_samples_.begin(1u << (levels_ - level - 1), std::size_t(kTileSize) << (level + 1), 5 * squares_.size());
  divided_.clear();
  // A pattern is seen through a window as wide as the samples are apart, so the corners of a pixel tell its mean where
  // it is finer than the pixel, and what division adds sees the finer detail that division is for.
  const double spacing = edge(level + 1);
  std::size_t left = 0;
  for (const Square& square : squares_)
    if (wants_division(square))
      divide(square);
    else
      squares_[left++] = square;
  while (radiance_.size() < positions_.size()) {
    squares_.resize(left);
    if (!trace_new_samples(tracer, spacing)) return false;
    left = 0;
    for (const Square& square : squares_)
      if (differs_on_a_side(square))
        again_.push_back(square);
      else
        squares_[left++] = square;
    for (const Square& square : again_) divide(square);
    again_.clear();
  }
  leaves_.insert(leaves_.end(), squares_.begin(), squares_.begin() + static_cast<std::ptrdiff_t>(left));
  squares_.swap(divided_);
  return true;
}

void AdaptiveSampler::divide(const Square& square) {
  const int half = 1 << (levels_ - square.level - 1);
  const int x = square.x, y = square.y, pixel = pixel_of(square);
  const auto [upper_left, upper_right, lower_left, lower_right] = square.corners;
  const std::uint32_t top = sample_at(x + half, y, pixel), left = sample_at(x, y + half, pixel),
                      middle = sample_at(x + half, y + half, pixel), right = sample_at(x + 2 * half, y + half, pixel),
                      bottom = sample_at(x + half, y + 2 * half, pixel);
  const std::array<std::array<std::uint32_t, 4>, 4> corners{{{upper_left, top, left, middle},
                                                             {top, upper_right, middle, right},
                                                             {left, middle, lower_left, bottom},
                                                             {middle, right, bottom, lower_right}}};
  for (int i = 0; i < 4; ++i) {
    Square part{corners[i],
                static_cast<std::uint16_t>(x + (i & 1) * half),
                static_cast<std::uint16_t>(y + (i >> 1) * half),
                static_cast<std::uint16_t>(square.level + 1),
                static_cast<std::uint32_t>(near_.size()),
                0};
    const double size = edge(part.level), unit = edge(levels_);
    const Vec2d center(x0_ + part.x * unit + size / 2, y0_ + part.y * unit + size / 2);
    for (std::uint32_t k = square.near_begin; k < square.near_end; ++k) {
      const SmallObject& object = scene_.small_objects[near_[k]];
      if (size > kEdgePerWidth * object.width() && object.box.overlaps(center, size / 2)) near_.push_back(near_[k]);
    }
    part.near_end = static_cast<std::uint32_t>(near_.size());
    divided_.push_back(part);
  }
}

/// The sample at lattice place (x, y) of the level under way, made by the first square that asks for it.
std::uint32_t AdaptiveSampler::sample_at(int x, int y, int pixel) {
  return level_samples_.at(x, y, [&] {
    const auto unit = static_cast<float>(edge(levels_));
    return add_sample({static_cast<float>(x0_) + static_cast<float>(x) * unit,
                       static_cast<float>(y0_) + static_cast<float>(y) * unit},
                      pixel);
  });
}

/// Leaves pixel after pixel, in the order that they became leaves.
void AdaptiveSampler::sort_leaves() {
  leaf_begin_.assign(kTilePixels + 1, 0);
  for (const Square& leaf : leaves_) ++leaf_begin_[pixel_of(leaf) + 1];
  for (int i = 0; i < kTilePixels; ++i) leaf_begin_[i + 1] += leaf_begin_[i];
  squares_.resize(leaves_.size());
  std::vector<std::uint32_t> next(leaf_begin_.begin(), leaf_begin_.end() - 1);
  for (const Square& leaf : leaves_) squares_[next[pixel_of(leaf)]++] = leaf;
  leaves_.swap(squares_);
}

/// Objects that the last level may miss, pixel by pixel: how much of the pixel they cover by their outline, how much by
/// the samples; what no sample sees gets one at the middle of its part of the pixel.
bool AdaptiveSampler::find_tiny_objects(SampleTracer& tracer) {
  if (pixel_near_.back() == 0) return true;
  for (int pixel = 0; pixel < kTilePixels; ++pixel)
    for (std::uint32_t k = pixel_near_[pixel]; k < pixel_near_[pixel + 1]; ++k) {
      const SmallObject& object = scene_.small_objects[near_[k]];
      if (object.width() >= kTinyWidth * edge(levels_)) continue;
      TinyPart part{static_cast<std::uint32_t>(pixel), object.shape + 1, 0, 0, kNoSample};
      Vec2d centroid;
      const double x = x0_ + pixel % kTileSize, y = y0_ + pixel / kTileSize;
      part.area = area_in_square(object.outline, x, y, 1, centroid);
      if (part.area <= 0) continue;
      for (const Square& leaf : leaves_of(pixel))
        for (const std::uint32_t corner : leaf.corners)
          if (hits_[corner].object == part.id) part.seen += corner_weight(leaf);
      if (part.seen == 0) part.ray = add_sample(Vec2f(centroid), pixel);
      tiny_.push_back(part);
    }
  if (!trace_new_samples(tracer, edge(levels_))) return false;
  for (TinyPart& part : tiny_)
    if (part.ray != kNoSample && hits_[part.ray].object != part.id) part.area = 0;  // something is before it
  return true;
}

void AdaptiveSampler::resolve(TileSums& sums) {
  std::size_t tiny = 0;
  for (int pixel = 0; pixel < kTilePixels; ++pixel) {
    const std::size_t begin = tiny;
    while (tiny < tiny_.size() && tiny_[tiny].pixel == static_cast<std::uint32_t>(pixel)) ++tiny;
    resolve_pixel(pixel, {tiny_.data() + begin, tiny_.data() + tiny}, sums);
  }
  if (sums.has_ray_counts())
    for (std::size_t i = 0; i < home_.size(); ++i) sums.add_rays(home_[i], ray_counts_[i]);
}

/// The mean of the pixel's leaves by area, a leaf being the mean of its corners; but the samples that see a tiny object
/// weigh as much as it covers, whichever few of them happened to meet it, and the others what is left.
void AdaptiveSampler::resolve_pixel(int pixel, std::span<const TinyPart> tiny, TileSums& sums) {
  double covered = 0, seen = 0;
  for (const TinyPart& part : tiny) covered += part.area, seen += part.seen;
  // Where nothing else is seen there is nothing to take from or give to.
  const bool corrects = covered > 0 && seen < 1 - 1e-9;
  const double share = covered > 1 ? 1 / covered : 1;
  const double others = corrects ? (1 - covered * share) / (1 - seen) : 1;

  const auto factor_of = [&](std::uint32_t sample) {
    double factor = others;
    for (const TinyPart& part : tiny)
      if (part.id == hits_[sample].object && part.seen > 0) factor = part.area * share / part.seen;
    return factor;
  };
  const auto for_each_sample = [&](auto&& add) {
    for (const Square& leaf : leaves_of(pixel)) {
      const double weight = corner_weight(leaf);
      for (const std::uint32_t corner : leaf.corners) add(corner, corrects ? weight * factor_of(corner) : weight);
    }
    if (corrects)
      for (const TinyPart& part : tiny)
        if (part.ray != kNoSample && part.area > 0) add(part.ray, part.area * share);
  };

  TileSums::ColorSum color;
  for_each_sample([&](std::uint32_t sample, double weight) { color.add(weight, radiance_[sample]); });
  sums.add_color(pixel, color);
  if (sums.has_truncation())
    for_each_sample(
        [&](std::uint32_t sample, double weight) { sums.add_truncation(pixel, weight, truncation_[sample]); });
  if (sums.has_first_hits())
    for_each_sample([&](std::uint32_t sample, double weight) {
      if (const FirstHit& hit = hits_[sample]; hit.object != 0) sums.add_first_hit(pixel, weight, hit);
    });
  if (!sums.has_ids()) return;
  votes_.clear();
  for_each_sample([&](std::uint32_t sample, double weight) {
    const FirstHit& hit = hits_[sample];
    const auto vote = std::find_if(votes_.begin(), votes_.end(), [&](const Vote& v) { return v.object == hit.object; });
    if (vote != votes_.end())
      vote->weight += weight;
    else
      votes_.push_back({hit.object, hit.material, weight});
  });
  // The ids are those of the object that covers most of the pixel; of equals the one met first.
  const auto most =
      std::max_element(votes_.begin(), votes_.end(), [](const Vote& a, const Vote& b) { return a.weight < b.weight; });
  if (most != votes_.end()) sums.set_ids(pixel, most->object, most->material);
}

}  // namespace raytree
