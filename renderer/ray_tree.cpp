#include "renderer/ray_tree.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <span>

#include "renderer/features.h"
#include "renderer/shading.h"

namespace raytree {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// A ray of the tree that waits for its turn.
struct PendingRay {
  Vec3f origin;
  float allowance;  ///< what may still be cut off below it, radiance
  Vec3f direction;
  std::uint32_t sample;  ///< in the chunk
  Rgb weight;            ///< of what it brings in its sample
  std::uint32_t level;   ///< the eye ray is 1
};
static_assert(sizeof(PendingRay) == 48);

/// A hit of the batch under way, with the context of its ray.
struct BatchPoint {
  ShadingPoint shading;
  Rgb weight;
  float allowance;
  std::uint32_t sample;
  std::uint32_t level;
};

/// What the two children of a hit may cut off below them, and which of them is itself cut.
struct Shares {
  float reflected, refracted;
  bool cuts_reflected, cuts_refracted;
};

/// Divides a ray's allowance over its children, whose bounds are given (0: no such child). The child with the smaller
/// bound is judged first, and what it leaves of its half passes to the other; so the cuts below a ray never exceed its
/// allowance. An absent child takes nothing, since its bound is 0 and leaves all.
inline Shares divided_allowance(float allowance, float reflected_bound, float refracted_bound) {
  const bool reflected_first = reflected_bound <= refracted_bound;
  const float smaller = reflected_first ? reflected_bound : refracted_bound;
  const float larger = reflected_first ? refracted_bound : reflected_bound;
  const float half = allowance / 2;
  const bool cuts_smaller = smaller <= half;
  const float rest = cuts_smaller ? allowance - smaller : half;
  const bool cuts_larger = larger <= rest;
  if (reflected_first) return {half, rest, cuts_smaller, cuts_larger};
  return {rest, half, cuts_larger, cuts_smaller};
}

constexpr int kTilePixels = kTileSize * kTileSize;

/// Eye samples are traced in blocks of so many along x and y, which makes a packet of eight.
constexpr int kBlockWidth = 4, kBlockHeight = 2;

}  // namespace

struct TileTracer::State {
  State(const Scene& scene_, const RenderOptions& options_, Film& film_)
      : scene(scene_),
        options(options_),
        settings(scene_.description.render),
        film(film_),
        rays(kBatchSize),
        hits(kBatchSize),
        shadow_rays(kBatchSize),
        occluded(kBatchSize + kBatchPadding),
        shadow_samples(kBatchSize),
        shadow_light(kBatchSize),
        eye_rays(kBatchSize),
        hit_rays(kBatchSize),
        points(kBatchSize),
        radiance(kBatchSize),
        truncation(kBatchSize),
        ray_counts(kBatchSize),
        pixel_of_sample(kBatchSize),
        center_of_pixel(kBatchSize) {
    pending.reserve(4 * kBatchSize);
    reflected_rays.reserve(kBatchSize);
    refracted_rays.reserve(kBatchSize);
    const ChannelSet& channels = options.channels;
    counts_rays = channels.has(ChannelGroup::ray_count);
    records_first_hit = channels.has(ChannelGroup::alpha) || channels.has(ChannelGroup::depth) ||
                        channels.has(ChannelGroup::normal) || channels.has(ChannelGroup::object_id) ||
                        channels.has(ChannelGroup::material_id) || channels.has(ChannelGroup::albedo);
    records_truncation = channels.has(ChannelGroup::truncation);
    for (const Material& material : scene.materials) wants_texture |= material.needs_texture;
    color_sum.resize(kTilePixels);
    truncation_sum.resize(records_truncation ? kTilePixels : 0);
    first_hits.resize(records_first_hit ? kTilePixels : 0);
    ray_count_sum.resize(counts_rays ? kTilePixels : 0);
  }

  /// Sums over a pixel's samples of what its eye rays hit.
  struct FirstHits {
    double depth = 0, normal[3] = {0, 0, 0}, albedo[3] = {0, 0, 0};
    std::uint32_t count = 0, object = 0, material = 0;
  };

  bool trace_tile(int x0, int y0);
  void add_eye_sample(float x, float y, int pixel, bool center);
  bool finish_chunk();
  void trace_batch(Coherence coherence, bool eye);
  void collect_hits(bool eye);
  void prefetch_triangles(const ShapeSet& shapes) const;
  std::span<const BatchPoint> batch_points() const { return {points.data(), point_count}; }
  void add_lights();
  void spawn();
  void cut(std::uint32_t sample, const Rgb& bound);
  void add_children(RayKind kind, std::vector<PendingRay>& children);
  void record_first_hit(const BatchPoint& point, const Hit& hit, ShapeId shape);
  void resolve_tile(int x0, int y0, int samples_per_pixel);

