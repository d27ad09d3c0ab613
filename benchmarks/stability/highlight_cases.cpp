// The famous faults of interpolated light, beside what normals interpolated in its place give: rows 1 to 3 and 6.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "benchmarks/stability/facet_cases.h"
#include "benchmarks/stability/faceted_circle.h"
#include "benchmarks/stability/faceted_scenes.h"
#include "geometry/angle.h"
#include "renderer/scene_fields.h"

namespace raytree::benchmarks::facets {
namespace {

constexpr auto kHolds = StabilityExpectation::holds;
constexpr auto kFailsAsKnown = StabilityExpectation::fails_as_known;

/// Largest and smallest distance from the middle, in pixels, at which values fall below `level`.
struct Contour {
  double least = 0, most = 0;
};
/// A pixel stands for what lies up to half its diagonal away, and the search goes in quarters of a pixel.
const double kContourError = std::sqrt(0.5) + 0.25;

Contour contour_of(const std::vector<float>& values, int size, double level) {
  Contour contour{double(size), 0};
  for (int degrees = 0; degrees < 360; ++degrees) {
    const double dx = std::cos(degrees * kDegree), dy = std::sin(degrees * kDegree);
    const auto at = [&](double r) {
      const auto x = static_cast<std::size_t>(size / 2.0 + dx * r), y = static_cast<std::size_t>(size / 2.0 + dy * r);
      return values[y * static_cast<std::size_t>(size) + x];
    };
    double radius = 0;
    while (radius < size / 2.0 - 1 && at(radius) >= level) radius += 0.25;
    contour.least = std::min(contour.least, radius), contour.most = std::max(contour.most, radius);
  }
  return contour;
}

/// most / least against a ratio between `low` and `high` whose longest radius is `longest` pixels.
StabilityFigure ratio_figure(const char* method, const Contour& contour, double low, double high, std::string known,
                             StabilityExpectation expectation) {
  const double error = kContourError / contour.least + kContourError / contour.most;
  return {method,
          "a contour's longest radius over its shortest",
          contour.most / contour.least,
          std::max(1.0, low * (1 - error)),
          high * (1 + error),
          std::move(known),
          expectation};
}

/// Four quads about a corner that faces the light, with all corners around in the dark.
SceneDescription one_lit_corner(FacetInterpolation interpolation, int size) {
  auto mesh = std::make_shared<PolygonMesh>();
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      mesh->positions.push_back(Vec3f(float(i), float(j), 0));
      mesh->normals.push_back(i == 0 && j == 0 ? Vec3f(0, 0, 1) : Vec3f(Vec3d(i, j, 0).normalized()));
    }
  if (interpolation == FacetInterpolation::barycentric) {
    // Cut so that the lit corner, 4, lies across from each diagonal.
    mesh->corners.assign({0, 1, 3, 1, 4, 3, 1, 2, 5, 1, 5, 4, 3, 4, 7, 3, 7, 6, 4, 5, 7, 5, 8, 7});
  } else {
    mesh->face_sizes.assign(4, 4);
    for (const std::uint32_t a : {0u, 1u, 3u, 4u}) mesh->corners.insert(mesh->corners.end(), {a, a + 1, a + 4, a + 3});
  }
  ShapeDescription shape = painted_mesh(std::move(mesh), NormalSource::file);
  shape.shading = ShadingMethod::gouraud;
  shape.interpolation = interpolation;
  return headlit_scene(std::move(shape), size, size, 2.1);
}

constexpr int kSphereSides = 12, kSphereStacks = 8;
constexpr double kSphereExponent = 20, kSphereLevel = 0.7;

SceneDescription lit_sphere(ShadingMethod method, int size) {
  ShapeDescription sphere = faceted_sphere(kSphereSides, kSphereStacks, method);
  if (method == ShadingMethod::gouraud) sphere.interpolation = FacetInterpolation::bilinear;
  return highlit_scene(std::move(sphere), size, size, 1.2, kSphereExponent);
}

/// The ratio of Gouraud's contour on that sphere: about the corner that faces the viewer lie four trapezoids, whose
/// light is bilinear between cos^n at the corners.
double gouraud_sphere_ratio() {
  const double longitude = 2 * kPi / kSphereSides, latitude = kPi / kSphereStacks;
  const double along = std::pow(std::cos(longitude), kSphereExponent),
               up = std::pow(std::cos(latitude), kSphereExponent), both = along * up;
  const auto light = [&](double x, double y) {
    const double v = y / std::sin(latitude), u = x / (std::sin(longitude) * (1 - v + v * std::cos(latitude)));
    return (1 - u) * (1 - v) + u * (1 - v) * along + (1 - u) * v * up + u * v * both;
  };
  double least = 1, most = 0;
  for (int step = 0; step <= 900; ++step) {
    const double angle = step * kDegree / 10;
    double near = 0, far = 0.3;  // within the trapezoid, and beyond the contour
    for (int i = 0; i < 50; ++i) {
      const double middle = (near + far) / 2;
      (light(middle * std::cos(angle), middle * std::sin(angle)) >= kSphereLevel ? near : far) = middle;
    }
    least = std::min(least, near), most = std::max(most, near);
  }
  return most / least;
}

StabilityResult highlight_shape(const StabilityRun& run) {
  StabilityResult result;
  const int size = run.effort < 0.5 ? 301 : 601;
  const double c = 0.5;
  const Contour triangles = contour_of(green_of(one_lit_corner(FacetInterpolation::barycentric, size), run), size, c);
  const Contour quads = contour_of(green_of(one_lit_corner(FacetInterpolation::bilinear, size), run), size, c);
  const double astroid = (1 - c) / (std::sqrt(2.0) * (1 - std::sqrt(c)));
  result.figures.push_back(ratio_figure("Gouraud, one lit corner of triangles", triangles, std::sqrt(2.0),
                                        std::sqrt(2.0), "sqrt 2: a square (Phong 1973, fig. 1.8)", kFailsAsKnown));
  result.figures.push_back(ratio_figure("Gouraud, one lit corner of quads", quads, astroid, astroid,
                                        fmt::format("(1 - c) / (sqrt 2 (1 - sqrt c)) = {:.3f} at c = 1/2", astroid),
                                        kFailsAsKnown));
  const auto on_sphere = [&](ShadingMethod method) {
    return contour_of(green_of(lit_sphere(method, size), run), size, kSphereLevel);
  };
  const double cross = gouraud_sphere_ratio();
  result.figures.push_back(ratio_figure("Gouraud, sphere of 12 x 8", on_sphere(ShadingMethod::gouraud), cross, cross,
                                        fmt::format("{:.3f}: cos^n bilinear between corners", cross), kFailsAsKnown));
  // Interpolated normals point along the radius through the hit, which lies nearer the middle than the surface: by the
  // facet's distance at most.
  const double facet_distance = std::cos(kPi / kSphereSides) * std::cos(kPi / (2 * kSphereStacks));
  for (const auto& [name, method] :
       {std::pair("Phong, sphere of 12 x 8", ShadingMethod::phong), {"limit, sphere of 12 x 8", ShadingMethod::limit}})
    result.figures.push_back(ratio_figure(name, on_sphere(method), 1, 1 / facet_distance,
                                          "1, and 1.06 seen on the facets: r of the hit", kHolds));
  const auto whole = [](ShadingMethod method) {
    SceneDescription scene = lit_sphere(method, 240);
    scene.cameras[0].height = 2.2;
    scene.materials[0].diffuse = Rgb(0.25f);
    return scene;
  };
  add_picture(result, run, "Gouraud: a cross", whole(ShadingMethod::gouraud), 240, 240);
  add_picture(result, run, "Phong: a circle", whole(ShadingMethod::phong), 240, 240);
  return result;
}

StabilityResult lost_highlight(const StabilityRun& run) {
  StabilityResult result;
  constexpr int kSides = 8;
  constexpr double kExponent = 50;
  const auto scene = [&](ShadingMethod method, int width, int height, double window) {
    return highlit_scene(faceted_cylinder(kSides, method, 180.0 / kSides), width, height, window, kExponent);
  };
  const auto peak = [&](ShadingMethod method) { return largest_of(green_of(scene(method, 401, 1, 0.005), run)); };
  const double left = std::pow(std::cos(kPi / kSides), kExponent);
  const char* quantity = "peak of the highlight, n = 50, over the true peak";
  result.figures = {
      predicted_figure("Gouraud", quantity, peak(ShadingMethod::gouraud), left, float_error(kExponent),
                       fmt::format("cos^50 (pi / 8) = {:.4f} (Phong 1973, sec. IV.4)", left), kFailsAsKnown),
      predicted_figure("Phong", quantity, peak(ShadingMethod::phong), 1, float_error(kExponent), "1", kHolds),
      predicted_figure("limit", quantity, peak(ShadingMethod::limit), 1, float_error(kExponent), "1", kHolds)};
  for (const auto& [name, method] :
       {std::pair("Gouraud: nothing is left", ShadingMethod::gouraud), {"Phong: in its place", ShadingMethod::phong}}) {
    SceneDescription shown = scene(method, 240, 180, 2.2);
    shown.materials[0].diffuse = Rgb(0.2f);
    add_picture(result, run, name, std::move(shown), 240, 180);
  }
  return result;
}

StabilityResult prism_flicker(const StabilityRun& run) {
  StabilityResult result;
  const int step = run.effort < 0.5 ? 6 : 2;  // degrees; 0 and 60, the two extremes, are among them
  for (const double exponent : {1.0, 5.0}) {
    constexpr double kPixel = 0.0025;
    const auto swing = [&](ShadingMethod method) {
      float least = 1, most = 0;
      for (int degrees = 0; degrees < 120; degrees += step) {
        const float peak =
            largest_of(green_of(highlit_scene(faceted_cylinder(3, method, degrees), 801, 1, kPixel, exponent), run));
        least = std::min(least, peak), most = std::max(most, peak);
      }
      return double(most - least);
    };
    const double exact = 1 - std::pow(std::cos(kPi / 3), exponent);
    const std::string quantity = fmt::format("swing of the peak over a turn, n = {:g}", exponent);
    // The peak is a corner, at most half a pixel from the nearest center; from there light falls to 0 over sin (pi /
    // 3).
    const double fall = kPixel / 2 / std::sin(kPi / 3) + float_error(exponent);
    result.figures.push_back({"Gouraud, prism of 3 sides", quantity, swing(ShadingMethod::gouraud), exact - fall,
                              exact + float_error(exponent),
                              fmt::format("1 - cos^n (pi / 3) = {:.3f} (Phong 1973, fig. 1.11)", exact),
                              kFailsAsKnown});
    // The normal at half a pixel from the peak is off by that over the facet's distance, 1/2.
    result.figures.push_back({"Phong, prism of 3 sides", quantity, swing(ShadingMethod::phong), 0,
                              exponent * kPixel * kPixel / 2 + float_error(exponent), "0", kHolds});
  }
  for (const auto& [caption, method, degrees] :
       {std::tuple("Gouraud, a corner to the lamp", ShadingMethod::gouraud, 30.0),
        {"Gouraud, 60 degrees later", ShadingMethod::gouraud, 90.0},
        {"Phong, then", ShadingMethod::phong, 90.0}}) {
    SceneDescription shown = highlit_scene(faceted_cylinder(3, method, degrees), 180, 180, 2.2, 5);
    shown.materials[0].diffuse = Rgb(0.1f);
    add_picture(result, run, caption, std::move(shown), 180, 180);
  }
  return result;
}

/// A facet faces the viewer.
double facing_facet(int sides) { return 180.0 / sides - 90; }

/// Largest error of the method's formula for (N.L)^exponent at those places, of 1.
double predicted_error(ShadingMethod method, int sides, double exponent, const std::vector<double>& places) {
  const FacetedCircle facets(sides, facing_facet(sides)), circle(0, 0);
  // Where sides are few, hits beside the one that faces the viewer lie visibly off the circle, which is no fault of
  // the shading.
  const double reach = method == ShadingMethod::phong ? std::sin(kPi / sides) : 1;
  double largest = 0;
  for (const double x : places)
    if (std::abs(x) < reach)
      largest = std::max(largest, std::abs(facets.light(method, x, exponent) - circle.light(method, x, exponent)));
  return largest;
}

/// The closed forms over the sides, and what all methods make of as many as Phong's needs.
void show_sides_needed(StabilityResult& result, const StabilityRun& run, double exponent, StabilityGraph measured) {
  StabilityGraph graph{"A highlight, n = 50, on a cylinder", "sides", "largest error, in 1/255", {}};
  const std::vector<double> places = pixel_centers(1500, 1.6 / 1500);
  std::vector<StabilityGraph::Line>::iterator dots = measured.lines.begin();
  for (const auto& [name, method] :
       {std::pair("flat", ShadingMethod::flat), {"Gouraud", ShadingMethod::gouraud}, {"Phong", ShadingMethod::phong}}) {
    StabilityGraph::Line line{fmt::format("{}, closed form", name), {}, true};
    const int most = method == ShadingMethod::flat ? 4096 : method == ShadingMethod::gouraud ? 1024 : 64;
    for (int sides = 8; sides <= most; sides *= 2)
      line.points.emplace_back(sides, 255 * predicted_error(method, sides, exponent, places));
    graph.lines.push_back(std::move(*dots++));
    graph.lines.push_back(std::move(line));
    constexpr int kShown = 19;
    SceneDescription scene =
        highlit_scene(faceted_cylinder(kShown, method, facing_facet(kShown)), 180, 140, 1.4, exponent);
    scene.materials[0].diffuse = Rgb(0.15f);
    add_picture(result, run, fmt::format("{}, 19 sides", name), std::move(scene), 180, 140);
  }
  graph.lines.push_back({"1/255", {{8, 1}, {4096, 1}}, true});
  result.graphs.push_back(std::move(graph));
}

StabilityResult sides_needed(const StabilityRun& run) {
  StabilityResult result;
  StabilityGraph measured;
  constexpr double kExponent = 50, kWindow = 1.6;
  constexpr int kPixels = 6000;
  const std::vector<double> centers = pixel_centers(kPixels, kWindow / kPixels);
  const auto seen_of = [&](ShadingMethod method, int sides, double turned_degrees) {
    return green_of(
        highlit_scene(faceted_cylinder(sides, method, turned_degrees), kPixels, 1, kWindow / kPixels, kExponent), run);
  };
  const std::vector<float> exact = seen_of(ShadingMethod::limit, 0, 0);
  const struct {
    const char* name;
    ShadingMethod method;
    int sides;
    StabilityExpectation expectation;
  } rows[] = {{"flat, 3445 sides", ShadingMethod::flat, 3445, kFailsAsKnown},
              {"Gouraud, 251 sides", ShadingMethod::gouraud, 251, kFailsAsKnown},
              {"Phong, 19 sides", ShadingMethod::phong, 19, kHolds}};
  for (const auto& row : rows) {
    const std::vector<float> seen = seen_of(row.method, row.sides, facing_facet(row.sides));
    const double reach = row.method == ShadingMethod::phong ? std::sin(kPi / row.sides) : 1;
    const double predicted = predicted_error(row.method, row.sides, kExponent, centers);
    double largest = 0;
    for (std::size_t i = 0; i < centers.size(); ++i)
      if (std::abs(centers[i]) < reach) largest = std::max(largest, std::abs(double(seen[i]) - double(exact[i])));
    StabilityFigure figure = predicted_figure(
        row.name, "largest error of a highlight, n = 50, in 1/255", 255 * largest, 255 * predicted,
        255 * 2 * float_error(kExponent),
        fmt::format("{:.3f}, below 1 from so many sides on (closed form)", 255 * predicted), row.expectation);
    // As many as are said to be enough.
    figure.high = std::min(figure.high, 1 + 255 * 2 * float_error(kExponent));
    result.figures.push_back(std::move(figure));
    measured.lines.push_back({row.name, {{row.sides, 255 * largest}}, false});
  }
  if (run.pictures) show_sides_needed(result, run, kExponent, std::move(measured));
  return result;
}

}  // namespace

std::vector<StabilityCase> highlight_cases() {
  return {
      {1, "gouraud-highlight-shape", "A highlight takes the shape of its facets",
       "One corner of four facets faces the light; a sphere of 12 x 8 facets with the lamp at the eye",
       "Interpolate normals in place of light", "Phong 1973, sec. I.2, fig. 1.8 to 1.10", highlight_shape},
      {2, "gouraud-highlight-loss", "A highlight inside a facet is lost",
       "A cylinder of 8 sides, one of which faces the lamp and has its corners 22.5 degrees off",
       "Interpolate normals in place of light", "Phong 1973, sec. IV.4", lost_highlight},
      {3, "gouraud-flicker", "A highlight flickers as a prism turns",
       "A prism of three sides turns before a lamp at the eye", "Interpolate normals in place of light",
       "Phong 1973, fig. 1.11", prism_flicker},
      {6, "facets-needed", "The facets that a highlight needs",
       "A cylinder of as many sides as are said to bring a highlight within 1/255 everywhere",
       "Interpolated normals: 19 sides in place of 251 or 3445",
       "closed forms: flat ~ 1 / k, Gouraud ~ 1 / k^2, Phong ~ 1 / k^3", sides_needed},
  };
}

}  // namespace raytree::benchmarks::facets
