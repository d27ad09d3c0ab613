#include "benchmarks/chart/chart_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "benchmarks/chart/chart_cost.h"
#include "geometry/stopwatch.h"
#include "renderer/adaptive_sampling.h"

namespace raytree::benchmarks {
namespace {

constexpr double kReferenceShare = 0.35;  ///< of the budget that the reference may take at kAssumedRays
constexpr double kFirstShare = 0.5;       ///< of that: of all pixels alike
constexpr std::size_t kRounds = 3;        ///< that share the rest
constexpr int kFinestGrid = 64;           ///< that a render takes
constexpr float kNegligible = 1e-4f;      ///< expected error of a pixel that is traced anew no more
constexpr float kEdgeError = 0.2f;        ///< of a grid of one row, per difference of what an edge parts
constexpr int kFewestGrid = 3, kMostGrid = 24;
constexpr int kTreeDepths[] = {8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256};
constexpr int kDeepTree = kTreeDepths[std::size(kTreeDepths) - 1];
constexpr double kFewRaysPerSample = 30, kManyRaysPerSample = 80;
constexpr int kReferenceRoughSamples = 4;  ///< each of a pixel's many samples has facets of its own
/// Tried one after the other until a deep tree is affordable; what is cut is a bound on the radiance lost.
constexpr double kCutoffs[] = {0, 1e-5, 1e-4, 1e-3};
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

/// Of both halves.
double samples_of(int grid) { return static_cast<double>(grid * grid + (grid + 1) * (grid + 1)); }

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

/// Takes the pixels of `mask` from another film of the same channels.
void take_pixels(Film& into, const Film& from, const std::vector<std::uint8_t>& mask) {
  for (int i = 0; i < kChannelGroupCount; ++i) {
    const auto group = static_cast<ChannelGroup>(i);
    if (!into.channels().has(group) || holds_ids(group)) continue;
    for (std::size_t plane = 0; plane < plane_names(group).size(); ++plane)
      for (std::size_t p = 0; p < mask.size(); ++p)
        if (mask[p] != 0) into.plane(group, static_cast<int>(plane))[p] = from.plane(group, static_cast<int>(plane))[p];
  }
}

Words with_grid(const Words& flags, int grid) {
  return joined_words(flags, {"--antialias", fmt::format("grid:{}", grid)});
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
  TreeDecay decay;
  for (const int depth : kTreeDepths) {
    ChartRender render = probe(branches ? depth : kDeepTree);
    if (!render.complete) return std::nullopt;
    if (deepest) decay.add(plan.depth, depth, rmse_between(*deepest, render.film));
    if (plan.depth > 0 && rays_per_sample(render) > most) {
      plan.residual = decay.beyond_start();
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
  plan.residual = decay.beyond_end();
  return plan;
}

}  // namespace

Words ReferencePlan::last_flags(std::size_t round) const { return with_grid(last, grid_of_round(grid, round) + 1); }

std::vector<float> expected_errors(const Film& a, const Film& b, const std::vector<int>& rows) {
  const int width = a.window().width, height = a.window().height;
  std::vector<float> errors(rows.size());
  const auto color = [&](const Film& film, std::size_t i) {
    const auto at = [&](int c) { return film.plane(ChannelGroup::color, c)[i]; };
    return Rgb(at(0), at(1), at(2));
  };
  const auto distance = [](const Rgb& x, const Rgb& y) {
    const auto largest = [](const Rgb& p, const Rgb& q) {
      return std::max({std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b)});
    };
    return std::max(largest(x, y), largest(display_like(x), display_like(y)));
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      const Rgb own = color(a, i);
      float around = 0;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u)
          around =
              std::max(around, distance(own, color(a, static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                                                          static_cast<std::size_t>(u))));
      errors[i] =
          std::max(distance(own, color(b, i)), kEdgeError * around * std::pow(static_cast<float>(rows[i]), -1.5f));
    }
  return errors;
}

void TreeDecay::add(int from, int to, double change) {
  const int steps = to - from, steps_before = to_ - from_;
  // What is missing at depth d goes like q^d: q from two changes one after the other, whose ratio rises with it.
  if (to_ > 0 && change_ > 0) {
    const auto ratio = [&](double q) {
      return std::pow(q, steps_before) * (1 - std::pow(q, steps)) / (1 - std::pow(q, steps_before));
    };
    double low = 0, high = kSlowestDecay;
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      (ratio(middle) < change / change_ ? low : high) = middle;
    }
    decay_ = high;
  }
  from_ = from, to_ = to, change_ = change;
}

