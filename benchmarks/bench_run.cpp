#include "benchmarks/bench_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "geometry/error.h"
#include "geometry/sphere_bounded_intersector.h"
#include "geometry/stopwatch.h"

namespace raytree::benchmarks {
namespace {

/// Answers farther apart than this share of the distance are different ones; rounding moves a distance by far less but
/// where rays graze.
constexpr float kSameDistance = 0x1p-10f;

/// Builds are repeated while all of them together take less than this, up to kMostBuilds.
constexpr double kRebuildSeconds = 0.5;
constexpr int kMostBuilds = 3;

/// Seconds that building takes beside medium quality's: what decides whether there is time for it.
double build_effort(const BenchConfiguration& configuration) {
  if (configuration.tracer == BenchTracer::naive) return 12;
  double effort = configuration.build.quality == EmbreeOptions::Quality::low    ? 0.4
                  : configuration.build.quality == EmbreeOptions::Quality::high ? 6
                                                                                : 1;
  // Quads are paired, and grids joined by sorting all edges, on one core.
  if (configuration.build.geometry == BenchGeometry::quads) effort += 1;
  if (configuration.build.geometry == BenchGeometry::grids) effort += 6;
  return effort;
}

/// Share of a kind's rays that may get another answer for the configuration's own reasons. Robust ones over the same
/// triangles differ where rounding decides on which side of an outline a ray passes: one in ten thousand, as
/// bare_trace.h has it; rays aimed at edges are at an outline whenever the edge is one, and without watertight edges
/// they pass between two triangles too. The naive tracer's rays are few and its arithmetic is another.
double differing_share(const BenchConfiguration& configuration, const std::string& rays) {
  // Grids halve quads their own way: another surface, off by what a quad is not flat, and many of the rays that leave
  // the old one find themselves on the new one's other side.
  if (configuration.build.geometry == BenchGeometry::grids) return 0.3;
  const bool same = configuration.tracer != BenchTracer::naive && configuration.build.robust;
  if (rays == "edge") return same ? 0.01 : 0.1;
  if (rays == "file") return same ? 1e-3 : 1e-2;
  return same ? 3e-4 : 3e-3;
}
constexpr double kAlwaysMayDiffer = 2;

/// Repetitions that quartiles can be made of; fewer are not worth their time.
constexpr int kLeastRepetitions = 3;

/// Rays of each batch where all of them together are fewer than one batch: a packet.
constexpr std::size_t kFewOfBatch = 8;

/// What answers a configuration's rays.
struct Asked {
  std::unique_ptr<const EmbreeBenchScene> bare;
  std::unique_ptr<const RayIntersector> own;
  const RayIntersector* seam = nullptr;
};

class BenchRun {
 public:
  BenchRun(const Scene& scene, const std::vector<BenchRays>& rays, const BenchRunOptions& options)
      : scene_(scene), rays_(rays), options_(options), start_(Clock::now()) {
    report_.scene = scene.description.name;
    report_.width = scene.description.image.width, report_.height = scene.description.image.height;
    report_.baseline = options.baseline;
    count(*scene.shapes);
    for (const BoundedShapes& group : scene.shapes->groups) count(group);
    report_.instances = scene.shapes->instances.size();
    subject_.meshes = report_.triangles > 0;
    subject_.threads = options.threads;
    subject_.primitives = static_cast<double>(report_.primitives());
  }

  std::vector<std::string> names() {
    build_base();
    std::vector<std::string> names;
    for (const BenchRays& kind : rays_)
      for (const BenchConfiguration& configuration : configurations_of(kind))
        names.push_back(kind.name + "/" + configuration.name());
    return names;
  }

