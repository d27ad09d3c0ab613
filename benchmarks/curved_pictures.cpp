// Row curved-pictures: curved surfaces at 1920x1080, from launch to a written file, what Embree holds of them, and that
// no crack is open and no facet shows along their outlines.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>

#include "benchmarks/child_process.h"
#include "benchmarks/crack_rays.h"
#include "benchmarks/curved_picture_scenes.h"
#include "benchmarks/outline_difference.h"
#include "benchmarks/row_bounds.h"
#include "benchmarks/rows.h"
#include "renderer/scene.h"

namespace raytree::benchmarks {
namespace {

constexpr int kThreads = 2;
constexpr int kPicturesTaken = 3;
constexpr double kMillion = 1e6;
constexpr std::size_t kCrackRays = 1'000'000;

Figure figure_of(const CurvedPicture& picture, const std::string& what, double value) {
  Figure figure;
  figure.row = "curved-pictures";
  figure.what = fmt::format("{}: {}", picture.name, what);
  figure.measured = {value, value, value, 1};
  return figure;
}

Figure at_most(Figure figure, double bound) {
  figure.kind = BoundKind::at_most;
  figure.bound = bound;
  return figure;
}

std::uint64_t triangles_of(const Scene& scene) {
  std::uint64_t count = 0;
  for (const ShapeSummary& shape : scene.summary.shapes) count += shape.triangles;
  return count;
}

Figure time_to_picture(const CurvedPicture& picture, const MeasureContext& context) {
  const std::filesystem::path file = context.scratch / "curved.exr", statistics = context.scratch / "curved.json";
  const std::string self = context.programs / "raytree_measure";
  std::vector<std::string> words = {context.programs / "raytree", "render"};
  words.insert(words.end(), picture.words.begin(), picture.words.end());
  for (const std::string& word :
       {std::string("--size"), fmt::format("{}x{}", kCurvedPictureWidth, kCurvedPictureHeight),
        std::string("--threads"), std::to_string(kThreads), std::string("-o"), file.string(), std::string("--stats"),
        statistics.string(), std::string("--quiet"), std::string("--progress"), std::string("none")})
    words.push_back(word);
  std::vector<double> seconds;
  std::uint64_t peak = 0;
  for (int i = 0; i < kPicturesTaken; ++i) {
    const ChildResult child = run_child_apart(self, words, context.scratch);
    require_success(child, "raytree render");
    seconds.push_back(child.wall_seconds);
    peak = std::max(peak, child.peak_bytes);
  }
  Figure figure = figure_of(
      picture,
      fmt::format("launch to EXR, {}x{}, {} threads{}", kCurvedPictureWidth, kCurvedPictureHeight, kThreads,
                  picture.rate > 0 ? fmt::format(", {} segments an edge", picture.rate) : ", default tolerance"),
      0);
  figure.measured = spread_of(std::move(seconds));
  figure.unit = "s";
  std::ifstream written(statistics);
  const nlohmann::json phases = nlohmann::json::parse(written).at("seconds");
  figure.note = fmt::format("{:.2f} s to read and cut, {:.2f} s to build, {:.2f} s to trace; {:.0f} MiB at most",
                            phases.at("load").get<double>(), phases.at("build").get<double>(),
                            phases.at("trace").get<double>(), static_cast<double>(peak) / (1024.0 * 1024.0));
  return figure;
}

/// What is measured on the curved shapes alone.
std::vector<Figure> surface_figures(const CurvedPicture& picture) {
  const bool by_tolerance = picture.rate == 0;
  const double tolerance = TessellationSettings().tolerance;
  PrepareOptions options;
  options.threads = kThreads;
  options.measure_tessellation = by_tolerance;
  Warnings warnings;
  const Scene scene = prepare(curved_shapes_alone(picture.make()), options, warnings);
  SceneDescription finer = curved_shapes_alone(picture.make());
  const double finer_tolerance = tolerance * (by_tolerance ? kFinerTolerance : kFinerToleranceOfMany);
  finer.render.tessellation = {finer_tolerance, 0};
  const Scene limit = prepare(std::move(finer), {}, warnings);
  const std::uint64_t triangles = triangles_of(scene);

  std::vector<Figure> figures;
  Figure size = figure_of(
      picture, fmt::format("Embree's bytes a triangle, {:.2f} M triangles", static_cast<double>(triangles) / kMillion),
      static_cast<double>(scene.intersector->memory_bytes()) / static_cast<double>(triangles));
  size.unit = "B";
  size.note = scene.summary.hierarchy;
  figures.push_back(std::move(size));

  const CrackCount cracks = count_cracks(*scene.shapes, *scene.intersector, scene.camera.position(), kCrackRays);
  const std::int64_t open = open_edges(*scene.shapes);
  Figure slipped = at_most(
      figure_of(picture, fmt::format("rays that slip through shared edges, of {}", cracks.rays), double(cracks.cracks)),
      kMostCracks);
  slipped.note = fmt::format("edges of one triangle alone: {}{}", open,
                             picture.closed ? ", of a closed cage" : ", at its borders");
  if (cracks.rays < kCrackRays / 10) slipped.problem = "too few edges to aim at";
  if (picture.closed && open != 0) slipped.problem = fmt::format("{} open edges in a closed surface", open);
  figures.push_back(std::move(slipped));

  const double bound = outline_bound(tolerance + finer_tolerance);
  const OutlineDifference outline = outline_difference(*scene.intersector, *limit.intersector, scene.camera,
                                                       kCurvedPictureWidth, kCurvedPictureHeight, bound);
  Figure silhouette = at_most(
      figure_of(picture,
                fmt::format("outline: largest difference of a pixel's coverage from that at a tolerance of {:.3f} px",
                            finer_tolerance),
                outline.largest),
      bound);
  silhouette.note = fmt::format(
      "{} pixels along the outline, {:.4f} px off in the mean, {} over the bound; compared with {:.2f} M "
      "triangles",
      outline.pixels, outline.mean, outline.over, static_cast<double>(triangles_of(limit)) / kMillion);
  if (outline.pixels == 0) silhouette.problem = "no outline in the picture";
  figures.push_back(std::move(silhouette));

  if (by_tolerance) {
    double largest = 0;
    for (const ShapeSummary& shape : scene.summary.shapes)
      if (shape.tessellation && shape.tessellation->measured)
        largest = std::max(largest, shape.tessellation->measured->largest.pixels);
    Figure off = at_most(figure_of(picture, "largest distance of a facet from the limit surface", largest), tolerance);
    off.unit = "px";
    off.note = fmt::format("{} points of each triangle", kSamplesPerFacet);
    figures.push_back(std::move(off));
  }
  return figures;
}

}  // namespace

std::vector<Figure> measure_curved_pictures(const MeasureContext& context) {
  std::vector<Figure> figures;
  for (const CurvedPicture& picture : curved_pictures(RAYTREE_TEST_DATA, context.scratch)) {
    context.progress(fmt::format("curved-pictures: {}", picture.name));
    figures.push_back(time_to_picture(picture, context));
    for (Figure& figure : surface_figures(picture)) figures.push_back(std::move(figure));
  }
  return figures;
}

}  // namespace raytree::benchmarks