double TreeDecay::beyond_start() const { return to_ > 0 ? change_ / (1 - std::pow(decay_, to_ - from_)) : 0; }

double TreeDecay::beyond_end() const { return beyond_start() * std::pow(decay_, to_ - from_); }

std::vector<std::uint8_t> mask_of_largest(const std::vector<float>& values, std::size_t count, float least) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) { return values[i] > values[k]; });
  std::vector<std::uint8_t> mask(values.size(), 0);
  for (std::size_t i = 0; i < std::min(count, order.size()) && values[order[i]] > least; ++i) mask[order[i]] = 1;
  return mask;
}

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
  const double most =
      std::clamp(rays_allowed / (pixels * samples_of(kFewestGrid)), kFewRaysPerSample, kManyRaysPerSample);
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
  const double samples_allowed = rays_allowed / rays;
  plan.grid =
      std::clamp(static_cast<int>(std::sqrt(kFirstShare * samples_allowed / pixels / 2)), kFewestGrid, kMostGrid);
  // The scene's own grid is to be compared with others.
  const Antialiasing& own = traits.render.antialias;
  while (own.method == Antialiasing::Method::grid && (own.grid_size == plan.grid || own.grid_size == plan.grid + 1))
    ++plan.grid;
  plan.first = flags_of(depth, cutoff, kFacetTolerance);
  plan.last = flags_of(depth, cutoff, kDaintyTolerance);
  std::size_t rounds = kRounds;
  while (rounds > 0 && grid_of_round(plan.grid, rounds) + 1 > kFinestGrid) --rounds;
  for (std::size_t round = 1; round <= rounds; ++round) {
    const double share = (1 - kFirstShare) * samples_allowed / static_cast<double>(rounds);
    plan.refined.push_back(
        static_cast<std::uint64_t>(std::min(pixels, share / samples_of(grid_of_round(plan.grid, round)))));
  }
  plan.words = fmt::format("the mean of two independent pictures of {} and {} samples a pixel", plan.grid * plan.grid,
                           (plan.grid + 1) * (plan.grid + 1));
  const int finest = grid_of_round(plan.grid, rounds);
  if (rounds > 0)
    plan.words += fmt::format(", up to {} and {} where they differ most", finest * finest, (finest + 1) * (finest + 1));
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
  Film first(0, 0, {}, {}), last(0, 0, {}, {});  // the halves
  std::vector<int> rows;                         // of a pixel's grids so far
  ChartReference reference;
  for (std::size_t round = 0; round <= plan.refined.size(); ++round) {
    std::vector<std::uint8_t> mask;
    if (round > 0) mask = mask_of_largest(expected_errors(first, last, rows), plan.refined[round - 1], kNegligible);
    if (round > 0 && std::find(mask.begin(), mask.end(), 1) == mask.end()) break;
    const int grid = grid_of_round(plan.grid, round);
    Warnings same;
    ChartRender coarse =
        render_timed(make(with_grid(plan.first, grid)), threads, stop, round == 0 ? warnings : same, mask);
    if (!coarse.complete) return std::nullopt;
    ChartRender fine = render_timed(make(with_grid(plan.last, grid + 1)), threads, stop, same, mask);
    if (!fine.complete) return std::nullopt;
    Film mean = blended(coarse.film, fine.film, grid * grid, (grid + 1) * (grid + 1));
    if (round == 0) {
      first = std::move(coarse.film), last = std::move(fine.film), reference.film = std::move(mean);
      rows.assign(first.window().width * static_cast<std::size_t>(first.window().height), grid);
    } else {
      take_pixels(first, coarse.film, mask);
      take_pixels(last, fine.film, mask);
      take_pixels(reference.film, mean, mask);
      for (std::size_t i = 0; i < rows.size(); ++i)
        if (mask[i] != 0) rows[i] = grid;
    }
  }
  reference.floor = picture_errors(chart_picture(reference.film, display), chart_picture(first, display));
  reference.floor.rmse = std::hypot(reference.floor.rmse, plan.depth_residual, plan.cutoff);
  reference.seconds = seconds_since(start);
  return reference;
}

}  // namespace raytree::benchmarks
