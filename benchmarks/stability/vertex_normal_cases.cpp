// Where vertex normals come from and how they are carried across a facet: rows 11 to 14.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "benchmarks/stability/facet_cases.h"
#include "benchmarks/stability/faceted_scenes.h"
#include "geometry/angle.h"
#include "geometry/vertex_normals.h"
#include "renderer/scene_fields.h"

namespace raytree::benchmarks::facets {
namespace {

/// A plate in the plane z = 0 and a fin that falls away from its edge at a right angle.
SceneDescription fin_scene(double crease_angle) {
  auto mesh = std::make_shared<PolygonMesh>();
  mesh->positions.assign(
      {Vec3f(-1, -1, 0), Vec3f(1, -1, 0), Vec3f(1, 0, 0), Vec3f(-1, 0, 0), Vec3f(1, 0, -1), Vec3f(-1, 0, -1)});
  mesh->face_sizes.assign(2, 4);
  mesh->corners.assign({0, 1, 2, 3, 3, 2, 4, 5});
  ShapeDescription shape = painted_mesh(std::move(mesh), NormalSource::smooth);
  shape.smoothing.emplace() = {Smoothing::Method::unit, crease_angle, false};
  return headlit_scene(std::move(shape), 40, 40, 2.1);
}

StabilityResult averaged_across_edge(const StabilityRun& run) {
  StabilityResult result;
  const auto error = [&](double crease_angle) {
    const Film film = film_of(fin_scene(crease_angle), run, {ChannelGroup::normal});
    const std::size_t below_edge = 20 * 40 + 20;
    return std::atan2(std::abs(double(film.plane(ChannelGroup::normal, 1)[below_edge])),
                      double(film.plane(ChannelGroup::normal, 2)[below_edge])) /
           kDegree;
  };
  // The first pixel's center lies half a pixel below the edge, where that share of the far edge's normal is mixed in.
  const double share = 0.5 * 2.1 / 40, half = (1 - share) * std::sqrt(0.5);
  const double expected = std::atan2(half, half + share) / kDegree;
  const double rounding = float_error() / kDegree;
  const char* quantity = "normal at the foot of a fin off, degrees";
  result.figures = {
      predicted_figure("one normal a vertex", quantity, error(180), expected, rounding,
                       fmt::format("45 at the edge, {:.2f} half a pixel beside it (Gouraud 1971, fig. 11)", expected),
                       StabilityExpectation::fails_as_known),
      predicted_figure("split at creases of 40 degrees", quantity, error(40), 0, rounding, "0",
                       StabilityExpectation::holds)};
  for (const auto& [caption, crease] : {std::pair("averaged: the edge is painted round", 180.0), {"split", 40.0}}) {
    SceneDescription scene = fin_scene(crease);
    scene.cameras[0].position = {5, 6, 7};
    scene.cameras[0].target = {0, -0.4, -0.3};
    scene.cameras[0].height = 2.6;
    scene.lights = {sunlight({-0.3, -0.4, -1})};
    scene.ambient = Rgb(0.1f);
    scene.materials[0].diffuse = Rgb(0.7f);
    add_picture(result, run, caption, std::move(scene), 220, 180);
  }
  return result;
}

/// Three squares that meet at a cube's corner, cut so that the corner has two triangles of the first and one each of
/// the others, or four corners of it.
PolygonMesh cut_corner() {
  PolygonMesh mesh;
  mesh.positions.assign(
      {Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0), Vec3f(0, 0, 1), Vec3f(1, 1, 0), Vec3f(0, 1, 1), Vec3f(1, 0, 1)});
  // z = 0: the diagonal starts at the corner; x = 0 and y = 0: it passes by.
  mesh.corners.assign({0, 4, 1, 0, 2, 4, 0, 3, 2, 3, 5, 2, 0, 1, 3, 1, 6, 3});
  return mesh;
}

/// That corner from straight ahead, lit from there: the light is as alike in the three squares as the normal is.
SceneDescription lit_corner(Smoothing::Method method) {
  ShapeDescription corner = painted_mesh(std::make_shared<PolygonMesh>(cut_corner()), NormalSource::smooth);
  corner.smoothing.emplace() = {method, 180, false};
  SceneDescription scene = highlit_scene(std::move(corner), 1, 1, 1.9, 20);
  scene.cameras[0].position = {-4.7, -4.7, -4.7};
  scene.cameras[0].target = {0.3, 0.3, 0.3};
  scene.lights = {sunlight({1, 1, 1})};
  scene.materials[0].diffuse = Rgb(0.25f);
  return scene;
}

StabilityResult weighted_normals(const StabilityRun& run) {
  StabilityResult result;
  const auto error = [](NormalMethod method) {
    PolygonMesh mesh = cut_corner();
    compute_vertex_normals(mesh, {method, kPi, false});
    const std::uint32_t at = mesh.normal_corners.empty() ? 0 : mesh.normal_corners[0];
    const Vec3d diagonal = Vec3d(-1, -1, -1) / std::sqrt(3.0);
    const Vec3d normal(mesh.normals[at]);
    return std::atan2(normal.cross(diagonal).length(), normal.dot(diagonal)) / kDegree;
  };
  // The first square counts twice: between (1, 1, 2) and (1, 1, 1).
  const double twice = std::acos(4 / std::sqrt(18.0)) / kDegree, rounding = float_error() / kDegree;
  const char* quantity = "normal of a cube's corner off its diagonal, degrees";
  for (const auto& [name, method] :
       {std::pair("unit normals of triangles", NormalMethod::unit), {"weighted by area", NormalMethod::area}})
    result.figures.push_back(
        predicted_figure(name, quantity, error(method), twice, rounding,
                         fmt::format("acos(4 / sqrt 18) = {:.2f}: one square has two triangles there", twice),
                         StabilityExpectation::fails_as_known));
  result.figures.push_back(
      predicted_figure("weighted by angle (the renderer's own)", quantity, error(NormalMethod::angle), 0, rounding,
                       "0 however faces are cut (Thuermer and Wuethrich 1998)", StabilityExpectation::holds));
  for (const auto& [caption, method] :
       {std::pair("unit normals of triangles: the highlight leans to the square that has two there",
                  Smoothing::Method::unit),
        {"weighted by area: as far", Smoothing::Method::area},
        {"weighted by angle: all three squares alike", Smoothing::Method::angle}})
    add_picture(result, run, caption, lit_corner(method), 200, 200);
  return result;
}

constexpr int kDentSize = 100;
const double kDentLean = 30 * kDegree;

SceneDescription dented_plate(bool mended, ShadingMethod method) {
  auto mesh = flat_grid(4, 0.5);
  mesh->normals.assign(25, Vec3f(0, 0, 1));
  mesh->normals[12] = Vec3f(Vec3d(std::sin(kDentLean), 0, std::cos(kDentLean)));
  ShapeDescription plate = painted_mesh(std::move(mesh), NormalSource::file);
  plate.shading = method;
  if (mended) plate.smoothing.emplace();
  SceneDescription scene = headlit_scene(std::move(plate), kDentSize, kDentSize, 2);
  scene.lights = {sunlight({-1, 0, -1})};
  return scene;
}

/// Root mean square of the light that is off: over six triangles of 1/8 out of 4, each of which has the share w of the
/// wrong normal on a part 2 (1 - w) dw of it.
double dent_error(ShadingMethod method) {
  const double level = std::sqrt(0.5);
  const auto light = [&](double w) {
    const double x = w * std::sin(kDentLean), z = w * std::cos(kDentLean) + 1 - w;
    const double lambert = (x + z) * level;
    return method == ShadingMethod::gouraud ? lambert : lambert / std::hypot(x, z);
  };
  double square = 0;
  constexpr int kSteps = 10000;
  for (int i = 0; i < kSteps; ++i) {
    const double w = (i + 0.5) / kSteps;
    square += 2 * (1 - w) * std::pow(light(w) - level, 2) / kSteps;
  }
  return std::sqrt(square * 6 * 0.125 / 4);
}

StabilityResult painted_dent(const StabilityRun& run) {
  StabilityResult result;
  const auto error = [&](bool mended, ShadingMethod method) {
    double square = 0;
    for (const float value : green_of(dented_plate(mended, method), run)) square += std::pow(value - std::sqrt(0.5), 2);
    return std::sqrt(square / (kDentSize * kDentSize));
  };
  const char* quantity = "light off, RMS over the plate";
  for (const auto& [name, method] : {std::pair("Gouraud", ShadingMethod::gouraud), {"Phong", ShadingMethod::phong}}) {
    const double expected = dent_error(method);
    // The midpoint rule over pixels of 1/25 of the dent's radius: the integrand's kinks are off by its square.
    result.figures.push_back(predicted_figure(
        fmt::format("{}, file's normals", name), quantity, error(false, method), expected, expected * 2 / (25 * 25),
        fmt::format("{:.4f} (integral)", expected), StabilityExpectation::fails_as_known));
    result.figures.push_back(predicted_figure(fmt::format("{}, normals made of the facets", name), quantity,
                                              error(true, method), 0, float_error(), "0", StabilityExpectation::holds));
  }
  for (const auto& [caption, mended] : {std::pair("one normal off by 30 degrees", false), {"normals of facets", true}})
    add_picture(result, run, caption, dented_plate(mended, ShadingMethod::phong), 180, 180);
  return result;
}

/// A square whose corners' light is 1, 0, 1, 0.
SceneDescription turned_square(FacetInterpolation interpolation, double degrees) {
  auto mesh = std::make_shared<PolygonMesh>();
  mesh->positions.assign({Vec3f(-1, -1, 0), Vec3f(1, -1, 0), Vec3f(1, 1, 0), Vec3f(-1, 1, 0)});
  mesh->normals.assign({Vec3f(0, 0, 1), Vec3f(1, 0, 0), Vec3f(0, 0, 1), Vec3f(1, 0, 0)});
  mesh->face_sizes.push_back(4);
  mesh->corners.assign({0, 1, 2, 3});
  ShapeDescription square = painted_mesh(std::move(mesh), NormalSource::file);
  square.shading = ShadingMethod::gouraud;
  square.interpolation = interpolation;
  square.transform.rotate(Vec3d(0, 0, degrees * kDegree));
  return headlit_scene(std::move(square), 21, 21, 2.9);
}

StabilityResult rotated_interpolation(const StabilityRun& run) {
  StabilityResult result;
  constexpr int kLast = 42;  // degrees, to either side; 45 would put corners on the row
  const auto swing = [&](FacetInterpolation interpolation) {
    float least = 1, most = 0;
    for (int degrees = -kLast; degrees <= kLast; degrees += 6) {
      const float value = green_of(turned_square(interpolation, degrees), run)[10 * 21 + 10];
      least = std::min(least, value), most = std::max(most, value);
    }
    return double(most - least);
  };
  const double exact = std::tan(kLast * kDegree);
  const std::string quantity = fmt::format("swing of the middle's light over {} degrees", 2 * kLast);
  const double rounding = 16 * float_error();  // the row's crossings with edges, then the share between them
  result.figures = {
      predicted_figure("along scan lines", quantity, swing(FacetInterpolation::scanline), exact, rounding,
                       fmt::format("tan {} degrees = {:.3f}; 1 over 90 degrees (Phong 1973, sec. I.2)", kLast, exact),
                       StabilityExpectation::fails_as_known),
      predicted_figure("bilinear in the patch's parameters", quantity, swing(FacetInterpolation::bilinear), 0, rounding,
                       "0", StabilityExpectation::holds),
      predicted_figure("barycentric (the renderer's own)", quantity, swing(FacetInterpolation::barycentric), 0,
                       rounding, "0", StabilityExpectation::holds)};
  for (const auto& [caption, interpolation, degrees] :
       {std::tuple("scan lines, upright", FacetInterpolation::scanline, 0.0),
        {"scan lines, turned by 42 degrees", FacetInterpolation::scanline, 42.0},
        {"bilinear, turned by 42 degrees", FacetInterpolation::bilinear, 42.0}})
    add_picture(result, run, caption, turned_square(interpolation, degrees), 170, 170);
  return result;
}

}  // namespace

std::vector<StabilityCase> vertex_normal_cases() {
  return {
      {11, "normals-across-creases", "Normals averaged across an edge that is none",
       "A fin and a plate that share vertices at a right angle",
       "Split normals where facets meet at more than the crease angle", "Gouraud 1971, fig. 11 (the T-37's tail)",
       averaged_across_edge},
      {12, "normals-by-weights", "Vertex normals that depend on how faces are cut",
       "A cube's corner where one square has two triangles and the others have one",
       "Weigh facets by their angle at the vertex", "Gouraud 1971, p. 30 and fig. 17; Thuermer and Wuethrich 1998",
       weighted_normals},
      {13, "wrong-normal-dent", "A wrong normal paints a dent", "One vertex normal of a flat plate leans by 30 degrees",
       "Normals made of the facets (smoothing)", "Gouraud 1971, fig. 12", painted_dent},
      {14, "scanline-rotation", "Interpolation along scan lines depends on rotation",
       "A square whose corners are 1, 0, 1, 0 turns about its middle",
       "Bilinear in the quad's own parameters, or over fixed triangles", "Phong 1973, sec. I.2; Gouraud 1971, fig. 12",
       rotated_interpolation}};
}

}  // namespace raytree::benchmarks::facets
