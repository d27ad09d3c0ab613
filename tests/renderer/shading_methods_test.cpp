// The four ways to shade a facet: which normals each sees, closed forms of Gouraud's interpolated light, shadows and
// reflections with each, Warnock's distance term, and bits that do not depend on threads.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>

#include "renderer/scene_fields.h"
#include "tests/renderer/facet_scenes.h"

namespace raytree {
namespace {

constexpr ShadingMethod kMethods[] = {ShadingMethod::flat, ShadingMethod::gouraud, ShadingMethod::phong,
                                      ShadingMethod::limit};

/// Largest angles over the side that faces the viewer of a cylinder of so many sides: of its shading normals against
/// those of the exact cylinder in the same pixel, and against the radius through the hit.
struct NormalErrors {
  double in_picture = 0, at_hit = 0;
};
NormalErrors normal_errors(int sides, ShadingMethod method) {
  const int width = 2000;
  const SceneDescription scene =
      test::headlit_scene(test::faceted_cylinder(sides, method, 180.0 / sides), width, 2, 0.002);
  const RenderResult result = test::rendered(scene);
  NormalErrors errors;
  for (int x = 0; x < width; ++x) {
    const double place = (x + 0.5 - width / 2.0) * 0.001;
    if (std::abs(place) > 0.999 * std::sin(kPi / sides)) continue;
    const Rgb normal = test::color_at(result.film, x, 0, ChannelGroup::normal);
    const double depth = result.film.plane(ChannelGroup::depth, 0)[x], seen = std::atan2(normal.r, normal.b);
    errors.in_picture = std::max(errors.in_picture, std::abs(seen - std::asin(place)));
    errors.at_hit = std::max(errors.at_hit, std::abs(seen - std::atan2(place, 10 - depth)));
  }
  return errors;
}

// Row 6 of the catalogue: theta = pi / k is half of what a side turns by. A flat normal is off by it; an interpolated
// one, which points along the radius through the hit as the true one does, by theta^3 / (3 sqrt 3), since the hit lies
// off the surface.
TEST(ShadingMethods, NormalsAreOffByTheirClosedForms) {
  for (const int sides : {8, 16, 32}) {
    const double theta = kPi / sides, exact = theta * theta * theta / (3 * std::sqrt(3.0));
    const NormalErrors flat = normal_errors(sides, ShadingMethod::flat),
                       phong = normal_errors(sides, ShadingMethod::phong),
                       limit = normal_errors(sides, ShadingMethod::limit);
    std::printf("  cylinder of %d: normals off by %.4f rad flat, %.5f phong (theta^3 / 3 sqrt 3 = %.5f)\n", sides,
                flat.in_picture, phong.in_picture, exact);
    EXPECT_NEAR(flat.in_picture, theta, 0.01 * theta);
    // The next term of the series is of the order theta^5.
    EXPECT_NEAR(phong.in_picture, exact, 0.8 * theta * theta * exact + 2e-6);
    EXPECT_LT(limit.at_hit, 3e-6) << "depth is a float near 10";
    EXPECT_LT(phong.at_hit, 3e-6);
  }
}

/// A bicubic height field over the unit square: x and y are u and v, so that in a picture from above each pixel has its
/// parameters, however coarse the facets.
SceneDescription height_field(int rate, ShadingMethod method, double (&heights)[4][4]) {
  PatchesShape patches;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) {
      heights[j][i] = 0.3 * std::sin(2.1 * i + 1) * std::cos(1.3 * j);
      patches.positions.push_back({i / 3.0 - 0.5, j / 3.0 - 0.5, heights[j][i]});
    }
  patches.bezier = {{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}};
  ShapeDescription shape = test::shape(std::move(patches), "paint");
  shape.shading = method;
  SceneDescription scene = test::headlit_scene(std::move(shape), 50, 50, 1);
  scene.render.tessellation.rate = rate;
  return scene;
}

TEST(ShadingMethods, LimitNormalsAreThoseOfTheSurfaceHoweverCoarseItsFacets) {
  const auto blend = [](double t, double(&values)[4], double(&slopes)[4]) {
    const double s = 1 - t;
    const double v[4] = {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
    const double d[4] = {-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t};
    std::copy(v, v + 4, values), std::copy(d, d + 4, slopes);
  };
  double errors[2] = {0, 0};
  for (const int by_limit : {0, 1}) {
    double heights[4][4];
    const SceneDescription scene = height_field(2, by_limit ? ShadingMethod::limit : ShadingMethod::phong, heights);
    const Film film = test::rendered(scene).film;
    for (int y = 0; y < 50; ++y)
      for (int x = 0; x < 50; ++x) {
        double bu[4], du[4], bv[4], dv[4], hu = 0, hv = 0;
        blend((x + 0.5) / 50, bu, du);
        blend((49.5 - y) / 50, bv, dv);
        for (int j = 0; j < 4; ++j)
          for (int i = 0; i < 4; ++i) hu += heights[j][i] * du[i] * bv[j], hv += heights[j][i] * bu[i] * dv[j];
        const Vec3d exact = Vec3d(-hu, -hv, 1).normalized();
        const Rgb seen = test::color_at(film, x, y, ChannelGroup::normal);
        errors[by_limit] = std::max(errors[by_limit], (Vec3d(seen.r, seen.g, seen.b) - exact).length());
      }
  }
  std::printf("  bicubic height field at rate 2: normals off by %.3f rad with phong, %.1e with limit\n", errors[0],
              errors[1]);
  EXPECT_GT(errors[0], 0.1);
  EXPECT_LT(errors[1], 1e-5);
}

/// A cube as a Catmull-Clark cage, its faces cut in rate x rate quads.
SceneDescription subdivided_cube(int rate, ShadingMethod method) {
  ShapeDescription cage = test::mesh_shape(std::make_shared<PolygonMesh>(), "paint", NormalSource::smooth);
  PolygonMesh& mesh = *std::get<MeshShape>(cage.kind).mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back(Vec3f(i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f));
  mesh.face_sizes.assign(6, 4);
  mesh.corners.assign({0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6});
  std::get<MeshShape>(cage.kind).subdivision.emplace();
  cage.shading = method;
  SceneDescription scene = test::headlit_scene(std::move(cage), 64, 64, 1.6);
  scene.render.tessellation.rate = rate;
  return scene;
}

TEST(ShadingMethods, OnFineFacetsLimitAndPhongMeet) {
  const double coarse = test::largest_difference(test::green(subdivided_cube(2, ShadingMethod::limit)),
                                                 test::green(subdivided_cube(2, ShadingMethod::phong))),
               fine = test::largest_difference(test::green(subdivided_cube(48, ShadingMethod::limit)),
                                               test::green(subdivided_cube(48, ShadingMethod::phong)));
  EXPECT_GT(coarse, 0.02);
  EXPECT_LT(fine, 2e-3);
}

TEST(ShadingMethods, LimitNormalsFollowMirroringTransformsAndInstances) {
  const auto turned = [](bool instanced, bool mirrored) {
    SceneDescription scene = subdivided_cube(2, ShadingMethod::limit);
    Matrix44d m;
    m.scale(Vec3d(mirrored ? -0.6 : 0.6, 0.9, 0.5));
    m.rotate(Vec3d(0.3, 0.5, 0.2));
    scene.shapes[0].transform = m;
    if (instanced) {
      GroupDescription group;
      group.name = "group";
      group.shapes = {scene.shapes[0]};
      group.shapes[0].transform = Matrix44d();
      scene.groups = {group};
      scene.shapes[0] = test::shape(InstanceShape{"group"}, "");
      scene.shapes[0].transform = m;
    }
    return test::green(scene);
  };
  for (const bool mirrored : {false, true}) {
    const std::vector<float> plain = turned(false, mirrored), instanced = turned(true, mirrored);
    EXPECT_LT(test::largest_difference(plain, instanced), 1e-3);
    // The cube is its own mirror image, and so is each facet's surface, but not the way its quads are cut.
    double sum = 0;
    for (const float value : plain) sum += value;
    EXPECT_GT(sum, 200);
  }
}

TEST(ShadingMethods, WithoutTheKeyMeshesArePhongOrFlatAsTheirNormalsSay) {
  const auto globe = [](NormalSource normals, std::optional<ShadingMethod> method, std::optional<ShadingMethod> all) {
    ShapeDescription mesh = test::mesh_shape(test::globe_mesh(1, 8, 6), "paint", normals);
    mesh.shading = method;
    std::get<MeshShape>(mesh.kind).crease_angle = 180;
    SceneDescription scene = test::headlit_scene(std::move(mesh), 40, 40, 2.2);
    scene.render.facets.shading = all;
    return test::green(scene);
  };
  const auto none = std::nullopt;
  const std::vector<float> smooth = globe(NormalSource::smooth, none, none),
                           flat = globe(NormalSource::flat, none, none);
  EXPECT_GT(test::largest_difference(smooth, flat), 0.05);
  EXPECT_EQ(globe(NormalSource::smooth, ShadingMethod::phong, none), smooth);
  EXPECT_EQ(globe(NormalSource::flat, ShadingMethod::phong, none), smooth)
      << "the shape's word on shading is the stronger";
  EXPECT_EQ(globe(NormalSource::smooth, ShadingMethod::flat, none), flat);
  EXPECT_EQ(globe(NormalSource::smooth, ShadingMethod::gouraud, ShadingMethod::flat), flat)
      << "the scene's even more so";
  EXPECT_EQ(globe(NormalSource::smooth, ShadingMethod::limit, none), smooth) << "polygons have no surface behind them";
}

/// One triangle in the plane z = 0 with normals of its own.
ShapeDescription leaning_triangle(const std::array<Vec3f, 3>& normals, ShadingMethod method) {
  auto mesh = test::triangles({{-2, -1, 0}, {2, -1, 0}, {0, 2, 0}}, {0, 1, 2});
  mesh->normals.assign(normals.begin(), normals.end());
  ShapeDescription result = test::mesh_shape(std::move(mesh), "paint", NormalSource::file);
  result.shading = method;
  return result;
}
constexpr double kLean[3] = {0.2, 0.7, 1.1};  // radians, about different axes
std::array<Vec3f, 3> leaning_normals() {
  return {Vec3f(Vec3d(std::sin(kLean[0]), 0, std::cos(kLean[0]))),
          Vec3f(Vec3d(0, std::sin(kLean[1]), std::cos(kLean[1]))),
          Vec3f(Vec3d(-std::sin(kLean[2]), 0, std::cos(kLean[2])))};
}

// Gouraud 1971: cos^n at the corners, linear over the triangle between.
TEST(ShadingMethods, GouraudsLightIsTheCornersLightInterpolated) {
  const double exponent = 5;
  const int size = 60;
  SceneDescription scene =
      test::highlit_scene(leaning_triangle(leaning_normals(), ShadingMethod::gouraud), size, size, 4, exponent);
  scene.materials[0].diffuse = Rgb(0.5f);
  const std::vector<float> values = test::green(scene);
  int inside = 0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const double px = (x + 0.5 - size / 2.0) * 4 / size, py = (size / 2.0 - y - 0.5) * 4 / size;
      const double c = (py + 1) / 3, b = (px - -2 + -2 * c) / 4, a = 1 - b - c;
      if (a < 0.01 || b < 0.01 || c < 0.01) continue;
      ++inside;
      double exact = 0;
      const double weights[3] = {a, b, c};
      for (int i = 0; i < 3; ++i)
        exact += weights[i] * (0.5 * std::cos(kLean[i]) + std::pow(std::cos(kLean[i]), exponent));
      EXPECT_NEAR(values[std::size_t(y * size + x)], exact, 2e-5);
    }
  EXPECT_GT(inside, 800);
}

// The corners are seen from the eye: light at an edge that two facets share is one, whichever is hit; and with the
// highlight of a perspective eye it is the corner's own.
TEST(ShadingMethods, GouraudsCornersAreSeenFromTheEye) {
  SceneDescription scene =
      test::highlit_scene(leaning_triangle(leaning_normals(), ShadingMethod::gouraud), 101, 101, 4, 3);
  scene.cameras[0].projection = CameraDescription::Projection::perspective;
  scene.cameras[0].position = {0, 0, 5};
  scene.cameras[0].field_of_view = 60;
  const Vec3d corners[3] = {{-2, -1, 0}, {2, -1, 0}, {0, 2, 0}};
  double exact = 0;
  for (int i = 0; i < 3; ++i) {
    const Vec3d to_eye = (Vec3d(0, 0, 5) - corners[i]).normalized(), halfway = (to_eye + Vec3d(0, 0, 1)).normalized();
    exact += std::pow(halfway.dot(Vec3d(leaning_normals()[std::size_t(i)])), 3) / 3;
  }
  // The middle of the picture shows the middle of the triangle: (0, 0, 0) is a third of each corner.
  EXPECT_NEAR(test::green(scene)[50 * 101 + 50], exact, 1e-5);
}

TEST(ShadingMethods, ShadowsFallAndMirrorsShowWithEach) {
  for (const ShadingMethod method : kMethods) {
    SceneDescription scene = test::headlit_scene(test::faceted_sphere(12, 8, method), 41, 41, 3);
    // A small disc before the middle takes the light of a lamp behind it, off the viewer's way.
    scene.lights = {test::directional_light({-1, 0, -1})};
    const float lit = test::green(scene)[20 * 41 + 20];
    scene.shapes.push_back(test::shape(DiscShape{{2, 0, 3}, {1, 0, 1}, 0.3}, "paint", "disc"));
    const float shadowed = test::green(scene)[20 * 41 + 20];
    EXPECT_GT(lit, 0.5) << enum_name(method);
    EXPECT_EQ(shadowed, 0) << enum_name(method);
    // The sphere in a mirror that faces the viewer from behind it shows its unlit back, lit by a lamp of its own.
    SceneDescription mirrored = test::headlit_scene(test::faceted_sphere(12, 8, method), 41, 41, 6);
    mirrored.materials.push_back(test::material("mirror", Rgb(0)));
    mirrored.materials[1].reflection = Rgb(1);
    mirrored.shapes[0].transform.translate(Vec3d(3, 0, 0));
    ShapeDescription mirror = test::shape(PlaneShape{{0, 0, 0}, {-1, 0, 0}}, "mirror", "mirror");
    mirror.kind = PlaneShape{{0, 0, -2}, {1, 0, 1}};
    mirrored.shapes.push_back(mirror);
    mirrored.lights = {test::directional_light({1, 0, 0})};
    mirrored.render.shadows = false;  // the mirror would stand in its light
    EXPECT_GT(test::largest(test::green(mirrored)), 0.5) << enum_name(method);
  }
}

// Seen from within, normals turn to the viewer, those of the corners too.
TEST(ShadingMethods, InsidesAreLitByALampWithin) {
  for (const ShadingMethod method : kMethods)
    for (const ShadowTerminator terminator : {ShadowTerminator::classic, ShadowTerminator::offset}) {
      SceneDescription scene = test::headlit_scene(test::faceted_sphere(16, 8, method), 30, 30, 1);
      scene.cameras[0].projection = CameraDescription::Projection::perspective;
      scene.cameras[0].position = {0, 0, 0};
      scene.cameras[0].target = {0.3, 0.2, -1};
      scene.cameras[0].field_of_view = 60;
      scene.lights = {test::point_light({0, 0, 0})};
      scene.render.facets.shadow_terminator = terminator;
      for (const float value : test::green(scene)) {
        EXPECT_GT(value, std::cos(kPi / 8)) << enum_name(method);
        if (method == ShadingMethod::gouraud) {
          EXPECT_NEAR(value, 1, 1e-5);
        }
      }
    }
}

// A mirror of facets: flat shows each facet's own plane, gouraud and phong one interpolated normal, limit the true one.
TEST(ShadingMethods, ReflectionsFollowTheNormalOfTheMethod) {
  const auto picture = [](ShadingMethod method) {
    ConeShape cone{{0, -2, 0}, {0, 2, 0}, 1.5, 0.5, 8};
    ShapeDescription shape = test::shape(cone, "paint");
    shape.shading = method;
    SceneDescription scene = test::headlit_scene(std::move(shape), 200, 3, 0.03);
    scene.materials = {test::material("paint", Rgb(0))};
    scene.materials[0].reflection = Rgb(1);
    scene.background = GradientBackground{Rgb(0), Rgb(0.5f), Rgb(1)};
    scene.shapes[0].transform.rotate(Vec3d(0, 0, kPi / 3));  // leans, so that heights of directions tell normals apart
    return test::green(scene);
  };
  const std::vector<float> flat = picture(ShadingMethod::flat), gouraud = picture(ShadingMethod::gouraud),
                           phong = picture(ShadingMethod::phong), limit = picture(ShadingMethod::limit);
  EXPECT_EQ(gouraud, phong);
  EXPECT_GT(test::largest_difference(flat, phong), 0.05);
  EXPECT_GT(test::largest_difference(limit, phong), 5e-4);
  EXPECT_LT(test::largest_difference(limit, phong), 0.5 * test::largest_difference(flat, limit));
}

// Warnock: parallel planes that face the light alike differ by their distance from it.
TEST(ShadingMethods, WarnocksTermTellsParallelPlanesApart) {
  for (const bool lamp_at_eye : {true, false}) {
    const auto shades = [&](double half_distance, bool flat = true) {
      SceneDescription scene = test::headlit_scene(
          test::mesh_shape(test::grid_mesh(1, 1, [](int, int) { return 0.0; }), "paint"), 20, 20, 4);
      scene.shapes[0].transform.translate(Vec3d(-1, 0, 0));
      scene.shapes.push_back(
          test::mesh_shape(test::grid_mesh(1, 1, [](int, int) { return 5.0; }), "paint", NormalSource::flat, "near"));
      scene.shapes[1].transform.translate(Vec3d(1, 0, 0));
      for (ShapeDescription& shape : scene.shapes) shape.half_distance = half_distance;
      if (!flat) scene.render.facets.shading = ShadingMethod::phong;
      if (lamp_at_eye) scene.lights = {test::point_light({0, 0, 1e6})};
      const std::vector<float> values = test::green(scene);
      return std::pair(values[10 * 20 + 5], values[10 * 20 + 15]);
    };
    const auto [far_plain, near_plain] = shades(0);
    EXPECT_NEAR(far_plain, near_plain, 1e-6);
    const auto [far_shade, near_shade] = shades(lamp_at_eye ? 1e6 : 10);
    EXPECT_EQ(shades(10, false), shades(0, false)) << "the term is flat shading's alone";
    if (lamp_at_eye) {
      EXPECT_NEAR(far_shade, 0.5, 1e-5);
      continue;
    }
    // The directional light shines from the eye's side: the distance is that from the eye, at (0, 0, 10).
    EXPECT_NEAR(far_shade, far_plain / (1 + std::hypot(10, 1) / 10), 0.01);
    EXPECT_NEAR(near_shade, near_plain / (1 + std::hypot(5, 1) / 10), 0.01);
  }
}

TEST(ShadingMethods, ContradictoryKeysAreRefused) {
  const auto refuse = [](ShapeDescription shape, const std::string& message) {
    try {
      test::prepared(test::headlit_scene(std::move(shape), 8, 8, 2));
      FAIL() << message;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  };
  ShapeDescription fading = test::faceted_sphere(8, 4, ShadingMethod::phong);
  fading.half_distance = 3;
  refuse(fading, "half_distance is for flat shading");
  ShapeDescription polygons = test::mesh_shape(test::globe_mesh(1, 8, 6), "paint");
  polygons.smoothing.emplace().method = Smoothing::Method::analytic;
  refuse(polygons, "no surface to take them from");
  refuse(test::faceted_sphere(2, 4, ShadingMethod::flat), "sides must be at least 3");
  refuse(test::faceted_sphere(8, 1, ShadingMethod::flat), "stacks must be at least 2");
}

TEST(ShadingMethods, VertexNormalsByEveryMethodReachThePicture) {
  const auto picture = [](Smoothing::Method method, double crease = 180) {
    ShapeDescription cone = test::faceted_sphere(7, 5, ShadingMethod::gouraud);
    cone.smoothing.emplace() = {method, crease, false};
    return test::green(test::headlit_scene(std::move(cone), 48, 48, 2.2));
  };
  std::vector<std::vector<float>> pictures;
  for (const auto& entry : EnumTable<Smoothing::Method>::entries) pictures.push_back(picture(entry.value));
  for (std::size_t i = 0; i < pictures.size(); ++i)
    for (std::size_t k = i + 1; k < pictures.size(); ++k) {
      // Facets are plane here, and edges as long on both sides of a meridian.
      if ((i == 1 && k == 5) || (i == 4 && k == 6)) continue;
      EXPECT_GT(test::largest_difference(pictures[i], pictures[k]), 1e-4) << i << " and " << k;
    }
  EXPECT_GT(test::largest_difference(pictures[0], picture(Smoothing::Method::angle, 5)), 0.05);
}

// A prism's n-gon cap and its quads, with values that differ from corner to corner.
TEST(ShadingMethods, InterpolationReachesQuadsAndLargerPolygons) {
  for (const int count : {3, 4, 7}) {
    const auto picture = [&](FacetInterpolation interpolation, double turned) {
      auto mesh = std::make_shared<PolygonMesh>();
      mesh->face_sizes.push_back(std::uint32_t(count));
      for (int i = 0; i < count; ++i) {
        const double angle = 2 * kPi * i / count, lean = i % 2 == 0 ? 0 : 1.2;
        mesh->positions.push_back(Vec3f(Vec3d(std::cos(angle), std::sin(angle), 0)));
        mesh->normals.push_back(Vec3f(Vec3d(0, std::sin(lean), std::cos(lean))));
        mesh->corners.push_back(std::uint32_t(i));
      }
      ShapeDescription polygon = test::mesh_shape(std::move(mesh), "paint", NormalSource::file);
      polygon.shading = ShadingMethod::gouraud;
      polygon.interpolation = interpolation;
      polygon.transform.rotate(Vec3d(0, 0, turned * kPi / 180));
      SceneDescription scene = test::headlit_scene(std::move(polygon), 21, 21, 2.2);
      // The light stays with the polygon: only rows of the picture turn against it.
      return test::green(scene)[10 * 21 + 10];
    };
    float least = 1, most = 0;
    for (int degrees = 2; degrees < 90; degrees += 4) {
      const float value = picture(FacetInterpolation::scanline, degrees);
      least = std::min(least, value), most = std::max(most, value);
    }
    EXPECT_EQ(most - least > 0.02f, count > 3) << count << ": " << most - least;
    for (const FacetInterpolation fixed : {FacetInterpolation::barycentric, FacetInterpolation::bilinear})
      EXPECT_NEAR(picture(fixed, 10), picture(fixed, 40), 2e-3) << count;
  }
}

TEST(ShadingMethods, PicturesDoNotDependOnThreadsOrTiles) {
  SceneDescription scene = test::highlit_scene(test::faceted_sphere(9, 6, ShadingMethod::gouraud), 96, 80, 3, 8);
  scene.shapes[0].interpolation = FacetInterpolation::scanline;
  scene.shapes[0].transform.translate(Vec3d(-0.5, 0, 0));
  scene.shapes.push_back(test::faceted_sphere(7, 5, ShadingMethod::limit));
  scene.shapes[1].transform.translate(Vec3d(0.8, 0.3, 0));
  scene.shapes.push_back(test::faceted_cylinder(5, ShadingMethod::phong));
  scene.shapes[2].interpolation = FacetInterpolation::bilinear;
  scene.shapes[2].transform.translate(Vec3d(0, 0, -1));
  for (std::size_t i = 0; i < 3; ++i) scene.shapes[i].name = "shape " + std::to_string(i);
  scene.materials[0].reflection = Rgb(0.5f);
  scene.render.facets.shadow_terminator = ShadowTerminator::offset;
  scene.render.facets.reflections = FacetReflections::consistent;
  scene.render.antialias = {Antialiasing::Method::whitted, 1};
  const Scene prepared = test::prepared(scene);
  RenderOptions options;
  options.channels = test::all_channels();
  options.threads = 1;
  const RenderResult one = render(prepared, options);
  test::expect_finite(one.film);
  options.threads = 3;
  options.tile_order_seed = 7;
  EXPECT_EQ(test::differing_pixels(one.film, render(prepared, options).film), 0u);
  options.window = {32, 32, 40, 32};
  EXPECT_EQ(test::differing_pixels(one.film, render(prepared, options).film), 0u);
}

}  // namespace
}  // namespace raytree
