// What a chart takes for the truth: a picture of the limit surface with a deep tree, nothing or next to nothing cut and
// many samples, made twice over from different samples and facets, so that what is left of its own error is known; with
// more samples where the two differ most.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/chart/chart_render.h"
#include "benchmarks/chart/error_metrics.h"

namespace raytree::benchmarks {

/// How the reference is made. A function of scene, size and budget alone, never of how quick the machine is, so that
/// errors repeat.
struct ReferencePlan {
  int grid = 3;       ///< one half has grid^2 samples a pixel, the other (grid + 1)^2
  Words first, last;  ///< flags of the halves but for their grids: the second's facets are half as large
  /// Of each round after that: how many pixels, those where most error is expected, are traced anew with grids of twice
  /// as many rows and one.
  std::vector<std::uint64_t> refined;
  /// What a tree of any depth would change: RMSE in a small picture, by what the last levels of the tree changed.
  double depth_residual = 0;
  double cutoff = 0;  ///< radiance cut from a sample at most
  std::string words;  ///< what it is, in a sentence
  bool operator==(const ReferencePlan&) const = default;
  /// By how finely it samples.
  bool is_as_fine_as(const ReferencePlan& other) const {
    return grid != other.grid ? grid > other.grid : refined >= other.refined;
  }
  /// Flags of a round's last and finest picture; round 0 is of all pixels.
  Words last_flags(std::size_t round) const;
};

/// What levels of a tree that are not traced would change, by what those before them did: it falls like a power of the
/// depth, as between facing mirrors.
class TreeDecay {
 public:
  static constexpr double kSlowestDecay = 0.99;  ///< a level; where changes do not tell

  /// Change by levels `from` to `to`, each call beginning where the last one ended.
  void add(int from, int to, double change);
  double beyond_start() const;  ///< by all levels from the last call's `from` on
  double beyond_end() const;    ///< by all levels from its `to` on

 private:
  int from_ = 0, to_ = 0;
  double change_ = 0, decay_ = kSlowestDecay;
};

/// Rows of a grid of a round's first half; the other half has one more.
inline int grid_of_round(int grid, std::size_t round) { return ((grid + 1) << round) - 1; }

/// What two pictures from grids of so many rows a pixel leave of the error, pixel by pixel, in linear light or on the
/// display-like scale, whichever is more: by how much they differ; or, since they may agree by chance, by how much the
/// pixels around differ, as the error of a grid's samples on an edge between those goes: by rows^-1.5.
std::vector<float> expected_errors(const Film& a, const Film& b, const std::vector<int>& rows);

/// 1 for the `count` largest that are above `least`, those of the earliest places among equals; 0 for others.
std::vector<std::uint8_t> mask_of_largest(const std::vector<float>& values, std::size_t count, float least);

/// Judges by rays counted in small pictures. None: stopped.
std::optional<ReferencePlan> plan_reference(const ChartSceneMaker& make, const SceneTraits& traits, int width,
                                            int height, double budget_seconds, int threads,
                                            const std::atomic<bool>* stop);

struct ChartReference {
  Film film{0, 0, {}, {}};  ///< mean of the halves, weighted by their samples
  /// Of the coarser half against the mean: somewhat more than the mean's own error, since independent halves lie on
  /// different sides of the truth. What no error of the chart can be told from.
  ErrorMetrics floor;
  double seconds = 0;  ///< wall time it took
};

/// None: stopped.
std::optional<ChartReference> make_reference(const ReferencePlan& plan, const ChartSceneMaker& make,
                                             const DisplayTransform& display, int threads,
                                             const std::atomic<bool>* stop, Warnings& warnings);

}  // namespace raytree::benchmarks
