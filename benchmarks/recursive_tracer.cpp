#include "benchmarks/recursive_tracer.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/ray_batch.h"
#include "geometry/stopwatch.h"
#include "renderer/float_mode.h"
#include "renderer/media.h"
#include "renderer/shading.h"
#include "renderer/shadow_path.h"

namespace raytree::benchmarks {
namespace {

constexpr float kColorTolerance = 2e-3f;
constexpr double kFlippedShare = 1e-3;  ///< of pixels, and of rays

class Tracer {
 public:
  Tracer(const Scene& scene, const EmbreeIntersector& intersector)
      : scene_(scene), intersector_(intersector), settings_(scene.description.render) {
    for (const Material& material : scene.materials) wants_texture_ |= material.needs_texture;
    if (scene.tracks_media) media_.emplace(scene);
    if (scene.rough_surfaces)
      throw Error(ErrorKind::bad_input, {scene.description.name, 0, "materials"},
                  "the recursive tracer knows no rough surfaces; set their roughness to 0");
  }

  std::array<std::uint64_t, kRayKindCount> rays{};

  Rgb sample(float x, float y) {
    sum_ = Rgb();
    Vec3f origin, direction;
    scene_.camera.ray(x, y, origin, direction);
    count(RayKind::primary);
    MediaId media = kNoMedia;
    if (media_) {
      media_->clear();
      media = media_->set_of(solids_around(scene_, origin, direction));
    }
    trace({origin, direction, Rgb(1), static_cast<float>(settings_.cutoff), 1, media, true});
    return is_finite(sum_) ? sum_ : Rgb();
  }

 private:
  void count(RayKind kind) { ++rays[static_cast<std::size_t>(kind)]; }

  struct Ray {
    Vec3f origin, direction;
    Rgb weight;
    float allowance;
    int level;
    MediaId media;
    bool from_eye = false;  ///< and nothing has been passed
  };

  void trace(const Ray& ray) {
    const Hit hit = intersector_.intersect_one(ray.origin, ray.direction, kInfinity);
    Rgb weight = ray.weight;
    if (hit.geometry == kNoGeometry) {
      if (media_) weight *= media_->transmitted(ray.media, kInfinity);
      sum_ += weight * scene_.background.along(ray.direction);
      return;
    }
    const SurfacePoint surface = surface_at(*scene_.shapes, ray.origin, ray.direction, hit, wants_texture_);
    const Material& material = scene_.materials[scene_.material_at(hit)];
    const SampleWindow window = ray.from_eye ? SampleWindow{&scene_.camera, 1} : SampleWindow();
    const std::optional<ObjectFrame> moved = scene_.frame_at(hit, material);
    const ObjectFrame* const frame = moved ? &*moved : nullptr;
    const ShadingPoint point = shading_point(surface, ray.direction, material, window, frame);
    MediaBoundary boundary;
    if (media_) {
      boundary = media_->boundary(ray.media, solid_at(scene_, hit), point.leaving);
      weight *= media_->transmitted(boundary.before, surface.distance);
      if (boundary.passes) {
        count(RayKind::refracted);
        trace({offset_origin(surface, -point.surface.geometric_normal), ray.direction, weight, ray.allowance, ray.level,
               boundary.after});
        return;
      }
    } else if (material.absorbs && point.leaving) {
      weight *= transmitted_share(material.absorption, surface.distance);
    }
    if (settings_.distance_attenuation > 0 && ray.level > 1)
      weight *= segment_attenuation(static_cast<float>(settings_.distance_attenuation), surface.distance);
    sum_ += weight * scene_.ambient * ambient_of(point, window, frame);
    if (material.has_diffuse || material.has_highlight)
      for (const Light& light : scene_.lights) add_light(point, light, weight, boundary.before);
    if (material.has_reflection || material.has_transmission) branch(point, boundary, weight, ray.allowance, ray.level);
  }

  /// What arrives of a light's rays at a point that lies in `media`.
  Rgb unshadowed_share(const Vec3f& origin, const LocalLight& local, MediaId media) {
    count(RayKind::shadow);
    if (!intersector_.occluded_one(origin, local.direction, local.distance))
      return media_ ? media_->transmitted(media, local.distance) : Rgb(1);
    if (!scene_.transparent_shadows) return Rgb();
    ShadowPath path(origin, local.direction, local.distance, media);
    Hit hit;
    do {
      count(RayKind::shadow);
      hit = intersector_.intersect_one(path.origin, path.direction, path.distance);
    } while (follow_shadow(scene_, media_ ? &*media_ : nullptr, hit, path));
    return path.transmittance;
  }

