// Whole pictures by the sphere-bounded tracer: what Embree shows but for edges, whatever the shapes; the same bits for
// any number of threads and either search; and nothing kept where nobody asks for it.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "geometry/mesh_source.h"
#include "renderer/builtin_scenes.h"
#include "tests/geometry/subdivision_cages.h"
#include "tests/renderer/patch_shapes.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;
using Search = SphereBoundedOptions::Search;

PrepareOptions by_spheres(Search search = Search::automatic) {
  PrepareOptions options;
  options.tracer = Tracer::spheres;
  options.spheres.search = search;
  return options;
}

RenderResult traced(SceneDescription description, const PrepareOptions& prepare_options, int threads = 0,
                    std::uint64_t order = 0) {
  const Scene scene = prepared(std::move(description), nullptr, prepare_options);
  RenderOptions options;
  options.channels = all_channels();
  options.threads = threads;
  options.tile_order_seed = order;
  return render(scene, options);
}

/// Largest difference of any channel between the pixel and one next to it.
float contrast(const Film& film, int x, int y) {
  const Rgb here = color_at(film, x, y);
  float most = 0;
  for (int j = std::max(0, y - 1); j <= std::min(film.window().height - 1, y + 1); ++j)
    for (int i = std::max(0, x - 1); i <= std::min(film.window().width - 1, x + 1); ++i) {
      const Rgb there = color_at(film, i, j);
      most = std::max({most, std::abs(there.r - here.r), std::abs(there.g - here.g), std::abs(there.b - here.b)});
    }
  return most;
}

/// Of a display's 255.
constexpr float kLevel = 1 / 255.0f;

ShapeDescription cube_limit(const std::string& material_name) {
  ShapeDescription result = mesh_shape(std::make_shared<PolygonMesh>(cube_cage()), material_name);
  std::get<MeshShape>(result.kind).subdivision.emplace();
  return result;
}

/// Pixels that differ by more than a level lie at edges of the one picture or the other, and are no more than `share`.
/// make(): the scene; one a picture, since copies share meshes, which prepare() consumes.
template <class Make>
void expect_the_same_picture(const Make& make, double share) {
  const ImageDescription image = make().image;
  const RenderResult a = traced(make(), {}), b = traced(make(), by_spheres());
  int different = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgb p = color_at(a.film, x, y), q = color_at(b.film, x, y);
      const float off = std::max({std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b)});
      if (off <= kLevel) continue;
      ++different;
      EXPECT_GE(std::max(contrast(a.film, x, y), contrast(b.film, x, y)), 2 * kLevel)
          << "pixel " << x << ", " << y << " differs by " << off << " and is no edge";
    }
  EXPECT_LE(different, share * image.width * image.height);
}

SceneDescription lit_scene(int size) {
  CameraDescription camera;
  camera.position = {1, 2.5, 7};
  camera.target = {0, 0, 0};
  camera.field_of_view = 35;
  SceneDescription scene = dark_scene(size, camera);
  scene.ambient = Rgb(0.1f);
  scene.background = ConstantBackground{Rgb(0.3f)};
  scene.render.depth = 4;
  scene.materials = {material("dull", Rgb(0.7f)), material("mirror", Rgb(0.2f)), material("glass", Rgb(0.05f))};
  scene.materials[1].reflection = Rgb(0.6f);
  scene.materials[2].transmission = Rgb(0.8f);
  scene.materials[2].reflection = Rgb(0.1f);
  scene.materials[2].index_of_refraction = 1.3;
  scene.lights = {directional_light({-1, -2, -1.5}), point_light({4, 5, 4}, Rgb(0.3f))};
  scene.shapes = {shape(PlaneShape{{0, -1.2, 0}, {0, 1, 0}}, "dull", "floor")};
  return scene;
}

TEST(SphereBoundedPicture, Spheres1980AsEmbreeHasIt) {
  const auto make = [] {
    SceneDescription scene = builtin_scene("spheres-1980");
    scene.image = {96, 72};
    return scene;
  };
  expect_the_same_picture(make, 0.005);
}