  const Scene& scene;
  const RenderOptions& options;
  const RenderSettings& settings;
  Film& film;
  RenderStatistics statistics;

  RayBatch rays;
  HitBatch hits;
  RayBatch shadow_rays;
  std::vector<std::uint8_t> occluded;
  std::vector<std::uint32_t> shadow_samples;
  std::vector<Rgb> shadow_light;  ///< what a shadow ray brings when nothing is in its way

  std::vector<PendingRay> eye_rays;      ///< contexts of the chunk's eye rays
  const PendingRay* contexts = nullptr;  ///< [rays.size] of the batch under way; read before children are spawned
  std::vector<std::uint32_t> hit_rays;   ///< [point_count] index in the batch of each hit
  std::size_t point_count = 0;
  std::vector<BatchPoint> points;   ///< hits of the batch under way
  std::vector<PendingRay> pending;  ///< the newest rays are traced first
  /// What the batch under way spawns, before it joins the pending rays: apart, so that neighbours in a packet run much
  /// the same way.
  std::vector<PendingRay> reflected_rays, refracted_rays;

  // The chunk of samples under way.
  std::vector<int> pixel_of;  ///< [column or row of samples in the tile] -> of pixels
  std::size_t chunk_size = 0;
  std::vector<Rgb> radiance, truncation;
  std::vector<std::uint32_t> ray_counts;
  std::vector<std::uint16_t> pixel_of_sample;
  std::vector<std::uint8_t> center_of_pixel;  ///< whether the sample stands for its pixel's ids

  // The tile under way, [kTileSize][kTileSize].
  struct ColorSum {
    double r = 0, g = 0, b = 0;
  };
  std::vector<ColorSum> color_sum, truncation_sum;
  std::vector<FirstHits> first_hits;
  std::vector<std::uint32_t> ray_count_sum;

  bool counts_rays = false, records_first_hit = false, records_truncation = false, wants_texture = false;
};

bool TileTracer::State::trace_tile(int x0, int y0) {
  const auto start = Clock::now();
  std::fill(color_sum.begin(), color_sum.end(), ColorSum());
  std::fill(truncation_sum.begin(), truncation_sum.end(), ColorSum());
  std::fill(first_hits.begin(), first_hits.end(), FirstHits());
  std::fill(ray_count_sum.begin(), ray_count_sum.end(), 0u);

  const int grid = settings.antialias.method == Antialiasing::Method::grid ? settings.antialias.grid_size : 1;
  const int width = std::min(kTileSize, scene.description.image.width - x0) * grid;
  const int height = std::min(kTileSize, scene.description.image.height - y0) * grid;
  const float spacing = 1.0f / static_cast<float>(grid);
  pixel_of.resize(static_cast<std::size_t>(kTileSize) * grid);
  for (std::size_t i = 0; i < pixel_of.size(); ++i) pixel_of[i] = static_cast<int>(i) / grid;
  for (int block_y = 0; block_y < height; block_y += kBlockHeight)
    for (int block_x = 0; block_x < width; block_x += kBlockWidth) {
      if (chunk_size + kBlockWidth * kBlockHeight > kBatchSize && !finish_chunk()) return false;
      for (int y = block_y; y < std::min(block_y + kBlockHeight, height); ++y)
        for (int x = block_x; x < std::min(block_x + kBlockWidth, width); ++x) {
          const int pixel_x = pixel_of[x], pixel_y = pixel_of[y];
          const bool center = x - pixel_x * grid == grid / 2 && y - pixel_y * grid == grid / 2;
          add_eye_sample(static_cast<float>(x0) + (static_cast<float>(x) + 0.5f) * spacing,
                         static_cast<float>(y0) + (static_cast<float>(y) + 0.5f) * spacing,
                         pixel_y * kTileSize + pixel_x, center);
        }
    }
  if (!finish_chunk()) return false;
  resolve_tile(x0, y0, grid * grid);
  statistics.thread_seconds += seconds_since(start);
  return true;
}

void TileTracer::State::add_eye_sample(float x, float y, int pixel, bool center) {
  const std::size_t i = chunk_size++;
  Vec3f origin, direction;
  scene.camera.ray(x, y, origin, direction);
  rays.set(i, origin, direction, std::numeric_limits<float>::infinity());
  eye_rays[i] = {origin, static_cast<float>(settings.cutoff), direction, static_cast<std::uint32_t>(i), Rgb(1), 1};
  radiance[i] = truncation[i] = Rgb();
  ray_counts[i] = 1;
  pixel_of_sample[i] = static_cast<std::uint16_t>(pixel);
  center_of_pixel[i] = center;
}