  BenchReport run() {
    if (rays_.empty()) throw Error(ErrorKind::failure, {}, "no ray of the scene meets anything: nothing to measure");
    build_base();
    std::vector<std::string> scenes;  // in the order of configurations
    for (const BenchRays& kind : rays_)
      for (const BenchConfiguration& configuration : configurations_of(kind)) {
        if (!options_.filter.takes(kind.name + "/" + configuration.name())) continue;
        const std::string name = configuration.scene_name();
        if (std::find(scenes.begin(), scenes.end(), name) == scenes.end()) scenes.push_back(name), weights_[name] = 0;
        weights_[name] += 1;
      }
    find_baseline();
    for (std::size_t i = 0; i < scenes.size() && !stopped(); ++i) measure_scene(scenes, i);
    // As they were asked for: by kind of rays, then by configuration.
    std::stable_sort(report_.rows.begin(), report_.rows.end(), [&](const BenchRow& a, const BenchRow& b) {
      const auto place = [&](const BenchRow& row) {
        return std::find_if(rays_.begin(), rays_.end(), [&](const BenchRays& r) { return r.name == row.rays_name; });
      };
      return place(a) < place(b);
    });
    return std::move(report_);
  }

 private:
  struct Subject {
    BenchConfiguration configuration;
    const Asked* asked;
    bool reported;
    BenchRow row;
    std::vector<double> seconds;
  };

  bool stopped() const { return options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed); }
  double seconds_left() const { return options_.seconds - seconds_since(start_); }

  void count(const BoundedShapes& shapes) {
    for (const MeshEntry& entry : shapes.meshes) report_.triangles += entry.mesh.triangle_count();
    report_.others += shapes.spheres.shape.size() + shapes.discs.shape.size() + shapes.cones.shape.size();
  }

  std::vector<BenchConfiguration> configurations_of(const BenchRays& kind) const {
    BenchSubject subject = subject_;
    subject.coherent = kind.rays.coherence == Coherence::coherent;
    return bench_configurations(subject);
  }

  /// The scene that the default baseline and all counterparts ask.
  void build_base() {
    if (base_.bare) return;
    base_ = build(BenchConfiguration());
    for (const int width : {4, 8, 16})
      if (base_.bare->has_native(width)) subject_.widest_call = width;
    if (!base_.bare->has_native(4)) subject_.widest_call = 1;
  }

  void find_baseline() {
    for (const BenchRays& kind : rays_)
      for (const BenchConfiguration& configuration : configurations_of(kind))
        if (configuration.name() == options_.baseline) {
          baseline_ = configuration;
          if (configuration.scene_name() != BenchConfiguration().scene_name()) other_baseline_ = build(configuration);
          return;
        }
    throw Error(ErrorKind::bad_input, {},
                fmt::format("--against: no configuration is called \"{}\"; raytree bench --list shows the names, "
                            "behind the kind of rays",
                            options_.baseline));
  }

  Asked build(const BenchConfiguration& configuration) {
    Asked asked;
    BenchBuild built;
    built.scene = configuration.scene_name();
    std::vector<double> seconds;
    const auto start = Clock::now();
    if (configuration.tracer == BenchTracer::seam) {
      asked.seam = scene_.intersector.get();
      seconds.push_back(scene_.seconds.build);
    } else if (configuration.tracer == BenchTracer::naive) {
      SphereBoundedOptions spheres;
      spheres.stop = options_.stop;
      asked.own = std::make_unique<SphereBoundedIntersector>(*scene_.shapes, spheres);
      asked.seam = asked.own.get();
      seconds.push_back(seconds_since(start));
    } else {
      BenchSceneOptions options = configuration.build;
      options.threads = options_.threads, options.stop = options_.stop;
      do {
        asked.bare.reset();
        asked.bare = std::make_unique<EmbreeBenchScene>(*scene_.shapes, options);
        seconds.push_back(asked.bare->build_seconds());
        if (base_effort_seconds_ == 0) base_effort_seconds_ = seconds_since(start);
      } while (seconds.size() < kMostBuilds && seconds_since(start) < kRebuildSeconds);
    }
    built.bytes = asked.bare ? asked.bare->memory_bytes() : asked.seam->memory_bytes();
    built.peak_bytes = asked.bare ? asked.bare->peak_memory_bytes() : asked.seam->peak_memory_bytes();
    if (asked.bare) built.triangles_per_primitive = asked.bare->triangles_per_primitive();
    built.seconds = spread_of(std::move(seconds));
    report_.builds.push_back(built);
    return asked;
  }