TEST(SphereBoundedPicture, EveryKindOfShape) {
  const auto make = [] {
    SceneDescription scene = lit_scene(64);
    scene.shapes.push_back(shape(SphereShape{{-1.5, 0, -1}, 0.9}, "glass", "ball"));
    scene.shapes.push_back(shape(DiscShape{{1.5, 0.3, -1.5}, {-0.3, 0.2, 1}, 1}, "mirror", "disc"));
    scene.shapes.push_back(shape(ConeShape{{0.8, -1.2, 1}, {0.8, 0, 1}, 0.5, 0.2}, "dull", "cone"));
    scene.shapes.push_back(mesh_shape(globe_mesh(0.7, 24, 12), "mirror", NormalSource::smooth, "globe"));
    scene.shapes.back().transform = translation({-0.3, -0.3, 1.2});
    scene.shapes.push_back(shape(SphereShape{{0.4, 0.9, -0.5}, 0.5, 16}, "dull", "facets"));
    return scene;
  };
  expect_the_same_picture(make, 0.03);
}

/// Quads that are flat but for rounding: what enters their glass does not meet the same quad again.
TEST(SphereBoundedPicture, GlassOfPolygons) {
  const auto make = [] {
    SceneDescription scene = builtin_scene("glass");
    scene.image = {48, 32};
    scene.render.antialias = {Antialiasing::Method::none, 1};
    return scene;
  };
  expect_the_same_picture(make, 0.03);
}

/// Curved surfaces are exact for one tracer and tessellated to a quarter of a pixel for the other; outlines and what
/// is mirrored differ by that. Nothing shadows itself: pixels off edges agree.
TEST(SphereBoundedPicture, CurvedSurfaces) {
  const auto make = [] {
    SceneDescription scene = lit_scene(48);
    scene.render.tessellation.tolerance = 0.05;
    scene.shapes.push_back(shape(round_patches(), "dull", "patches"));
    scene.shapes.back().transform = translation({-1.1, 0, 0});
    scene.shapes.push_back(cube_limit("dull"));
    scene.shapes.back().transform = translation({1.2, -0.1, 0.3});
    return scene;
  };
  expect_the_same_picture(make, 0.04);
}

TEST(SphereBoundedPicture, CurvedSurfacesInInstancesMirroredAndStretched) {
  const auto make = [] {
    SceneDescription scene = lit_scene(40);
    scene.render.tessellation.tolerance = 0.05;
    GroupDescription group{"g", {}, {"test.json", 2, "groups.g"}};
    group.shapes.push_back(shape(round_patches(), "dull", "patches"));
    group.shapes.back().transform = scaling({0.5, -0.8, 0.5});
    group.shapes.push_back(mesh_shape(std::make_shared<PolygonMesh>(cube_cage()), "dull", NormalSource::flat, "cube"));
    group.shapes.back().transform = scaling({0.3, 0.3, 0.3}) * translation({0.9, -0.5, 0});
    scene.groups.push_back(std::move(group));
    for (const double x : {-1.3, 0.9}) {
      scene.shapes.push_back(shape(InstanceShape{"g"}, "", x < 0 ? "left" : "right"));
      scene.shapes.back().transform = scaling({x < 0 ? -1.0 : 1.0, 1.2, 0.8}) * translation({x, 0, 0});
    }
    return scene;
  };
  expect_the_same_picture(make, 0.05);
}

/// Polygons far from flat, lit from the eye's side: what lies on their planes is neither dark nor lost.
TEST(SphereBoundedPicture, PolygonsThatAreNotFlatDoNotShadowThemselves) {
  SceneDescription scene = dark_scene(32, front_camera(0.9));
  scene.materials = {material("dull", Rgb(1))};
  scene.lights = {directional_light({0.2, -0.1, -1})};
  PolygonMesh quads = grid_cage(4, 4, 0.7f);
  for (Vec3f& p : quads.positions) p = (p - Vec3f(1.5f, 1.5f, 0)) * 0.3f;
  scene.shapes = {mesh_shape(std::make_shared<PolygonMesh>(std::move(quads)), "dull")};
  const RenderResult result = traced(std::move(scene), by_spheres());
  int dark = 0;
  for (int y = 1; y < 31; ++y)
    for (int x = 1; x < 31; ++x) dark += color_at(result.film, x, y).r < 0.3f;
  // Two polygons' planes part at their edge, and the higher one may shadow the other there.
  EXPECT_LT(dark, 30);
}

