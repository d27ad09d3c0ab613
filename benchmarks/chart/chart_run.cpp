#include "benchmarks/chart/chart_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <iterator>
#include <limits>
#include <set>

#include "benchmarks/chart/chart_cost.h"
#include "benchmarks/report_page.h"
#include "geometry/stopwatch.h"
#include "renderer/film_image.h"
#include "renderer/image_file.h"

namespace raytree::benchmarks {
namespace {

constexpr double kEnough = 0.02;  ///< (quartile distance) / median / sqrt(samples) of a time that is known
constexpr std::size_t kFewestSamples = 3, kMostSamples = 15;
constexpr double kAloneShare = 0.65;    ///< of the budget: until then knobs are turned one at a time...
constexpr double kCrossedShare = 0.75;  ///< ...until then several; then times are taken again
constexpr double kProbeShare = 0.08;    ///< of the budget that small pictures may take
constexpr double kPointShare = 0.1;     ///< of the budget that one render may take
constexpr double kProbeSlack = 8;       ///< a small picture may take as many times its share of the pixels
constexpr int kEstimateEdge = 6;        ///< the naive tracer's time is guessed from a picture of 1/6 of the edges
constexpr double kSecondsBetweenSaves = 15;

/// Of the bits of the picture's light.
std::string hash_of(const Film& film) {
  const std::size_t bytes =
      static_cast<std::size_t>(film.window().width) * static_cast<std::size_t>(film.window().height) * sizeof(float);
  std::string all(3 * bytes, '\0');
  for (int c = 0; c < 3; ++c)
    std::memcpy(all.data() + static_cast<std::size_t>(c) * bytes, film.plane(ChannelGroup::color, c), bytes);
  return text_hash(all);
}

bool time_is_known(const ChartPoint& point) {
  if (point.cpu_seconds.size() >= kMostSamples) return true;
  if (point.cpu_seconds.size() < kFewestSamples) return false;
  const Spread cpu = point.cpu();
  return (cpu.high - cpu.low) / cpu.median / std::sqrt(static_cast<double>(cpu.count)) <= kEnough;
}

class ChartMeasurement {
 public:
  ChartMeasurement(const ChartOptions& options, const EarlierChart* earlier, Warnings& warnings)
      : options_(options), earlier_(earlier), warnings_(warnings), display_(DisplayOptions()) {}

  MeasuredChart run() {
    const std::optional<SceneTraits> traits = look_at_scene();
    if (!traits || !take_reference(*traits)) return interrupted();
    std::deque<ChartSetting> alone, crossed;
    for (ChartSetting& setting : sweep_of(*traits, options_.added, result_.data.plan.grid))
      (setting.part == SweepPart::crossed ? crossed : alone).push_back(std::move(setting));
    keep_earlier_points(alone, crossed);
    if (!stale_.empty()) repeat();
    // However little time is left, a chart holds the scene as it is.
    if (result_.data.points.empty() && !alone.empty()) measure(alone.front()), alone.pop_front();
    sort_by_cost(alone);
    bool more = true;
    while (more && !stopped() && spent() < 1) {
      // The second time around, budget is left though all times are known.
      const bool first = more_time_needed() || result_.data.points.empty();
      const bool any_alone = measure_new(alone, first ? kAloneShare : (1 + spent()) / 2);
      const bool any_crossed = measure_new(crossed, first ? kCrossedShare : (1 + spent()) / 2);
      more = repeat() || any_alone || any_crossed;
    }
    for (const auto* queue : {&alone, &crossed})
      if (!queue->empty())
        result_.data.left_out.push_back(
            fmt::format("{} settings {} were not reached within the budget; the same command goes on from here",
                        queue->size(), queue == &alone ? "of one knob" : "of the crossed set"));
    // Errors against two references do not compare.
    for (auto i = stale_.rbegin(); i != stale_.rend(); ++i)
      result_.data.points.erase(result_.data.points.begin() + static_cast<std::ptrdiff_t>(*i));
    result_.data.complete = !stopped();
    return std::move(result_);
  }

 private:
  bool stopped() const { return options_.stop != nullptr && *options_.stop; }
  double spent() const { return seconds_since(start_) / options_.budget_seconds; }
  double seconds_left() const { return options_.budget_seconds - seconds_since(start_); }

  MeasuredChart interrupted() {
    result_.data.complete = false;
    return std::move(result_);
  }

  void phase(const std::string& text) const {
    if (options_.on_phase) options_.on_phase(text);
  }

