#include "benchmarks/bench_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

#include "benchmarks/bench_check.h"
#include "benchmarks/bench_sample.h"
#include "benchmarks/bench_tracers.h"
#include "geometry/error.h"
#include "geometry/stopwatch.h"

namespace raytree::benchmarks {
namespace {

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

/// Seconds a triangle that the check's hierarchy takes, and the share of the time left that it may have.
constexpr double kCheckSecondsEach = 1e-6;
constexpr double kCheckShare = 0.3;

/// Of the rays that all answer alike, so many of the baseline's are checked too.
constexpr std::size_t kAlwaysChecked = 256;

/// Repetitions that quartiles can be made of; fewer are not worth their time.
constexpr int kLeastRepetitions = 3;

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
    subject_.widest_call = EmbreeBenchScene::widest_call(options.isa);
    subject_.seam = options.isa.empty();
  }

  std::vector<std::string> names() {
    std::vector<std::string> names;
    for (const BenchRays& kind : rays_)
      for (const BenchConfiguration& configuration : configurations_of(kind))
        names.push_back(kind.name + "/" + configuration.name());
    return names;
  }

  BenchReport run() {
    if (rays_.empty()) throw Error(ErrorKind::failure, {}, "no ray of the scene meets anything: nothing to measure");
    find_baseline();
    build_base();
    std::vector<std::string> scenes;  // in the order of configurations
    for (const BenchRays& kind : rays_)
      for (const BenchConfiguration& configuration : configurations_of(kind)) {
        if (!options_.filter.takes(kind.name + "/" + configuration.name())) continue;
        const std::string name = configuration.scene_name();
        if (std::find(scenes.begin(), scenes.end(), name) == scenes.end()) scenes.push_back(name), weights_[name] = 0;
        weights_[name] += 1;
      }
    for (std::size_t i = 0; i < scenes.size() && !stopped(); ++i) measure_scene(scenes, i);
    blame_baseline();
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
    const BuiltTracer* asked;
    bool reported;
    BenchRow row;
    std::vector<double> seconds;
    std::vector<float> answers;

    int threads(int of_run) const { return configuration.threads > 0 ? configuration.threads : of_run; }
  };

