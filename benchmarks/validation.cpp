#include "benchmarks/validation.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "geometry/surface.h"
#include "geometry/triangle_reference.h"
#include "renderer/adaptive_sampling.h"
#include "renderer/float_mode.h"

namespace raytree::benchmarks {
namespace {

/// Eye rays go to the tracer in blocks of so many along x and y, as the renderer has it.

/// A number made of a pixel's place that tells nothing about it (SplitMix64, Steele et al. 2014).
std::uint64_t hash(std::uint64_t x, std::uint64_t y) {
  std::uint64_t z = (y << 32 | x) + 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// What is kept of a tile.
struct TileReport {
  std::array<ValidationCounts, kRayKindCount> kinds;
  std::vector<ValidationExample> examples;
  double largest_edge_error = 0, largest_distance_error = 0;
  std::uint64_t pixels = 0, classified_pixels = 0, differing_pixels = 0;
  double largest_difference = 0;
  int differing_x = 0, differing_y = 0;
};

/// One thread's.
struct Worker {
  explicit Worker(const Scene& scene, const std::atomic<bool>* stop) : samples(scene, SampleRecords(), stop) {}
  SampleTracer samples;
  TreeLog log;
  TreeRadiance radiance;
  std::vector<Vec2f> positions;
  std::vector<std::pair<int, int>> pixels;  ///< [positions.size()]
  std::vector<std::uint8_t> chosen;
};

class SetLog {
 public:
  explicit SetLog(TreeLog* log) { TreeTracer::set_log(log); }
  ~SetLog() { TreeTracer::set_log(nullptr); }
  SetLog(const SetLog&) = delete;
  SetLog& operator=(const SetLog&) = delete;
};

/// Lends the scene another tracer.
class LentTracer {
 public:
  LentTracer(Scene& scene, std::unique_ptr<const RayIntersector> tracer)
      : scene_(scene), own_(std::exchange(scene.intersector, std::move(tracer))) {}
  ~LentTracer() { scene_.intersector = std::move(own_); }
  LentTracer(const LentTracer&) = delete;
  LentTracer& operator=(const LentTracer&) = delete;

 private:
  Scene& scene_;
  std::unique_ptr<const RayIntersector> own_;
};

class Validation {
 public:
  Validation(const Scene& scene, const RayJudge& judge, const ValidationOptions& options, ValidationReport& report)
      : scene_(scene), judge_(judge), report_(report) {
    const double share =
        options.pixels == 0 ? 1 : static_cast<double>(options.pixels) / (double(report.width) * double(report.height));
    takes_all_ = share >= 1;
    if (!takes_all_) most_hash_ = static_cast<std::uint64_t>(std::ldexp(share, 64));
  }

  /// False: stopped.
  bool compare_tile(int x0, int y0, Worker& worker, TileReport& tile) {
    list_pixels(x0, y0, worker);
    const SetLog set(&worker.log);
    if (!compare_trees(worker.positions, worker.chosen, judge_, worker.samples, worker.log, worker.radiance))
      return false;
    std::vector<RayVerdict> verdicts(worker.positions.size(), RayVerdict::agree);
    const auto take_worst = [&](const TreeRay& ray) {
      verdicts[ray.sample] = std::max(verdicts[ray.sample], ray.comparison.verdict);
    };
    for (const TreeRay& ray : worker.log.rays) take_worst(ray);
    for (TreeRay& ray : worker.log.rays) {
      if (verdicts[ray.sample] == RayVerdict::agree && difference(worker.radiance, ray.sample) > kMostPixelDifference &&
          reads_differently(ray)) {
        ray.comparison.verdict = RayVerdict::edge;
        take_worst(ray);
      }
      count(ray, worker, tile);
    }
    for (std::size_t i = 0; i < worker.positions.size(); ++i) compare_pixel(worker, i, verdicts[i], tile);
    return true;
  }

 private:
  /// Between the samples' radiance by either tracer, display-like.
  static double difference(const TreeRadiance& radiance, std::size_t i) {
    const Rgb off = display_like(radiance.fast[i]) - display_like(radiance.truth[i]);
    const double most = std::max({std::abs(off.r), std::abs(off.g), std::abs(off.b)});
    return std::isnan(most) ? std::numeric_limits<double>::infinity() : most;
  }

  /// Whether the two hits on one surface, as close as the bounds have them, read different things there: on either side
  /// of an edge in the surface's pattern, or on a facet so small beside its distance that its normals change over the
  /// bound. Eye rays see patterns filtered, without edges.
  bool reads_differently(const TreeRay& ray) const {
    if (ray.ray.occlusion || ray.follows_shadow || ray.hit.geometry == kNoGeometry) return false;
    const Material& material = scene_.materials[scene_.material_at(ray.hit)];
    const Hit truth = rounded_hit(ray.found, ray.ray.max_distance);
    const SurfacePoint a = surface_at(*scene_.shapes, ray.ray.origin, ray.ray.direction, ray.hit, true),
                       b = surface_at(*scene_.shapes, ray.ray.origin, ray.ray.direction, truth, true);
    const RayComparison& bounds = ray.comparison;
    const double apart = (Vec3d(a.position) - Vec3d(b.position)).length();
    if (!(apart <= bounds.position_error + bounds.edge_error + bounds.distance_error + a.clearance + b.clearance))
      return false;
    if ((a.shading_normal - b.shading_normal).length() > kMostPixelDifference) return true;
    if (ray.kind == RayKind::primary) return false;
    const auto diffuse = [&](const Hit& hit, const SurfacePoint& point) {
      const std::optional<ObjectFrame> moved = scene_.frame_at(hit, material);
      return material.diffuse.at(point, Footprint(), moved ? &*moved : nullptr);
    };
    const Rgb off = diffuse(ray.hit, a) - diffuse(truth, b);
    return std::max({std::abs(off.r), std::abs(off.g), std::abs(off.b)}) > kMostPixelDifference;
  }

  void list_pixels(int x0, int y0, Worker& worker) const {
    worker.positions.clear();
    worker.pixels.clear();
    worker.chosen.clear();
    const int x1 = std::min(x0 + kTileSize, report_.width), y1 = std::min(y0 + kTileSize, report_.height);
    for (int block_y = y0; block_y < y1; block_y += kBlockHeight)
      for (int block_x = x0; block_x < x1; block_x += kBlockWidth)
        for (int y = block_y; y < std::min(block_y + kBlockHeight, y1); ++y)
          for (int x = block_x; x < std::min(block_x + kBlockWidth, x1); ++x) {
            worker.positions.emplace_back(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            worker.pixels.emplace_back(x, y);
            worker.chosen.push_back(takes_all_ ||
                                    hash(static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y)) < most_hash_);
          }
  }

  void count(const TreeRay& ray, const Worker& worker, TileReport& tile) const {
    ValidationCounts& counts = tile.kinds[static_cast<int>(ray.kind)];
    const RayComparison& comparison = ray.comparison;
    ++counts.rays;
    ++counts.verdicts[static_cast<int>(comparison.verdict)];
    counts.largest_ulps = std::max(counts.largest_ulps, comparison.distance_ulps);
    if (comparison.verdict == RayVerdict::agree) return;
    if (comparison.verdict == RayVerdict::edge)
      tile.largest_edge_error = std::max(tile.largest_edge_error, comparison.edge_error);
    if (comparison.verdict == RayVerdict::coplanar || comparison.verdict == RayVerdict::self)
      tile.largest_distance_error = std::max(tile.largest_distance_error, comparison.distance_error);
    const auto alike = std::count_if(tile.examples.begin(), tile.examples.end(), [&](const ValidationExample& e) {
      return e.ray.comparison.verdict == comparison.verdict;
    });
    if (alike >= static_cast<std::ptrdiff_t>(kMostExamples)) return;
    ValidationExample example;
    example.kind = ray.kind;
    example.x = worker.pixels[ray.sample].first, example.y = worker.pixels[ray.sample].second;
    const Hit alone = judge_.ask_tracer(ray.ray);
    example.alone = ray.ray.occlusion ? (alone.geometry != kNoGeometry) == ray.occluded
                                      : alone.geometry == ray.hit.geometry &&
                                            (alone.geometry == kNoGeometry || (alone.primitive == ray.hit.primitive &&
                                                                               alone.distance == ray.hit.distance));
    example.ray = ray;
    tile.examples.push_back(example);
  }

  void compare_pixel(const Worker& worker, std::size_t i, RayVerdict verdict, TileReport& tile) const {
    const auto [x, y] = worker.pixels[i];
    const std::size_t at =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(report_.width) + static_cast<std::size_t>(x);
    const Rgb fast = display_like(worker.radiance.fast[i]);
    report_.gray[at] = 0.2126f * fast.r + 0.7152f * fast.g + 0.0722f * fast.b;
    if (!worker.chosen[i]) return;
    ++tile.pixels;
    report_.verdicts[at] = static_cast<std::uint8_t>(verdict);
    if (verdict != RayVerdict::agree) {
      ++tile.classified_pixels;
      return;
    }
    const double off = difference(worker.radiance, i);
    if (off > kMostPixelDifference) {
      if (tile.differing_pixels++ == 0) tile.differing_x = x, tile.differing_y = y;
      report_.verdicts[at] = static_cast<std::uint8_t>(RayVerdict::defect);
    }
    tile.largest_difference = std::max(tile.largest_difference, off);
  }

  const Scene& scene_;
  const RayJudge& judge_;
  ValidationReport& report_;
  bool takes_all_ = true;
  std::uint64_t most_hash_ = 0;
};

void add(ValidationCounts& sum, const ValidationCounts& part) {
  sum.rays += part.rays;
  for (int v = 0; v < kRayVerdictCount; ++v) sum.verdicts[v] += part.verdicts[v];
  sum.largest_ulps = std::max(sum.largest_ulps, part.largest_ulps);
}

void add(ValidationReport& report, const TileReport& tile) {
  for (int kind = 0; kind < kRayKindCount; ++kind) add(report.kinds[kind], tile.kinds[kind]);
  report.largest_edge_error = std::max(report.largest_edge_error, tile.largest_edge_error);
  report.largest_distance_error = std::max(report.largest_distance_error, tile.largest_distance_error);
  report.pixels += tile.pixels;
  report.classified_pixels += tile.classified_pixels;
  if (report.differing_pixels == 0) report.differing_x = tile.differing_x, report.differing_y = tile.differing_y;
  report.differing_pixels += tile.differing_pixels;
  report.largest_difference = std::max(report.largest_difference, tile.largest_difference);
  for (const ValidationExample& example : tile.examples) {
    const auto alike = std::count_if(
        report.examples.begin(), report.examples.end(),
        [&](const ValidationExample& other) { return other.ray.comparison.verdict == example.ray.comparison.verdict; });
    if (alike < static_cast<std::ptrdiff_t>(kMostExamples)) report.examples.push_back(example);
  }
}

void add(TracerSpeed& sum, const TracerSpeed& part) { sum.rays += part.rays, sum.seconds += part.seconds; }

}  // namespace

ValidationCounts ValidationReport::all() const {
  ValidationCounts sum;
  for (const ValidationCounts& kind : kinds) add(sum, kind);
  return sum;
}

ValidationReport validate(Scene& scene, const ShapeSet& truth_shapes, const ReferenceTracer& truth,
                          const ValidationOptions& options) {
  ValidationReport report;
  report.scene = scene.description.name;
  report.width = scene.description.image.width, report.height = scene.description.image.height;
  const std::size_t size = static_cast<std::size_t>(report.width) * static_cast<std::size_t>(report.height);
  report.verdicts.assign(size, ValidationReport::kNotCompared);
  report.gray.assign(size, 0.0f);

  const RayIntersector& tracer = *scene.intersector;
  const LentTracer lent(scene, std::make_unique<TreeTracer>(*scene.shapes, tracer, truth));
  // A truth that knows what facets stand for excuses what lies between the two, once facets themselves agree.
  std::optional<TriangleReference> facets;
  std::optional<RayJudge> of_facets;
  if (options.tolerance.sphere_pixels > 0) {
    facets.emplace(truth_shapes);
    of_facets.emplace(*scene.shapes, tracer, truth_shapes, *facets);
  }
  const RayJudge judge(*scene.shapes, tracer, truth_shapes, truth, options.tolerance,
                       of_facets ? &*of_facets : nullptr);
  Validation validation(scene, judge, options, report);
  const int columns = (report.width + kTileSize - 1) / kTileSize, rows = (report.height + kTileSize - 1) / kTileSize;
  std::vector<TileReport> tiles(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  tbb::enumerable_thread_specific<Worker> workers([&] { return Worker(scene, options.stop); });
  std::atomic<bool> complete{true};
  std::mutex mutex;
  std::uint64_t done = 0;
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, tiles.size(), 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        const FlushDenormals flush;
        Worker& worker = workers.local();
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
          if ((options.stop != nullptr && options.stop->load()) ||
              !validation.compare_tile(column * kTileSize, row * kTileSize, worker, tiles[i])) {
            complete = false;
            return;
          }
          std::lock_guard lock(mutex);
          ++done;
          if (options.on_tile) options.on_tile(done, tiles.size());
        }
      },
      tbb::simple_partitioner());
  for (const TileReport& tile : tiles) add(report, tile);
  for (const Worker& worker : workers) {
    report.diverged_rays += worker.log.diverged;
    add(report.fast, worker.log.fast);
    add(report.truth, worker.log.truth);
  }
  std::stable_sort(report.examples.begin(), report.examples.end(),
                   [](const auto& a, const auto& b) { return a.ray.comparison.verdict > b.ray.comparison.verdict; });
  report.complete = complete;
  return report;
}

}  // namespace raytree::benchmarks
