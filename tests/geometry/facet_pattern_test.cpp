// Facet patterns: counts by closed forms, and for every combination of small rates facets that turn the right way, join
// without a gap and cover the face.
#include "geometry/facet_pattern.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "geometry/angle.h"
#include "geometry/error.h"
#include "geometry/facet_pattern_set.h"
#include "tests/geometry/analytic_surfaces.h"

namespace raytree {
namespace {

using Rates = std::vector<std::uint16_t>;

Rates uniform(FaceDomain domain, std::size_t sides, std::uint16_t rate) {
  return Rates(sides + inner_rate_count(domain), rate);
}

TEST(FacetPattern, UniformRatesGiveTheCountsOfClosedForms) {
  for (std::uint16_t r : {1, 2, 3, 4, 7, 16, 33}) {
    const FacetPattern quad = make_facet_pattern(FaceDomain::quad, uniform(FaceDomain::quad, 4, r));
    EXPECT_EQ(quad.facet_count(), 2u * r * r);
    EXPECT_EQ(quad.parameters.size(), (r + 1u) * (r + 1u));
    EXPECT_EQ(quad.boundary_count, 4u * r);
    const FacetPattern triangle = make_facet_pattern(FaceDomain::triangle, uniform(FaceDomain::triangle, 3, r));
    EXPECT_EQ(triangle.facet_count(), 1u * r * r);
    EXPECT_EQ(triangle.parameters.size(), (r + 1u) * (r + 2u) / 2);
    EXPECT_EQ(triangle.boundary_count, 3u * r);
    for (const std::size_t n : {3u, 5u, 6u, 11u}) {
      const FacetPattern gon = make_facet_pattern(FaceDomain::quad_subfaces, uniform(FaceDomain::quad_subfaces, n, r));
      // Rings of n quads each; an odd rate leaves an n-gon in the middle: a fan of n triangles, or one where n is 3.
      const std::size_t middle = r % 2 == 0 ? 0 : n == 3 ? 1 : n;
      EXPECT_EQ(gon.facet_count(), n * (r * r / 2) + middle) << n << " " << r;
      EXPECT_EQ(gon.boundary_count, n * r);
      // Euler: V - E + F = 1 with E = (3 F + boundary) / 2.
      EXPECT_EQ(gon.parameters.size(), (gon.facet_count() + gon.boundary_count) / 2 + 1);
    }
  }
}

/// n-gons are laid out flat: sub-face i as a kite of a regular polygon.
Vec2d flat(FaceDomain domain, std::size_t sides, const Vec2f& p) {
  if (domain != FaceDomain::quad_subfaces) return Vec2d(p);
  const int tiles = int(std::ceil(std::sqrt(double(sides)) - 1e-9));
  const auto tile = [](double x) { return int(x) + (x - int(x) > 0.75 ? 1 : 0); };
  const int corner = tile(p.y) * tiles + tile(p.x);
  const double u = 2 * (p.x - tile(p.x)), v = 2 * (p.y - tile(p.y));
  const auto at = [&](int i) {
    const double angle = 2 * 3.14159265358979 * i / double(sides);
    return Vec2d(std::cos(angle), std::sin(angle));
  };
  const Vec2d here = at(corner), next = (here + at(corner + 1)) * 0.5, before = (here + at(corner - 1)) * 0.5;
  return here * ((1 - u) * (1 - v)) + next * (u * (1 - v)) + before * ((1 - u) * v);
}

double twice_area(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
}

/// Empty, or what is wrong.
std::string problem(FaceDomain domain, const Rates& rates) {
  const std::size_t sides = rates.size() - inner_rate_count(domain);
  const FacetPattern pattern = make_facet_pattern(domain, rates);
  const FacetCounts counts = count_facets(domain, rates);
  if (counts.boundary != pattern.boundary_count || counts.facets != pattern.facet_count() ||
      counts.boundary + counts.interior != pattern.parameters.size())
    return "counts";
  std::size_t boundary = 0;
  for (std::size_t i = 0; i < sides; ++i) boundary += rates[i];
  if (pattern.boundary_count != boundary) return "boundary count";
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  double area = 0, expected = 0;
  std::set<std::uint32_t> met;
  for (std::size_t f = 0; f < pattern.facet_count(); ++f) {
    const std::uint32_t* t = &pattern.facets[3 * f];
    const auto at = [&](int k) { return flat(domain, sides, pattern.parameters[t[k]]); };
    const double a = twice_area(at(0), at(1), at(2));
    if (!(a > 1e-6)) return "a facet without area or turned over";
    area += a;
    for (int k = 0; k < 3; ++k) {
      met.insert(t[k]);
      if (!edges.insert({t[k], t[(k + 1) % 3]}).second) return "an edge used twice in one direction";
    }
  }
  for (const auto& [a, b] : edges)
    if (!edges.count({b, a}) && !(a < boundary && b == (a + 1) % boundary)) return "a gap inside";
  for (std::uint32_t i = 0; i < boundary; ++i)
    if (!edges.count({i, std::uint32_t((i + 1) % boundary)})) return "a piece of the boundary without a facet";
  if (met.size() != pattern.parameters.size()) return "a point without a facet";
  const auto outline = [&](std::size_t i) { return flat(domain, sides, pattern.parameters[i % boundary]); };
  for (std::size_t i = 0; i < boundary; ++i) expected += twice_area({0, 0}, outline(i), outline(i + 1));
  if (std::abs(area - expected) > 1e-5) return "the facets do not cover the face";
  return {};
}

TEST(FacetPattern, AnyRatesGiveFacetsThatCoverTheFaceOnce) {
  const auto check_all = [](FaceDomain domain, std::size_t sides, std::uint16_t largest) {
    Rates rates = uniform(domain, sides, 1);
    for (;;) {
      const std::string text = problem(domain, rates);
      ASSERT_EQ(text, "") << testing::PrintToString(rates);
      std::size_t i = 0;
      while (i < rates.size() && rates[i] == largest) rates[i++] = 1;
      if (i == rates.size()) return;
      ++rates[i];
    }
  };
  check_all(FaceDomain::quad, 4, 4);
  check_all(FaceDomain::triangle, 3, 7);
  check_all(FaceDomain::quad_subfaces, 3, 5);
  check_all(FaceDomain::quad_subfaces, 5, 3);
  // Rates far apart.
  EXPECT_EQ(problem(FaceDomain::quad, {1, 90, 2, 37, 41, 3}), "");
  EXPECT_EQ(problem(FaceDomain::triangle, {64, 1, 5, 17}), "");
  EXPECT_EQ(problem(FaceDomain::quad_subfaces, {1, 50, 2, 2, 2, 31, 9, 12}), "");
}

TEST(FacetPattern, PointsOfASideAreSpacedEvenly) {
  const FacetPattern pattern = make_facet_pattern(FaceDomain::quad, Rates{1000, 3, 7, 2, 5, 5});
  for (int i = 0; i <= 1000; ++i) EXPECT_EQ(pattern.parameters[std::size_t(i)], Vec2f(float(i / 1000.0), 0));
}

TEST(FacetPattern, SetsMakeEachPatternOnceAndKeepWithinTheirBytes) {
  // Faces of four kinds in turn, of them one without sides, over several blocks of those that are looked at side by
  // side.
  test::AnalyticSurface surface(4, [](std::size_t, Vec2d) { return SurfaceSample(); });
  TessellationRates rates;
  constexpr std::uint32_t kFaces = 20000;
  for (std::uint32_t face = 0; face < kFaces; ++face) {
    std::vector<FaceEdge> sides;
    for (std::uint32_t i = 0; i < 4 && face % 4 != 3; ++i) sides.push_back({4 * face + i, i, false, false});
    if (face % 4 == 2) sides.pop_back();
    surface.add_face(face % 4 == 2 ? FaceDomain::triangle : FaceDomain::quad, sides);
    rates.inner.push_back({2, 2});
  }
  rates.edges.assign(surface.edge_count(), 2);
  for (std::uint32_t face = 1; face < kFaces; face += 4) rates.edges[4 * face] = 3;
  const FacetPatternSet set(surface, rates), small(surface, rates, 1);
  EXPECT_EQ(set.pattern_count(), 3u);
  std::vector<std::uint16_t> face_rates;
  for (std::size_t face = 0; face < kFaces; ++face) {
    if (face % 4 == 3) {
      EXPECT_EQ(set.kept(face), nullptr) << "a hole";
      EXPECT_EQ(set.counts(face).facets, 0u);
      continue;
    }
    rates_of_face(surface, rates, face, face_rates);
    const FacetCounts counts = count_facets(surface.domain(face), face_rates);
    ASSERT_NE(set.kept(face), nullptr);
    EXPECT_EQ(set.kept(face), set.kept(face % 4)) << "the same pattern";
    EXPECT_EQ(set.kept(face)->facet_count(), counts.facets);
    EXPECT_EQ(set.counts(face).facets, counts.facets);
    EXPECT_EQ(set.counts(face).interior, counts.interior);
    EXPECT_EQ(small.kept(face) != nullptr, face % 4 == 0) << "one pattern fills the bytes";
    EXPECT_EQ(small.counts(face).facets, counts.facets);
  }
}

TEST(FacetPattern, FacesOfTooManyFacetsAreRefused) {
  EXPECT_THROW(make_facet_pattern(FaceDomain::quad_subfaces, Rates(60001, 1024)), Error);
  EXPECT_EQ(count_facets(FaceDomain::quad_subfaces, Rates(60001, 1)).facets, 60000u);
}

}  // namespace
}  // namespace raytree
