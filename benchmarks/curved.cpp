// Row curved: points a second of every kind of surface, what finding the rates of a view costs beside making the
// triangles, and what Embree makes of a surface as triangles, quads or grids.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <cmath>
#include <random>

#include "benchmarks/bumpy_torus.h"
#include "benchmarks/row_bounds.h"
#include "benchmarks/rows.h"
#include "geometry/embree_kinds.h"
#include "geometry/patch_surface.h"
#include "geometry/polygon_mesh.h"
#include "geometry/stopwatch.h"
#include "geometry/subdivision_surface.h"
#include "geometry/tessellation.h"
#include "geometry/tessellation_rates.h"

namespace raytree::benchmarks {
namespace {

using Surface = std::unique_ptr<ParametricSurface>;

constexpr int kRepetitionsOfSurfaces = 5;
constexpr int kRepetitionsOfKinds = 3;  // each builds a million triangles twice
constexpr double kMillion = 1e6;

double seconds_of(const std::function<void()>& work) {
  const auto start = Clock::now();
  work();
  return seconds_since(start);
}

Surface cage_surface(const PolygonMesh& mesh) {
  Warnings warnings;
  return make_subdivision_surface(mesh, {}, {}, warnings);
}

/// Patches over the torus, 50 x 50.
template <class MakePatch>
Surface patch_surface(const MakePatch& make_patch) {
  constexpr int kPatches = 50;
  std::vector<SurfacePatch> patches;
  for (int i = 0; i < kPatches; ++i)
    for (int j = 0; j < kPatches; ++j)
      patches.emplace_back(make_patch(
          [=](int u, int v) { return Vec3d(on_bumpy_torus((i + u / 3.0) / kPatches, (j + v / 3.0) / kPatches)); }));
  Warnings warnings;
  return std::make_unique<PatchSurface>(std::move(patches), PatchSurfaceOptions(), SourceLocation(), warnings);
}

template <class PointAt>
BezierPatch bezier_through(const PointAt& point) {
  BezierPatch patch;
  for (int v = 0; v < 4; ++v)
    for (int u = 0; u < 4; ++u) patch.points[static_cast<std::size_t>(4 * v + u)] = point(u, v);
  return patch;
}

struct Kind {
  const char* name;
  std::function<Surface()> make;
  int rate;
  double least;           ///< 0: no bound
  const char* reference;  ///< what OpenSubdiv's own evaluation was measured at before, on the same machine
};

Figure points_figure(const Kind& kind) {
  Surface surface;
  const double set_up = seconds_of([&] { surface = kind.make(); });
  std::size_t points = 0;
  std::vector<double> rates;
  for (int i = 0; i <= kRepetitionsOfSurfaces; ++i) {
    const double seconds = seconds_of([&] { points = tessellate_uniformly(*surface, kind.rate).positions.size(); });
    if (i > 0) rates.push_back(static_cast<double>(points) / kMillion / seconds);  // the first one warms up
  }
  Figure figure;
  figure.row = "curved";
  figure.what = fmt::format("limit points with normals a second, {}, {} faces, {} points as triangles, 1 thread",
                            kind.name, surface->face_count(), points);
  figure.unit = "M/s";
  figure.measured = spread_of(std::move(rates));
  if (kind.least > 0) figure.kind = BoundKind::at_least, figure.bound = kind.least;
  figure.note = fmt::format("{:.3f} s before, to make the surface{}", set_up, kind.reference);
  return figure;
}

Figure rates_figure(const char* name, const PolygonMesh& cage, double distance) {
  const Surface surface = cage_surface(cage);
  std::size_t triangles = 0;
  ViewRates found;
  const auto find = [&] { return seconds_of([&] { found = rates_for_distance(*surface, distance); }); };
  const auto make = [&] { return seconds_of([&] { triangles = tessellate(*surface, found.rates).triangle_count(); }); };
  PairLimits limits;
  limits.least = 3, limits.most = kRepetitionsOfSurfaces;
  const PairedSpread pairs = measure_pairs(find, make, limits);
  Figure figure;
  figure.row = "curved";
  figure.what = fmt::format("finding the rates of a view / making its {} triangles, {}, 1 thread", triangles, name);
  figure.measured = pairs.ratio;
  figure.note = fmt::format("{:.3f} s to find, {:.3f} s to make", pairs.a.median, pairs.b.median);
  return figure;
}

SurfaceGrid torus_grid(std::size_t quads) {
  SurfaceGrid grid;
  grid.columns = grid.rows = quads + 1;
  for (std::size_t j = 0; j <= quads; ++j)
    for (std::size_t i = 0; i <= quads; ++i)
      grid.points.push_back(on_bumpy_torus(double(i) / double(quads), double(j) / double(quads)));
  return grid;
}

/// Eye rays in blocks of 4 x 2, and rays between random points about the torus.
std::vector<BareRay> eye_rays(int width, int height) {
  std::vector<BareRay> rays;
  const Vec3d eye(0, 7, 8), forward = (Vec3d(0, 0, 0) - eye).normalized(), right(1, 0, 0), up = right.cross(forward);
  for (int y = 0; y < height; y += 2)
    for (int x = 0; x < width; x += 4)
      for (int k = 0; k < 8; ++k) {
        const double u = (x + k % 4 + 0.5) / width - 0.5, v = (y + k / 4 + 0.5) / height - 0.5;
        rays.push_back({Vec3f(eye), Vec3f((forward + right * u - up * (v * height / width)).normalized())});
      }
  return rays;
}
std::vector<BareRay> random_rays(std::size_t count) {
  std::mt19937 random(1980);
  std::uniform_real_distribution<double> place(-1, 1);
  std::vector<BareRay> rays;
  while (rays.size() < count) {
    const Vec3d a(4 * place(random), place(random), 4 * place(random)),
        b(4 * place(random), place(random), 4 * place(random));
    rays.push_back({Vec3f(a), Vec3f((b - a).normalized())});
  }
  return rays;
}

/// Bytes a triangle of each kind, and the time to a picture of its own that each takes beside triangles.
std::vector<Figure> kind_figures(std::size_t quads, int width, int height) {
  const SurfaceGrid grid = torus_grid(quads);
  const std::vector<BareRay> coherent = eye_rays(width, height), incoherent = random_rays(coherent.size() / 2);
  const auto run = [&](EmbreeKind kind) { return measure_kind(kind, grid, coherent, incoherent); };
  std::vector<Figure> figures;
  const auto triangles = static_cast<double>(grid.triangle_count());
  for (int k = 0; k < kEmbreeKindCount; ++k) {
    const auto kind = static_cast<EmbreeKind>(k);
    std::vector<double> bytes, picture, tracing, build;
    bool same_hits = true;
    for (int i = 0; i < kRepetitionsOfKinds; ++i) {
      const EmbreeKindFigures reference = run(EmbreeKind::triangles), figure = run(kind);
      const auto trace = [](const EmbreeKindFigures& f) { return f.packet_seconds + f.single_seconds; };
      bytes.push_back(figure.bytes / triangles);
      build.push_back(figure.build_seconds);
      tracing.push_back(trace(reference) / trace(figure));
      picture.push_back((reference.build_seconds + trace(reference)) / (figure.build_seconds + trace(figure)));
      const double differ = std::abs(static_cast<double>(reference.hits) - static_cast<double>(figure.hits));
      same_hits = same_hits && differ <= 1e-4 * static_cast<double>(reference.hits);
    }
    Figure size;
    size.row = "curved";
    size.what =
        fmt::format("Embree's bytes a triangle, as {}, {:.1f} M triangles", name_of(kind), triangles / kMillion);
    size.unit = "B";
    size.measured = spread_of(std::move(bytes));
    Figure time;
    time.row = "curved";
    time.what =
        fmt::format("time to picture as triangles / as {}, {:.1f} M triangles, {} eye and {} random rays, 1 thread",
                    name_of(kind), triangles / kMillion, coherent.size(), incoherent.size());
    time.measured = spread_of(std::move(picture));
    time.note = fmt::format("built in {:.2f} s, traced at {:.2f} of triangles' speed",
                            spread_of(std::move(build)).median, spread_of(std::move(tracing)).median);
    if (!same_hits) time.problem = "other hits than triangles have";
    figures.push_back(std::move(size));
    figures.push_back(std::move(time));
  }
  return figures;
}

std::vector<Figure> measure_all(const MeasureContext& context) {
  constexpr const char* kRegularBefore = "; OpenSubdiv alone: 6-8 M/s by Bfr";
  constexpr const char* kIrregularBefore = "; OpenSubdiv alone: 4.4 M/s by Bfr";
  const Kind kinds[] = {
      {"a regular cage", [] { return cage_surface(bumpy_torus_cage(100, 100, false, false)); }, 10, kLeastRegularSpeed,
       kRegularBefore},
      {"a regular cage with texture", [] { return cage_surface(bumpy_torus_cage(100, 100, false, true)); }, 10, 0, ""},
      {"a cage with irregular vertices at each face", [] { return cage_surface(irregular_torus_cage(false)); }, 10,
       kLeastIrregularSpeed, kIrregularBefore},
      {"the same with texture", [] { return cage_surface(irregular_torus_cage(true)); }, 10, 0, ""},
      {"Bezier patches", [] { return patch_surface([](const auto& point) { return bezier_through(point); }); }, 20, 0,
       ""},
      {"Coons patches",
       [] {
         return patch_surface([](const auto& point) {
           CoonsPatch patch;
           for (int k = 0; k < 4; ++k) {
             const auto i = static_cast<std::size_t>(k);
             patch.bottom.points[i] = point(k, 0), patch.top.points[i] = point(k, 3);
             patch.left.points[i] = point(0, k), patch.right.points[i] = point(3, k);
           }
           return patch;
         });
       },
       20, 0, ""},
  };
  std::vector<Figure> figures;
  for (const Kind& kind : kinds) {
    context.progress(fmt::format("curved: {}", kind.name));
    figures.push_back(points_figure(kind));
  }
  context.progress("curved: rates of a view");
  figures.push_back(rates_figure("a regular cage", bumpy_torus_cage(100, 100, false, false), 2e-4));
  figures.push_back(rates_figure("a cage with irregular vertices at each face", irregular_torus_cage(false), 2e-4));
  context.progress("curved: triangles, quads, grids");
  for (Figure& figure : kind_figures(704, 1280, 960)) figures.push_back(std::move(figure));
  return figures;
}

}  // namespace

std::vector<Figure> measure_curved(const MeasureContext& context) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  tbb::task_arena arena(1);
  return arena.execute([&] { return measure_all(context); });
}

}  // namespace raytree::benchmarks
