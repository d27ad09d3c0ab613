// Hits that are none: beside thin triangles at grazing rays, in boxes too wide for single precision, at scales that it
// does not hold.
#include <algorithm>
#include <cmath>

#include "benchmarks/ray_comparison.h"
#include "benchmarks/stability/case_pictures.h"
#include "benchmarks/stability/intersection_cases.h"
#include "benchmarks/stability/ray_probes.h"
#include "geometry/angle.h"
#include "geometry/embree_intersector.h"
#include "geometry/triangle_reference.h"
#include "renderer/float_mode.h"

namespace raytree::benchmarks {
namespace {

/// What a set of rays found, beside the truth in double.
struct AgainstTruth {
  std::size_t rays = 0, hits = 0;
  std::size_t misses = 0, false_hits = 0;  ///< of the tracer, as they are
  std::size_t unexplained = 0;             ///< answers that no rounding bound of this ray and surface allows
};

void compare_with_truth(const ShapeSet& shapes, const EmbreeIntersector& tracer, const std::vector<ProbeRay>& rays,
                        AgainstTruth& sum) {
  const TriangleReference truth(shapes);
  const RayJudge judge(shapes, tracer, shapes, truth);
  const std::vector<Hit> hits = hits_of(tracer, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const ComparedRay ray{rays[i].origin, rays[i].direction, kInfinity, false};
    const ReferenceHit found = judge.ask_truth(ray);
    const bool hit = hits[i].geometry != kNoGeometry;
    ++sum.rays;
    sum.hits += hit;
    sum.misses += !hit && found.hit();
    sum.false_hits += hit && !found.hit();
    sum.unexplained += judge.nearest(ray, hits[i], found).verdict == RayVerdict::defect;
  }
}

/// The triangles of Embree issue 387, whose edges round to 11.2, 9.7 and 1.4 units: the longest, along which the apex
/// stands so far, and its least and largest height over it, in powers of ten.
constexpr double kLong = 11.16, kApexAlong = 9.73, kLeastApex = -5, kMostApex = -0.7;

/// Places of hits in the triangle's plane, in its longest edges: x along that edge, y across. The triangle blue, what
/// lies in it light, what lies off it by a hundredth orange.
StabilityPicture hit_place_picture(std::string caption, const std::vector<Vec2d>& places, const Vec2d& apex) {
  constexpr int kWidth = 280, kHeight = 60, kScale = 180;  // pixels; for one edge
  std::vector<int> seen(std::size_t(kWidth) * kHeight);
  const auto off = [&](const Vec2d& p) {
    // Of a triangle over the x axis: how far outside of its three sides.
    const Vec2d side = apex - Vec2d(1, 0);
    return std::max(
        {-p.y, (apex.x * p.y - apex.y * p.x) / apex.length(), (side.y * (p.x - 1) - side.x * p.y) / side.length()});
  };
  for (const Vec2d& p : places) {
    const int x = static_cast<int>(std::floor(p.x * kScale)) + (kWidth - kScale) / 2,
              y = kHeight / 2 - static_cast<int>(std::floor(p.y * kScale));
    if (x < 0 || x >= kWidth || y < 0 || y >= kHeight) continue;
    int& pixel = seen[std::size_t(y) * kWidth + std::size_t(x)];
    pixel = std::max(pixel, off(p) > 0.01 ? 2 : 1);
  }
  return painted_picture(
      std::move(caption), kWidth, kHeight,
      [&](int x, int y) {
        const Vec2d p((x + 0.5 - (kWidth - kScale) / 2.0) / kScale, (kHeight / 2.0 - y + 0.5) / kScale);
        const int what = seen[std::size_t(y) * kWidth + std::size_t(x)];
        if (what != 0) return what == 2 ? kFaultColor : kPaperColor;
        return off(p) <= 0 ? kSoundColor : kDarkColor;
      },
      2);
}

/// Rays 0.52 degrees over the plane of such triangles from less than 600 units away.
StabilityResult run_phantom_hits(const StabilityRun& run) {
  ProbeRandom random(39);
  constexpr double kGrazing = 0.52 * kDegree, kFar = 590;

  const std::size_t triangles = probe_count(run, 150, 60);
  AgainstTruth sum;
  double by_distance = 0, by_weights = 0;  // out of the triangle's box, in lengths of its longest edge
  std::vector<Vec2d> places_by_distance, places_by_weights;
  for (std::size_t t = 0; t < triangles; ++t) {
    const Vec3d x = random.direction(), d = random.direction(), y = unit(d - x * d.dot(x)), n = x.cross(y);
    const Vec3d place = random.in_cube(300);
    const double across = std::pow(10.0, random.uniform(kLeastApex, kMostApex));
    const Vec3d corners[3] = {place, place + x * kLong, place + x * kApexAlong + y * across};
    const ShapeSet shapes = triangle_soup({Vec3f(corners[0]), Vec3f(corners[1]), Vec3f(corners[2])});
    const EmbreeIntersector tracer(shapes, run.tracer_options());
    std::vector<ProbeRay> rays;
    for (int i = 0; i < 512; ++i) {
      const double azimuth = random.uniform(0, 2 * kPi);
      const Vec3d back = (x * std::cos(azimuth) + y * std::sin(azimuth)) * std::cos(kGrazing) + n * std::sin(kGrazing);
      // Half of them at the triangle, half past it by up to its size.
      const double reach = i % 2 == 0 ? 1 : 2;
      double u = random.uniform(0, reach), v = random.uniform(0, reach);
      if (i % 2 == 0 && u + v > 1) u = 1 - u, v = 1 - v;
      const Vec3d target = corners[0] * (1 - u - v) + corners[1] * u + corners[2] * v;
      rays.push_back(ray_to(target + back * random.uniform(20, kFar), target));
    }
    compare_with_truth(shapes, tracer, rays, sum);
    const auto hits = hits_of(tracer, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (hits[i].geometry == kNoGeometry) continue;
      const SurfacePoint point = surface_at(shapes, rays[i].origin, rays[i].direction, hits[i], false);
      const Vec3d ran = Vec3d(rays[i].origin) + Vec3d(rays[i].direction) * double(hits[i].distance);
      const Vec3d a = corner_of(shapes, 0, 0), b = corner_of(shapes, 0, 1), c = corner_of(shapes, 0, 2);
      const auto out_of_box = [&](const Vec3d& p) {
        double out = 0;
        for (int axis = 0; axis < 3; ++axis)
          out = std::max(
              {out, p[axis] - std::max({a[axis], b[axis], c[axis]}), std::min({a[axis], b[axis], c[axis]}) - p[axis]});
        return out / kLong;
      };
      by_distance = std::max(by_distance, out_of_box(ran));
      by_weights = std::max(by_weights, out_of_box(Vec3d(point.position)));
      const auto in_plane = [&](const Vec3d& p) { return Vec2d((p - place).dot(x), (p - place).dot(y)) / kLong; };
      places_by_distance.push_back(in_plane(ran)), places_by_weights.push_back(in_plane(Vec3d(point.position)));
    }
  }
  StabilityResult result;
  result.figures.push_back(known_failure("place from origin and distance",
                                         "farthest out of the triangle's box, longest edges", by_distance, 1, 2e3,
                                         "1e3: distance 12291 in a scene of 600 (Embree issue 387)"));
  if (run.pictures) {
    const Vec2d apex = Vec2d(kApexAlong, std::pow(10.0, kMostApex)) / kLong;
    result.pictures.push_back(
        hit_place_picture("Where hits of thin triangles lie in their plane, from origin and distance: beside them "
                          "(orange) by more than a hundredth of their length",
                          places_by_distance, apex));
    result.pictures.push_back(
        hit_place_picture("The same hits from weights: in the triangle", places_by_weights, apex));
  }
  result.figures.push_back(held("place from weights, as the renderer has it", "the same", by_weights, 0,
                                // Coordinates of up to 900 units: 5 half ulps of 1024.
                                5 * double(kRoundoff) * 1024 / kLong, "5 half ulps of the coordinates"));
  result.figures.push_back(held("the renderer's tracer", "hits and misses that no bound on rounding allows",
                                static_cast<double>(sum.unexplained), 0, 0, "0 (docs/validation.md)"));
  return result;
}

constexpr double kBoxHeight = 1.2e5, kOverBox = 500;

/// Rays straight down from 500 units over the lid of a box of so many units' width, 1.2e5 tall.
AgainstTruth over_wide_box(const StabilityRun& run, double width, double& worst) {
  ProbeRandom random(40);
  const double h = width / 2;
  std::vector<Vec3f> p;
  for (int i = 0; i < 8; ++i)
    p.push_back(Vec3f(Vec3d((i & 1) != 0 ? h : -h, (i & 2) != 0 ? h : -h, (i & 4) != 0 ? kBoxHeight : 0)));
  ShapeSet box = triangle_soup({});
  box.meshes[0].mesh.positions.assign(p.begin(), p.end());
  box.meshes[0].mesh.corners.assign(
      {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5});
  const EmbreeIntersector tracer(box, run.tracer_options());
  std::vector<ProbeRay> rays;
  for (std::size_t i = 0; i < probe_count(run, 8000, 2000); ++i)
    rays.push_back({Vec3f(Vec3d(random.uniform(-0.9, 0.9) * h, random.uniform(-0.9, 0.9) * h, kBoxHeight + kOverBox)),
                    {0, 0, -1}});
  AgainstTruth sum;
  compare_with_truth(box, tracer, rays, sum);
  worst = 0;
  std::size_t wrong = 0;
  for (const Hit& hit : hits_of(tracer, rays)) {
    const double off = hit.geometry == kNoGeometry ? kBoxHeight : std::abs(hit.distance - kOverBox);
    worst = std::max(worst, off);
    wrong += off > 1;
  }
  sum.false_hits = wrong;
  return sum;
}

StabilityResult run_wide_box(const StabilityRun& run) {
  StabilityResult result;
  double worst = 0;
  const auto share = [](std::size_t n, std::size_t of) { return static_cast<double>(n) / static_cast<double>(of); };
  for (const double width : {5.89e11, 1.2e9}) {
    const AgainstTruth sum = over_wide_box(run, width, worst);
    const std::string box = width > 1e10 ? ", box 5.9e11 wide and 1.2e5 tall" : ", box 1.2e9 wide and 1.2e5 tall";
    result.figures.push_back(held("the renderer's tracer", "rays answered more than a unit off" + box,
                                  share(sum.false_hits, sum.rays), 0, 0,
                                  "0 with Embree 3.13.5; false hits near the bottom before (Embree issue 416)"));
    // Of heights alone: rays run straight down.
    result.figures.push_back(held("the renderer's tracer", "worst distance, heights" + box, worst / kBoxHeight, 0,
                                  8 * double(kRoundoff), "rounding of the height: 8 half ulps"));
    result.figures.push_back(held("the renderer's tracer", "answers that no bound on rounding allows" + box,
                                  share(sum.unexplained, sum.rays), 0, 0, "0 (docs/validation.md)"));
  }
  result.nothing_to_see =
      "every ray is answered right, to the rounding of its height. The false hits are those of other releases of "
      "Embree.";
  return result;
}

struct ScaleCheck {
  int rays = 0, distances = 0, places = 0;  ///< `distances`, `places`: that hit where they should

