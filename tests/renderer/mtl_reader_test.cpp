// Material libraries: every illumination model in Whitted's terms, and what is damaged or dropped.
#include "renderer/mtl_reader.h"

#include <gtest/gtest.h>

#include "tests/reader_checks.h"
#include "tests/test_data.h"

namespace raytree {
namespace {

MaterialDescription one(const std::string& statements, Warnings* warnings = nullptr) {
  Warnings own;
  const auto materials = read_mtl("newmtl a\n" + statements, "a.mtl", warnings != nullptr ? *warnings : own);
  EXPECT_EQ(materials.size(), 1u);
  return materials.empty() ? MaterialDescription() : materials.front();
}

Rgb diffuse(const MaterialDescription& material) { return std::get<Rgb>(material.diffuse); }

const std::string kColors = "Ka .1 .2 .3\nKd .4 .5 .6\nKs .7 .8 .9\nNs 32\n";

TEST(MtlReader, TheIlluminationModelSwitchesTermsOn) {
  struct Case {
    int model;
    bool lights, highlight, reflects, transmits, thin;
  };
  // The table of docs/mesh-materials.md, row by row.
  for (const Case& c : {Case{0, false, false, false, false, false}, Case{1, true, false, false, false, false},
                        Case{2, true, true, false, false, false}, Case{3, true, true, true, false, false},
                        Case{4, true, true, true, true, true}, Case{5, true, true, true, false, false},
                        Case{6, true, true, true, true, false}, Case{7, true, true, true, true, false},
                        Case{8, true, true, false, false, false}, Case{9, true, true, false, true, true},
                        Case{10, true, true, false, false, false}}) {
    SCOPED_TRACE(c.model);
    const MaterialDescription m = one(kColors + "Ni 1.3\nTf .5 .6 .7\nillum " + std::to_string(c.model));
    EXPECT_EQ(diffuse(m), c.lights ? Rgb(.4f, .5f, .6f) : Rgb());
    ASSERT_TRUE(m.ambient);
    EXPECT_EQ(std::get<Rgb>(*m.ambient), c.lights ? Rgb(.1f, .2f, .3f) : Rgb(.4f, .5f, .6f));
    EXPECT_EQ(m.highlight.weight, c.highlight ? Rgb(.7f, .8f, .9f) : Rgb());
    EXPECT_EQ(m.highlight.exponent, 32);
    EXPECT_EQ(m.reflection, c.reflects ? Rgb(.7f, .8f, .9f) : Rgb());
    EXPECT_EQ(m.transmission, c.transmits ? Rgb(.5f, .6f, .7f) : Rgb());
    EXPECT_EQ(m.thin, c.thin);
    EXPECT_EQ(m.index_of_refraction, 1.3);
    EXPECT_EQ(m.fresnel.has_value(), c.model >= 5 && c.model <= 7);
    if (m.fresnel) {
      EXPECT_EQ(*m.fresnel, c.model != 6);
    }
  }
}

TEST(MtlReader, WithoutAModelTheNumbersSay) {
  EXPECT_EQ(one("Kd 1 0 0").highlight.weight, Rgb());
  EXPECT_EQ(one("Kd 1 0 0\nKs .5 .5 .5").highlight.weight, Rgb(.5f));
  EXPECT_EQ(one("Kd 1 0 0\nKs .5 .5 .5").reflection, Rgb());
  EXPECT_EQ(one("Kd 1 0 0\nd .25").transmission, Rgb(.75f));
  EXPECT_TRUE(one("Kd 1 0 0\nd .25").thin);
  EXPECT_FALSE(one("Kd 1 0 0").ambient);  // as diffuse
}

TEST(MtlReader, ADissolvedSurfaceIsThereOnlySoMuch) {
  const MaterialDescription m = one("Kd .8 .4 .2\nKa .4 .4 .4\nd .25\nTf 1 .5 0\nillum 2");
  EXPECT_EQ(diffuse(m), Rgb(.2f, .1f, .05f));
  EXPECT_EQ(std::get<Rgb>(*m.ambient), Rgb(.1f));
  EXPECT_EQ(m.transmission, Rgb(.75f, .375f, 0));
  // Tr is the reverse of d; where both stand, d counts.
  EXPECT_EQ(one("Tr .25\nillum 2").transmission, Rgb(.25f));
  EXPECT_EQ(one("Tr .25\nd .5\nillum 2").transmission, Rgb(.5f));
  EXPECT_EQ(one("d -halo .5\nillum 2").transmission, Rgb(.5f));
}

TEST(MtlReader, GlassTransmitsWhatItSaysAndAllWhereItSaysNothing) {
  EXPECT_EQ(one("Ks 1 1 1\nillum 7").transmission, Rgb(1));
  EXPECT_EQ(one("Ks 1 1 1\nillum 7\nd 1").transmission, Rgb());
  EXPECT_EQ(one("Ks 1 1 1\nillum 7\nd 1\nTf .9 .9 1").transmission, Rgb(.9f, .9f, 1));
  EXPECT_EQ(one("illum 6\nTr .5\nTf .5 .5 .5").transmission, Rgb(.25f));
  EXPECT_EQ(diffuse(one("illum 6")), Rgb());  // glass has no diffuse color of its own
}

TEST(MtlReader, OneNumberStandsForThreeAndXyzBecomesRec709) {
  EXPECT_EQ(diffuse(one("Kd .5")), Rgb(.5f));
  const Rgb white = diffuse(one("Kd xyz .95047 1 1.08883"));  // D65
  EXPECT_NEAR(white.r, 1, 1e-4);
  EXPECT_NEAR(white.g, 1, 1e-4);
  EXPECT_NEAR(white.b, 1, 1e-4);
}

TEST(MtlReader, NumbersOutOfRangeBecomeTheNearestThatMeanSomething) {
  EXPECT_EQ(one("Ns 0.75\nKs 1 1 1").highlight.exponent, 1);
  EXPECT_EQ(one("Ni 0").index_of_refraction, 1.5);
  EXPECT_EQ(one("d 7\nillum 2").transmission, Rgb());
  EXPECT_EQ(diffuse(one("Kd -1 .5 .5")), Rgb(0, .5f, .5f));
}

TEST(MtlReader, NumbersOutOfRangeAreCountedWithTheirFirstLine) {
  Warnings warnings;
  read_mtl(
      "newmtl a\nKd -1 .5 .5\nKs 1 -1 -1\nNs .5\nNs 0\nNi 0\nNi -1.5\nd 7\nTr -.1\nd 1.5\n"
      "newmtl b\nKd 0 2 1e9\nKs xyz 0 1 0\nNs 1\nNi .9\nd 1\nTr 0\n",
      "a.mtl", warnings);
  const auto find = [&](const std::string& part) { return test::found_warning(warnings, part); };
  EXPECT_EQ(find("negative components"), "2 x2");
  EXPECT_EQ(find("(Ns) below 1"), "4 x2");
  EXPECT_EQ(find("(Ni) that are not positive"), "6 x2");
  EXPECT_EQ(find("(d, Tr) outside 0 to 1"), "8 x3");
  EXPECT_EQ(warnings.size(), 4u) << "the second material is in range";
}

TEST(MtlReader, NamesMayHoldBlanksAndLineEndsVary) {
  Warnings warnings;
  const auto materials =
      read_mtl("\xef\xbb\xbf# of a modeller\r\nnewmtl Hard Shiny\tPlastic \r\n  Kd 1 0 0\r\n\r\nnewmtl\r\nKd 0 1 0",
               "a.mtl", warnings);
  ASSERT_EQ(materials.size(), 2u);
  EXPECT_EQ(materials[0].name, "Hard Shiny\tPlastic");
  EXPECT_EQ(materials[1].name, "");
  EXPECT_TRUE(warnings.empty());
}

TEST(MtlReader, WhatIsDroppedIsCountedWithItsFirstLine) {
  Warnings warnings;
  const auto materials = read_mtl(
      "newmtl a\nmap_Kd a.png\nbump b.png\nKe 1 1 1\nPr .5\nPm 1\nKd spectral a.rfl\nillum 10\nwhat 7\nKe 0 0 0\n"
      "newmtl a\nKd 1 0 0\n",
      "a.mtl", warnings);
  ASSERT_EQ(materials.size(), 1u);
  EXPECT_EQ(diffuse(materials[0]), Rgb(1, 0, 0));
  const auto find = [&](const std::string& part) { return test::found_warning(warnings, part); };
  EXPECT_EQ(find("textures"), "2 x2");
  EXPECT_EQ(find("emission"), "4 x1");
  EXPECT_EQ(find("physically based"), "5 x2");
  EXPECT_EQ(find("spectrum"), "7 x1");
  EXPECT_EQ(find("illum 10"), "8 x1");
  EXPECT_EQ(find("unknown"), "9 x1");
  EXPECT_EQ(find("earlier"), "0 x1");
  EXPECT_EQ(warnings.size(), 7u);
}

TEST(MtlReader, DamagedStatementsAreErrorsWithTheirLine) {
  for (const auto& [text, line, part] : {std::tuple{"Kd 1 1 1\n", 1, "before the first newmtl"},
                                         {"newmtl a\nKd\n", 2, "Kd needs"},
                                         {"newmtl a\n\nKs 1 red 1\n", 3, "\"red\""},
                                         {"newmtl a\nKd 1 nan 1\n", 2, "\"nan\""},
                                         {"newmtl a\nNs\n", 2, "Ns needs"},
                                         {"newmtl a\nNi glass\n", 2, "\"glass\""},
                                         {"newmtl a\nillum 2.5\n", 2, "illum"},
                                         {"newmtl a\nillum 42\n", 2, "0 to 10, not \"42\""},
                                         {"newmtl a\nd\n", 2, "d needs"}}) {
    SCOPED_TRACE(text);
    test::expect_refusal(
        [&text = text] {
          Warnings warnings;
          read_mtl(text, "a.mtl", warnings);
        },
        "a.mtl", line, part);
  }
}

// Any bytes: an error or materials, never more.
TEST(MtlReader, BytesOfAnyKindDoNoHarm) {
  const std::string good = "newmtl a\n" + kColors + "Ni 1.3\nd .5\nTf .5 .6 .7\nillum 7\nmap_Kd a.png\n";
  test::read_damaged_copies(good, 4000, [](const std::string& text) {
    Warnings warnings;
    read_mtl(text, "a.mtl", warnings);
  });
}

TEST(MtlReader, LibrariesOfOthersLoad) {
  std::size_t count = 0;
  for (const char* folder : {"obj_features/assimp", "obj_features/tinyobj"})
    for (const auto& file : test::test_data_files(folder)) {
      if (file.extension() != ".mtl") continue;
      SCOPED_TRACE(file.string());
      ++count;
      Warnings warnings;
      EXPECT_NO_THROW(read_mtl_file(file.string(), warnings));
    }
  if (count == 0) GTEST_SKIP() << "no test data in obj_features";
  std::fprintf(stderr, "%zu libraries\n", count);
}

}  // namespace
}  // namespace raytree