  Words command(const Words& flags) const {
    Words words = options_.command;
    words.insert(words.end(), flags.begin(), flags.end());
    return words;
  }

  /// The scene as it is, prepared once: what it has, and the chart's head.
  std::optional<SceneTraits> look_at_scene() {
    phase("preparing the scene");
    ChartScene scene = options_.make({});
    ChartData& data = result_.data;
    data.scene = scene.description.name;
    data.title = scene.description.title;
    data.scene_hash = scene_hash(scene);
    data.version = options_.version;
    data.machine = machine_line();
    data.width = scene.description.image.width;
    data.height = scene.description.image.height;
    data.threads = options_.threads;
    data.budget_seconds = options_.budget_seconds;
    scene.prepare.threads = options_.threads;
    scene.prepare.stop = options_.stop;
    try {
      return scene_traits(prepare(std::move(scene.description), scene.prepare, warnings_));
    } catch (const Error&) {
      if (!stopped()) throw;
      return std::nullopt;
    }
  }

  std::vector<std::byte> png_of(const Film& film) const {
    const DisplayImage shown = display_image(film, display_);
    return encode_image(display_referred_image(shown, film, {}), ImageFormat::png);
  }

  bool take_reference(const SceneTraits& traits) {
    ChartData& data = result_.data;
    phase("planning the reference");
    std::optional<ReferencePlan> plan = plan_reference(options_.make, traits, data.width, data.height,
                                                       options_.budget_seconds, options_.threads, options_.stop);
    if (!plan) return false;
    const bool goes_on = earlier_ != nullptr && same_subject(earlier_->data, data);
    if (goes_on && earlier_->reference && earlier_->data.plan.is_as_fine_as(*plan)) {
      data.plan = earlier_->data.plan;
      data.floor = earlier_->data.floor;
      data.reference_seconds = earlier_->data.reference_seconds;
      result_.reference = earlier_->reference;
    } else {
      phase("tracing the reference: " + plan->words);
      data.plan = *plan;
      std::optional<ChartReference> made =
          make_reference(*plan, options_.make, display_, options_.threads, options_.stop, warnings_);
      if (!made) return false;
      data.floor = made->floor;
      data.reference_seconds = made->seconds;
      result_.reference = std::move(made->film);
      if (options_.keep_reference) options_.keep_reference(*result_.reference);
    }
    data.reference_command = command_text(command(data.plan.last_flags(0)));
    data.reference_picture = png_of(*result_.reference);
    reference_ = chart_picture(*result_.reference, display_);
    return true;
  }

  /// Points of an earlier chart take the places of settings still to be measured.
  void keep_earlier_points(std::deque<ChartSetting>& alone, std::deque<ChartSetting>& crossed) {
    if (earlier_ == nullptr || !same_subject(earlier_->data, result_.data)) return;
    const bool same_reference = earlier_->data.plan == result_.data.plan;
    const std::string head = command_text(options_.command);
    for (const ChartPoint& point : earlier_->data.points) {
      std::deque<ChartSetting>& queue = point.setting.part == SweepPart::crossed ? crossed : alone;
      const auto place = std::find_if(queue.begin(), queue.end(),
                                      [&](const ChartSetting& s) { return s.flags == point.setting.flags; });
      if (place == queue.end()) continue;
      ChartPoint kept = point;
      kept.setting = *place;
      kept.command = command_text(command(kept.setting.flags));
      queue.erase(place);
      if (!keys_.insert(kept.key).second) continue;
      if (!same_reference) stale_.insert(result_.data.points.size());
      result_.data.points.push_back(std::move(kept));
      ++result_.points_kept;
    }
  }

  /// Small pictures of settings that wait say which are cheap; those that come to a setting that was measured go.
  void sort_by_cost(std::deque<ChartSetting>& queue) {
    std::vector<ChartSetting> settings;
    std::set<std::string> seen = keys_;
    phase("looking which settings are cheap");
    const double share = probe_own_settings() * static_cast<double>(queue.size()) / options_.budget_seconds;
    small_pictures_pay_ = share <= kProbeShare;
    for (ChartSetting& setting : queue) {
      if (stopped()) break;
      const ChartScene scene = options_.make(setting.flags);
      if (!seen.insert(text_hash(render_key(scene))).second) continue;
      // The naive tracer's rays are as many, and take far longer.
      if (small_pictures_pay_ && scene.prepare.tracer != Tracer::spheres)
        setting.expected_rays = expected_rays_of(scene, most_probe_seconds());
      settings.push_back(std::move(setting));
    }
    sort_cheap_first(settings);
    queue.assign(std::make_move_iterator(settings.begin()), std::make_move_iterator(settings.end()));
  }