TEST(SphereBoundedPicture, BitsDependOnNeitherThreadsNorSearch) {
  const auto make = [] {
    SceneDescription scene = lit_scene(40);
    scene.shapes.push_back(cube_limit("mirror"));
    scene.shapes.push_back(shape(SphereShape{{-1.6, 0.2, 0}, 0.6}, "glass", "ball"));
    scene.shapes.push_back(mesh_shape(globe_mesh(0.5, 12, 6), "dull", NormalSource::smooth, "globe"));
    scene.shapes.back().transform = translation({1.6, 0, 0.5});
    return scene;
  };
  const tbb::global_control more_threads(tbb::global_control::max_allowed_parallelism, 3);
  const RenderResult reference = traced(make(), by_spheres(Search::linear), 1);
  for (const int threads : {2, 3}) {
    const RenderResult result = traced(make(), by_spheres(Search::hierarchy), threads, 99);
    EXPECT_EQ(differing_pixels(reference.film, result.film), 0u);
    EXPECT_EQ(result.statistics.rays, reference.statistics.rays);
  }
}

/// The naive tracer's own time: Whitted's three quarters and more in intersections, once there is more than a handful
/// of objects.
TEST(SphereBoundedPicture, MostOfTheTimeGoesIntoIntersections) {
  SceneDescription scene = lit_scene(32);
  scene.shapes.push_back(mesh_shape(globe_mesh(1, 48, 24), "dull"));
  const RenderStatistics statistics = traced(std::move(scene), by_spheres(Search::linear)).statistics;
  EXPECT_GT(statistics.intersection_seconds, 0.75 * statistics.thread_seconds);
}

TEST(SphereBoundedPicture, SourcesAreKeptWhereAskedForAlone) {
  const auto make = [] {
    SceneDescription scene = lit_scene(16);
    scene.shapes = {mesh_shape(std::make_shared<PolygonMesh>(cube_cage()), "dull"), cube_limit("dull"),
                    shape(round_patches(), "dull", "patches"), mesh_shape(globe_mesh(1, 8, 4), "dull")};
    return scene;
  };
  const Scene plain = prepared(make());
  for (const MeshEntry& entry : plain.shapes->meshes) EXPECT_EQ(entry.source, nullptr);
  EXPECT_EQ(plain.sphere_pixels, 0);
  PrepareOptions keeping;
  keeping.keep_sources = true;
  const Scene kept = prepared(make(), nullptr, keeping);
  EXPECT_EQ(kept.sphere_pixels, 0) << "Embree's hits lie on triangles";
  ASSERT_EQ(kept.shapes->meshes.size(), 4u);
  const auto& meshes = kept.shapes->meshes;
  ASSERT_TRUE(meshes[0].source && meshes[1].source && meshes[2].source);
  EXPECT_EQ(meshes[0].source->polygon_count(), 6u);
  EXPECT_GE(meshes[1].source->patches.size(), 6u);
  EXPECT_EQ(meshes[2].source->patches.size(), 8u);
  EXPECT_EQ(meshes[1].source->parameters.faces.size(), meshes[1].mesh.triangle_count());
  EXPECT_EQ(meshes[3].source, nullptr) << "triangles are what they were";
  EXPECT_GT(kept.summary.array_bytes, plain.summary.array_bytes + meshes[1].source->memory_bytes());
  const Scene traced_by_spheres = prepared(make(), nullptr, by_spheres());
  EXPECT_EQ(traced_by_spheres.sphere_pixels, kDefaultSpherePixels);
  EXPECT_TRUE(traced_by_spheres.summary.hierarchy.find("bounding spheres") != std::string::npos);
}

}  // namespace
}  // namespace raytree