  void add_light(const ShadingPoint& point, const Light& light, Rgb weight, MediaId media) {
    const LocalLight local = local_light(point, light, settings_.highlights);
    if (!local.lit) return;
    Rgb shadowed = settings_.shadowed_highlights ? local.diffuse + local.highlight : local.diffuse;
    if (!settings_.shadowed_highlights) sum_ += weight * local.highlight;
    if (is_black(shadowed)) return;
    if (settings_.shadows)
      shadowed *= unshadowed_share(offset_origin(point.surface, point.surface.geometric_normal), local, media);
    sum_ += weight * shadowed;
  }

  void branch(const ShadingPoint& point, const MediaBoundary& boundary, Rgb weight, float allowance, int level) {
    if (level >= settings_.depth) return;
    const Branches children = media_ ? branches_between(point, boundary.relative_index) : branches(point);
    const Rgb below = scene_.bound(settings_.depth - level - 1);
    struct Child {
      Rgb weight;
      float cost;
      bool refracted;
    };
    const auto child = [&](Rgb share, bool refracted) {
      const Rgb product = weight * share;
      return Child{product, max_channel(product * below), refracted};
    };
    Child first = child(children.reflected_weight, false), second = child(children.refracted_weight, true);
    const bool both = !is_black(first.weight) && !is_black(second.weight);
    // The cheaper child is judged first, by half the allowance; what it leaves passes to the other.
    if (second.cost < first.cost) std::swap(first, second);
    float rest = allowance;
    for (const Child* one : {&first, &second}) {
      if (is_black(one->weight)) continue;
      const float share = both && one == &first ? allowance / 2 : rest;
      if (one->cost <= share) {
        rest -= one->cost;
        continue;
      }
      rest -= share;
      const Vec3f side = one->refracted ? -point.surface.geometric_normal : point.surface.geometric_normal;
      count(one->refracted ? RayKind::refracted : RayKind::reflected);
      trace({offset_origin(point.surface, side), one->refracted ? children.refracted : children.reflected, one->weight,
             share, level + 1, one->refracted ? boundary.after : boundary.before});
    }
  }

  const Scene& scene_;
  const EmbreeIntersector& intersector_;
  const RenderSettings& settings_;
  bool wants_texture_ = false;
  std::optional<MediaTable> media_;
  Rgb sum_;
};

}  // namespace

RecursiveResult render_recursively(const Scene& scene, const EmbreeIntersector& intersector, int threads) {
  const int width = scene.description.image.width, height = scene.description.image.height;
  const int columns = (width + kTileSize - 1) / kTileSize, rows = (height + kTileSize - 1) / kTileSize;
  RecursiveResult result;
  result.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const auto start = Clock::now();
  tbb::task_arena arena(threads);
  tbb::enumerable_thread_specific<Tracer> tracers([&] { return Tracer(scene, intersector); });
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, columns * rows, 1),
        [&](const tbb::blocked_range<int>& range) {
          const FlushDenormals flush;
          Tracer& tracer = tracers.local();
          for (int tile = range.begin(); tile != range.end(); ++tile) {
            const int x0 = tile % columns * kTileSize, y0 = tile / columns * kTileSize;
            for (int y = y0; y < std::min(y0 + kTileSize, height); ++y)
              for (int x = x0; x < std::min(x0 + kTileSize, width); ++x)
                result.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                              static_cast<std::size_t>(x)] =
                    tracer.sample(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
          }
        },
        tbb::simple_partitioner());
  });
  for (const Tracer& tracer : tracers)
    for (std::size_t i = 0; i < kRayKindCount; ++i) result.rays[i] += tracer.rays[i];
  result.wall_seconds = seconds_since(start);
  return result;
}

std::string picture_mismatch(const RecursiveResult& recursive, const RenderResult& rendered) {
  const std::size_t pixels = recursive.pixels.size();
  std::size_t flipped = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const Rgb pixel = recursive.pixels[i];
    const float values[3] = {pixel.r, pixel.g, pixel.b};
    float difference = 0;
    for (int c = 0; c < 3; ++c)
      difference = std::max(difference, std::abs(values[c] - rendered.film.plane(ChannelGroup::color, c)[i]));
    flipped += !(difference <= kColorTolerance * std::max(1.0f, max_channel(pixel)));
  }
  if (static_cast<double>(flipped) > kFlippedShare * static_cast<double>(pixels))
    return fmt::format("{} of {} pixels differ from render()'s", flipped, pixels);
  for (std::size_t i = 0; i < kRayKindCount; ++i) {
    const auto ours = static_cast<double>(recursive.rays[i]), theirs = static_cast<double>(rendered.statistics.rays[i]);
    if (std::abs(ours - theirs) > kFlippedShare * std::max(ours, theirs) + 1)
      return fmt::format("the recursion traced {} rays of kind {}, render() {}", recursive.rays[i], i,
                         rendered.statistics.rays[i]);
  }
  return {};
}

}  // namespace raytree::benchmarks
