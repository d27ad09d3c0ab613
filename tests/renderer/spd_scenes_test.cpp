// The generated databases against the files that the original programs wrote, and against counts in closed form.
#include "renderer/spd_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <set>

#include "geometry/sphere_flake.h"
#include "renderer/builtin_scenes.h"
#include "renderer/nff_reader.h"
#include "renderer/scene.h"
#include "renderer/spd_meshes.h"
#include "tests/renderer/test_scenes.h"
#include "tests/test_data.h"

namespace raytree {
namespace {

/// Of a number written with six digits, and of the floats between; zeros come out as rounding leaves them.
double text_error(double value) { return 5.1e-6 * std::abs(value) + 3e-7; }

template <class Vec>
void expect_near(const Vec& a, const Vec& b, const std::string& what) {
  for (int i = 0; i < 3; ++i) ASSERT_NEAR(a[i], b[i], text_error(b[i])) << what;
}

struct Polygon {
  std::vector<Vec3d> corners, normals;
  std::string material;
};

/// All polygons in the order of their shapes.
std::vector<Polygon> polygons_of(const SceneDescription& scene) {
  std::vector<Polygon> polygons;
  for (const ShapeDescription& shape : scene.shapes) {
    const auto* kind = std::get_if<MeshShape>(&shape.kind);
    if (kind == nullptr) continue;
    const PolygonMesh& mesh = *kind->mesh;
    std::size_t next = 0;
    for (std::size_t face = 0; face < mesh.face_count(); ++face) {
      Polygon& polygon = polygons.emplace_back();
      polygon.material = shape.material;
      const std::size_t size = mesh.all_triangles() ? 3 : mesh.face_sizes[face];
      for (std::size_t i = 0; i < size; ++i) {
        const std::uint32_t corner = mesh.corners[next++];
        polygon.corners.push_back(mesh.origin + Vec3d(mesh.positions[corner]));
        if (!mesh.normals.empty()) polygon.normals.emplace_back(mesh.normals[corner]);
      }
    }
  }
  return polygons;
}

const MaterialDescription& material_named(const SceneDescription& scene, const std::string& name) {
  for (const MaterialDescription& material : scene.materials)
    if (material.name == name) return material;
  throw Error(ErrorKind::failure, {}, "no material " + name);
}

void expect_same_material(const SceneDescription& ours, const std::string& our_name, const SceneDescription& theirs,
                          const std::string& their_name) {
  const MaterialDescription &a = material_named(ours, our_name), &b = material_named(theirs, their_name);
  const auto rgb = [](const MaterialDescription& m) {
    const Rgb c = std::get<Rgb>(m.diffuse);
    return Vec3d(c.r, c.g, c.b);
  };
  expect_near(rgb(a), rgb(b), their_name);
  ASSERT_NEAR(a.highlight.exponent, b.highlight.exponent, text_error(b.highlight.exponent)) << their_name;
  ASSERT_EQ(a.highlight.weight, b.highlight.weight) << their_name;
  ASSERT_EQ(a.reflection, b.reflection) << their_name;
  ASSERT_EQ(a.transmission, b.transmission) << their_name;
  if (!is_black(b.transmission)) {
    ASSERT_EQ(a.index_of_refraction, b.index_of_refraction) << their_name;
  }
}

template <class Kind>
std::vector<const ShapeDescription*> shapes_of(const SceneDescription& scene) {
  std::vector<const ShapeDescription*> found;
  for (const ShapeDescription& shape : scene.shapes)
    if (std::holds_alternative<Kind>(shape.kind)) found.push_back(&shape);
  return found;
}

void expect_same_scene(const SceneDescription& ours, const SceneDescription& theirs) {
  ASSERT_EQ(ours.cameras.size(), 1u);
  expect_near(ours.cameras[0].position, theirs.cameras[0].position, "from");
  expect_near(ours.cameras[0].target, theirs.cameras[0].target, "at");
  EXPECT_EQ(ours.cameras[0].up, theirs.cameras[0].up);
  EXPECT_NEAR(ours.cameras[0].field_of_view, theirs.cameras[0].field_of_view, 1e-12);
  EXPECT_EQ(ours.image.width, theirs.image.width);
  EXPECT_EQ(ours.image.height, theirs.image.height);
  EXPECT_EQ(std::get<ConstantBackground>(ours.background).color, std::get<ConstantBackground>(theirs.background).color);
  ASSERT_EQ(ours.lights.size(), theirs.lights.size());
  for (std::size_t i = 0; i < ours.lights.size(); ++i) {
    expect_near(std::get<PointLight>(ours.lights[i].kind).position,
                std::get<PointLight>(theirs.lights[i].kind).position, "light");
    EXPECT_EQ(ours.lights[i].color, theirs.lights[i].color * 0.5f);
  }

  const std::vector<Polygon> our_polygons = polygons_of(ours), their_polygons = polygons_of(theirs);
  ASSERT_EQ(our_polygons.size(), their_polygons.size());
  for (std::size_t i = 0; i < our_polygons.size(); ++i) {
    const Polygon &a = our_polygons[i], &b = their_polygons[i];
    const std::string what = "polygon " + std::to_string(i);
    ASSERT_EQ(a.corners.size(), b.corners.size()) << what;
    for (std::size_t k = 0; k < a.corners.size(); ++k) expect_near(a.corners[k], b.corners[k], what);
    ASSERT_EQ(a.normals.size(), b.normals.size()) << what;
    for (std::size_t k = 0; k < a.normals.size(); ++k) expect_near(a.normals[k], b.normals[k], what);
    expect_same_material(ours, a.material, theirs, b.material);
  }

  const auto our_cones = shapes_of<ConeShape>(ours), their_cones = shapes_of<ConeShape>(theirs);
  ASSERT_EQ(our_cones.size(), their_cones.size());
  for (std::size_t i = 0; i < our_cones.size(); ++i) {
    const auto &a = std::get<ConeShape>(our_cones[i]->kind), &b = std::get<ConeShape>(their_cones[i]->kind);
    const std::string what = "cone " + std::to_string(i);
    expect_near(a.base, b.base, what);
    expect_near(a.apex, b.apex, what);
    ASSERT_NEAR(a.base_radius, b.base_radius, text_error(b.base_radius)) << what;
    ASSERT_NEAR(a.apex_radius, b.apex_radius, text_error(b.apex_radius)) << what;
    expect_same_material(ours, our_cones[i]->material, theirs, their_cones[i]->material);
  }

  // The balls are one shape: what they are is known once they are prepared.
  PrepareOptions options;
  options.build = false;
  Warnings warnings;
  const Scene prepared = prepare(ours, options, warnings);
  EXPECT_TRUE(warnings.empty());
  const SphereArray& spheres = prepared.shapes->spheres;
  const auto their_spheres = shapes_of<SphereShape>(theirs);
  ASSERT_EQ(spheres.shape.size(), their_spheres.size());
  for (std::size_t i = 0; i < their_spheres.size(); ++i) {
    const auto& b = std::get<SphereShape>(their_spheres[i]->kind);
    const Imath::V4f& a = spheres.center_radius[i];
    expect_near(prepared.shapes->origin + Vec3d(a.x, a.y, a.z), b.center, "sphere " + std::to_string(i));
    ASSERT_NEAR(a.w, b.radius, text_error(b.radius)) << "sphere " << i;
    expect_same_material(ours, ours.shapes[spheres.shape[i]].material, theirs, their_spheres[i]->material);
  }
}

TEST(SpdScenes, AreThoseOfTheOriginalProgramsPrimitiveByPrimitive) {
  const std::set<std::string> names{"balls", "gears", "rings", "teapot", "tree"};
  const auto files = test::test_data_files("spd");
  if (files.empty()) GTEST_SKIP() << "LEFT OUT: no test data in spd";
  std::size_t compared = 0;
  for (const auto& path : files) {
    if (!names.contains(path.stem()) || path.extension() != ".nff" || path.parent_path().filename() != "spd") continue;
    SCOPED_TRACE(path.filename().string());
    Warnings warnings;
    // The programs make a coarser teapot today than the one whose counts were published.
    const std::string name = "spd-" + path.stem().string() + (path.stem() == "teapot" ? ":6" : "");
    expect_same_scene(spd_scene(name), read_nff_file(path.string(), warnings));
    ++compared;
  }
  EXPECT_EQ(compared, names.size());
  EXPECT_EQ(compared, names.size());
}

/// The text of a compressed file; empty where it cannot be had.
std::string unpacked(const std::string& path) {
  std::string text;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(("gzip -dc '" + path + "'").c_str(), "r"), pclose);
  std::vector<char> block(1 << 16);
  while (pipe != nullptr) {
    const std::size_t count = std::fread(block.data(), 1, block.size(), pipe.get());
    if (count == 0) break;
    text.append(block.data(), count);
  }
  return text;
}

TEST(SpdScenes, AMillionTetrahedronsFacesAreThoseOfTheOriginalProgram) {
  const auto files = test::test_data_files("big");
  if (files.empty()) GTEST_SKIP() << "LEFT OUT: no test data in big";
  const auto file =
      std::find_if(files.begin(), files.end(), [](const auto& path) { return path.filename() == "tetra_s10.nff.gz"; });
  ASSERT_NE(file, files.end());
  Warnings warnings;
  expect_same_scene(spd_scene("spd-tetra:10"), read_nff(unpacked(file->string()), "tetra.nff", warnings));
}

/// What stands in a database of that size.
struct Contents {
  std::size_t spheres, cones, polygons;
};
Contents contents(SpdDatabase database, int size) {
  const SceneDescription scene = spd_scene(database, size);
  Contents result{shapes_of<SphereShape>(scene).size(), shapes_of<ConeShape>(scene).size(), polygons_of(scene).size()};
  for (const ShapeDescription* flake : shapes_of<SphereFlakeShape>(scene))
    result.spheres += static_cast<std::size_t>(sphere_flake_count(std::get<SphereFlakeShape>(flake->kind).levels));
  return result;
}

TEST(SpdScenes, HoldAsManyPrimitivesAsTheirSizesSay) {
  for (const int n : {1, 2, 3, 4, 5}) {
    const auto size = static_cast<std::size_t>(n);
    const auto expect = [&](SpdDatabase database, const Contents& expected) {
      const Contents found = contents(database, n);
      EXPECT_EQ(found.spheres, expected.spheres) << spd_entry(database).name << n;
      EXPECT_EQ(found.cones, expected.cones) << spd_entry(database).name << n;
      EXPECT_EQ(found.polygons, expected.polygons) << spd_entry(database).name << n;
    };
    const auto power = [&](std::size_t base) { return static_cast<std::size_t>(std::pow(double(base), n)); };
    expect(SpdDatabase::balls, {(9 * power(9) - 1) / 8, 0, 1});
    expect(SpdDatabase::gears, {0, 0, size * size * size * 146 + 1});
    expect(SpdDatabase::mount, {4, 0, 2 * power(4)});
    const std::size_t rings = 5 * size * (size + 1) * (2 * size + 1);
    expect(SpdDatabase::rings, {rings, rings, 1});
    if (n > 1) expect(SpdDatabase::teapot, {0, 0, 64 * size * size - 8 * size + size * size});
    expect(SpdDatabase::tetra, {0, 0, power(4)});
    expect(SpdDatabase::tree, {2 * power(2) - 1, 2 * power(2) - 1, 1});
  }
  // The published totals ("total prim.") are of the standard sizes.
  const std::size_t totals[] = {7382, 9345, 8196, 8401, 9264, 4096, 8191};
  for (const SpdEntry& entry : spd_databases()) {
    const Contents found = contents(entry.database, entry.standard_size);
    EXPECT_EQ(found.spheres + found.cones + found.polygons, totals[static_cast<std::size_t>(entry.database)])
        << entry.name;
  }
}

TEST(SpdScenes, TheMountainHasOneHeightAtEachPlaceAndLevelCorners) {
  for (const int size : {1, 4, 6, 9}) {
    const auto mesh = spd_mountain(size);
    const std::size_t row = (std::size_t(1) << size) + 1;
    ASSERT_EQ(mesh->positions.size(), row * row);
    for (const std::size_t corner : {std::size_t(0), row - 1, row * row - row, row * row - 1})
      EXPECT_EQ(mesh->positions[corner].z, 0);
    double lowest = 0, highest = 0;
    for (const Vec3f& p : mesh->positions) {
      ASSERT_TRUE(std::isfinite(p.z));
      lowest = std::min(lowest, double(p.z));
      highest = std::max(highest, double(p.z));
    }
    EXPECT_GT(highest - lowest, 0.2);
    EXPECT_LT(highest - lowest, 4);
  }
}

TEST(SpdScenes, AreBuiltInUnderTheirNamesAtAnySize) {
  EXPECT_TRUE(is_builtin_scene("spd-tree"));
  EXPECT_TRUE(is_builtin_scene("spd-tree:3"));
  EXPECT_FALSE(is_builtin_scene("spd-trees"));
  EXPECT_EQ(builtin_scene("spd-tree:3").name, "spd-tree:3");
  EXPECT_EQ(builtin_scene("spd-tree:11").name, "spd-tree") << "its standard size";
  EXPECT_EQ(builtin_scene("spd-tree:3").shapes.size(), 31u);
  for (const char* bad :
       {"spd-tree:", "spd-tree:0", "spd-tree:-1", "spd-tree:18", "spd-tree:3x", "spd-tree:1e1", "spd-tree:99999999999"})
    try {
      builtin_scene(bad);
      ADD_FAILURE() << bad;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      EXPECT_NE(std::string(error.what()).find("from 1 to 17"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace raytree