  void measure_scene(const std::vector<std::string>& scenes, std::size_t at) {
    const std::string& name = scenes[at];
    double weight_left = 0;
    for (std::size_t i = at; i < scenes.size(); ++i) weight_left += weights_[scenes[i]];
    double seconds = options_.seconds > 0 ? std::max(0.0, seconds_left()) * weights_[name] / weight_left : 0;
    const auto start = Clock::now();
    const BenchConfiguration first = first_of(name);
    Asked own;
    const Asked* asked = &base_;
    if (name != BenchConfiguration().scene_name()) {
      const double expected = first.tracer == BenchTracer::seam ? 0 : base_effort_seconds_ * build_effort(first);
      if (options_.seconds > 0 && expected > 0.5 * std::max(0.0, seconds_left())) {
        report_.left_out.push_back({name, fmt::format("building it would take some {:.2g} s, {:.2g} s were left",
                                                      expected, std::max(0.0, seconds_left()))});
        return;
      }
      if (other_baseline_.bare || other_baseline_.seam != nullptr) asked = &other_baseline_;
      if (asked == &base_ || baseline_.scene_name() != name) {
        own = build(first);
        asked = &own;
      }
    }
    if (seconds > 0) seconds = std::max(0.2 * seconds, seconds - seconds_since(start));
    for (const BenchRays& kind : rays_)
      if (!stopped()) measure_kind(kind, name, *asked, seconds / static_cast<double>(rays_.size()));
  }

  BenchConfiguration first_of(const std::string& scene_name) const {
    for (const BenchRays& kind : rays_)
      for (const BenchConfiguration& configuration : configurations_of(kind))
        if (configuration.scene_name() == scene_name) return configuration;
    return {};
  }

  /// The baseline, what stands beside the rows, and the rows that the filter takes of one scene.
  std::vector<Subject> subjects_of(const BenchRays& kind, const std::string& scene_name, const Asked& asked) {
    const bool default_scene = baseline_.scene_name() == BenchConfiguration().scene_name();
    std::vector<Subject> subjects{{baseline_, default_scene ? &base_ : &other_baseline_, false, {}, {}}};
    const auto place = [&](const BenchConfiguration& configuration) {
      return std::find_if(subjects.begin(), subjects.end(),
                          [&](const Subject& subject) { return subject.configuration.name() == configuration.name(); });
    };
    for (const BenchConfiguration& configuration : configurations_of(kind)) {
      if (configuration.scene_name() != scene_name) continue;
      if (!options_.filter.takes(kind.name + "/" + configuration.name())) continue;
      const BenchConfiguration same_call = counterpart(configuration);
      const bool beside = configuration.tracer == BenchTracer::bare && same_call.name() != configuration.name();
      if (beside && place(same_call) == subjects.end()) subjects.push_back({same_call, &base_, false, {}, {}});
      if (const auto found = place(configuration); found != subjects.end()) {
        found->reported = true;
        continue;
      }
      subjects.push_back({configuration, &asked, true, {}, {}});
      if (beside && same_call.name() != baseline_.name()) subjects.back().row.beside = same_call.name();
    }
    return subjects;
  }

  PassResult pass(const Subject& subject, const BenchRays& kind, const LookAtBatch& look = {}) const {
    const int threads = subject.configuration.threads > 0 ? subject.configuration.threads : options_.threads;
    if (subject.asked->seam != nullptr)
      return timed_pass(
          kind.rays, threads,
          [&](std::size_t batch, HitBatch& hits, std::uint8_t* occluded) {
            return ask_tracer<RunningTime>(*subject.asked->seam, kind.rays, batch, hits, occluded);
          },
          look);
    const RaySet& rays = kind.bare();
    return timed_pass(
        rays, threads,
        [&](std::size_t batch, HitBatch& hits, std::uint8_t* occluded) {
          const RayBatch& asked = rays.batches[batch];
          const BenchCall call = subject.configuration.call;
          const double seconds = rays.occlusion ? subject.asked->bare->occluded(asked, call, occluded)
                                                : subject.asked->bare->intersect(asked, call, hits);
          if (!kind.plane_distance.empty()) {
            const std::vector<float>& planes = kind.plane_distance[batch];
            for (std::size_t i = 0; i < asked.size; ++i) {
              if (planes[i] == kInfinity) continue;
              occluded[i] = 1;
              if (!rays.occlusion && hits.geometry[i] == kNoGeometry) hits.set(i, {kPlaneGeometry, 0, 0, 0, planes[i]});
            }
          }
          return seconds;
        },
        look);
  }

