#include "benchmarks/chart/chart_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "benchmarks/chart/chart_cost.h"
#include "geometry/stopwatch.h"

namespace raytree::benchmarks {
namespace {

constexpr double kReferenceShare = 0.35;  ///< of the budget that the reference may take at kAssumedRays
constexpr int kFewestGrid = 3, kMostGrid = 24;
constexpr int kShallowTree = 8, kDeepTree = 40, kTreeStep = 4;
constexpr double kFewRaysPerSample = 30, kManyRaysPerSample = 80;
constexpr int kReferenceRoughSamples = 4;  ///< each of a pixel's many samples has facets of its own
/// Tried one after the other until a deep tree is affordable; what is cut is a bound on the radiance lost.
constexpr double kCutoffs[] = {0, 1e-5, 1e-4, 1e-3};
/// Of what four more levels change to what the four before did, at most.
constexpr double kMostDepthRatio = 0.9;
constexpr double kFacetTolerance = 0.1, kDaintyTolerance = 0.05;  ///< pixels, of the halves

Words joined_words(const Words& first, const Words& last) {
  Words words = first;
  words.insert(words.end(), last.begin(), last.end());
  return words;
}

Words tree_flags(const SceneTraits& traits, int depth, double cutoff) {
  if (!traits.branches) return {};
  return {"--depth", std::to_string(depth), "--cutoff", fmt::format("{}", cutoff)};
}

double rays_per_sample(const ChartRender& render) {
  return static_cast<double>(render.total_rays()) / static_cast<double>(render.samples);
}

/// Between two films of one size, linear light.
double rmse_between(const Film& a, const Film& b) {
  const auto pixels = static_cast<std::size_t>(a.window().width) * static_cast<std::size_t>(a.window().height);
  double squares = 0;
  for (int c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < pixels; ++i) {
      const double off = static_cast<double>(a.plane(ChannelGroup::color, c)[i]) -
                         static_cast<double>(b.plane(ChannelGroup::color, c)[i]);
      squares += off * off;
    }
  return std::sqrt(squares / (3 * static_cast<double>(pixels)));
}

/// The mean of two planes, weighted.
void blend(float* into, const float* other, std::size_t count, double weight, double other_weight) {
  for (std::size_t i = 0; i < count; ++i)
    into[i] =
        static_cast<float>((weight * static_cast<double>(into[i]) + other_weight * static_cast<double>(other[i])) /
                           (weight + other_weight));
}

/// The mean of two films of the chart's channels. A pixel that only one of them hit keeps that one's distance.
Film blended(Film first, const Film& last, double weight, double last_weight) {
  const auto pixels = static_cast<std::size_t>(first.window().width) * static_cast<std::size_t>(first.window().height);
  for (int c = 0; c < 3; ++c)
    blend(first.plane(ChannelGroup::color, c), last.plane(ChannelGroup::color, c), pixels, weight, last_weight);
  blend(first.plane(ChannelGroup::alpha, 0), last.plane(ChannelGroup::alpha, 0), pixels, weight, last_weight);
  float* distance = first.plane(ChannelGroup::depth, 0);
  const float* last_distance = last.plane(ChannelGroup::depth, 0);
  for (std::size_t i = 0; i < pixels; ++i) {
    if (std::isfinite(distance[i]) && std::isfinite(last_distance[i]))
      blend(distance + i, last_distance + i, 1, weight, last_weight);
    else
      distance[i] = std::min(distance[i], last_distance[i]);
    Vec3d normal(0, 0, 0);
    for (int c = 0; c < 3; ++c)
      normal[c] = weight * static_cast<double>(first.plane(ChannelGroup::normal, c)[i]) +
                  last_weight * static_cast<double>(last.plane(ChannelGroup::normal, c)[i]);
    const double length = normal.length();
    for (int c = 0; c < 3; ++c)
      first.plane(ChannelGroup::normal, c)[i] = static_cast<float>(length > 0 ? normal[c] / length : 0);
  }
  return first;
}

/// How deep a tree is traced, and what that costs and leaves out.
struct TreePlan {
  int depth = kDeepTree;
  double cutoff = 0, rays_per_sample = 0;
  double residual = 0;  ///< RMSE by all further levels
  double error() const { return std::hypot(residual, cutoff); }
};

/// The deepest tree of at most `most` rays a sample, by small pictures of one depth after the other. None: stopped.
template <class Probe>
std::optional<TreePlan> plan_tree(Probe&& probe, double cutoff, double most, bool branches) {
  TreePlan plan{0, cutoff, 0, 0};
  std::optional<Film> deepest;
  std::vector<double> changes;  // of each step
  // Further levels change ever less, by about as much less as those did that were tried.
  const auto ratio = [&] {
    if (changes.size() < 2 || !(changes.front() > 0)) return kMostDepthRatio;
    return std::min(kMostDepthRatio,
                    std::pow(changes.back() / changes.front(), 1.0 / static_cast<double>(changes.size() - 1)));
  };
  for (int depth = branches ? kShallowTree : kDeepTree; depth <= kDeepTree; depth += kTreeStep) {
    ChartRender render = probe(depth);
    if (!render.complete) return std::nullopt;
    if (deepest) changes.push_back(rmse_between(*deepest, render.film));
    if (plan.depth > 0 && rays_per_sample(render) > most) {
      plan.residual = changes.back() / (1 - ratio());
      return plan;
    }
    plan.depth = depth;
    plan.rays_per_sample = rays_per_sample(render);
    deepest = std::move(render.film);
    if (render.branches_at_depth_limit == 0) {  // all that there is
      plan.depth = kDeepTree;
      return plan;
    }
  }
  plan.residual = changes.empty() ? 0 : changes.back() * ratio() / (1 - ratio());
  return plan;
}

}  // namespace

std::optional<ReferencePlan> plan_reference(const ChartSceneMaker& make, const SceneTraits& traits, int width,
                                            int height, double budget_seconds, int threads,
                                            const std::atomic<bool>* stop) {
  const auto flags_of = [&](int depth, double cutoff, double tolerance) {
    Words words = joined_words(reference_surface_flags(traits, tolerance), tree_flags(traits, depth, cutoff));
    if (traits.rough) words.insert(words.end(), {"--rough-samples", std::to_string(kReferenceRoughSamples)});
    return words;
  };
  const double pixels = static_cast<double>(width) * static_cast<double>(height);
  const double rays_allowed = budget_seconds * kReferenceShare * kAssumedRays / ray_cost(make({}).description);
  constexpr int kFewestSamples = kFewestGrid * kFewestGrid + (kFewestGrid + 1) * (kFewestGrid + 1);
  const double most = std::clamp(rays_allowed / (pixels * kFewestSamples), kFewRaysPerSample, kManyRaysPerSample);
  std::optional<TreePlan> tree;
  for (const double cutoff : kCutoffs) {
    const auto probe = [&](int depth) {
      const Words flags = joined_words(flags_of(depth, cutoff, kFacetTolerance), {"--antialias", "grid:2"});
      return small_picture(make(flags), width, height, threads, stop);
    };
    const std::optional<TreePlan> next = plan_tree(probe, cutoff, most, traits.branches);
    if (!next) return std::nullopt;
    if (!tree || next->error() < tree->error()) tree = next;
    if (tree->depth == kDeepTree) break;
  }
  ReferencePlan plan;
  plan.depth_residual = tree->residual;
  plan.cutoff = tree->cutoff;
  const int depth = tree->depth;
  const double cutoff = tree->cutoff, rays = tree->rays_per_sample;
  plan.grid = std::clamp(static_cast<int>(std::sqrt(rays_allowed / (rays * pixels) / 2)), kFewestGrid, kMostGrid);
  // The scene's own grid is to be compared with others.
  const Antialiasing& own = traits.render.antialias;
  while (own.method == Antialiasing::Method::grid && (own.grid_size == plan.grid || own.grid_size == plan.grid + 1))
    ++plan.grid;
  plan.first =
      joined_words(flags_of(depth, cutoff, kFacetTolerance), {"--antialias", fmt::format("grid:{}", plan.grid)});
  plan.last =
      joined_words(flags_of(depth, cutoff, kDaintyTolerance), {"--antialias", fmt::format("grid:{}", plan.grid + 1)});
  plan.words = fmt::format("the mean of two independent pictures of {} and {} samples a pixel", plan.grid * plan.grid,
                           (plan.grid + 1) * (plan.grid + 1));
  if (traits.branches) {
    plan.words += fmt::format(", trees of up to {} levels", depth);
    if (plan.depth_residual > 0)
      plan.words += fmt::format(" (deeper ones would change it by an RMSE of about {:.1g})", plan.depth_residual);
    plan.words +=
        cutoff > 0 ? fmt::format(", no more than {:g} of radiance cut from a sample", cutoff) : ", nothing cut";
  }
  if (traits.curved)
    plan.words +=
        fmt::format(", facets within {} and {} pixels of the limit surface", kFacetTolerance, kDaintyTolerance);
  if (!traits.sided_shapes.empty()) plan.words += ", round shapes exact";
  if (traits.facets) plan.words += ", normals of the limit surface";
  if (traits.rough) plan.words += fmt::format(", {} facets a rough hit", kReferenceRoughSamples);
  return plan;
}

std::optional<ChartReference> make_reference(const ReferencePlan& plan, const ChartSceneMaker& make,
                                             const DisplayTransform& display, int threads,
                                             const std::atomic<bool>* stop, Warnings& warnings) {
  const Clock::time_point start = Clock::now();
  ChartRender first = render_timed(make(plan.first), threads, stop, warnings);
  if (!first.complete) return std::nullopt;
  Warnings same;
  const ChartRender last = render_timed(make(plan.last), threads, stop, same);
  if (!last.complete) return std::nullopt;
  ChartReference reference;
  const ChartPicture coarse = chart_picture(first.film, display);
  reference.film = blended(std::move(first.film), last.film, plan.grid * plan.grid, (plan.grid + 1) * (plan.grid + 1));
  reference.floor = picture_errors(chart_picture(reference.film, display), coarse);
  reference.floor.rmse = std::hypot(reference.floor.rmse, plan.depth_residual, plan.cutoff);
  reference.seconds = seconds_since(start);
  return reference;
}

}  // namespace raytree::benchmarks