  bool stopped() const { return options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed); }
  double seconds_left() const { return std::max(0.0, options_.seconds - seconds_since(start_)); }

  void count(const BoundedShapes& shapes) {
    for (const MeshEntry& entry : shapes.meshes) report_.triangles += entry.mesh.triangle_count();
    report_.others += shapes.spheres.shape.size() + shapes.discs.shape.size() + shapes.cones.shape.size();
  }

  std::vector<BenchConfiguration> configurations_of(const BenchRays& kind) const {
    if (!options_.configurations.empty()) return options_.configurations;
    BenchSubject subject = subject_;
    subject.coherent = kind.rays.coherence == Coherence::coherent;
    return bench_configurations(subject);
  }

  void find_baseline() {
    for (const BenchRays& kind : rays_)
      for (const BenchConfiguration& configuration : configurations_of(kind))
        if (configuration.name() == options_.baseline) {
          baseline_ = configuration;
          return;
        }
    throw Error(ErrorKind::bad_input, {},
                fmt::format("--against: no configuration is called \"{}\"; raytree bench --list shows the names, "
                            "behind the kind of rays",
                            options_.baseline));
  }

  /// The scenes that the baseline and all counterparts ask.
  void build_base() {
    base_scene_ = counterpart(baseline_, baseline_).scene_name();
    base_ = built(counterpart(baseline_, baseline_));
    base_seconds_ = base_.first_seconds;
    if (baseline_.tracer != BenchTracer::bare) own_baseline_ = built(baseline_);
  }

  BuiltTracer built(BenchConfiguration configuration) {
    configuration.build.isa = options_.isa;
    BuiltTracer tracer = build_tracer(scene_, configuration, options_.threads, options_.stop);
    report_.builds.push_back(tracer.build);
    return tracer;
  }

  void measure_scene(const std::vector<std::string>& scenes, std::size_t at) {
    const std::string& name = scenes[at];
    double weight_left = 0;
    for (std::size_t i = at; i < scenes.size(); ++i) weight_left += weights_[scenes[i]];
    double seconds = options_.seconds > 0 ? seconds_left() * weights_[name] / weight_left : 0;
    const auto start = Clock::now();
    const BenchConfiguration first = first_of(name);
    BuiltTracer own;
    const BuiltTracer* asked = name == base_scene_ ? &base_ : &own_baseline_;
    if (name != base_scene_ && name != baseline_.scene_name()) {
      const double expected = first.tracer == BenchTracer::seam ? 0 : base_seconds_ * build_effort(first);
      if (options_.seconds > 0 && expected > 0.5 * seconds_left()) {
        report_.left_out.push_back(
            {name, fmt::format("building it would take some {:.2g} s, {:.2g} s were left", expected, seconds_left())});
        return;
      }
      own = built(first);
      asked = &own;
    }
    if (seconds > 0) seconds = std::max(0.2 * seconds, seconds - seconds_since(start));
    surface_check_.reset();
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
  std::vector<Subject> subjects_of(const BenchRays& kind, const std::string& scene_name, const BuiltTracer& asked) {
    std::vector<Subject> subjects{{baseline_, own_baseline_ ? &own_baseline_ : &base_, false, {}, {}, {}}};
    const auto place = [&](const BenchConfiguration& configuration) {
      return std::find_if(subjects.begin(), subjects.end(),
                          [&](const Subject& subject) { return subject.configuration.name() == configuration.name(); });
    };
    for (const BenchConfiguration& configuration : configurations_of(kind)) {
      if (configuration.scene_name() != scene_name) continue;
      if (!options_.filter.takes(kind.name + "/" + configuration.name())) continue;
      const BenchConfiguration same_call = counterpart(configuration, baseline_);
      const bool beside = configuration.tracer == BenchTracer::bare && same_call.name() != configuration.name();
      if (beside && place(same_call) == subjects.end()) subjects.push_back({same_call, &base_, false, {}, {}, {}});
      if (const auto found = place(configuration); found != subjects.end()) {
        found->reported = true;
        continue;
      }
      subjects.push_back({configuration, &asked, true, {}, {}, {}});
      if (beside && same_call.name() != baseline_.name()) subjects.back().row.beside = same_call.name();
    }
    return subjects;
  }

  PassResult pass(const Subject& subject, const BenchRays& kind) const {
    return ask_all(*subject.asked, subject.configuration.call, kind, subject.threads(options_.threads));
  }

  void measure_kind(const BenchRays& all, const std::string& scene_name, const BuiltTracer& asked, double seconds) {
    std::vector<Subject> subjects = subjects_of(all, scene_name, asked);
    if (std::none_of(subjects.begin(), subjects.end(), [](const Subject& subject) { return subject.reported; })) return;
    RayBudget budget{seconds, options_.repetitions, false};
    for (const Subject& subject : subjects) budget.naive |= subject.configuration.tracer == BenchTracer::naive;
    const BenchRays kind = fitting_part(all, budget, [&](const BenchRays& trial) {
      for (const Subject& subject : subjects) pass(subject, trial);
    });
    for (Subject& subject : subjects) {
      const int threads = subject.threads(options_.threads);
      BenchAnswers answers = answers_of(*subject.asked, subject.configuration.call, kind, threads);
      subject.answers = std::move(answers.distances);
      BenchRow& row = subject.row;
      row.rays_name = kind.name;
      row.configuration = subject.configuration.name();
      row.threads = threads;
      row.rays = kind.rays.size();
      row.hits = answers.pass.hits, row.checksum = answers.pass.checksum;
    }
    check_answers(subjects, kind);
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

  /// Where answers differ from the baseline's, both are asked about in double; of the baseline's some others too.
  void check_answers(std::vector<Subject>& subjects, const BenchRays& kind) {
    const std::vector<float>& reference = subjects.front().answers;
    std::vector<bool> of_baseline(reference.size(), false);
    const std::size_t step = std::max<std::size_t>(1, kind.rays.size() / kAlwaysChecked);
    std::vector<std::vector<std::size_t>> rays(subjects.size());
    for (std::size_t batch = 0, count = 0; batch < kind.rays.batches.size(); ++batch)
      for (std::size_t i = 0; i < kind.rays.batches[batch].size; ++i, ++count) {
        const std::size_t at = batch * kBenchmarkBatch + i;
        of_baseline[at] = count % step == 0;
        for (std::size_t s = 1; s < subjects.size(); ++s)
          if (differs(reference[at], subjects[s].answers[at])) rays[s].push_back(at), of_baseline[at] = true;
      }
    for (std::size_t at = 0; at < of_baseline.size(); ++at)
      if (of_baseline[at]) rays[0].push_back(at);
    for (std::size_t s = 0; s < subjects.size(); ++s) {
      Subject& subject = subjects[s];
      if (s > 0) subject.row.differ = rays[s].size();
      if (rays[s].empty()) continue;
      const BenchCheck* check = check_of(*subject.asked);
      if (check == nullptr) continue;
      BenchConfiguration configuration = subject.configuration;
      if (configuration.tracer == BenchTracer::seam) configuration.build.robust = options_.seam_watertight;
      const CheckedAnswers answers = check->check(configuration, *subject.asked, kind, subject.answers, rays[s]);
      subject.row.checked = answers.checked, subject.row.wrong = answers.wrong;
      subject.row.wrong_example = answers.example;
    }
    const BenchRow& baseline = subjects.front().row;
    if (baseline.wrong > 0) wrong_baselines_.emplace(kind.name, baseline);
  }

  /// The baseline is asked again beside every scene: what is wrong with it is said in its row, or, where that was not
  /// asked for, in all rows that it stands behind.
  void blame_baseline() {
    for (const auto& [kind, baseline] : wrong_baselines_) {
      const auto own = std::find_if(report_.rows.begin(), report_.rows.end(),
                                    [&, &wrong = baseline](const BenchRow& row) { return row.name() == wrong.name(); });
      for (BenchRow& row : report_.rows) {
        if (row.rays_name != kind || row.wrong > 0 || (own != report_.rows.end() && &row != &*own)) continue;
        row.checked = baseline.checked, row.wrong = baseline.wrong;
        row.wrong_example = (own != report_.rows.end() ? "" : "the baseline: ") + baseline.wrong_example;
      }
    }
  }

  /// The truth about what a tracer traces, made when it is first asked for; null: there is no time for it.
  const BenchCheck* check_of(const BuiltTracer& tracer) {
    const bool grids = tracer.bare && tracer.bare->has_own_surface();
    std::unique_ptr<const BenchCheck>& check = grids ? surface_check_ : check_;
    if (check) return check.get();
    if (options_.seconds > 0 && subject_.primitives * kCheckSecondsEach > kCheckShare * seconds_left()) return nullptr;
    if (grids)
      check = std::make_unique<const BenchCheck>(tracer.bare->surface());
    else
      check = std::make_unique<const BenchCheck>(*scene_.shapes);
    return check.get();
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
  std::string base_scene_;
  BuiltTracer base_, own_baseline_;
  std::unique_ptr<const BenchCheck> check_, surface_check_;  ///< of the scene's triangles; of one scene's grids
  std::map<std::string, BenchRow> wrong_baselines_;          ///< of kinds of rays
  double base_seconds_ = 0;                                  ///< one build of the base scene
  std::map<std::string, double> weights_;                    ///< rows of each scene
  BenchReport report_;
};

}  // namespace

bool BenchReport::suspicious() const {
  return std::any_of(rows.begin(), rows.end(), [](const BenchRow& row) { return row.suspicious(); });
}

std::vector<std::string> bench_row_names(const Scene& scene, const std::vector<BenchRays>& rays, int threads,
                                         const std::string& isa) {
  BenchRunOptions options;
  options.threads = threads, options.isa = isa;
  return BenchRun(scene, rays, options).names();
}

BenchReport run_bench(const Scene& scene, const std::vector<BenchRays>& rays, const BenchRunOptions& options) {
  return BenchRun(scene, rays, options).run();
}

}  // namespace raytree::benchmarks
