// OBJ and PLY as they are written read back to the same mesh, bit for bit.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/mesh_file.h"
#include "geometry/obj_reader.h"
#include "geometry/obj_writer.h"
#include "geometry/ply_reader.h"
#include "geometry/ply_writer.h"
#include "tests/geometry/subdivision_cages.h"
#include "tests/mesh_expectations.h"

namespace raytree {
namespace {

PolygonMesh rich_mesh() {
  PolygonMesh mesh = test::grid_cage(5, 4, 1);
  test::add_face(mesh, {0, 1, 2, 12, 10});
  test::add_face(mesh, {3, 4, 9});
  for (Vec3f& p : mesh.positions) p = p * 0.1f + Vec3f(1.0f / 3, 1e-30f, -7e10f * p.z);
  for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
    mesh.texture_corners.push_back(static_cast<std::uint32_t>(i % 7));
    mesh.normal_corners.push_back(static_cast<std::uint32_t>(i % 5));
  }
  for (int i = 0; i < 7; ++i) mesh.texture_coordinates.push_back({0.1f * static_cast<float>(i), 1 / 3.0f});
  for (int i = 0; i < 5; ++i) mesh.normals.push_back(Vec3f(std::sin(static_cast<float>(i)), 0.5f, 1e-9f));
  mesh.groups = {{"left part", "red", 0, 3}, {"left part", "", 3, 2}, {"", "", 5, 9}};
  mesh.material_libraries = {"a b.mtl"};
  SubdivisionRules rules;
  rules.boundary = BoundaryRule::edge_and_corner;
  rules.face_varying = FaceVaryingRule::corners_plus2;
  rules.crease_method = CreaseMethod::chaikin;
  rules.triangles = TriangleRule::smooth;
  rules.creases = {{{0, 1}, 0.1}, {{1, 2}, std::numeric_limits<double>::infinity()}};
  rules.corners = {{4, 3.3}};
  rules.holes = {2};
  mesh.subdivision = rules;
  return mesh;
}

TEST(MeshWriters, ObjReadsBackToTheSameBits) {
  Warnings warnings;
  const PolygonMesh mesh = rich_mesh();
  const std::string text = obj_text(mesh);
  const PolygonMesh back = read_obj(text, "x.obj", warnings);
  EXPECT_TRUE(test::same_mesh(mesh, back));
  EXPECT_EQ(back.material_libraries, mesh.material_libraries);
  EXPECT_EQ(obj_text(back), text);
  EXPECT_NE(text.find("t corner 1/1/0 4 3.3\n"), std::string::npos);
  EXPECT_TRUE(warnings.empty());
}

TEST(MeshWriters, MeshesFarAwayKeepTheirPlace) {
  PolygonMesh mesh = test::cube_cage();
  mesh.origin = Vec3d(1234567, -7654321, 42);
  mesh.positions[3].x = 0.1f;
  Warnings warnings;
  EXPECT_TRUE(test::same_mesh(mesh, read_obj(obj_text(mesh), "x.obj", warnings)));
  const PolygonMesh back = read_ply(ply_bytes(mesh), "x.ply", warnings);
  EXPECT_EQ(back.origin, mesh.origin);
  EXPECT_TRUE(test::same_bits(back.positions, mesh.positions));
}

TEST(MeshWriters, PlyReadsBackAndSplitsWhatCornersHaveOfTheirOwn) {
  Warnings warnings;
  PolygonMesh mesh = rich_mesh();
  const PolygonMesh split = read_ply(ply_bytes(mesh), "x.ply", warnings);
  ASSERT_EQ(split.corners.size(), mesh.corners.size());
  for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
    EXPECT_EQ(split.positions[split.corners[i]], mesh.positions[mesh.corners[i]]);
    EXPECT_EQ(split.normals[split.corners[i]], mesh.normals[mesh.normal_corners[i]]);
    EXPECT_EQ(split.texture_coordinates[split.corners[i]], mesh.texture_coordinates[mesh.texture_corners[i]]);
  }
  EXPECT_EQ(ply_bytes(split), ply_bytes(read_ply(ply_bytes(split), "x.ply", warnings)));
  // Without anything of their own the vertices stay what they are; a face may have more corners than a byte counts.
  PolygonMesh gon;
  for (std::uint32_t i = 0; i < 300; ++i) {
    gon.positions.push_back(Vec3f(static_cast<float>(i), static_cast<float>(i * i), 0));
    gon.corners.push_back(i);
  }
  gon.face_sizes = {300};
  EXPECT_TRUE(test::same_mesh(gon, read_ply(ply_bytes(gon), "x.ply", warnings)));
  PolygonMesh triangles;
  triangles.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}};
  triangles.corners = {0, 1, 2};
  EXPECT_TRUE(test::same_mesh(triangles, read_ply(ply_bytes(triangles), "x.ply", warnings)));
}

TEST(MeshWriters, MeshFilesSurviveBothWays) {
  for (const auto& path : test::test_data_files("subdiv/osd_shapes")) {
    if (path.extension() != ".obj") continue;
    SCOPED_TRACE(path.filename().string());
    Warnings warnings;
    const PolygonMesh mesh = read_mesh_file(path.string(), warnings);
    const std::string text = obj_text(mesh);
    const PolygonMesh back = read_obj(text, "x.obj", warnings);
    EXPECT_TRUE(test::same_mesh(mesh, back));
    EXPECT_EQ(obj_text(back), text);
  }
}

}  // namespace
}  // namespace raytree
