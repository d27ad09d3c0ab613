// Faults of interpolated normals that have remedies, on and off: mirrored rays that lead below their facet, false
// shadows where light grazes, light from behind (rows 17 to 19).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "benchmarks/stability/case_tools.h"
#include "benchmarks/stability/facet_cases.h"
#include "benchmarks/stability/faceted_scenes.h"
#include "geometry/angle.h"
#include "renderer/facet_shading.h"

namespace raytree::benchmarks::facets {
namespace {

/// What a mirror sphere's eye rays do.
struct MirroredRays {
  int hits = 0, below = 0;  ///< `below`: mirrored to below their facet
  double share() const { return double(below) / hits; }
};

SceneDescription mirror_sphere(int sides, FacetReflections reflections, ShadingMethod method, int size) {
  SceneDescription scene = headlit_scene(faceted_sphere(sides, sides / 2, method), size, size, 2.1);
  scene.materials[0].diffuse = Rgb(0);
  scene.materials[0].reflection = Rgb(1);
  scene.render.facets.reflections = reflections;
  return scene;
}

MirroredRays mirrored_rays(int sides, FacetReflections reflections, ShadingMethod method, const StabilityRun& run) {
  const int size = run.effort < 0.5 ? 200 : 400;
  const Scene scene = prepared_for(run, mirror_sphere(sides, reflections, method, size));
  FacetShading facets(scene);
  const auto width = static_cast<std::size_t>(size);
  RayBatch rays(width);
  HitBatch hits(width);
  MirroredRays result;
  for (int y = 0; y < size; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      Vec3f origin, direction;
      scene.camera.ray(float(x) + 0.5f, float(y) + 0.5f, origin, direction);
      rays.set(x, origin, direction, std::numeric_limits<float>::infinity());
    }
    rays.size = width;
    scene.intersector->intersect(rays, Coherence::coherent, hits);
    facets.begin_batch();
    std::size_t p = 0;
    for (std::size_t x = 0; x < width; ++x) {
      if (hits.geometry[x] == kNoGeometry) continue;
      const Vec3f direction = rays.direction(x);
      SurfacePoint surface = surface_at(*scene.shapes, rays.origin(x), direction, hits[x], false);
      facets.add(p, hits[x], direction, true, surface);
      ShadingPoint point = shading_point(surface, direction, scene.materials[0]);
      facets.bend(p++, point);
      ++result.hits;
      // A single precision direction along the facet.
      result.below += branches(point).reflected.dot(point.surface.geometric_normal) < -1e-6f;
    }
  }
  return result;
}

StabilityResult mirrored_below(const StabilityRun& run) {
  StabilityResult result;
  for (const int sides : {16, 64}) {
    const double bound = std::pow(std::sin(2 * kPi / sides), 2);
    const std::string quantity = fmt::format("share of mirrored rays below their facet, {} sides", sides);
    const MirroredRays classic = mirrored_rays(sides, FacetReflections::classic, ShadingMethod::phong, run);
    result.figures.push_back({"Phong's normals, followed", quantity, classic.share(), 1.0 / classic.hits, bound,
                              fmt::format("some, at most sin^2(2 pi / k) = {:.3g}", bound),
                              StabilityExpectation::fails_as_known});
    for (const auto& [name, reflections, method] :
         {std::tuple("clamped (default)", FacetReflections::clamped, ShadingMethod::phong),
          {"consistent normals", FacetReflections::consistent, ShadingMethod::phong},
          {"consistent normals, limit", FacetReflections::consistent, ShadingMethod::limit}})
      result.figures.push_back({name, quantity, mirrored_rays(sides, reflections, method, run).share(), 0, 0,
                                "0 (Reshetov, Soupikov and Mark 2010)", StabilityExpectation::holds});
  }
  for (const auto& [caption, reflections] : {std::pair("followed: the rim shows the inside", FacetReflections::classic),
                                             {"consistent normals", FacetReflections::consistent}}) {
    SceneDescription scene = mirror_sphere(16, reflections, ShadingMethod::phong, 220);
    scene.background = GradientBackground{};
    add_picture(result, run, caption, std::move(scene), 220, 220);
  }
  return result;
}

const Vec3d kGrazingLight = Vec3d(1, 0.4, 0.3).normalized();  ///< to the lamp

SceneDescription grazed_sphere(int sides, ShadowTerminator terminator, ShadingMethod method) {
  SceneDescription scene = headlit_scene(faceted_sphere(sides, sides / 2, method), 240, 240, 2.1);
  scene.lights = {sunlight(-kGrazingLight)};
  scene.render.facets.shadow_terminator = terminator;
  return scene;
}

/// Cosine between the normals of the film and the light: [pixel], 0 where nothing is.
std::vector<double> light_cosines(const Film& film) {
  const auto pixels = static_cast<std::size_t>(film.window().width) * static_cast<std::size_t>(film.window().height);
  std::vector<double> cosines;
  for (std::size_t i = 0; i < pixels; ++i)
    cosines.push_back(Vec3d(film.plane(ChannelGroup::normal, 0)[i], film.plane(ChannelGroup::normal, 1)[i],
                            film.plane(ChannelGroup::normal, 2)[i])
                          .dot(kGrazingLight));
  return cosines;
}

constexpr double kLeastCosine = 1e-3;  ///< from which on a pixel counts as lit by its normal: far above rounding

/// Pixels whose interpolated normal faces the light, on a sphere that nothing else shadows.
struct FalseShadows {
  int lit = 0, dark = 0;  ///< `dark`: and yet they are
  int turned_away = 0;    ///< lit ones whose facet faces away from the light
  int grazed = 0;         ///< lit ones whose cosine is within what facets and normals differ by
  double share(int count) const { return double(count) / lit; }
};
FalseShadows false_shadows(int sides, ShadowTerminator terminator, ShadingMethod method, const StabilityRun& run) {
  const Film film = film_of(grazed_sphere(sides, terminator, method), run, {ChannelGroup::color, ChannelGroup::normal});
  const std::vector<double> smooth = light_cosines(film);
  const std::vector<double> own =
      light_cosines(film_of(grazed_sphere(sides, terminator, ShadingMethod::flat), run, {ChannelGroup::normal}));
  // A corner's normal and its facet's: half a facet along the meridian and along the equator.
  const double half = kPi / sides, most = std::sin(std::acos(std::cos(half) * std::cos(half)));
  FalseShadows shadows;
  for (std::size_t i = 0; i < smooth.size(); ++i) {
    if (smooth[i] < kLeastCosine) continue;
    ++shadows.lit;
    shadows.dark += film.plane(ChannelGroup::color, 1)[i] == 0;
    shadows.turned_away += own[i] < 0;
    shadows.grazed += smooth[i] <= most;
  }
  return shadows;
}

StabilityResult shadow_terminator(const StabilityRun& run) {
  StabilityResult result;
  for (const int sides : {8, 16, 32, 64, 128}) {
    if (run.effort < 0.5 && sides != 16 && sides != 64) continue;
    const std::string quantity = fmt::format("share of lit pixels in false shadow, {} sides", sides);
    const FalseShadows classic = false_shadows(sides, ShadowTerminator::classic, ShadingMethod::phong, run);
    result.figures.push_back(
        {"classic", quantity, classic.share(classic.dark), classic.share(classic.turned_away),
         classic.share(classic.grazed),
         "no less than facets turned away, no more than N.L up to the sine of a facet's lean (derived)",
         StabilityExpectation::fails_as_known});
    const FalseShadows offset = false_shadows(sides, ShadowTerminator::offset, ShadingMethod::phong, run);
    result.figures.push_back({"offset to the smooth surface", quantity, offset.share(offset.dark), 0, 0,
                              "0 (Hanika 2021)", StabilityExpectation::holds});
  }
  for (const auto& [caption, terminator] :
       {std::pair("classic, 20 sides", ShadowTerminator::classic), {"offset", ShadowTerminator::offset}})
    add_picture(result, run, caption, grazed_sphere(20, terminator, ShadingMethod::phong), 220, 220);
  return result;
}

/// To a lamp behind the sheet, on the side that its normals lean to.
const Vec3d kLightBehind = Vec3d(1, 0, -0.5).normalized();

/// Color and normals of a sheet across the view, lit from behind; its normals are `left` on its left side.
Film sheet_film(ShadingMethod method, const Vec3f& left, int size, const StabilityRun& run) {
  auto mesh = flat_grid(1, 2);
  mesh->normals.assign(4, Vec3f(Vec3d(0.8, 0, 0.6)));
  mesh->normals[0] = mesh->normals[2] = left;
  ShapeDescription sheet = painted_mesh(std::move(mesh), NormalSource::file);
  sheet.shading = method;
  SceneDescription scene = headlit_scene(std::move(sheet), size, size, 1.9);
  scene.lights = {sunlight(-kLightBehind)};
  return film_of(std::move(scene), run, {ChannelGroup::color, ChannelGroup::normal});
}

/// The same sheet, its normals upright on the left, by N.L alone and as it is rendered; and a little light all over.
void add_sheet_pictures(StabilityResult& result, const StabilityRun& run) {
  if (!run.pictures) return;
  constexpr int kSize = 180;
  constexpr float kFaint = 0.02f;
  const Film film = sheet_film(ShadingMethod::phong, Vec3f(0, 0, 1), kSize, run);
  std::vector<float> by_normal, by_facet;
  for (std::size_t i = 0; i < std::size_t(kSize * kSize); ++i) {
    const double cosine = film.plane(ChannelGroup::normal, 0)[i] * kLightBehind.x +
                          film.plane(ChannelGroup::normal, 2)[i] * kLightBehind.z;
    by_normal.push_back(kFaint + static_cast<float>(std::max(0.0, cosine)));
    by_facet.push_back(kFaint + film.plane(ChannelGroup::color, 1)[i]);
  }
  add_gray_picture(result, run, "By the interpolated normal alone: the lamp behind shines through where normals lean",
                   by_normal, kSize, kSize);
  add_gray_picture(result, run, "By the facet's side too: dark, as a sheet is that is lit from behind", by_facet, kSize,
                   kSize);
}

StabilityResult light_from_behind(const StabilityRun& run) {
  StabilityResult result;
  const int size = 20;
  const auto film = [&](ShadingMethod method) { return sheet_film(method, Vec3f(0.8f, 0, 0.6f), size, run); };
  const auto share = [&](auto&& counts) {
    int count = 0;
    for (std::size_t i = 0; i < std::size_t(size * size); ++i) count += counts(i);
    return double(count) / (size * size);
  };
  const char* quantity = "share of a sheet that is lit from behind";
  const Film phong = film(ShadingMethod::phong);
  const auto by_normal_alone = [&](std::size_t i) {
    return phong.plane(ChannelGroup::normal, 0)[i] * kLightBehind.x +
               phong.plane(ChannelGroup::normal, 2)[i] * kLightBehind.z >
           0;
  };
  result.figures.push_back({"interpolated normal alone", quantity, share(by_normal_alone), 1, 1,
                            "1: N.L = .45 everywhere", StabilityExpectation::fails_as_known});
  for (const auto& [name, method] :
       {std::pair("flat", ShadingMethod::flat), {"Gouraud", ShadingMethod::gouraud}, {"Phong", ShadingMethod::phong}}) {
    const Film seen = film(method);
    const auto is_lit = [&](std::size_t i) { return seen.plane(ChannelGroup::color, 1)[i] > 0; };
    result.figures.push_back(
        {fmt::format("{}, facet's side too", name), quantity, share(is_lit), 0, 0, "0", StabilityExpectation::holds});
  }
  add_sheet_pictures(result, run);
  return result;
}

}  // namespace

std::vector<StabilityCase> facet_remedy_cases() {
  return {{17, "mirrored-below-facet", "Interpolated normals mirror rays into their own facet",
           "A mirror sphere of 16 and 64 sides, one ray a pixel", "Clamp them, or bend normals before (--reflections)",
           "Reshetov, Soupikov and Mark 2010", mirrored_below},
          {18, "shadow-terminator", "False shadows where light grazes a smooth shape",
           "A sphere of 8 to 128 sides in light from the side",
           "Start shadow rays on the smooth surface (--terminator offset)", "Hanika 2021 (Ray Tracing Gems II, ch. 4)",
           shadow_terminator},
          {19, "light-from-behind", "Light through a sheet by its interpolated normal",
           "A thin sheet whose normals lean to a lamp behind it", "Light must be on the facet's own side too",
           "Veach 1997, ch. 5", light_from_behind}};
}

}  // namespace raytree::benchmarks::facets
