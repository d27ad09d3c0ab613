// The famous faults of interpolated light, as numbers, beside what normals interpolated in its place give: rows 1 to 6
// of the catalogue of failures. Each prints what docs/shading.md quotes.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "renderer/scene_fields.h"
#include "tests/renderer/facet_scenes.h"

namespace raytree {
namespace {

/// Largest over smallest radius, about the picture's middle, at which values fall below `level`.
double contour_ratio(const SceneDescription& scene, double level) {
  const std::vector<float> values = test::green(scene);
  const int size = scene.image.width;
  double least = size, most = 0;
  for (int degrees = 0; degrees < 360; ++degrees) {
    const double dx = std::cos(degrees * kPi / 180), dy = std::sin(degrees * kPi / 180);
    const auto at = [&](double r) {
      const int x = static_cast<int>(std::floor(size / 2.0 + dx * r)),
                y = static_cast<int>(std::floor(size / 2.0 + dy * r));
      return values[std::size_t(y * size + x)];
    };
    double radius = 0;
    while (radius < size / 2.0 - 1 && at(radius) >= level) radius += 0.25;
    least = std::min(least, radius), most = std::max(most, radius);
  }
  return most / least;
}

/// Four quads about a corner that faces the light, with all corners around in the dark.
SceneDescription one_lit_corner(FacetInterpolation interpolation) {
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
  ShapeDescription shape = test::mesh_shape(std::move(mesh), "paint", NormalSource::file);
  shape.shading = ShadingMethod::gouraud;
  shape.interpolation = interpolation;
  return test::headlit_scene(std::move(shape), 601, 601, 2.1);
}

// Row 1. A contour of the light of one corner is a square over triangles and an astroid over quads; on the sphere of
// Phong's figures 1.8 to 1.10 a cross. Normals give the circle back.
TEST(HighlightFaults, GouraudsHighlightHasTheShapeOfItsFacets) {
  const double c = 0.5;
  const double triangles = contour_ratio(one_lit_corner(FacetInterpolation::barycentric), c),
               quads = contour_ratio(one_lit_corner(FacetInterpolation::bilinear), c);
  const double exact = (1 - c) / (std::sqrt(2.0) * (1 - std::sqrt(c)));
  std::printf("  row 1: contour r_max / r_min %.3f over triangles (sqrt 2), %.3f over quads (%.3f)\n", triangles, quads,
              exact);
  EXPECT_NEAR(triangles, std::sqrt(2.0), 0.02);
  EXPECT_NEAR(quads, exact, 0.02);

  const auto on_sphere = [](ShadingMethod method) {
    ShapeDescription sphere = test::faceted_sphere(12, 8, method);
    sphere.interpolation =
        method == ShadingMethod::limit ? FacetInterpolation::barycentric : FacetInterpolation::bilinear;
    return contour_ratio(test::highlit_scene(std::move(sphere), 601, 601, 1.2, 20), 0.7);
  };
  const double gouraud = on_sphere(ShadingMethod::gouraud), phong = on_sphere(ShadingMethod::phong),
               limit = on_sphere(ShadingMethod::limit);
  std::printf("  row 1: on a sphere of 12 x 8: %.3f gouraud, %.3f phong, %.3f limit\n", gouraud, phong, limit);
  EXPECT_GT(gouraud, 1.25);
  EXPECT_LT(phong, 1.12);
  EXPECT_LT(limit, 1.06);
}

// Row 2. A side that faces the light has both its corners pi / k off: cos^n of that is all that is left.
TEST(HighlightFaults, GouraudLosesTheHighlightInsideAFacet) {
  const int sides = 8;
  const double exponent = 50;
  const auto peak = [&](ShadingMethod method) {
    return test::largest(test::green(
        test::highlit_scene(test::faceted_cylinder(sides, method, 180.0 / sides), 401, 1, 0.005, exponent)));
  };
  const double left = std::pow(std::cos(kPi / sides), exponent);
  std::printf("  row 2: peak of the highlight %.4f gouraud (cos^n pi / k = %.4f), %.4f phong\n",
              peak(ShadingMethod::gouraud), left, peak(ShadingMethod::phong));
  EXPECT_NEAR(peak(ShadingMethod::gouraud), left, 1e-4);
  EXPECT_NEAR(peak(ShadingMethod::phong), 1, 1e-4);
  EXPECT_NEAR(peak(ShadingMethod::limit), 1, 1e-4);
}

// Row 3. The prism of Phong's figure 1.11, turned by a degree a frame.
TEST(HighlightFaults, GouraudsHighlightFlickersOnATurningPrism) {
  for (const double exponent : {1.0, 5.0}) {
    const auto swing = [&](ShadingMethod method) {
      float least = 1, most = 0;
      for (int degrees = 0; degrees < 120; ++degrees) {
        const float peak = test::largest(
            test::green(test::highlit_scene(test::faceted_cylinder(3, method, degrees), 801, 1, 0.0025, exponent)));
        least = std::min(least, peak), most = std::max(most, peak);
      }
      return double(most - least);
    };
    const double exact = 1 - std::pow(std::cos(kPi / 3), exponent);
    const double gouraud = swing(ShadingMethod::gouraud), phong = swing(ShadingMethod::phong);
    std::printf("  row 3: swing of the peak at n = %g: %.3f gouraud (1 - cos^n pi / 3 = %.3f), %.4f phong\n", exponent,
                gouraud, exact, phong);
    EXPECT_NEAR(gouraud, exact, 0.02);
    EXPECT_LT(phong, 0.002);
  }
}

/// Over the middle half of a matte cylinder: the largest step between pixels, and the largest change of slope between
/// them, per unit of x.
struct Breaks {
  double value = 0, slope = 0;
};
Breaks breaks(int sides, ShadingMethod method) {
  const int width = 4000;
  const std::vector<float> values =
      test::green(test::headlit_scene(test::faceted_cylinder(sides, method, 3), width, 1, 2.0 / width));
  Breaks result;
  constexpr int kSpan = 8;  // pixels: far above rounding, far below a side
  for (int x = width / 4; x < 3 * width / 4; ++x) {
    const auto value = [&](int i) { return double(values[std::size_t(i)]); };
    result.value = std::max(result.value, std::abs(value(x + 1) - value(x)));
    const double slope_change = (value(x + kSpan) - 2 * value(x) + value(x - kSpan)) / kSpan;
    result.slope = std::max(result.slope, std::abs(slope_change) * width / 2);
  }
  return result;
}

// Rows 4 and 5. Flat sides leave steps that fall with their number alone; interpolated light leaves breaks of slope,
// which fall as fast, and interpolated normals next to none.
TEST(HighlightFaults, MachBandsStandWhereValuesOrSlopesBreak) {
  Breaks gouraud_before;
  for (const int sides : {16, 32, 64}) {
    const Breaks flat = breaks(sides, ShadingMethod::flat), gouraud = breaks(sides, ShadingMethod::gouraud),
                 phong = breaks(sides, ShadingMethod::phong), limit = breaks(sides, ShadingMethod::limit);
    std::printf(
        "  rows 4, 5: %2d sides: step %.4f flat, %.4f gouraud; break of slope %.4f gouraud, %.4f phong, %.4f limit\n",
        sides, flat.value, gouraud.value, gouraud.slope, phong.slope, limit.slope);
    // At most where the angle is 30 degrees and a side turns by 2 pi / k.
    EXPECT_NEAR(flat.value, 2 * std::sin(kPi / 6) * std::sin(kPi / sides), 0.35 * flat.value);
    EXPECT_LT(gouraud.value, 1e-3);
    EXPECT_GT(gouraud.slope, 3 * phong.slope);
    if (gouraud_before.slope > 0) {
      EXPECT_NEAR(gouraud_before.slope / gouraud.slope, 2, 0.3);
    }
    gouraud_before = gouraud;
  }
}

// Row 6: the number of sides from which on a highlight of exponent 50 is right to a step of a display, 1/255.
TEST(HighlightFaults, SidesThatAHighlightNeeds) {
  const auto error = [](ShadingMethod method, int sides) {
    const int width = 6000;
    const auto picture = [&](int count) {
      return test::green(
          test::highlit_scene(test::faceted_cylinder(count, method, -90 - 180.0 / sides), width, 1, 1.6 / width, 50));
    };
    const std::vector<float> seen = picture(sides), exact = picture(0);
    // Where steps are large, and thus few, beside the side that faces the viewer hits lie visibly off the circle, which
    // is no fault of the shading.
    const double reach = method == ShadingMethod::phong ? std::sin(kPi / sides) : 0.8;
    double largest = 0;
    for (int x = 0; x < width; ++x)
      if (std::abs((x + 0.5) / width - 0.5) * 1.6 < reach)
        largest = std::max(largest, std::abs(double(seen[std::size_t(x)]) - double(exact[std::size_t(x)])));
    return largest;
  };
  const struct {
    ShadingMethod method;
    int enough, too_few;
  } rows[] = {{ShadingMethod::flat, 3445, 3200}, {ShadingMethod::gouraud, 251, 235}, {ShadingMethod::phong, 19, 17}};
  for (const auto& [method, enough, too_few] : rows) {
    const double right = error(method, enough), wrong = error(method, too_few);
    std::printf("  row 6: %s: light off by %.5f at %d sides, %.5f at %d (1/255 = %.5f)\n",
                std::string(enum_name(method)).c_str(), right, enough, wrong, too_few, 1 / 255.0);
    EXPECT_LT(right, 1.02 / 255);
    EXPECT_GT(wrong, 1 / 255.0);
  }
}

// Row 11: a tail fin on a plate that share vertices (Gouraud 1971, figure 11). Row 13: one wrong normal paints a dent.
TEST(HighlightFaults, NormalsAveragedOverARightAngleAreHalfOfItOff) {
  const auto plate = [](double crease) {
    auto mesh = std::make_shared<PolygonMesh>();
    mesh->positions.assign(
        {Vec3f(-1, -1, 0), Vec3f(1, -1, 0), Vec3f(1, 0, 0), Vec3f(-1, 0, 0), Vec3f(1, 0, -1), Vec3f(-1, 0, -1)});
    mesh->face_sizes.assign(2, 4);
    mesh->corners.assign({0, 1, 2, 3, 3, 2, 4, 5});
    ShapeDescription shape = test::mesh_shape(std::move(mesh), "paint", NormalSource::smooth);
    shape.smoothing.emplace() = {Smoothing::Method::unit, crease, false};
    SceneDescription scene = test::headlit_scene(std::move(shape), 40, 40, 2.1);
    const Film film = test::rendered(scene).film;
    // Just below the edge that both share.
    const Rgb normal = test::color_at(film, 20, 20, ChannelGroup::normal);
    return std::acos(std::min(1.0f, normal.b)) * 180 / kPi;
  };
  std::printf("  row 11: normal at the foot off by %.1f deg averaged, %.1f deg with a crease angle of 40\n", plate(180),
              plate(40));
  EXPECT_NEAR(plate(180), 45, 3);
  EXPECT_NEAR(plate(40), 0, 0.1);
}

}  // namespace
}  // namespace raytree
