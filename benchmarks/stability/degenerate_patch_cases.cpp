// Rows 8 to 10: normals where P_u x P_v vanishes, each method against the limit of the normals around the place.
#include <algorithm>
#include <cmath>

#include "benchmarks/samples/patches.h"
#include "benchmarks/stability/case_pictures.h"
#include "benchmarks/stability/case_tools.h"
#include "benchmarks/stability/curved_parts.h"
#include "geometry/angle.h"
#include "geometry/patch_normal.h"

namespace raytree::benchmarks {
namespace {

using namespace samples;

constexpr int kPlaces = 65;          ///< of a singular edge, or one place so many times
constexpr double kRounding = 1e-12;  ///< degrees; normals in double are off by a few 1e-14

double degrees_apart(const Vec3d& a, const Vec3d& b) { return std::atan2(a.cross(b).length(), a.dot(b)) / kDegree; }

struct NormalError {
  double without = 0;  ///< share of the places that have no normal
  double worst = 0;    ///< of the others, degrees
};

/// place(t): parameters, t in [0, 1]; truth(t): the normal's direction.
template <class Place, class Truth>
NormalError outcome(const BezierPatch& patch, DegenerateNormal method, const Place& place, const Truth& truth) {
  NormalError result;
  for (int i = 0; i < kPlaces; ++i) {
    const double t = i / (kPlaces - 1.0);
    const Vec2d at = place(t);
    const Vec3d found = patch_normal(patch, evaluate(patch, at.x, at.y), at.x, at.y, derivative_scale(patch), method);
    if (found == Vec3d(0, 0, 0))
      result.without += 1.0 / kPlaces;
    else
      result.worst = std::max(result.worst, degrees_apart(found, truth(t)));
  }
  return result;
}

/// A method that finds no normal anywhere, as it is known not to.
StabilityFigure finds_none(const char* method, const char* where, const NormalError& error) {
  return known_failure(method, std::string("share of places without a normal, ") + where, error.without, 1 - kRounding,
                       1 + kRounding, "1: P_u x P_v vanishes");
}

void add_held(StabilityResult& result, const char* method, const char* where, const NormalError& error) {
  result.figures.push_back(
      held(method, std::string("share of places without a normal, ") + where, error.without, 0, 0, "0"));
  result.figures.push_back(held(method, std::string("degrees off the limit of normals around, ") + where, error.worst,
                                0, kRounding, "0 but for rounding"));
}

/// Patches of few facets in light from the side, with normals of each of the methods at the corners.
struct MethodShown {
  const char* caption;
  DegenerateNormal method;
};
void add_patch_pictures(StabilityResult& result, const StabilityRun& run, const std::vector<BezierPatch>& patches,
                        int along, int across, const ParallelView& view, std::initializer_list<MethodShown> shown) {
  if (!run.pictures) return;
  for (const auto& [caption, method] : shown)
    result.pictures.push_back(lit_picture(run, caption, cut_patches(patches, along, across, method), view));
}

StabilityResult collapsed_edge(const StabilityRun& run) {
  StabilityResult result;
  const std::vector<BezierCurve> profile{straight({1, 0, 0}, {0, 1, 0})};
  const BezierPatch cone = revolve(profile)[0], octant = sphere_patches()[4];
  const auto tip = [](double t) { return Vec2d(t, 1); };
  const auto around = [&](double t) {
    const Vec3d base = evaluate(cone, t, 0).position;
    return Vec3d(base.x, 1, base.z);
  };
  const auto up = [](double) { return Vec3d(0, 1, 0); };
  result.figures.push_back(
      finds_none("P_u x P_v", "tip of a cone", outcome(cone, DegenerateNormal::none, tip, around)));
  result.figures.push_back(
      finds_none("P_u x P_v", "pole of a sphere", outcome(octant, DegenerateNormal::none, tip, up)));
  // One normal for the whole tip, (1, 1, -1): off by acos(2 / sqrt 6) at both ends.
  const double one_normal = std::acos(2 / std::sqrt(6.0)) / kDegree;
  result.figures.push_back(known_failure("Gouraud's boundaries",
                                         "degrees off the limit of normals around, tip of a cone",
                                         outcome(cone, DegenerateNormal::gouraud, tip, around).worst, one_normal - 1e-9,
                                         one_normal + 1e-9, "35.3 = acos(2 / sqrt 6): one normal for all"));
  add_held(result, "first order, as OpenSubdiv", "tip of a cone",
           outcome(cone, DegenerateNormal::first_order, tip, around));
  add_held(result, "limit by power series", "tip of a cone", outcome(cone, DegenerateNormal::limit, tip, around));
  add_held(result, "limit by power series", "pole of a sphere", outcome(octant, DegenerateNormal::limit, tip, up));
  ParallelView view;
  view.middle = {0, 0.4, 0}, view.toward = {0.2, 0.9, 1}, view.to_light = {1, 0.9, 0.4};
  add_patch_pictures(result, run, revolve(profile), 4, 2, view,
                     {{"P_u x P_v: no normal at the tip, no light about it (orange)", DegenerateNormal::none},
                      {"Gouraud's: one normal a quarter, seams between them", DegenerateNormal::gouraud},
                      {"limit by power series: a cone", DegenerateNormal::limit}});
  return result;
}

/// x = u (1 - 2 v), y = 2 u v (1 - v), z = u^2: half a bowl whose two boundaries make one straight line through the
/// tip.
BezierPatch bowl() {
  Monomials a = no_monomials();
  a[0][1] = {1, 0, 0};
  a[1][1] = {-2, 2, 0};
  a[2][1] = {0, -2, 0};
  a[0][2] = {0, 0, 1};
  return patch_of_monomials(a);
}

/// x = u, y = (v - 1/2) u^2, z = u + u^2: all curves leave the tip in one direction. On the cylinder z = x + x^2, so
/// the normal at the tip is (-1, 0, 1).
BezierPatch cusp() {
  Monomials a = no_monomials();
  a[0][1] = {1, 0, 1};
  a[0][2] = {0, -0.5, 1};
  a[1][2] = {0, 1, 0};
  return patch_of_monomials(a);
}

StabilityResult tangent_boundaries(const StabilityRun& run) {
  StabilityResult result;
  const auto tip = [](double t) { return Vec2d(0, t); };
  const auto up = [](double) { return Vec3d(0, 0, 1); };
  const auto leaning = [](double) { return Vec3d(-1, 0, 1); };
  result.figures.push_back(finds_none("Gouraud's boundaries", "boundaries in one line",
                                      outcome(bowl(), DegenerateNormal::gouraud, tip, up)));
  result.figures.push_back(
      finds_none("Gouraud's boundaries", "a cusp", outcome(cusp(), DegenerateNormal::gouraud, tip, leaning)));
  result.figures.push_back(
      finds_none("first order, as OpenSubdiv", "a cusp", outcome(cusp(), DegenerateNormal::first_order, tip, leaning)));
  add_held(result, "first order, as OpenSubdiv", "boundaries in one line",
           outcome(bowl(), DegenerateNormal::first_order, tip, up));
  add_held(result, "limit by power series", "boundaries in one line",
           outcome(bowl(), DegenerateNormal::limit, tip, up));
  add_held(result, "limit by power series", "a cusp", outcome(cusp(), DegenerateNormal::limit, tip, leaning));
  ParallelView view;
  view.middle = {0, 0.3, 0.3}, view.toward = {0.2, -1, 1.4}, view.to_light = {0.8, -0.3, 1};
  add_patch_pictures(result, run, {bowl()}, 4, 12, view,
                     {{"Half a bowl, Gouraud's boundaries: no light at the tip", DegenerateNormal::gouraud},
                      {"Limit by power series", DegenerateNormal::limit}});
  view.middle = {0.5, 0, 0.8}, view.toward = {-1, 0.5, 1}, view.to_light = {-0.3, 0.4, 1};
  add_patch_pictures(result, run, {cusp()}, 4, 4, view,
                     {{"A cusp, first order as OpenSubdiv: no light at the tip", DegenerateNormal::first_order},
                      {"Limit by power series: lit to the tip", DegenerateNormal::limit}});
  return result;
}

StabilityResult parallel_partials(const StabilityRun& run) {
  StabilityResult result;
  // x = u + v, y = v^2 - u^2, z = x + y: a plane with normal (-1, -1, 1).
  Monomials a = no_monomials();
  a[0][1] = a[1][0] = {1, 0, 1};
  a[0][2] = {0, -1, -1};
  a[2][0] = {0, 1, 1};
  const BezierPatch patch = patch_of_monomials(a);
  const auto corner = [](double) { return Vec2d(0, 0); };
  const auto truth = [](double) { return Vec3d(-1, -1, 1); };
  const char* const where = "corner of a plane";
  result.figures.push_back(finds_none("P_u x P_v", where, outcome(patch, DegenerateNormal::none, corner, truth)));
  result.figures.push_back(
      finds_none("Gouraud's boundaries", where, outcome(patch, DegenerateNormal::gouraud, corner, truth)));
  add_held(result, "first order, as OpenSubdiv", where, outcome(patch, DegenerateNormal::first_order, corner, truth));
  add_held(result, "limit by power series", where, outcome(patch, DegenerateNormal::limit, corner, truth));
  ParallelView view;
  view.middle = {1, 0, 1}, view.toward = {-1, -1, 1}, view.to_light = {-1, 0.6, 1}, view.window = 3.2;
  add_patch_pictures(
      result, run, {patch}, 4, 4, view,
      {{"P_u x P_v, and Gouraud's: no light in the corner of a plane (orange)", DegenerateNormal::gouraud},
       {"First order, as OpenSubdiv", DegenerateNormal::first_order},
       {"Limit by power series", DegenerateNormal::limit}});
  return result;
}

}  // namespace

std::vector<StabilityCase> degenerate_patch_cases() {
  constexpr const char* kRemedy =
      "the first term of the normals' power series toward the inside; off: P_u x P_v, Gouraud's";
  return {
      {8, "collapsed-edge", "An edge that is a point", "the tip of a cone and the pole of a sphere, as patches",
       kRemedy, "Gouraud 1971, p. 27, fig. 10; OpenSubdiv issue 947", collapsed_edge},
      {9, "tangent-boundaries", "A point where boundaries are tangent", "a bowl and a cusp that end in a tip", kRemedy,
       "Gouraud 1971, p. 28", tangent_boundaries},
      {10, "parallel-partials", "Parallel partials at a smooth corner", "P_u and P_v parallel in a corner of a plane",
       kRemedy, "OpenSubdiv issues 947 and 1352", parallel_partials}};
}

}  // namespace raytree::benchmarks
