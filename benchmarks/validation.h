// `raytree validate`: every ray of a picture, asked of the fast tracer and of the truth, and the picture by either.
// Tiles over threads; what is kept of a tile is its counts and a few examples. The report depends on the scene and the
// options alone, but for what it says of speed.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "benchmarks/tree_comparison.h"
#include "renderer/image_file.h"
#include "renderer/scene.h"

namespace raytree::benchmarks {

struct ValidationOptions {
  std::uint64_t pixels = 0;  ///< whose trees are compared, picked by a hash of their place; 0: all
  FacetTolerance tolerance;  ///< where the truth is not the fast tracer's triangles
  const std::atomic<bool>* stop = nullptr;
  std::function<void(std::uint64_t done, std::uint64_t total)> on_tile;  ///< from any thread, one at a time
};

/// Of the rays of one kind.
struct ValidationCounts {
  std::uint64_t rays = 0;
  std::array<std::uint64_t, kRayVerdictCount> verdicts{};
  double largest_ulps = 0;  ///< between two distances to one surface
};

/// A ray that is disagreed upon. `raytree ray` asks it again.
struct ValidationExample {
  RayKind kind = RayKind::primary;
  int x = 0, y = 0;   ///< pixel
  bool alone = true;  ///< the fast tracer says the same of the ray without its packet
  TreeRay ray;
};
inline constexpr std::size_t kMostExamples = 3;  ///< of a verdict

struct ValidationReport {
  std::string scene;
  std::string truth_name;     ///< what was compared with, by its name on the command line
  std::string planted_fault;  ///< in the fast tracer; empty: none
  int width = 0, height = 0;
  std::array<ValidationCounts, kRayKindCount> kinds;
  std::vector<ValidationExample> examples;  ///< by verdict, then in the order of tiles
  double largest_edge_error = 0;            ///< bound that excused an `edge`, scene units
  double largest_distance_error = 0;        ///< bound that excused a `coplanar` or `self`

  std::uint64_t pixels = 0;              ///< compared
  std::uint64_t classified_pixels = 0;   ///< with a ray that is disagreed upon in their trees
  std::uint64_t diverged_rays = 0;       ///< of the truth's trees that have no like in the fast tracer's
  std::uint64_t differing_pixels = 0;    ///< not classified, yet off by more than kMostPixelDifference
  double largest_difference = 0;         ///< of pixels not classified, display-like
  int differing_x = 0, differing_y = 0;  ///< the first of the differing pixels
  TracerSpeed fast, truth;
  bool complete = true;  ///< false: stopped

  static constexpr std::uint8_t kNotCompared = 255;
  std::vector<std::uint8_t> verdicts;  ///< [height][width] RayVerdict of the pixel, or kNotCompared
  std::vector<float> gray;             ///< [height][width] the fast tracer's picture, display-like

  ValidationCounts all() const;
  std::uint64_t count(RayVerdict verdict) const { return all().verdicts[static_cast<int>(verdict)]; }
  bool holds() const { return count(RayVerdict::defect) == 0 && differing_pixels == 0; }
};

inline constexpr double kMostPixelDifference = 1.0 / 255;

/// Compares the scene's intersector, which is over `scene.shapes`, with a truth that is over `truth_shapes` (the same
/// shapes, unless faults are planted), one sample at each pixel's center. The scene's intersector is another one while
/// it runs.
ValidationReport validate(Scene& scene, const ShapeSet& truth_shapes, const ReferenceTracer& truth,
                          const ValidationOptions& options);

/// What the report says, for people; `rays` by kind, verdict by verdict, examples as arguments of `raytree ray`.
std::string report_text(const ValidationReport& report);
std::string report_json(const ValidationReport& report);

/// Markdown: the head, and the line of one report.
std::string validation_table_head();
std::string validation_table_line(const ValidationReport& report);

/// The picture in gray with the disagreements in the colors of their classes. `planes` holds the pixels.
Image marked_image(const ValidationReport& report, std::array<std::vector<std::uint8_t>, 3>& planes);

/// A float as shortest text that reads back as the same float.
std::string exact(float value);
std::string exact(const Vec3f& value);

}  // namespace raytree::benchmarks
