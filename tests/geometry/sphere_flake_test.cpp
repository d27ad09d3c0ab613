// The sphere-flake: closed forms (count, tangency, extent), SPD's published spheres one by one, bad parameters.
#include "geometry/sphere_flake.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

#include "geometry/angle.h"
#include "geometry/error.h"
#include "tests/test_data.h"

namespace raytree {
namespace {

SphereFlakeParameters flake(int levels, double radius = 1, Vec3d center = Vec3d(0)) {
  SphereFlakeParameters parameters;
  parameters.levels = levels;
  parameters.center = center;
  parameters.radius = radius;
  return parameters;
}

// A center is a sum of at most seven steps in double, rounded once to float: half an ulp per coordinate, and
// coordinates stay below twice the radius, so |error| <= sqrt(3) 2^-24 2 radius. Twice that for a difference of two.
constexpr double kCenterError = 2 * 1.7320508 * 2 / 16777216.0;

double distance(const Vec3f& a, const Vec3f& b) { return (Vec3d(a) - Vec3d(b)).length(); }

/// Calls visit(parent, child, levels below the child) for every pair.
template <class Visit>
void visit_children(std::size_t parent, int levels, const Visit& visit) {
  if (levels == 0) return;
  const auto subtree = std::size_t(sphere_flake_count(levels - 1));
  for (std::size_t child = 0; child < 9; ++child) {
    const std::size_t index = parent + 1 + child * subtree;
    visit(parent, index);
    visit_children(index, levels - 1, visit);
  }
}

TEST(SphereFlake, CountIsTheGeometricSum) {
  const std::int64_t counts[] = {1, 10, 91, 820, 7381, 66430, 597871, 5380840};
  for (int levels = 0; levels <= 7; ++levels) EXPECT_EQ(sphere_flake_count(levels), counts[levels]);
  for (int levels = 0; levels <= 5; ++levels) {
    const SphereArrays spheres = make_sphere_flake(flake(levels));
    EXPECT_EQ(spheres.sphere_count(), std::size_t(counts[levels]));
    EXPECT_EQ(spheres.centers.size(), spheres.sphere_count());
  }
}

TEST(SphereFlake, EveryChildTouchesItsParentAtAThirdOfItsRadius) {
  const double radius = 3.5;
  const SphereArrays spheres = make_sphere_flake(flake(5, radius));
  EXPECT_EQ(spheres.radii[0], 3.5f);
  EXPECT_EQ(spheres.centers[0], Vec3f(0));
  std::size_t pairs = 0;
  visit_children(0, 5, [&](std::size_t parent, std::size_t child) {
    ++pairs;
    const double r = spheres.radii[parent];
    ASSERT_NEAR(spheres.radii[child], r / 3, r / 3 * 2e-7);
    ASSERT_NEAR(distance(spheres.centers[parent], spheres.centers[child]), r * 4 / 3, radius * kCenterError + r * 2e-7);
  });
  EXPECT_EQ(pairs, spheres.sphere_count() - 1);
}

TEST(SphereFlake, SixChildrenOnTheEquatorAndThreeAbove) {
  const SphereArrays spheres = make_sphere_flake(flake(1));
  std::vector<double> equator, above;
  for (std::size_t i = 1; i < 10; ++i) {
    const Vec3d d = Vec3d(spheres.centers[i]) / (4.0 / 3);
    double azimuth = std::atan2(-d.z, d.x) * 180 / 3.14159265358979323846;
    if (azimuth < 0) azimuth += 360;
    if (std::abs(d.y) < 1e-6)
      equator.push_back(azimuth);
    else {
      EXPECT_NEAR(d.y, std::sqrt(2.0 / 3), 1e-6);
      above.push_back(azimuth);
    }
  }
  std::sort(equator.begin(), equator.end());
  std::sort(above.begin(), above.end());
  ASSERT_EQ(equator.size(), 6u);
  ASSERT_EQ(above.size(), 3u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(equator[i], 15 + 60.0 * double(i), 1e-4);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(above[i], 45 + 120.0 * double(i), 1e-4);
}

// Neighbors on the equator stand 60 degrees apart; an upper child and the equator's nearest have the angle of cosine
// cos(30) sqrt(1/3) = 1/2, 60 degrees again. So the least distance of two centers is the chord 4/3, twice 2/3 that two
// radii of 1/3 take.
TEST(SphereFlake, SiblingsDoNotOverlap) {
  const SphereArrays spheres = make_sphere_flake(flake(1));
  double least = 10;
  for (std::size_t i = 1; i < 10; ++i)
    for (std::size_t j = i + 1; j < 10; ++j) least = std::min(least, distance(spheres.centers[i], spheres.centers[j]));
  EXPECT_NEAR(least, 4.0 / 3, kCenterError);
  EXPECT_GE(least, 2.0 / 3);
}

TEST(SphereFlake, LiesWithinItsBoundingRadius) {
  EXPECT_DOUBLE_EQ(sphere_flake_bounding_radius(flake(0, 2)), 2);
  EXPECT_DOUBLE_EQ(sphere_flake_bounding_radius(flake(1, 2)), 2 * (2 - 1.0 / 3));
  for (int levels = 0; levels <= 5; ++levels) {
    const SphereArrays spheres = make_sphere_flake(flake(levels));
    double reach = 0;
    for (std::size_t i = 0; i < spheres.sphere_count(); ++i)
      reach = std::max(reach, Vec3d(spheres.centers[i]).length() + spheres.radii[i]);
    EXPECT_LE(reach, sphere_flake_bounding_radius(flake(levels)) + kCenterError);
    EXPECT_GE(reach, levels == 0 ? 1 : 5.0 / 3 - kCenterError);  // the first generation reaches 4/3 + 1/3
  }
}

TEST(SphereFlake, CenterMovesTheOriginAndNothingElse) {
  const Vec3d center(1e6 + 0.001, -3, 2);
  const SphereArrays here = make_sphere_flake(flake(3)), there = make_sphere_flake(flake(3, 1, center));
  EXPECT_EQ(there.origin, center);
  EXPECT_TRUE(std::equal(here.centers.begin(), here.centers.end(), there.centers.begin()));
}

TEST(SphereFlake, SameBitsForAnyNumberOfThreads) {
  const auto made_with = [](std::size_t threads) {
    tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return make_sphere_flake(flake(5, 0.7));
  };
  const SphereArrays one = made_with(1), three = made_with(3);
  EXPECT_EQ(std::memcmp(one.centers.data(), three.centers.data(), one.centers.size() * sizeof(Vec3f)), 0);
  EXPECT_EQ(std::memcmp(one.radii.data(), three.radii.data(), one.radii.size() * sizeof(float)), 0);
}

// Published: lines of the output of SPD's program (balls -s 4 and -s 6), x y z with z up, six digits. Those of level 6
// are children of spheres whose axis lies near -z and near +z, where a frame could be turned in several ways.
TEST(SphereFlake, EqualsPublishedSpheres) {
  struct Published {
    int levels;
    std::size_t index;
    double x, y, z, radius;
  };
  const Published published[] = {
      {4, 1, 0.272166, 0.272166, 0.544331, 0.166667},        {4, 2, 0.420314, 0.420314, 0.618405, 0.0555556},
      {4, 3, 0.470715, 0.470715, 0.598245, 0.0185185},       {4, 5, 0.475329, 0.45787, 0.577669, 0.00617284},
      {4, 12, 0.488174, 0.453255, 0.598245, 0.00617284},     {4, 13, 0.461623, 0.409245, 0.557924, 0.0185185},
      {6, 27473, 0.209389, 0.403216, 0.793129, 0.000685871}, {6, 27474, 0.207859, 0.402806, 0.795369, 0.000685871},
      {6, 27513, 0.211686, 0.403156, 0.81407, 0.000685871},  {6, 27516, 0.209036, 0.402446, 0.81407, 0.000685871}};
  const SphereArrays four = make_sphere_flake(flake(4, 0.5)), six = make_sphere_flake(flake(6, 0.5));
  for (const Published& sphere : published) {
    const SphereArrays& spheres = sphere.levels == 4 ? four : six;
    const Vec3f& center = spheres.centers[sphere.index];
    EXPECT_NEAR(center.x, sphere.x, 6e-7) << sphere.levels << ' ' << sphere.index;
    EXPECT_NEAR(center.y, sphere.z, 6e-7) << sphere.levels << ' ' << sphere.index;
    EXPECT_NEAR(center.z, -sphere.y, 6e-7) << sphere.levels << ' ' << sphere.index;
    EXPECT_NEAR(spheres.radii[sphere.index], sphere.radius, 6e-7);
  }
}

// Published: the output of SPD's program at its default size, sphere by sphere and in its order. Its text has six
// digits: half a unit of the sixth of a coordinate below 1 is 5e-7, plus our float rounding of 6e-8.
TEST(SphereFlake, EqualsBallsOfTheStandardProceduralDatabases) {
  const std::filesystem::path file = std::filesystem::path(RAYTREE_TEST_DATA) / "spd" / "balls.nff";
  std::ifstream text(file);
  if (!text) {
    std::fprintf(stderr, "LEFT OUT: no test data %s\n", file.c_str());
    GTEST_SKIP() << "no " << file;
  }
  const SphereArrays spheres = make_sphere_flake(flake(4, 0.5));
  std::size_t index = 0;
  for (std::string line; std::getline(text, line);) {
    if (line.rfind("s ", 0) != 0) continue;
    std::istringstream fields(line.substr(2));
    double x, y, z, radius;
    ASSERT_TRUE(fields >> x >> y >> z >> radius);
    ASSERT_LT(index, spheres.sphere_count());
    const Vec3f& center = spheres.centers[index];
    ASSERT_NEAR(center.x, x, 6e-7) << "sphere " << index;
    ASSERT_NEAR(center.y, z, 6e-7) << "sphere " << index;
    ASSERT_NEAR(center.z, -y, 6e-7) << "sphere " << index;
    ASSERT_NEAR(spheres.radii[index], radius, 6e-7) << "sphere " << index;
    ++index;
  }
  EXPECT_EQ(index, spheres.sphere_count());
  std::fprintf(stderr, "compared %zu spheres with SPD's\n", index);
}

TEST(SphereFlake, RefusesWhatCannotBe) {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const SphereFlakeParameters bad[] = {flake(-1),
                                       flake(8),
                                       flake(2, 0),
                                       flake(2, -1),
                                       flake(2, nan),
                                       flake(2, infinity),
                                       flake(2, 1e300),
                                       flake(2, 1e-40),
                                       flake(2, 1, Vec3d(0, nan, 0)),
                                       flake(2, 1, Vec3d(infinity, 0, 0))};
  for (const SphereFlakeParameters& parameters : bad) {
    try {
      make_sphere_flake(parameters);
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      EXPECT_NE(std::string(error.what()).find("sphere-flake"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace raytree