  /// Distances of a pass's hits, infinite for misses, 0 for occluded rays.
  std::vector<float> answers_of(const Subject& subject, const BenchRays& kind, PassResult& result) const {
    std::vector<float> answers(kind.rays.batches.size() * kBenchmarkBatch, kInfinity);
    result = pass(subject, kind, [&](std::size_t batch, const HitBatch& hits, const std::uint8_t* occluded) {
      for (std::size_t i = 0; i < kind.rays.batches[batch].size; ++i) {
        float& answer = answers[batch * kBenchmarkBatch + i];
        if (kind.rays.occlusion)
          answer = occluded[i] != 0 ? 0 : kInfinity;
        else if (hits.geometry[i] != kNoGeometry)
          answer = hits.distance[i];
      }
    });
    return answers;
  }

  static std::uint64_t different(const std::vector<float>& a, const std::vector<float>& b) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (a[i] == b[i]) continue;
      count += !(std::abs(a[i] - b[i]) <= kSameDistance * std::max(a[i], b[i]));
    }
    return count;
  }

  static BenchRays part_of(const BenchRays& kind, std::size_t batches, std::size_t most_of_batch) {
    BenchRays part;
    part.name = kind.name;
    const auto take = [&](const RaySet& from, RaySet& to) {
      to.coherence = from.coherence, to.occlusion = from.occlusion;
      const std::size_t count = from.batches.size(), taken = std::min(count, batches);
      for (std::size_t k = 0; k < taken; ++k) {
        const RayBatch& batch = from.batches[k * count / taken];
        RayBatch& copy = to.batches.emplace_back(kBenchmarkBatch);
        for (std::size_t i = 0; i < std::min(batch.size, most_of_batch); ++i)
          copy.push(batch.origin(i), batch.direction(i), batch.max_distance[i]);
      }
    };
    take(kind.rays, part.rays);
    if (!kind.plane_distance.empty()) {
      take(kind.without_planes, part.without_planes);
      const std::size_t count = kind.plane_distance.size(), taken = std::min(count, batches);
      for (std::size_t k = 0; k < taken; ++k) part.plane_distance.push_back(kind.plane_distance[k * count / taken]);
    }
    return part;
  }

  /// As many of a kind's rays as there is time for: powers of two of batches, or of rays of one batch, so that two runs
  /// with about the same time take the same rays.
  BenchRays fitting_part(const BenchRays& kind, const std::vector<Subject>& subjects, double seconds) const {
    const bool naive = std::any_of(subjects.begin(), subjects.end(), [](const Subject& subject) {
      return subject.configuration.tracer == BenchTracer::naive;
    });
    // Few rays are a few of many batches, so that they are the picture's, not a corner's.
    const auto few = [&](std::size_t rays) { return part_of(kind, rays / kFewOfBatch, kFewOfBatch); };
    if (seconds <= 0) return naive ? few(kNaiveRays) : part_of(kind, kBenchBatches, kBenchmarkBatch);
    const BenchRays trial = naive ? few(2 * kFewOfBatch) : part_of(kind, 2, kBenchmarkBatch);
    double round = 0;
    for (int i = 0; i < 2; ++i) {  // the second counts: the first finds cold caches
      const auto start = Clock::now();
      for (const Subject& subject : subjects) pass(subject, trial);
      round = seconds_since(start);
    }
    double rays = seconds / ((options_.repetitions + 1) * round / static_cast<double>(trial.rays.size()));
    rays = std::exp2(std::floor(std::log2(std::max(rays, 16.0))));
    if (rays < double(kBenchmarkBatch)) return few(static_cast<std::size_t>(rays));
    return part_of(kind, static_cast<std::size_t>(std::min(rays, 1e9)) / kBenchmarkBatch, kBenchmarkBatch);
  }

  void measure_kind(const BenchRays& all, const std::string& scene_name, const Asked& asked, double seconds) {
    std::vector<Subject> subjects = subjects_of(all, scene_name, asked);
    if (std::none_of(subjects.begin(), subjects.end(), [](const Subject& subject) { return subject.reported; })) return;
    const BenchRays kind = fitting_part(all, subjects, seconds);
    std::vector<float> reference;
    for (Subject& subject : subjects) {
      PassResult result;
      const std::vector<float> answers = answers_of(subject, kind, result);
      if (reference.empty()) reference = answers;
      BenchRow& row = subject.row;
      row.rays_name = kind.name;
      row.configuration = subject.configuration.name();
      row.threads = subject.configuration.threads > 0 ? subject.configuration.threads : options_.threads;
      row.rays = kind.rays.size();
      row.hits = result.hits, row.checksum = result.checksum;
      row.differ = different(reference, answers);
      // What either side explains: of two configurations the more careless one.
      const double share =
          std::max(differing_share(subject.configuration, kind.name), differing_share(baseline_, kind.name));
      row.may_differ = static_cast<std::uint64_t>(kAlwaysMayDiffer + share * static_cast<double>(row.rays));
    }
    const auto start = Clock::now();
    for (int repetition = 0; repetition < options_.repetitions && !stopped(); ++repetition) {
      // What the trial foretold may not have come: a machine that is busy with other things.
      if (seconds > 0 && repetition >= kLeastRepetitions && seconds_since(start) > seconds) break;
      for (Subject& subject : subjects) {
        const PassResult result = pass(subject, kind);
        subject.seconds.push_back(result.seconds);
        subject.row.repeatable &= result.hits == subject.row.hits && result.checksum == subject.row.checksum;
      }
    }
    finish_rows(subjects);
  }

  void finish_rows(std::vector<Subject>& subjects) {
    const auto ratio_to = [](const Subject& subject, const std::vector<double>& other) {
      std::vector<double> ratios;
      for (std::size_t i = 0; i < subject.seconds.size() && i < other.size(); ++i)
        ratios.push_back(other[i] / subject.seconds[i]);
      return spread_of(std::move(ratios));
    };
    for (Subject& subject : subjects) {
      if (!subject.reported) continue;
      BenchRow& row = subject.row;
      for (const double seconds : subject.seconds)
        row.samples.push_back(static_cast<double>(row.rays) / seconds * 1e-6);
      row.speed = spread_of(row.samples);
      row.ratio = ratio_to(subject, subjects.front().seconds);
      for (const Subject& other : subjects)
        if (!row.beside.empty() && other.configuration.name() == row.beside)
          row.beside_ratio = ratio_to(subject, other.seconds);
      report_.rows.push_back(std::move(row));
    }
  }

  const Scene& scene_;
  const std::vector<BenchRays>& rays_;
  const BenchRunOptions& options_;
  const Clock::time_point start_;
  BenchSubject subject_;
  BenchConfiguration baseline_;
  Asked base_, other_baseline_;
  double base_effort_seconds_ = 0;         ///< one build of the base scene
  std::map<std::string, double> weights_;  ///< rows of each scene
  BenchReport report_;
};

}  // namespace

bool BenchReport::suspicious() const {
  return std::any_of(rows.begin(), rows.end(), [](const BenchRow& row) { return row.suspicious(); });
}

std::vector<std::string> bench_row_names(const Scene& scene, const std::vector<BenchRays>& rays, int threads) {
  BenchRunOptions options;
  options.threads = threads;
  return BenchRun(scene, rays, options).names();
}

BenchReport run_bench(const Scene& scene, const std::vector<BenchRays>& rays, const BenchRunOptions& options) {
  return BenchRun(scene, rays, options).run();
}

}  // namespace raytree::benchmarks