  /// Seconds that a small picture of the scene's own settings takes: where preparing is most of a render, as long.
  double probe_own_settings() {
    const Clock::time_point begin = Clock::now();
    own_rays_ = expected_rays_of(options_.make({}), std::numeric_limits<double>::infinity());
    own_probe_seconds_ = seconds_since(begin);
    return own_probe_seconds_;
  }

  /// What a small picture may take of a setting that the budget holds: beyond preparing the scene, its share of the
  /// pixels of a whole one, and some times more. Trees that double at every level have no end otherwise.
  double most_probe_seconds() const {
    const double share = std::pow(std::min(1.0, static_cast<double>(kProbeWidth) / result_.data.width), 2);
    return own_probe_seconds_ + kProbeSlack * share * kPointShare * options_.budget_seconds;
  }

  /// 0: stopped; infinite: the small picture took longer than `most_seconds`.
  double expected_rays_of(const ChartScene& scene, double most_seconds) const {
    const TimeLimit limit(options_.stop, most_seconds);
    const std::optional<double> rays =
        expected_rays(scene, result_.data.width, result_.data.height, options_.threads, &limit.stop());
    if (rays) return *rays;
    return stopped() ? 0 : std::numeric_limits<double>::infinity();
  }

  bool more_time_needed() const {
    return !std::all_of(result_.data.points.begin(), result_.data.points.end(), time_is_known);
  }

  /// Measures settings of the queue until so much of the budget is spent. False: nothing was left to measure.
  bool measure_new(std::deque<ChartSetting>& queue, double until) {
    bool measured = false;
    while (!queue.empty() && !stopped() && spent() < until) {
      const ChartSetting setting = std::move(queue.front());
      queue.pop_front();
      measure(setting);
      measured = true;
    }
    return measured;
  }

  void leave_out(const ChartSetting& setting, const std::string& why) {
    result_.data.left_out.push_back(command_text(setting.flags) + ": " + why);
  }

  void measure(const ChartSetting& setting) {
    ChartScene scene = options_.make(setting.flags);
    const std::string key = text_hash(render_key(scene));
    if (keys_.count(key) != 0) return;  // as another setting
    phase(setting.part == SweepPart::defaults ? "the scene's own settings" : command_text(setting.flags));
    // What everything is compared with is measured whatever it takes.
    const double most = setting.part == SweepPart::defaults
                            ? std::numeric_limits<double>::infinity()
                            : std::max(0.5, std::min(kPointShare * options_.budget_seconds, seconds_left()));
    if (setting.part != SweepPart::defaults) {
      const double estimate = estimated_seconds(scene, setting);
      if (std::isinf(estimate)) {
        leave_out(setting, fmt::format("a small picture of it alone took over {}: more than this budget's {} a render",
                                       short_seconds(most_probe_seconds()), short_seconds(most)));
        return;
      }
      if (estimate > most) {
        leave_out(setting, fmt::format("would take about {}, more than this budget's {} a render",
                                       short_seconds(estimate), short_seconds(most)));
        return;
      }
    }
    const TimeLimit limit(options_.stop, most);
    Warnings same;
    const ChartRender render = render_timed(std::move(scene), options_.threads, &limit.stop(), same);
    if (stopped()) return;
    if (!render.complete) {
      leave_out(setting, fmt::format("stopped after {}, this budget's most for a render", short_seconds(most)));
      return;
    }
    keys_.insert(key);
    ChartPoint point;
    point.setting = setting;
    point.command = command_text(command(setting.flags));
    point.key = key;
    point.cpu_seconds = {render.cpu_seconds};
    point.wall_seconds = {render.wall_seconds};
    point.build_seconds = render.build_seconds;
    point.rays = render.rays;
    if (render.peak_bytes) point.peak_bytes = {static_cast<double>(*render.peak_bytes)};
    point.film_bytes = render.film_bytes;
    point.array_bytes = render.array_bytes;
    point.tracer_bytes = render.tracer_bytes;
    point.picture_hash = hash_of(render.film);
    judge(point, render.film);
    result_.data.points.push_back(std::move(point));
    save_now_and_then();
  }

  void judge(ChartPoint& point, const Film& film) const {
    point.errors = picture_errors(reference_, chart_picture(film, display_));
    point.picture = png_of(film);
  }

