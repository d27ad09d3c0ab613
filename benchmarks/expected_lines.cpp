#include "benchmarks/expected_lines.h"

#include <cmath>
#include <limits>

#include "benchmarks/naive.h"
#include "benchmarks/outline_difference.h"
#include "benchmarks/row_bounds.h"
#include "renderer/scene_description.h"
#include "renderer/spd_counts.h"

namespace raytree::benchmarks {
namespace {

constexpr double kAnyInterval = std::numeric_limits<double>::quiet_NaN();

Figure line(const char* row, const char* what, const char* unit = "") {
  Figure figure;
  figure.row = row, figure.what = what, figure.unit = unit;
  return figure;
}
Figure at_least(double bound, const char* row, const char* what, const char* unit = "") {
  Figure figure = line(row, what, unit);
  figure.kind = BoundKind::at_least, figure.bound = bound;
  return figure;
}
Figure at_most(double bound, const char* row, const char* what, const char* unit = "") {
  Figure figure = line(row, what, unit);
  figure.kind = BoundKind::at_most, figure.bound = bound;
  return figure;
}
Figure floor_line(const char* what) {
  Figure figure = at_least(kLeastFloor, "floor", what);
  figure.chase = kChasedFloor;
  return figure;
}
/// The intervals are known ratios, which embree_ratios.cpp lists with the rays they are of.
Figure ratios_line(const char* what) {
  Figure figure = line("ratios", what);
  figure.kind = BoundKind::within, figure.bound = figure.upper = kAnyInterval, figure.noise = kBetweenMachines;
  return figure;
}

/// What the outline of a surface cut to the default tolerance may differ by from that of a finer one.
double most_outline(double finer) { return outline_bound(TessellationSettings().tolerance * (1 + finer)); }

std::vector<Figure> made_lines() {
  return {
      floor_line("bare Embree calls / tracing phase, spheres-1980, 1280x960, 1 thread"),
      floor_line("bare Embree calls / tracing phase, spheres-1980, 1280x960, 2 threads"),
      floor_line("bare Embree calls / tracing phase, spheres-1980 with a terrain of 1M triangles, 1280x960, 1 thread"),
      floor_line("bare Embree calls / tracing phase, spheres-1980 with a terrain of 1M triangles, 1280x960, 2 threads"),
      at_least(kLeastWaves, "waves", "single-ray recursion / generations, spheres-1980, *, 1 thread"),
      at_least(kLeastWavesOfTwo, "waves", "single-ray recursion / generations, spheres-1980, *, 2 threads"),
      at_least(kLeastWaves, "waves", "single-ray recursion / generations, spheres-1980 with a terrain *, 1 thread"),
      at_least(kLeastWavesOfTwo, "waves",
               "single-ray recursion / generations, spheres-1980 with a terrain *, 2 threads"),
      at_least(kLeastThreads, "threads", "one thread's time / two threads', spheres-1980, *"),
      at_least(kLeastThreads, "threads", "one thread's time / two threads', spheres-1980 with a terrain *"),
      at_most(1000 * kMostFirstRaySeconds, "start", "launch to the first ray, one sphere, *", "ms"),
      at_most(kMostFileRatio, "start", "launch to a written PNG / loading OpenImageIO alone, one sphere, *"),
      at_most(kMostLargeTime, "large",
              "launch to EXR / *, terrain of *; the renderer's kind, grids / Embree's of triangles"),
      at_most(kMostLargeTime, "large", "launch to EXR / *, terrain of *; both as quads"),
      line("large", "launch to EXR / *, terrain of *; both as grids"),
      at_most(kMostLargeMemory, "large", "the renderer's kind: peak memory, less film and 160 MiB, / *"),
      at_most(kMostIdlePercent, "idle", "all features that a scene does not use together, *", "%"),
      line("idle", "the same, of Raytree's own code alone, without Embree's", "%"),
      line("split", "overhead (Whitted 1980: 13 %), spheres-1980, 1 thread", "%"),
      line("split", "intersection (Whitted 1980: 75 %), spheres-1980, 1 thread", "%"),
      line("split", "shading (Whitted 1980: 12 %), spheres-1980, 1 thread", "%"),
      line("split", "overhead (Whitted 1980: 13 %), spheres-1980 with a terrain *, 1 thread", "%"),
      line("split", "intersection (Whitted 1980: 75 %), spheres-1980 with a terrain *, 1 thread", "%"),
      line("split", "shading (Whitted 1980: 12 %), spheres-1980 with a terrain *, 1 thread", "%"),
      at_least(kLeastPlySpeed, "loading", "reading PLY binary, little-endian, 1M triangles", "MB/s"),
      at_most(kMostLoadingMemory, "loading", "reading PLY binary, little-endian, *: peak memory / arrays kept"),
      at_least(kLeastPlySpeed, "loading", "reading PLY binary, big-endian, 1M triangles", "MB/s"),
      at_most(kMostLoadingMemory, "loading", "reading PLY binary, big-endian, *: peak memory / arrays kept"),
      line("loading", "reading PLY ascii, 1M triangles", "MB/s"),
      at_most(kMostLoadingMemory, "loading", "reading PLY ascii, *: peak memory / arrays kept"),
      at_least(kLeastObjSpeed, "loading", "reading OBJ, 1M triangles", "MB/s"),
      at_most(kMostLoadingMemory, "loading", "reading OBJ, *: peak memory / arrays kept"),
      at_least(kLeastBenchShare, "bench", "bare Embree calls / raytree bench, * primary rays, *"),
      at_least(kLeastBenchShare, "bench", "bare Embree calls / raytree bench, * shadow rays, *"),
      at_least(kLeastBenchShare, "bench", "bare Embree calls / raytree bench, * mirror rays, *"),
      at_least(kLeastBenchShare, "bench", "bare Embree calls / raytree bench, * refracted rays, *"),
      at_least(kLeastBenchShare, "bench", "bare Embree calls / raytree bench, * bounce rays, *"),
      ratios_line("primary, * / *, *"),
      ratios_line("shadow, * / *, *"),
      ratios_line("mirror, * / *, *"),
      ratios_line("refracted, * / *, *"),
      ratios_line("bounce, * / *, *"),
      ratios_line("edge, * / *, *"),
      line("ratios", "primary, a ray of * more than of *, *", "ns"),
      at_most(kMostInstancesGibibytes, "instances",
              "peak memory of preparing * instances of a mesh of a million triangles, *", "GiB"),
      at_most(kMostOverBare, "instances", "the seam / bare Embree calls, * primary rays at 10,000 instances, *"),
      at_most(kMostOverBare, "instances", "the seam / bare Embree calls, * shadow rays at 10,000 instances, *"),
      at_most(kMostOverBare, "instances", "the seam / bare Embree calls, * bounce rays at 10,000 instances, *"),
      line("instances", "packets followed together / apart, * at 9 instances, 1 thread; the renderer takes the first"),
      line("instances",
           "packets followed together / apart, * at 100 instances, 1 thread; the renderer takes the second"),
      line("instances",
           "packets followed together / apart, * at 900 instances, 1 thread; the renderer takes the second"),
      at_least(kLeastTypesShare, "types", "triangles alone / with spheres, time of the same * primary rays, *"),
      at_least(kLeastTypesShare, "types", "triangles alone / with spheres, time of the same * shadow rays, *"),
      at_least(kLeastTypesShare, "types", "triangles alone / with spheres, time of the same * mirror rays, *"),
      at_least(kLeastTypesShare, "types", "triangles alone / with spheres, time of the same * refracted rays, *"),
      at_least(kLeastTypesShare, "types", "triangles alone / with spheres, time of the same * bounce rays, *"),
      line("types", "a hierarchy of the spheres' own / testing them one by one, *, 2 spheres beside *"),
      line("types", "a hierarchy of the spheres' own / testing them one by one, *, 8 spheres beside *"),
      line("types", "a hierarchy of the spheres' own / testing them one by one, *, 16 spheres beside *"),
      line("types", "a hierarchy of the spheres' own / testing them one by one, *, 32 spheres beside *"),
      at_least(kLeastRegularSpeed, "curved", "limit points with normals a second, a regular cage, *", "M/s"),
      line("curved", "limit points with normals a second, a regular cage with texture, *", "M/s"),
      at_least(kLeastIrregularSpeed, "curved",
               "limit points with normals a second, a cage with irregular vertices at each face, *", "M/s"),
      line("curved", "limit points with normals a second, the same with texture, *", "M/s"),
      line("curved", "limit points with normals a second, Bezier patches, *", "M/s"),
      line("curved", "limit points with normals a second, Coons patches, *", "M/s"),
      line("curved", "finding the rates of a view / making its * triangles, a regular cage, 1 thread"),
      line("curved",
           "finding the rates of a view / making its * triangles, a cage with irregular vertices *, 1 thread"),
      line("curved", "Embree's bytes a triangle, as *, * M triangles", "B"),
      line("curved", "time to picture as triangles / as *, * M triangles, * eye and * random rays, 1 thread"),
      line("curved-pictures", "*: launch to EXR, 1920x1080, 2 threads, default tolerance", "s"),
      line("curved-pictures", "*: launch to EXR, 1920x1080, 2 threads, * segments an edge", "s"),
      line("curved-pictures", "*: Embree's bytes a triangle, * M triangles", "B"),
      at_most(kMostCracks, "curved-pictures", "*: rays that slip through shared edges, of *"),
      at_most(most_outline(kFinerTolerance), "curved-pictures",
              "*: outline: largest difference of a pixel's coverage *"),
      at_most(most_outline(kFinerToleranceOfMany), "curved-pictures",
              "*: outline: largest difference of a pixel's coverage *"),
      at_most(TessellationSettings().tolerance, "curved-pictures",
              "*: largest distance of a facet from the limit surface", "px"),
      at_least(kLeastPovrayTrace, "povray", "POV-Ray's tracing time / ours, no anti-aliasing, spheres-1980, *"),
      at_least(kLeastPovrayRay, "povray", "the same a ray, spheres-1980, *"),
      at_most(kMostPovrayDiffering, "povray",
              "pixels away from edges where POV-Ray sees another distance, *, spheres-1980, *", "%"),
      at_least(kLeastPovrayAdaptive, "povray",
               "POV-Ray's tracing time (+A0.3 +AM2 +R3) / ours, adaptive, *, spheres-1980, *"),
      at_least(kLeastPovrayTrace, "povray",
               "POV-Ray's tracing time / ours, no anti-aliasing, spheres-1980 with a terrain *"),
      at_least(kLeastPovrayRay, "povray", "the same a ray, spheres-1980 with a terrain *"),
      at_most(kMostPovrayDiffering, "povray",
              "pixels away from edges where POV-Ray sees another distance, *, spheres-1980 with a terrain *", "%"),
      at_least(kLeastPovrayLaunch, "povray", "POV-Ray's time from launch to PNG / ours, spheres-1980 with a terrain *"),
      at_least(kLeastPovrayAdaptive, "povray",
               "POV-Ray's tracing time (+A0.3 +AM2 +R3) / ours, adaptive, *, spheres-1980 with a terrain *"),
      at_most(kMostMaskDiffering, "povray-masks", "pixels away from edges that POV-Ray sees otherwise, spheres-1980, *",
              "%"),
      at_most(kMostMaskDiffering, "povray-masks",
              "pixels away from edges that POV-Ray sees otherwise, spheres-1980 with a terrain *", "%"),
      at_most(kMostMaskDiffering, "povray-masks",
              "pixels away from edges that POV-Ray sees otherwise, cones, cylinders and discs, *", "%"),
      at_most(kMostMaskDiffering, "povray-masks", "pixels away from edges that POV-Ray sees otherwise, spd-gears:*",
              "%"),
      at_most(kMostMaskDiffering, "povray-masks", "pixels away from edges that POV-Ray sees otherwise, spd-rings:*",
              "%"),
      at_most(100 * kSpdTolerance, "spd", "balls: largest difference of its counts from the published ones", "%"),
      at_most(100 * kSpdTolerance, "spd", "gears: largest difference of its counts from the published ones", "%"),
      at_most(100 * kSpdTolerance, "spd", "mount: largest difference of its counts from the published ones", "%"),
      at_most(100 * kSpdTolerance, "spd", "rings: largest difference of its counts from the published ones", "%"),
      at_most(100 * kSpdTolerance, "spd", "teapot: largest difference of its counts from the published ones", "%"),
      at_most(100 * kSpdTolerance, "spd", "tetra: largest difference of its counts from the published ones", "%"),
      at_most(100 * kSpdTolerance, "spd", "tree: largest difference of its counts from the published ones", "%"),
      line("naive", "time of bounding spheres tried one by one / Embree's, * objects), *, 1 thread"),
      line("naive", "time of bounding spheres in a hierarchy / Embree's, * objects), *, 1 thread"),
      line("naive", "share of intersection in the time of bounding spheres tried one by one, spheres-1980 *", "%"),
      line("naive", "share of intersection in the time of bounding spheres tried one by one, whitted-fig*", "%"),
      at_least(kSimpleShare, "naive", "share of intersection *, sphere-flake of * objects)", "%"),
      at_least(kSimpleShare, "naive", "share of intersection *, terrain of * objects)", "%"),
      at_least(kComplexShare, "naive", "share of intersection *, sphere-flake of * objects)", "%"),
      at_least(kComplexShare, "naive", "share of intersection *, terrain of * objects)", "%"),
      at_least(kComplexShare, "naive", "share of intersection *, spd-*, standard render * objects)", "%"),
  };
}

}  // namespace

const std::vector<Figure>& expected_lines() {
  static const std::vector<Figure> lines = made_lines();
  return lines;
}

bool takes_any_interval(const Figure& expected) {
  return expected.kind == BoundKind::within && std::isnan(expected.bound);
}

}  // namespace raytree::benchmarks
