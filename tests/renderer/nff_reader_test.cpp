// NFF: every entity against its definition, and what is damaged or dropped.
#include "renderer/nff_reader.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/angle.h"
#include "renderer/scene.h"
#include "tests/reader_checks.h"
#include "tests/test_data.h"

namespace raytree {
namespace {

const std::string kView = "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 60\nhither 1\nresolution 101 51\n";

SceneDescription read_nff_text(const std::string& text, Warnings* warnings = nullptr) {
  Warnings own;
  return read_nff(text, "a.nff", warnings != nullptr ? *warnings : own);
}

TEST(NffReader, TheViewSpansTheCentersOfItsRows) {
  const SceneDescription scene = read_nff_text(kView);
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.cameras[0].position, Vec3d(0, 0, 5));
  EXPECT_EQ(scene.cameras[0].target, Vec3d(0, 0, 0));
  EXPECT_EQ(scene.image.width, 101);
  EXPECT_EQ(scene.image.height, 51);
  // The centers of 51 rows span 50 of the 51 pixels.
  const double half = std::tan(scene.cameras[0].field_of_view / 2 * kDegree);
  EXPECT_NEAR(half * 50 / 51, std::tan(30 * kDegree), 1e-12);
}

TEST(NffReader, LightsWithoutIntensityShareIt) {
  const SceneDescription scene = read_nff_text("b .1 .2 .3\nl 1 2 3\nl 4 5 6 .5 .25 1\nl 7 8 9\nl 1 1 1\n" + kView);
  EXPECT_EQ(std::get<ConstantBackground>(scene.background).color, Rgb(.1f, .2f, .3f));
  ASSERT_EQ(scene.lights.size(), 4u);
  EXPECT_EQ(scene.lights[0].color, Rgb(.5f));  // 1 / sqrt(4)
  EXPECT_EQ(scene.lights[1].color, Rgb(.5f, .25f, 1));
  EXPECT_EQ(std::get<PointLight>(scene.lights[1].kind).position, Vec3d(4, 5, 6));
}

TEST(NffReader, FillsBecomeWhittedsCoefficients) {
  const SceneDescription scene =
      read_nff_text(kView + "f 1 .5 .25 .8 .3 32 .6 1.4\ns 1 2 3 4\nf 1 1 1 1 0 100000 0 0\ns 0 0 0 1\n");
  ASSERT_EQ(scene.materials.size(), 2u);
  const MaterialDescription& m = scene.materials[0];
  EXPECT_EQ(std::get<Rgb>(m.diffuse), Rgb(1, .5f, .25f) * .8f);
  EXPECT_EQ(m.highlight.weight, Rgb(.3f));
  EXPECT_EQ(m.highlight.exponent, 32);
  EXPECT_EQ(m.reflection, Rgb(.3f));
  EXPECT_EQ(m.transmission, Rgb(.6f));
  EXPECT_EQ(m.index_of_refraction, 1.4);
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_EQ(scene.shapes[0].material, m.name);
  EXPECT_EQ(scene.shapes[1].material, scene.materials[1].name);
  EXPECT_EQ(std::get<SphereShape>(scene.shapes[0].kind).center, Vec3d(1, 2, 3));
  EXPECT_EQ(std::get<SphereShape>(scene.shapes[0].kind).radius, 4);
}

TEST(NffReader, ConesAndCylinders) {
  const SceneDescription scene = read_nff_text(kView + "c 0 1 2 3\n4 5 6 7\nc\n0 0 0 2 0 0 1 0\n");
  ASSERT_EQ(scene.shapes.size(), 2u);
  const auto& cone = std::get<ConeShape>(scene.shapes[0].kind);
  EXPECT_EQ(cone.base, Vec3d(0, 1, 2));
  EXPECT_EQ(cone.base_radius, 3);
  EXPECT_EQ(cone.apex, Vec3d(4, 5, 6));
  EXPECT_EQ(cone.apex_radius, 7);
  EXPECT_EQ(std::get<ConeShape>(scene.shapes[1].kind).apex_radius, 0);
}

TEST(NffReader, PolygonsOfOneFillAreOneMesh) {
  const std::string square = "p 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n", triangle = "p 3 0 0 1 1 0 1 1 1 1\n";
  const std::string patch = "pp 3\n0 0 2 0 0 1\n1 0 2 0 0 1\n1 1 2 1 0 1\n";
  const SceneDescription scene =
      read_nff_text(kView + "f 1 1 1 1 0 1 0 1\n" + square + triangle + patch + "f 1 0 0 1 0 1 0 1\n" + triangle);
  ASSERT_EQ(scene.shapes.size(), 3u);
  const auto& first = std::get<MeshShape>(scene.shapes[0].kind);
  EXPECT_EQ(first.normals, NormalSource::flat);
  ASSERT_EQ(first.mesh->face_count(), 2u);
  EXPECT_EQ(first.mesh->face_sizes[0], 4u);
  EXPECT_EQ(first.mesh->face_sizes[1], 3u);
  const auto& patches = std::get<MeshShape>(scene.shapes[1].kind);
  EXPECT_EQ(patches.normals, NormalSource::file);
  ASSERT_EQ(patches.mesh->normals.size(), 3u);
  EXPECT_EQ(patches.mesh->normals[2], Vec3f(1, 0, 1));
  EXPECT_EQ(patches.mesh->origin + Vec3d(patches.mesh->positions[2]), Vec3d(1, 1, 2));
  EXPECT_TRUE(std::get<MeshShape>(scene.shapes[2].kind).mesh->all_triangles());
}

TEST(NffReader, WhatIsOddIsDroppedAndCounted) {
  Warnings warnings;
  const SceneDescription scene =
      read_nff_text(kView +
                        "# a comment\ntess 4\nf 1 1 1 1 0 1 0 1 wood.jpg # and another\ns 0 0 0 -2\n"
                        "c 1 1 1 1 1 1 1 1\np 2 0 0 0 1 1 1\np 3 0 0 0 1 0 0 0 1 0\n",
                    &warnings);
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_EQ(std::get<SphereShape>(scene.shapes[0].kind).radius, 2);
  EXPECT_EQ(std::get<MeshShape>(scene.shapes[1].kind).mesh->face_count(), 1u);
  ASSERT_EQ(warnings.size(), 3u);
  EXPECT_EQ(warnings[0].where.line, 9);
  EXPECT_EQ(warnings[0].count, 2);
  EXPECT_EQ(warnings[1].where.line, 11);
  EXPECT_EQ(warnings[2].where.line, 12);
  EXPECT_EQ(warnings[2].count, 2);
}

TEST(NffReader, DamageIsAnErrorWithItsLine) {
  for (const auto& [text, line, part] :
       {std::tuple{std::string("s 0 0 0 1\n"), 0, "viewpoint"},
        {kView + "s 0 0 0\n", 9, "ends"},
        {kView + "s 0 0 zero 1\n", 8, "\"zero\""},
        {kView + "s 0 0 0 0\n", 8, "not 0"},
        {kView + "s 0 0 nan 1\n", 8, "out of range"},
        {kView + "s 0 0 1e30 1\n", 8, "out of range"},
        {kView + "\nf 1 1 1\n", 10, "ends"},
        {kView + "f 1 1 1 1 1 1 2 1\n", 8, "at most 1"},
        {kView + "f -1 1 1 1 1 1 0 1\n", 8, "negative"},
        {kView + "p 1.5 0 0 0\n", 8, "whole number"},
        {kView + "p 4294967295\n0 0 0\n", 10, "ends"},
        {std::string("v\nat 0 0 0\n"), 2, "expected from"},
        {std::string("v from 0 0 1 at 0 0 0 up 0 1 0 angle 190 hither 1 resolution 5 5\n"), 1, "angle"},
        {std::string("v from 0 0 0 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 5 5\n"), 1, "same point"},
        {std::string("v from 0 0 1 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 0 5\n"), 1, "resolution"},
        {std::string("v from 0 0 1 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 65536 65536\n"), 1, "2^30"}}) {
    SCOPED_TRACE(text);
    test::expect_refusal([&text = text] { read_nff_text(text); }, "a.nff", line, part);
  }
}

TEST(NffReader, BytesOfAnyKindDoNoHarm) {
  const std::string good = "b 0 0 0\nl 1 2 3\n" + kView +
                           "f 1 .5 .25 .8 .3 32 .6 1.4\ns 1 2 3 4\nc 0 1 2 3 4 5 6 7\np 3 0 0 0 1 0 0 0 1 0\n"
                           "pp 3\n0 0 2 0 0 1\n1 0 2 0 0 1\n1 1 2 1 0 1\n";
  test::read_damaged_copies(good, 4000, [](const std::string& text) { read_nff_text(text); });
}

TEST(NffReader, TheStandardProceduralDatabasesLoadWhole) {
  struct Case {
    const char* name;
    std::size_t spheres, cones, faces;
  };
  std::size_t found = 0;
  for (const Case& c :
       {Case{"balls.nff", 7381, 0, 1}, Case{"gears.nff", 0, 0, 9345}, Case{"rings.nff", 4200, 4200, 1},
        Case{"tree.nff", 4095, 4095, 1}, Case{"shells.nff", 5761, 0, 0}, Case{"teapot.nff", 0, 0, 2292}}) {
    const std::string path = std::string(RAYTREE_TEST_DATA) + "/spd/" + c.name;
    if (!std::filesystem::exists(path)) continue;
    SCOPED_TRACE(path);
    ++found;
    Warnings warnings;
    const SceneDescription scene = read_nff_file(path, warnings);
    std::size_t spheres = 0, cones = 0, faces = 0;
    for (const ShapeDescription& shape : scene.shapes) {
      spheres += std::holds_alternative<SphereShape>(shape.kind);
      cones += std::holds_alternative<ConeShape>(shape.kind);
      if (const auto* mesh = std::get_if<MeshShape>(&shape.kind)) faces += mesh->mesh->face_count();
    }
    EXPECT_EQ(spheres, c.spheres);
    EXPECT_EQ(cones, c.cones);
    EXPECT_EQ(faces, c.faces);
    EXPECT_TRUE(warnings.empty());
  }
  if (found == 0) GTEST_SKIP() << "LEFT OUT: no test data in spd";
  std::fprintf(stderr, "%zu databases\n", found);
}

}  // namespace
}  // namespace raytree