  /// Wall seconds of a render, from small pictures; 0 where nothing is known yet.
  double estimated_seconds(const ChartScene& scene, const ChartSetting& setting) {
    if (scene.prepare.tracer == Tracer::spheres) return estimated_naive_seconds(scene);
    const auto own = std::find_if(result_.data.points.begin(), result_.data.points.end(),
                                  [](const ChartPoint& p) { return p.setting.part == SweepPart::defaults; });
    if (own == result_.data.points.end() || !small_pictures_pay_ || own_rays_ == 0) return 0;
    const double rays =
        setting.expected_rays > 0 ? setting.expected_rays : expected_rays_of(scene, most_probe_seconds());
    return own->wall().median * rays / own_rays_;
  }

  /// With the naive tracer, whose time goes with the pixels.
  double estimated_naive_seconds(const ChartScene& scene) const {
    ChartScene small = scene;
    ImageDescription& image = small.description.image;
    const double pixels = static_cast<double>(image.width) * image.height;
    image = {std::max(1, image.width / kEstimateEdge), std::max(1, image.height / kEstimateEdge)};
    const double factor = pixels / (static_cast<double>(image.width) * image.height);
    const double most = kPointShare * options_.budget_seconds / 2;
    const TimeLimit limit(options_.stop, most);
    Warnings same;
    const ChartRender render = render_timed(std::move(small), options_.threads, &limit.stop(), same);
    return render.complete ? render.wall_seconds * factor : most * factor;
  }

  /// Whose times are to be taken again: while any of them is not known, the scene's own settings and what lies on the
  /// fronts alone, since all that is said follows from these.
  std::vector<std::size_t> wanting_time() const {
    const std::vector<ChartPoint>& points = result_.data.points;
    std::set<std::size_t> foremost;
    for (const MetricInfo& metric : kMetrics)
      if (metric.charted)
        for (const std::size_t i : chart_front(result_.data, metric)) foremost.insert(i);
    std::vector<std::size_t> first, rest;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (time_is_known(points[i]) && stale_.count(i) == 0) continue;
      if (points[i].wall().median > seconds_left()) continue;
      const bool leads =
          points[i].setting.part == SweepPart::defaults || foremost.count(i) != 0 || stale_.count(i) != 0;
      (leads ? first : rest).push_back(i);
    }
    return first.empty() ? rest : first;
  }

  /// One more time of every point that wants it and fits, by turns. False: none does.
  bool repeat() {
    bool any = false;
    for (const std::size_t i : wanting_time()) {
      ChartPoint& point = result_.data.points[i];
      if (stopped() || point.wall().median > seconds_left()) continue;
      any = true;
      phase("again: " + (point.setting.flags.empty() ? "the scene's own settings" : command_text(point.setting.flags)));
      Warnings same;
      const ChartRender render =
          render_timed(options_.make(point.setting.flags), options_.threads, options_.stop, same);
      if (!render.complete) return any;
      point.cpu_seconds.push_back(render.cpu_seconds);
      point.wall_seconds.push_back(render.wall_seconds);
      if (render.peak_bytes) point.peak_bytes.push_back(static_cast<double>(*render.peak_bytes));
      point.build_seconds = std::min(point.build_seconds, render.build_seconds);
      if (point.picture_hash != hash_of(render.film)) point.repeats = false;
      if (stale_.erase(i) != 0) judge(point, render.film);
      save_now_and_then();
    }
    return any;
  }

  void save_now_and_then() {
    if (!options_.save || seconds_since(saved_) < kSecondsBetweenSaves || !stale_.empty()) return;
    options_.save(result_.data);
    saved_ = Clock::now();
  }

  const ChartOptions& options_;
  const EarlierChart* earlier_;
  Warnings& warnings_;
  DisplayTransform display_;
  Clock::time_point start_ = Clock::now(), saved_ = Clock::now();
  MeasuredChart result_;
  ChartPicture reference_;
  std::set<std::string> keys_;
  double own_rays_ = 0;  ///< of the scene's own settings, by a small picture; 0: stopped
  double own_probe_seconds_ = 0;
  bool small_pictures_pay_ = false;
  std::set<std::size_t> stale_;  ///< points whose errors are against another reference
};

}  // namespace

bool same_subject(const ChartData& a, const ChartData& b) {
  return a.scene_hash == b.scene_hash && a.version == b.version && a.machine == b.machine && a.width == b.width &&
         a.height == b.height && a.threads == b.threads;
}

MeasuredChart measure_chart(const ChartOptions& options, const EarlierChart* earlier, Warnings& warnings) {
  return ChartMeasurement(options, earlier, warnings).run();
}

}  // namespace raytree::benchmarks
