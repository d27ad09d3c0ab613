#include "renderer/tile_sums.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace raytree {

SampleRecords records_for(const ChannelSet& channels) {
  SampleRecords records;
  records.first_hits = channels.has(ChannelGroup::alpha) || channels.has(ChannelGroup::depth) ||
                       channels.has(ChannelGroup::normal) || channels.has(ChannelGroup::object_id) ||
                       channels.has(ChannelGroup::material_id) || channels.has(ChannelGroup::albedo);
  records.ray_counts = channels.has(ChannelGroup::ray_count);
  records.truncation = channels.has(ChannelGroup::truncation);
  return records;
}

TileSums::TileSums(const ChannelSet& channels) : color_(kTilePixels) {
  const SampleRecords records = records_for(channels);
  if (records.truncation) truncation_.resize(kTilePixels);
  if (records.first_hits) covered_.resize(kTilePixels);
  if (channels.has(ChannelGroup::depth) || channels.has(ChannelGroup::normal) || channels.has(ChannelGroup::albedo))
    surfaces_.resize(kTilePixels);
  if (channels.has(ChannelGroup::object_id) || channels.has(ChannelGroup::material_id)) ids_.resize(kTilePixels);
  if (records.ray_counts) ray_counts_.resize(kTilePixels);
}

void TileSums::clear() {
  const auto zero = [](auto& sums) {
    std::fill(sums.begin(), sums.end(), typename std::decay_t<decltype(sums)>::value_type());
  };
  zero(color_), zero(truncation_), zero(covered_), zero(surfaces_), zero(ids_), zero(ray_counts_);
}

void TileSums::SurfaceSum::add(double weight, const FirstHit& hit) {
  depth += weight * hit.distance;
  for (int i = 0; i < 3; ++i) normal[i] += weight * hit.normal[i];
  albedo[0] += weight * hit.albedo.r;
  albedo[1] += weight * hit.albedo.g;
  albedo[2] += weight * hit.albedo.b;
}

void TileSums::resolve(int x0, int y0, double weight, Film& film) const {
  const PixelWindow& window = film.window();
  const int left = std::max(x0, window.x0), right = std::min(x0 + kTileSize, window.x0 + window.width);
  const int top = std::max(y0, window.y0), bottom = std::min(y0 + kTileSize, window.y0 + window.height);
  const double scale = 1 / weight;
  const auto write = [&](ChannelGroup group, int plane, auto&& value) {
    float* pixels = film.plane(group, plane);
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x)
        pixels[static_cast<std::size_t>(y - window.y0) * window.width + (x - window.x0)] =
            static_cast<float>(value((y - y0) * kTileSize + (x - x0)));
  };
  // Colors are judged sample by sample; what else may not be a number, since some input was not, becomes 0 here.
  const auto finite = [](double value) { return std::abs(value) <= std::numeric_limits<float>::max() ? value : 0.0; };
  const auto write_ids = [&](ChannelGroup group, auto&& value) {
    std::uint32_t* pixels = film.id_plane(group);
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x)
        pixels[static_cast<std::size_t>(y - window.y0) * window.width + (x - window.x0)] =
            value((y - y0) * kTileSize + (x - x0));
  };
  const ChannelSet& channels = film.channels();
  if (channels.has(ChannelGroup::color)) {
    write(ChannelGroup::color, 0, [&](int i) { return color_[i].r * scale; });
    write(ChannelGroup::color, 1, [&](int i) { return color_[i].g * scale; });
    write(ChannelGroup::color, 2, [&](int i) { return color_[i].b * scale; });
  }
  if (channels.has(ChannelGroup::truncation)) {
    write(ChannelGroup::truncation, 0, [&](int i) { return finite(truncation_[i].r * scale); });
    write(ChannelGroup::truncation, 1, [&](int i) { return finite(truncation_[i].g * scale); });
    write(ChannelGroup::truncation, 2, [&](int i) { return finite(truncation_[i].b * scale); });
  }
  if (channels.has(ChannelGroup::alpha)) write(ChannelGroup::alpha, 0, [&](int i) { return covered_[i] * scale; });
  if (channels.has(ChannelGroup::depth))
    write(ChannelGroup::depth, 0, [&](int i) {
      return covered_[i] > 0 ? finite(surfaces_[i].depth / covered_[i]) : std::numeric_limits<double>::infinity();
    });
  if (channels.has(ChannelGroup::normal))
    for (int axis = 0; axis < 3; ++axis)
      write(ChannelGroup::normal, axis, [&](int i) {
        const double* n = surfaces_[i].normal;
        const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        return length > 0 ? finite(n[axis] / length) : 0.0;
      });
  if (channels.has(ChannelGroup::albedo))
    for (int c = 0; c < 3; ++c)
      write(ChannelGroup::albedo, c,
            [&](int i) { return covered_[i] > 0 ? finite(surfaces_[i].albedo[c] / covered_[i]) : 0.0; });
  if (channels.has(ChannelGroup::object_id)) write_ids(ChannelGroup::object_id, [&](int i) { return ids_[i].object; });
  if (channels.has(ChannelGroup::material_id))
    write_ids(ChannelGroup::material_id, [&](int i) { return ids_[i].material; });
  if (channels.has(ChannelGroup::ray_count)) write_ids(ChannelGroup::ray_count, [&](int i) { return ray_counts_[i]; });
}

}  // namespace raytree