/// Traces the chunk's eye rays and all that grows from them, then adds the samples to their pixels. False: stopped.
bool TileTracer::State::finish_chunk() {
  rays.size = chunk_size;
  statistics.rays[static_cast<int>(RayKind::primary)] += chunk_size;
  statistics.samples += chunk_size;
  statistics.deepest_level = std::max(statistics.deepest_level, 1);
  contexts = eye_rays.data();
  trace_batch(Coherence::coherent, true);
  while (!pending.empty()) {
    if (options.stop != nullptr && options.stop->load(std::memory_order_relaxed)) return false;
    const std::size_t count = std::min(kBatchSize, pending.size());
    contexts = pending.data() + pending.size() - count;
    for (std::size_t i = 0; i < count; ++i) {
      const PendingRay& ray = contexts[i];
      rays.set(i, ray.origin, ray.direction, std::numeric_limits<float>::infinity());
      if (kFeatures.ray_count_channel && counts_rays) ++ray_counts[ray.sample];
    }
    rays.size = count;
    trace_batch(Coherence::mixed, false);
  }
  for (std::size_t i = 0; i < chunk_size; ++i) {
    const int pixel = pixel_of_sample[i];
    if (is_finite(radiance[i])) {
      color_sum[pixel].r += radiance[i].r, color_sum[pixel].g += radiance[i].g, color_sum[pixel].b += radiance[i].b;
    } else {
      ++statistics.not_finite_samples;
    }
    if (kFeatures.truncation_channel && records_truncation) {
      ColorSum& sum = truncation_sum[pixel];
      sum.r += truncation[i].r, sum.g += truncation[i].g, sum.b += truncation[i].b;
    }
    if (kFeatures.ray_count_channel && counts_rays) ray_count_sum[pixel] += ray_counts[i];
  }
  chunk_size = 0;
  return !(options.stop != nullptr && options.stop->load(std::memory_order_relaxed));
}

void TileTracer::State::trace_batch(Coherence coherence, bool eye) {
  const auto start = Clock::now();
  scene.intersector->intersect(rays, coherence, hits);
  const auto hit = Clock::now();
  const double intersection_before = statistics.intersection_seconds;
  collect_hits(eye);
  if (!eye) pending.resize(pending.size() - rays.size);
  add_lights();
  spawn();
  add_children(RayKind::reflected, reflected_rays);
  add_children(RayKind::refracted, refracted_rays);
  const double shadow_seconds = statistics.intersection_seconds - intersection_before;
  statistics.shading_seconds += seconds_since(hit) - shadow_seconds;
  statistics.intersection_seconds += std::chrono::duration<double>(hit - start).count();
}

void TileTracer::State::add_children(RayKind kind, std::vector<PendingRay>& children) {
  if (children.empty()) return;
  statistics.rays[static_cast<int>(kind)] += children.size();
  for (const PendingRay& child : children)
    statistics.deepest_level = std::max(statistics.deepest_level, static_cast<int>(child.level));
  pending.insert(pending.end(), children.begin(), children.end());
  children.clear();
}

void TileTracer::State::collect_hits(bool eye) {
  const ShapeSet& shapes = *scene.shapes;
  point_count = 0;
  for (std::size_t i = 0; i < rays.size; ++i) {
    if (hits.geometry[i] != kNoGeometry) {
      hit_rays[point_count++] = static_cast<std::uint32_t>(i);
      continue;
    }
    const PendingRay& ray = contexts[i];
    // A ray that is not finite misses everything: its sample becomes NaN, and so is counted and reported.
    const Vec3f poison = (ray.origin + ray.direction) * 0.0f;
    radiance[ray.sample] += ray.weight * scene.background.along(ray.direction) + Rgb(poison.x + poison.y + poison.z);
  }
  prefetch_triangles(shapes);

  for (std::size_t p = 0; p < point_count; ++p) {
    const std::size_t i = hit_rays[p];
    const PendingRay& ray = contexts[i];
    const Hit hit = hits[i];
    const ShapeId shape = shapes.shape_of(hit.geometry, hit.primitive);
    const Material& material = scene.materials[scene.shape_materials[shape]];
    BatchPoint& point = points[p];
    find_surface(shapes, ray.origin, ray.direction, hit, wants_texture, point.shading.surface);
    complete_shading_point(point.shading, ray.direction, material);
    point.weight = ray.weight;
    point.allowance = ray.allowance;
    point.sample = ray.sample;
    point.level = ray.level;
    if (kFeatures.distance_attenuation && settings.distance_attenuation > 0 && !eye)
      point.weight *=
          segment_attenuation(static_cast<float>(settings.distance_attenuation), point.shading.surface.distance);
    radiance[ray.sample] +=
        point.weight * scene.ambient *
        (material.ambient_as_diffuse ? point.shading.diffuse : material.ambient.at(point.shading.surface));
    if (kFeatures.first_hit_channels && eye && records_first_hit) record_first_hit(point, hit, shape);
  }
}