  bool all_distances() const { return distances == rays; }
  bool all_places() const { return places == rays; }
};

/// Rays at a quad of that size: distances within 32 half ulps of coordinates of 3 sizes, the renderer's places
/// likewise.
ScaleCheck check_scale(const StabilityRun& run, double scale) {
  ProbeRandom random(41);
  const Vec3d n = unit(Vec3d(1, 2, 3)), x = unit(n.cross(Vec3d(0, 1, 0))), y = n.cross(x);
  const ShapeSet quad = quad_of_triangles((x + y) * (-scale), x * (2 * scale), y * (2 * scale));
  const EmbreeIntersector tracer(quad, run.tracer_options());
  std::vector<ProbeRay> rays;
  std::vector<double> distances;
  const Vec3d a = corner_of(quad, 0, 0);
  for (int i = 0; i < 256; ++i) {
    const Vec3d to = (x * random.uniform(-0.9, 0.9) + y * random.uniform(-0.9, 0.9)) * scale;
    const Vec3d from = to + unit(n + (x * random.uniform(-1, 1) + y * random.uniform(-1, 1))) * (2 * scale);
    rays.push_back(ray_to(from, to));
    distances.push_back((a - Vec3d(rays.back().origin)).dot(n) / Vec3d(rays.back().direction).dot(n));
  }
  const auto hits = hits_of(tracer, rays);
  // A slope of at least 1/2, a dozen steps of rounding each: surface_bounds() has less.
  const double most = 32 * double(kRoundoff) * 3 * scale;
  ScaleCheck check;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool hit = hits[i].geometry != kNoGeometry;
    ++check.rays;
    if (!hit) continue;
    check.distances += std::abs(hits[i].distance - distances[i]) <= most;
    const Vec3d place(surface_at(quad, rays[i].origin, rays[i].direction, hits[i], false).position);
    check.places += (place - Vec3d(rays[i].origin) - Vec3d(rays[i].direction) * distances[i]).length() <= most;
  }
  return check;
}

StabilityResult run_scales(const StabilityRun& run) {
  const FlushDenormals as_while_tracing;
  // From 1 outward, decade by decade: what holds at 1e15 says nothing once 1e14 fails.
  const auto last_decade = [&](bool (ScaleCheck::*part)() const, int step) {
    int decade = 0;
    while (std::abs(decade) < 30 && (check_scale(run, std::pow(10.0, decade + step)).*part)()) decade += step;
    return decade;
  };
  int failed_between = 0;
  for (int decade = -9; decade <= 12; ++decade) {
    const ScaleCheck check = check_scale(run, std::pow(10.0, decade));
    failed_between += !check.all_distances() || !check.all_places();
  }
  StabilityResult result;
  // The distance is a quotient of products of three lengths, which must stay within float's 1.2e-38 to 3.4e38: sizes
  // of 2e-13 to 7e12, or somewhat less for lengths of several sizes.
  const std::string cube = " hold: the size's cube within single precision's range";
  result.figures.push_back(known_failure("single precision, scene as given",
                                         "smallest size whose distances hold, power of ten",
                                         last_decade(&ScaleCheck::all_distances, -1), -13, -12, "1e-12" + cube));
  result.figures.push_back(known_failure("single precision, scene as given", "largest size that holds, power of ten",
                                         last_decade(&ScaleCheck::all_distances, 1), 12, 13, "1e12" + cube));
  // Embree's robust mode takes U + V + W, four times the area that the ray sees, for 0 below 1e-18: all weights are 0
  // then. This quad shows 2 size^2 times a cosine of at least 1/2 a triangle.
  result.figures.push_back(known_failure("weights of Embree's hits", "smallest size whose places hold, power of ten",
                                         last_decade(&ScaleCheck::all_places, -1), -9, -9,
                                         "1e-9: areas below 2.5e-19 have no weights"));
  result.figures.push_back(held("sizes from 1e-9 to 1e12", "decades where a ray misses or is off", failed_between, 0, 0,
                                "0; scene files refuse coordinates above 1e12"));
  if (run.pictures) {
    StabilityGraph graph{"Rays at a quad that are answered right, to rounding",
                         "size, units",
                         "share",
                         {{"distances", {}}, {"places from weights", {}}},
                         StabilityGraph::Scale::logarithmic,
                         StabilityGraph::Scale::linear};
    // Embree's assertions end the process at coordinates beyond 1.8e18.
    for (int decade = -16; decade <= 16; ++decade) {
      const ScaleCheck check = check_scale(run, std::pow(10.0, decade));
      graph.lines[0].points.emplace_back(std::pow(10.0, decade), double(check.distances) / check.rays);
      graph.lines[1].points.emplace_back(std::pow(10.0, decade), double(check.places) / check.rays);
    }
    result.graphs.push_back(std::move(graph));
  }
  return result;
}

}  // namespace

std::vector<StabilityCase> false_hit_cases() {
  return {{39, "phantom-hits", "Phantom hits beside thin triangles",
           "triangles with edges of 11.2, 9.7 and 1.4, less than .2 high, rays 0.52 degrees over them",
           "hit points from weights instead of distances; in the first figure from the distance", "Embree issue 387",
           run_phantom_hits},
          {40, "wide-box", "False hits in a box too wide", "rays straight down at a box of 5.9e11 by 1.2e5 units",
           "none is needed where rays run straight down; coordinates above 1e12 are refused", "Embree issue 416",
           run_wide_box},
          {41, "scales", "Scales that single precision does not hold", "one quad from 1e-30 to 1e30 units",
           "sizes from 1e-9 to 1e12; coordinates above 1e12 are refused", "Embree issue 42 and README", run_scales}};
}

}  // namespace raytree::benchmarks
