// Measures a scene's rays in every configuration asked for, side by side in one process: builds, speeds, ratios, and
// whether the answers are the same.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "benchmarks/bench_configuration.h"
#include "benchmarks/intersection_benchmark.h"
#include "benchmarks/npy_reader.h"

namespace raytree::benchmarks {

/// Rays of one kind and what makes them comparable between tracers: planes are not Embree's, so rays are ended for it
/// where they meet one, outside the clock, as the renderer's tracer ends them inside its own.
struct BenchRays {
  std::string name;       ///< "primary", "edge", "file"
  RaySet rays;            ///< as the renderer's tracer and the naive one get them
  RaySet without_planes;  ///< as bare Embree gets them; empty where the scene has no planes: `rays`
  /// [batch][ray] distance of the plane that ends it, or infinity; empty where the scene has no planes.
  std::vector<std::vector<float>> plane_distance;

  const RaySet& bare() const { return plane_distance.empty() ? rays : without_planes; }
};
inline constexpr const char* kBenchRayNames[] = {"primary", "shadow", "mirror", "refracted", "bounce", "edge", "file"};

/// All kinds of a prepared scene, or those of a file alone, less empty ones; of each no more than `most_batches`.
std::vector<BenchRays> bench_rays(const Scene& scene, std::size_t most_batches, const std::atomic<bool>* stop);
std::vector<BenchRays> bench_rays(const Scene& scene, const std::vector<FileRay>& file);

/// Batches of 1024 rays of each kind where no time is set.
inline constexpr std::size_t kBenchBatches = 32;
/// Batches of each kind that are worth making where so many seconds are set; 0: kBenchBatches.
std::size_t batches_for(double seconds);
/// Rays of each kind for the naive tracer, which takes a thousand times as long.
inline constexpr std::size_t kNaiveRays = 64;

struct BenchRunOptions {
  int threads = 1;
  int repetitions = 9;
  /// Seconds for the whole, shared out: rays become fewer, and what does not fit is left out. 0: as long as it takes
  /// for kBenchBatches of each kind.
  double seconds = 0;
  std::string baseline = kBenchBaseline;
  /// Configurations of every kind of rays, the baseline among them; none: bench_configurations().
  std::vector<BenchConfiguration> configurations;
  NameFilter filter = NameFilter("");
  /// Instruction set that Embree is held to, see BenchSceneOptions::isa; the renderer's tracer, which takes the best,
  /// is then not measured.
  std::string isa;
  bool seam_watertight = true;  ///< PrepareOptions::watertight of the scene: what the seam's answers are held to
  const std::atomic<bool>* stop = nullptr;
};

struct BenchRow {
  std::string rays_name;      ///< kind of rays
  std::string configuration;  ///< name of it
  int threads = 1;
  std::size_t rays = 0;
  std::uint64_t hits = 0, checksum = 0;  ///< of its own answers, whatever the threads
  std::uint64_t differ = 0;  ///< rays whose answer is another than the baseline's: hit or not, or a thousandth farther
  /// Rays that were asked again in double: those that differ (of the baseline, from anything's; and some of its
  /// others), 0 where there was no time for it. And those of them whose answer no rounding of the configuration's
  /// arithmetic makes.
  std::uint64_t checked = 0, wrong = 0;
  std::string wrong_example;  ///< the first of these: origin, direction, what it got, what is true
  bool repeatable = true;     ///< every repetition gave the same checksum
  Spread speed;               ///< million rays a second
  Spread ratio;               ///< speed over the baseline's, repetition by repetition
  std::string beside;         ///< configuration that differs in the scene alone; empty: the baseline, or none
  Spread beside_ratio;
  std::vector<double> samples;  ///< million rays a second, one a repetition

  std::string name() const { return rays_name + "/" + configuration; }
  bool suspicious() const { return wrong > 0 || !repeatable; }
};

struct BenchBuild {
  std::string scene;  ///< scene_name() of configurations
  Spread seconds;
  std::uint64_t bytes = 0, peak_bytes = 0;
  double triangles_per_primitive = 1;
};

struct BenchLeftOut {
  std::string name, reason;
};

struct BenchReport {
  std::string scene;
  int width = 0, height = 0;
  std::uint64_t triangles = 0, others = 0;  ///< that hierarchies hold, those of groups once
  std::uint64_t instances = 0;
  std::string baseline;
  std::vector<BenchBuild> builds;
  std::vector<BenchRow> rows;
  std::vector<BenchLeftOut> left_out;

  std::uint64_t primitives() const { return triangles + others; }
  bool suspicious() const;
};

/// Names of all rows that there are for such a scene, in the order of measuring.
std::vector<std::string> bench_row_names(const Scene& scene, const std::vector<BenchRays>& rays, int threads,
                                         const std::string& isa = {});

/// Rows that the filter takes. Each repetition asks the baseline, then each configuration of one scene; the baseline is
/// asked again beside every scene, so that no more than three are held at once. One more repetition comes first and
/// does not count: answers are compared there. Throws Error (bad_input) where no row is called like the baseline.
BenchReport run_bench(const Scene& scene, const std::vector<BenchRays>& rays, const BenchRunOptions& options);

}  // namespace raytree::benchmarks
