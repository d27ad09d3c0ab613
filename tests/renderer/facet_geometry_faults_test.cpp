// What facets do to outlines, and bad normals and crooked quads to shading: rows 7, 13, 15 and 16 of the catalogue of
// failures, with the remedy beside the fault.
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/scene_fields.h"
#include "tests/renderer/facet_scenes.h"

namespace raytree {
namespace {

// Row 7: an outline of k sides lies up to R (1 - cos pi / k) inside its circle; an exact disc has none of it.
TEST(FacetGeometryFaults, OutlinesOfFacetsLieInsideTheirCircle) {
  const int size = 501;
  const double pixels = 240;  // the radius in the picture
  const auto error = [&](int sides) {
    DiscShape disc{{0, 0, 0}, {0, 0, 1}, 1, sides};
    const SceneDescription scene = test::headlit_scene(test::shape(disc, "paint"), size, size, size / pixels);
    const std::vector<float> values = test::green(scene);
    double nearest = size;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        if (values[std::size_t(y * size + x)] == 0)
          nearest = std::min(nearest, std::hypot(x + 0.5 - size / 2.0, y + 0.5 - size / 2.0));
    return pixels - nearest;
  };
  for (const int sides : {8, 16, 32, 64}) {
    const double exact = pixels * (1 - std::cos(kPi / sides)), seen = error(sides);
    std::printf("  row 7: outline of %2d sides off by %.2f pixels of %g (R (1 - cos pi / k) = %.2f)\n", sides, seen,
                pixels, exact);
    EXPECT_NEAR(seen, exact, 0.5);
  }
  EXPECT_NEAR(error(0), 0, 0.5);
}

// Row 13: one vertex normal turned by 30 degrees paints a dent in a flat plate (Gouraud 1971, figure 12); normals made
// of the facets mend it.
TEST(FacetGeometryFaults, AWrongNormalPaintsADent) {
  const auto deviation = [](bool mended, ShadingMethod method) {
    auto mesh = test::grid_mesh(4, 0.5, [](int, int) { return 0.0; });
    mesh->normals.assign(25, Vec3f(0, 0, 1));
    mesh->normals[12] = Vec3f(Vec3d(std::sin(kPi / 6), 0, std::cos(kPi / 6)));
    ShapeDescription plate = test::mesh_shape(std::move(mesh), "paint", NormalSource::file);
    plate.shading = method;
    if (mended) plate.smoothing.emplace();
    SceneDescription scene = test::headlit_scene(std::move(plate), 100, 100, 2);
    scene.lights = {test::directional_light({-1, 0, -1})};
    const double flat = std::sqrt(0.5);
    double square = 0;
    for (const float value : test::green(scene)) square += (value - flat) * (value - flat);
    return std::sqrt(square / 1e4);
  };
  for (const ShadingMethod method : {ShadingMethod::gouraud, ShadingMethod::phong}) {
    std::printf("  row 13: %s: a normal off by 30 deg leaves %.4f of the light off on average, mended %.1e\n",
                std::string(enum_name(method)).c_str(), deviation(false, method), deviation(true, method));
    EXPECT_GT(deviation(false, method), 0.02);
    EXPECT_LT(deviation(true, method), 1e-6);
  }
}

// Row 15: a saddle of height h is h / 2 high in its middle; two triangles put that at 0 or h. As a bilinear surface,
// tessellated, it is what it should be.
TEST(FacetGeometryFaults, TwoTrianglesAreNoCrookedQuad) {
  const auto middle_depth = [](bool surface) {
    auto mesh = std::make_shared<PolygonMesh>();
    mesh->positions.assign({Vec3f(-1, -1, 0), Vec3f(1, -1, 0.5f), Vec3f(1, 1, 0), Vec3f(-1, 1, 0.5f)});
    mesh->face_sizes.push_back(4);
    mesh->corners.assign({0, 1, 2, 3});
    ShapeDescription quad = test::mesh_shape(std::move(mesh), "paint", NormalSource::smooth);
    if (surface) {
      SubdivisionRules& rules = std::get<MeshShape>(quad.kind).subdivision.emplace();
      rules.scheme = SubdivisionScheme::bilinear;
      rules.boundary = BoundaryRule::edge_and_corner;
    }
    SceneDescription scene = test::headlit_scene(std::move(quad), 101, 101, 2.2);
    scene.render.tessellation.rate = surface ? 16 : 0;
    const Film film = test::rendered(scene).film;
    return 10 - double(film.plane(ChannelGroup::depth, 0)[test::pixel_index(film, 50, 50)]);
  };
  const double triangles = std::abs(middle_depth(false) - 0.25), surface = std::abs(middle_depth(true) - 0.25);
  std::printf("  row 15: middle of a saddle of height .5 off by %.3f as two triangles, %.1e as a bilinear surface\n",
              triangles, surface);
  EXPECT_NEAR(triangles, 0.25, 1e-5);
  EXPECT_LT(surface, 1e-4);
}

// Row 16: normals that cancel each other between corners leave no pixel without a number, whatever looks at them.
TEST(FacetGeometryFaults, NormalsThatCancelLeaveFinitePixels) {
  for (const auto& shading : EnumTable<ShadingMethod>::entries)
    for (const auto& interpolation : EnumTable<FacetInterpolation>::entries)
      for (const auto& reflections : EnumTable<FacetReflections>::entries) {
        auto mesh = std::make_shared<PolygonMesh>();
        mesh->positions.assign({Vec3f(-1, -1, 0), Vec3f(1, -1, 0), Vec3f(1, 1, 0), Vec3f(-1, 1, 0)});
        mesh->normals.assign({Vec3f(1, 0, 0), Vec3f(-1, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 0, -1)});
        mesh->face_sizes.push_back(4);
        mesh->corners.assign({0, 1, 2, 3});
        ShapeDescription quad = test::mesh_shape(std::move(mesh), "paint", NormalSource::file);
        quad.shading = shading.value;
        quad.interpolation = interpolation.value;
        SceneDescription scene = test::highlit_scene(std::move(quad), 32, 32, 2.2, 20);
        scene.materials[0].reflection = Rgb(0.5f);
        scene.materials[0].diffuse = Rgb(0.5f);
        scene.render.depth = 4;
        scene.render.facets.reflections = reflections.value;
        scene.render.facets.shadow_terminator = ShadowTerminator::offset;
        const RenderResult result = test::rendered(scene);
        test::expect_finite(result.film);
        EXPECT_EQ(result.statistics.not_finite_samples, 0u);
      }
}

}  // namespace
}  // namespace raytree
