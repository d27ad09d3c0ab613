// What facets do to outlines and crooked quads, and what no interpolation may leave behind: rows 7, 15 and 16.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "benchmarks/stability/case_pictures.h"
#include "benchmarks/stability/case_tools.h"
#include "benchmarks/stability/facet_cases.h"
#include "benchmarks/stability/faceted_scenes.h"
#include "geometry/angle.h"
#include "renderer/render.h"
#include "renderer/scene_fields.h"

namespace raytree::benchmarks::facets {
namespace {

constexpr double kOutlinePixels = 240;  ///< radius in the picture
constexpr int kOutlineSize = 501;

/// How far the outline lies inside its circle, pixels: to the center of the nearest dark pixel.
double outline_error(ShapeDescription round, const StabilityRun& run) {
  const std::vector<float> values =
      green_of(headlit_scene(std::move(round), kOutlineSize, kOutlineSize, kOutlineSize / kOutlinePixels), run);
  double nearest = kOutlineSize;
  for (int y = 0; y < kOutlineSize; ++y)
    for (int x = 0; x < kOutlineSize; ++x)
      if (values[std::size_t(y * kOutlineSize + x)] == 0)
        nearest = std::min(nearest, std::hypot(x + 0.5 - kOutlineSize / 2.0, y + 0.5 - kOutlineSize / 2.0));
  return kOutlinePixels - nearest;
}

ShapeDescription disc_of(int sides) { return painted(DiscShape{{0, 0, 0}, {0, 0, 1}, 1, sides}); }

/// A dome about z whose rim is the unit circle: the profile (radius, height) turned about y, then laid back.
ShapeDescription turned_dome() {
  PatchesShape patches;
  patches.positions = {{0, 0.5, 0}, {0.5, 0.5, 0}, {1, 0.3, 0}, {1, 0, 0}};
  patches.lathe = {{0, 1, 2, 3}};
  ShapeDescription dome = painted(std::move(patches));
  dome.transform.rotate(Vec3d(kPi / 2, 0, 0));
  return dome;
}

StabilityResult polygonal_outline(const StabilityRun& run) {
  StabilityResult result;
  const char* quantity = "outline inside the circle of 240 pixels, pixels, the most";
  // The nearest dark pixel's center lies outside the outline, and no farther from its nearest point than half a
  // pixel's diagonal.
  const double diagonal = std::sqrt(0.5), rounding = 1e-3;
  for (const int sides : {8, 16, 32, 64}) {
    const double exact = kOutlinePixels * (1 - std::cos(kPi / sides));
    result.figures.push_back({fmt::format("{} sides", sides), quantity, outline_error(disc_of(sides), run),
                              exact - diagonal, exact + rounding,
                              fmt::format("R (1 - cos(pi / k)) = {:.2f} (Gouraud 1971, p. 20)", exact),
                              StabilityExpectation::fails_as_known});
  }
  result.figures.push_back(
      {"exact disc", quantity, outline_error(disc_of(0), run), -diagonal, rounding, "0", StabilityExpectation::holds});
  // A cubic's quarter circle is at most 2.73e-4 of its radius off.
  const double tolerance = TessellationSettings().tolerance;
  result.figures.push_back({"surface cut by screen space, 1/4 pixel", quantity, outline_error(turned_dome(), run),
                            -diagonal - 2.73e-4 * kOutlinePixels, tolerance + 2.73e-4 * kOutlinePixels, "1/4",
                            StabilityExpectation::holds});
  for (const auto& [caption, sides] : {std::pair("8 sides", 8), {"exact", 0}}) {
    SceneDescription scene = headlit_scene(disc_of(sides), 200, 200, 2.2);
    add_picture(result, run, caption, std::move(scene), 200, 200);
  }
  return result;
}

SceneDescription saddle_scene(bool surface) {
  auto mesh = std::make_shared<PolygonMesh>();
  mesh->positions.assign({Vec3f(-1, -1, 0), Vec3f(1, -1, 0.5f), Vec3f(1, 1, 0), Vec3f(-1, 1, 0.5f)});
  mesh->face_sizes.push_back(4);
  mesh->corners.assign({0, 1, 2, 3});
  ShapeDescription quad = painted_mesh(std::move(mesh), NormalSource::smooth);
  if (surface) {
    SubdivisionRules& rules = std::get<MeshShape>(quad.kind).subdivision.emplace();
    rules.scheme = SubdivisionScheme::bilinear;
    rules.boundary = BoundaryRule::edge_and_corner;
  }
  SceneDescription scene = headlit_scene(std::move(quad), 101, 101, 2.2);
  scene.render.tessellation.rate = surface ? 16 : 0;
  return scene;
}

StabilityResult crooked_quad(const StabilityRun& run) {
  StabilityResult result;
  const auto off = [&](bool surface) {
    const Film film = film_of(saddle_scene(surface), run, {ChannelGroup::depth});
    return std::abs(10 - double(film.plane(ChannelGroup::depth, 0)[50 * 101 + 50]) - 0.25);
  };
  const char* quantity = "middle of a saddle of height 1/2 off the bilinear patch";
  // Depth is a float near 10.
  const double rounding = 10 * 0x1p-22;
  result.figures = {predicted_figure("two triangles", quantity, off(false), 0.25, rounding, "h / 2 = 1/4",
                                     StabilityExpectation::fails_as_known),
                    predicted_figure("bilinear surface, tessellated", quantity, off(true), 0, rounding, "0",
                                     StabilityExpectation::holds)};
  for (const bool surface : {false, true}) {
    SceneDescription scene = saddle_scene(surface);
    scene.cameras[0].position = {4, 7, 6};
    scene.cameras[0].height = 3;
    scene.lights = {sunlight({-1, 0.3, -0.6})};
    if (!surface) scene.shapes[0].shading = ShadingMethod::flat;
    add_picture(result, run, surface ? "as a bilinear surface" : "as two triangles: a crease along the diagonal",
                std::move(scene), 220, 180);
  }
  return result;
}

/// Normals of a square's corners, once around from the lower left: each is opposite to that across.
const Vec3f kCancelingNormals[4] = {{0.6f, 0, 0.8f}, {0, 1, 0}, {-0.6f, 0, -0.8f}, {0, -1, 0}};
/// Pixels each way: in the middle one, where the diagonals cross, normals cancel in every way of interpolating.
constexpr int kCancelingSize = 33;
constexpr double kCancelingWindow = 2.2;

SceneDescription canceling_quad(ShadingMethod shading, FacetInterpolation interpolation) {
  auto mesh = std::make_shared<PolygonMesh>();
  mesh->positions.assign({Vec3f(-1, -1, 0), Vec3f(1, -1, 0), Vec3f(1, 1, 0), Vec3f(-1, 1, 0)});
  mesh->normals.assign(std::begin(kCancelingNormals), std::end(kCancelingNormals));
  mesh->face_sizes.push_back(4);
  mesh->corners.assign({0, 1, 2, 3});
  ShapeDescription quad = painted_mesh(std::move(mesh), NormalSource::file);
  quad.shading = shading;
  quad.interpolation = interpolation;
  return highlit_scene(std::move(quad), kCancelingSize, kCancelingSize, kCancelingWindow, 20);
}

/// The same square by n / |n| as it stands: bilinear, in single precision.
StabilityPicture canceled_picture() {
  return painted_picture(
      "n / |n| as it stands: no number in the middle pixel (orange)", kCancelingSize, kCancelingSize,
      [](int x, int y) {
        constexpr float pixel = float(kCancelingWindow / kCancelingSize);
        const float u = 0.5f + (float(x) - kCancelingSize / 2) * pixel / 2;
        const float v = 0.5f - (float(y) - kCancelingSize / 2) * pixel / 2;
        if (u < 0 || u > 1 || v < 0 || v > 1) return gray(0);
        const Vec3f n = (kCancelingNormals[0] * (1 - u) + kCancelingNormals[1] * u) * (1 - v) +
                        (kCancelingNormals[3] * (1 - u) + kCancelingNormals[2] * u) * v;
        const float cosine = n.z / n.length();
        return std::isfinite(cosine) ? gray(std::max(0.0f, cosine)) : kFaultColor;
      },
      6);
}

StabilityResult canceling_normals(const StabilityRun& run) {
  std::size_t not_finite = 0, pixels = 0;
  StabilityResult result;
  constexpr int size = kCancelingSize;
  for (const auto& shading : EnumTable<ShadingMethod>::entries)
    for (const auto& interpolation : EnumTable<FacetInterpolation>::entries)
      for (const auto& reflections : EnumTable<FacetReflections>::entries) {
        SceneDescription scene = canceling_quad(shading.value, interpolation.value);
        scene.materials[0].reflection = Rgb(0.5f);
        scene.materials[0].diffuse = Rgb(0.5f);
        scene.render.depth = 4;
        scene.render.facets.reflections = reflections.value;
        scene.render.facets.shadow_terminator = ShadowTerminator::offset;
        RenderOptions options;
        options.channels = {ChannelGroup::color, ChannelGroup::normal};
        options.stop = run.stop;
        const RenderResult rendered = render(prepared_for(run, std::move(scene)), options);
        not_finite += static_cast<std::size_t>(rendered.statistics.not_finite_samples);
        for (const ChannelGroup group : {ChannelGroup::color, ChannelGroup::normal})
          for (int c = 0; c < 3; ++c)
            for (int i = 0; i < size * size; ++i) not_finite += !std::isfinite(rendered.film.plane(group, c)[i]);
        pixels += std::size_t(size) * std::size_t(size);
      }
  // What n / |n| would be there.
  const Vec3f canceled = (kCancelingNormals[0] + kCancelingNormals[2]) * 0.5f;
  result.figures = {predicted_figure("n / |n| as it stands", "not finite in the middle, of 1",
                                     std::isfinite(canceled.x / canceled.length()) ? 0 : 1, 1, 0, "1: 0 / 0",
                                     StabilityExpectation::fails_as_known),
                    predicted_figure("every shading, interpolation and reflection",
                                     fmt::format("values that are not finite, of {} pixels", pixels),
                                     double(not_finite), 0, 0, "0", StabilityExpectation::holds)};
  if (run.pictures) {
    result.pictures.push_back(canceled_picture());
    SceneDescription scene = canceling_quad(ShadingMethod::phong, FacetInterpolation::bilinear);
    scene.materials[0].highlight.weight = Rgb(0);
    scene.materials[0].diffuse = Rgb(1);
    StabilityPicture rendered = stability_picture("The facet's own normal there", film_of(std::move(scene), run));
    rendered.magnified = 6;
    result.pictures.push_back(std::move(rendered));
  }
  return result;
}

}  // namespace

std::vector<StabilityCase> facet_geometry_cases() {
  return {
      {7, "polygonal-outline", "Outlines of facets are polygons",
       "A disc of 8 to 64 sides, 240 pixels in radius, against its circle",
       "Cut surfaces by what a facet misses in the picture, or use exact shapes",
       "Gouraud 1971, p. 20; Phong 1973, ch. VI", polygonal_outline},
      {15, "crooked-quad", "A quad that is not flat is no two triangles",
       "A saddle of height 1/2 over a square of edge 2, seen from above", "A bilinear surface, tessellated",
       "Embree issues 323, 399 and 538", crooked_quad},
      {16, "canceling-normals", "Interpolated normals that cancel each other",
       "Corners whose normals are opposite, in each way of shading, interpolating and mirroring",
       "The facet's own normal where nothing is left", "bevy issue 10905; Mitsuba 3 issue 1733", canceling_normals}};
}

}  // namespace raytree::benchmarks::facets