/// The vertices of the batch's triangles lie anywhere in memory: all are asked for before the first is used.
void TileTracer::State::prefetch_triangles(const ShapeSet& shapes) const {
  if (shapes.meshes.empty()) return;
  const auto for_each_triangle = [&](auto&& function) {
    for (std::size_t p = 0; p < point_count; ++p) {
      const std::size_t i = hit_rays[p];
      if (hits.geometry[i] >= kFirstMeshGeometry)
        function(shapes.meshes[hits.geometry[i] - kFirstMeshGeometry].mesh, std::size_t(hits.primitive[i]) * 3);
    }
  };
  for_each_triangle([](const TriangleMesh& mesh, std::size_t corner) { __builtin_prefetch(&mesh.corners[corner]); });
  for_each_triangle([](const TriangleMesh& mesh, std::size_t corner) {
    const bool normals = !mesh.normals.empty() && mesh.normal_corners.empty();
    for (std::size_t c = corner; c < corner + 3; ++c) {
      __builtin_prefetch(&mesh.positions[mesh.corners[c]]);
      if (normals) __builtin_prefetch(&mesh.normals[mesh.corners[c]]);
    }
  });
}

void TileTracer::State::add_lights() {
  for (const Light& light : scene.lights) {
    std::size_t count = 0;
    for (const BatchPoint& point : batch_points()) {
      const Material& material = *point.shading.material;
      if (!material.has_diffuse && !material.has_highlight) continue;
      const LocalLight local = local_light(point.shading, light, settings.highlights);
      if (!local.lit) continue;
      Rgb shadowed = local.diffuse;
      if (settings.shadowed_highlights)
        shadowed += local.highlight;
      else
        radiance[point.sample] += point.weight * local.highlight;
      if (is_black(shadowed)) continue;
      if (!settings.shadows) {
        radiance[point.sample] += point.weight * shadowed;
        continue;
      }
      const Vec3f origin = offset_origin(point.shading.surface, point.shading.surface.geometric_normal);
      shadow_rays.set(count, origin, local.direction, local.distance);
      shadow_samples[count] = point.sample;
      shadow_light[count] = point.weight * shadowed;
      ++count;
    }
    if (count == 0) continue;
    shadow_rays.size = count;
    const auto start = Clock::now();
    scene.intersector->occluded(shadow_rays, Coherence::coherent, occluded.data());
    statistics.intersection_seconds += seconds_since(start);
    statistics.rays[static_cast<int>(RayKind::shadow)] += count;
    for (std::size_t i = 0; i < count; ++i)
      if (!occluded[i]) radiance[shadow_samples[i]] += shadow_light[i];
    if (kFeatures.ray_count_channel && counts_rays)
      for (std::size_t i = 0; i < count; ++i) ++ray_counts[shadow_samples[i]];
  }
}

void TileTracer::State::spawn() {
  std::uint64_t branches_at_limit = 0;
  for (const BatchPoint& point : batch_points()) {
    const Material& material = *point.shading.material;
    if (!material.has_reflection && !material.has_transmission) continue;
    const Branches children = branches(point.shading);
    const Rgb reflected_weight = point.weight * children.reflected_weight;
    const Rgb refracted_weight = point.weight * children.refracted_weight;
    const bool reflects = !is_black(reflected_weight), refracts = !is_black(refracted_weight);
    const int level = static_cast<int>(point.level);
    if (level >= settings.depth) {
      branches_at_limit += reflects + refracts;
      continue;
    }
    const Rgb below = scene.bound(settings.depth - level - 1);
    const Rgb reflected_bound = reflected_weight * below, refracted_bound = refracted_weight * below;
    const Shares shares =
        divided_allowance(point.allowance, max_channel(reflected_bound), max_channel(refracted_bound));
    const SurfacePoint& surface = point.shading.surface;
    if (reflects) {
      if (shares.cuts_reflected)
        cut(point.sample, reflected_bound);
      else
        reflected_rays.push_back({offset_origin(surface, surface.geometric_normal), shares.reflected,
                                  children.reflected, point.sample, reflected_weight, point.level + 1});
    }
    if (refracts) {
      if (shares.cuts_refracted)
        cut(point.sample, refracted_bound);
      else
        refracted_rays.push_back({offset_origin(surface, -surface.geometric_normal), shares.refracted,
                                  children.refracted, point.sample, refracted_weight, point.level + 1});
    }
  }
  statistics.branches_at_depth_limit += branches_at_limit;
}

