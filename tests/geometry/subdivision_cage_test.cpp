// What is refused of a cage before OpenSubdiv sees it, by name and face number; and how rules join.
#include "geometry/subdivision_cage.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/geometry/subdivision_cages.h"

namespace raytree {
namespace {

const SourceLocation kWhere{"cage.json", 7, "shapes.cage"};

std::string refusal(const std::function<void(PolygonMesh&, SubdivisionRules&)>& damage) {
  PolygonMesh mesh = test::cube_cage();
  SubdivisionRules rules;
  damage(mesh, rules);
  try {
    check_cage(mesh, rules, kWhere);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_EQ(error.where().file, "cage.json");
    EXPECT_EQ(error.where().line, 7);
    return error.what();
  }
  return "accepted";
}

TEST(SubdivisionCage, RefusesBadFacesByNumber) {
  constexpr auto kNaN = std::numeric_limits<float>::quiet_NaN();
  const auto expect = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  EXPECT_EQ(refusal([](PolygonMesh&, SubdivisionRules&) {}), "accepted");
  for (const std::uint32_t index : {8u, 99u, 1000000000u, 0xfffffff9u})
    expect(refusal([&](PolygonMesh& m, SubdivisionRules&) { m.corners[9] = index; }),
           "face 2 (counted from 0) refers to vertex " + std::to_string(index) + "; there are 8");
  expect(refusal([](PolygonMesh& m, SubdivisionRules&) { m.corners[8] = m.corners[10]; }),
         "face 2 (counted from 0) uses vertex 5 twice");
  for (const std::uint32_t size : {0u, 2u})
    expect(refusal([&](PolygonMesh& m, SubdivisionRules&) {
             m.face_sizes[1] = size;
             m.corners.resize(20 + size);
           }),
           "face 1 (counted from 0) has " + std::to_string(size) + " corners; 3 is the least");
  expect(refusal([](PolygonMesh& m, SubdivisionRules&) { m.face_sizes[5] = 5; }), "face 5");
  expect(refusal([](PolygonMesh& m, SubdivisionRules&) { m.corners.push_back(0); }), "fewer corners");
  expect(refusal([](PolygonMesh& m, SubdivisionRules&) { m.positions[3].y = kNaN; }), "vertex 3");
  expect(refusal([](PolygonMesh& m, SubdivisionRules&) {
           m.texture_coordinates = {{0, 0}};
           m.texture_corners.assign(24, 0);
           m.texture_corners[6] = 1;
         }),
         "face 1 (counted from 0) refers to texture coordinates 1; there are 1");
  expect(refusal([](PolygonMesh& m, SubdivisionRules&) { m = {}; }), "no faces");
  expect(refusal([](PolygonMesh&, SubdivisionRules& r) { r.scheme = SubdivisionScheme::loop; }),
         "face 0 (counted from 0) has 4 corners; the scheme loop takes triangles alone");
}

TEST(SubdivisionCage, RefusesFacesAndFansBeyondSixteenBits) {
  PolygonMesh gon;
  for (std::uint32_t i = 0; i < 65536; ++i) {
    gon.positions.push_back(Vec3f(static_cast<float>(i), 0, 0));
    gon.corners.push_back(i);
  }
  gon.face_sizes = {65536};
  EXPECT_THROW(check_cage(gon, {}, kWhere), Error);
  PolygonMesh fan;
  fan.positions.assign(65538, Vec3f(0, 0, 0));
  for (std::uint32_t i = 0; i < 65536; ++i)
    for (const std::uint32_t vertex : {0u, i + 1, (i + 1) % 65536 + 1}) fan.corners.push_back(vertex);
  try {
    check_cage(fan, {}, kWhere);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("face 65535"), std::string::npos) << error.what();
  }
}

TEST(SubdivisionCage, RefusesBadTags) {
  const auto expect = [](const std::function<void(SubdivisionRules&)>& damage, const std::string& part) {
    const std::string text = refusal([&](PolygonMesh&, SubdivisionRules& rules) { damage(rules); });
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  expect([](auto& r) { r.creases = {{{0, 1}, 1}, {{0, 8}, 1}}; }, "crease 1 (counted from 0) names vertex 8");
  expect([](auto& r) { r.creases = {{{3}, 1}}; }, "two vertices");
  expect([](auto& r) { r.creases = {{{3, 3}, 1}}; }, "itself");
  for (const double bad : {-1.0, -1e-30, kNaN}) {
    expect([&](auto& r) { r.creases = {{{0, 1}, bad}}; }, "crease 0");
    expect([&](auto& r) { r.corners = {{2, bad}}; }, "vertex 2");
  }
  expect([](auto& r) { r.corners = {{8, 1}}; }, "names vertex 8");
  expect([](auto& r) { r.holes = {6}; }, "face 6; there are 6 faces");
  expect([](auto& r) { r.crease_angle = 181; }, "180");
  expect([](auto& r) { r.creases = {{{0, 1, 3}, std::numeric_limits<double>::infinity()}}; }, "accepted");
}

TEST(SubdivisionCage, RulesOfTheSceneAreStrongerThanTheFiles) {
  SubdivisionRules file, scene;
  file.boundary = BoundaryRule::edge_and_corner;
  file.crease_method = CreaseMethod::chaikin;
  file.creases = {{{0, 1}, 2}};
  scene.boundary = BoundaryRule::none;
  scene.creases = {{{0, 1}, 5}};
  scene.holes = {3};
  const SubdivisionRules both = joined(file, scene);
  EXPECT_EQ(both.boundary, BoundaryRule::none);
  EXPECT_EQ(both.crease_method, CreaseMethod::chaikin);
  EXPECT_FALSE(both.scheme);
  ASSERT_EQ(both.creases.size(), 2u);
  EXPECT_EQ(both.creases[1].sharpness, 5);
  EXPECT_EQ(both.holes.size(), 1u);
}

}  // namespace
}  // namespace raytree