void TileTracer::State::cut(std::uint32_t sample, const Rgb& bound) {
  if (kFeatures.truncation_channel && records_truncation) truncation[sample] += bound;
  ++statistics.branches_cut;
}

void TileTracer::State::record_first_hit(const BatchPoint& point, const Hit&, ShapeId shape) {
  FirstHits& first = first_hits[pixel_of_sample[point.sample]];
  const SurfacePoint& surface = point.shading.surface;
  ++first.count;
  first.depth += surface.distance;
  for (int i = 0; i < 3; ++i) first.normal[i] += surface.shading_normal[i];
  first.albedo[0] += point.shading.diffuse.r;
  first.albedo[1] += point.shading.diffuse.g;
  first.albedo[2] += point.shading.diffuse.b;
  if (center_of_pixel[point.sample]) {
    first.object = shape + 1;
    first.material = scene.shape_materials[shape] + 1;
  }
}

void TileTracer::State::resolve_tile(int x0, int y0, int samples_per_pixel) {
  const PixelWindow& window = film.window();
  const int left = std::max(x0, window.x0), right = std::min(x0 + kTileSize, window.x0 + window.width);
  const int top = std::max(y0, window.y0), bottom = std::min(y0 + kTileSize, window.y0 + window.height);
  const double scale = 1.0 / samples_per_pixel;
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
    write(ChannelGroup::color, 0, [&](int i) { return color_sum[i].r * scale; });
    write(ChannelGroup::color, 1, [&](int i) { return color_sum[i].g * scale; });
    write(ChannelGroup::color, 2, [&](int i) { return color_sum[i].b * scale; });
  }
  if (channels.has(ChannelGroup::truncation)) {
    write(ChannelGroup::truncation, 0, [&](int i) { return finite(truncation_sum[i].r * scale); });
    write(ChannelGroup::truncation, 1, [&](int i) { return finite(truncation_sum[i].g * scale); });
    write(ChannelGroup::truncation, 2, [&](int i) { return finite(truncation_sum[i].b * scale); });
  }
  if (channels.has(ChannelGroup::alpha))
    write(ChannelGroup::alpha, 0, [&](int i) { return first_hits[i].count * scale; });
  if (channels.has(ChannelGroup::depth))
    write(ChannelGroup::depth, 0, [&](int i) {
      return first_hits[i].count > 0 ? finite(first_hits[i].depth / first_hits[i].count)
                                     : std::numeric_limits<double>::infinity();
    });
  if (channels.has(ChannelGroup::normal))
    for (int axis = 0; axis < 3; ++axis)
      write(ChannelGroup::normal, axis, [&](int i) {
        const double* n = first_hits[i].normal;
        const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        return length > 0 ? finite(n[axis] / length) : 0.0;
      });
  if (channels.has(ChannelGroup::albedo))
    for (int c = 0; c < 3; ++c)
      write(ChannelGroup::albedo, c, [&](int i) {
        return first_hits[i].count > 0 ? finite(first_hits[i].albedo[c] / first_hits[i].count) : 0.0;
      });
  if (channels.has(ChannelGroup::object_id))
    write_ids(ChannelGroup::object_id, [&](int i) { return first_hits[i].object; });
  if (channels.has(ChannelGroup::material_id))
    write_ids(ChannelGroup::material_id, [&](int i) { return first_hits[i].material; });
  if (channels.has(ChannelGroup::ray_count))
    write_ids(ChannelGroup::ray_count, [&](int i) { return ray_count_sum[i]; });
}

TileTracer::TileTracer(const Scene& scene, const RenderOptions& options, Film& film)
    : state_(std::make_unique<State>(scene, options, film)) {}
TileTracer::~TileTracer() = default;
TileTracer::TileTracer(TileTracer&&) noexcept = default;

bool TileTracer::trace(int x0, int y0) { return state_->trace_tile(x0, y0); }
const RenderStatistics& TileTracer::statistics() const { return state_->statistics; }

}  // namespace raytree
