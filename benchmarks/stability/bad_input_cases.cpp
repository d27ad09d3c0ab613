// What is no triangle and no ray: vertices that are not finite, triangles without area, rays in a triangle's plane,
// rays without a direction.
#include <cmath>
#include <limits>

#include "benchmarks/ray_comparison.h"
#include "benchmarks/stability/case_pictures.h"
#include "benchmarks/stability/intersection_cases.h"
#include "benchmarks/stability/ray_probes.h"
#include "geometry/angle.h"
#include "geometry/embree_intersector.h"
#include "geometry/mesh_checks.h"
#include "geometry/triangle_reference.h"
#include "geometry/vertex_normals.h"

namespace raytree::benchmarks {
namespace {

constexpr float kPoison = std::numeric_limits<float>::quiet_NaN();

bool is_finite_vector(const Vec3f& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Hits of rays at the ball from outside whose surface is not finite, or whose normal is not a unit one.
std::size_t not_finite_surfaces(const StabilityRun& run, const ShapeSet& shapes, ProbeRandom& random) {
  const EmbreeIntersector tracer(shapes, run.tracer_options());
  std::vector<ProbeRay> rays;
  for (std::size_t i = 0; i < probe_count(run, 10000, 4000); ++i)
    rays.push_back(ray_to(random.direction() * 3.0, random.direction() * random.uniform(0, 1)));
  std::size_t bad = 0;
  const auto hits = hits_of(tracer, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].geometry == kNoGeometry) continue;
    const SurfacePoint point = surface_at(shapes, rays[i].origin, rays[i].direction, hits[i], false);
    bad += !is_finite_vector(point.position) || !std::isfinite(point.clearance) ||
           !(std::abs(point.geometric_normal.length() - 1) < 1e-6f);
  }
  return bad;
}

/// As a mesh that was read, settled: what cannot be drawn is dropped. Returns the faces that the warnings count.
std::int64_t settled_drops(PolygonMesh& mesh) {
  Warnings warnings;
  const MeshLocator nowhere{[](std::size_t) { return SourceLocation(); }, [](std::size_t) { return SourceLocation(); }};
  settle_mesh(mesh, "mesh", nowhere, warnings);
  std::int64_t dropped = 0;
  for (const Warning& warning : warnings)
    if (warning.message.rfind("faces", 0) == 0) dropped += warning.count;
  return dropped;
}

PolygonMesh polygons_of(const ShapeSet& shapes) {
  PolygonMesh mesh;
  mesh.positions = shapes.meshes[0].mesh.positions;
  mesh.corners = shapes.meshes[0].mesh.corners;
  return mesh;
}

ShapeSet shapes_of(const PolygonMesh& mesh) {
  ShapeSet shapes = triangle_soup({});
  shapes.meshes[0].mesh.positions = mesh.positions;
  shapes.meshes[0].mesh.corners = mesh.corners;
  return shapes;
}

constexpr int kBallPixels = 170;

/// Rays of a picture of the unit ball, row by row, kBallPixels each way.
std::vector<ProbeRay> rays_at_ball() {
  constexpr double kPixel = 2.2 / kBallPixels;
  std::vector<ProbeRay> rays;
  for (int y = 0; y < kBallPixels; ++y)
    for (int x = 0; x < kBallPixels; ++x)
      rays.push_back({Vec3f(Vec3d((x + 0.5) * kPixel - 1.1, 1.1 - (y + 0.5) * kPixel, 3)), {0, 0, -1}});
  return rays;
}

/// What the tracer answers to them, facets by the lamp at the viewer: from outside light, from inside dark; orange
/// where `is_faulty` says so of a ray and its hit.
template <class IsFaulty>
StabilityPicture ball_picture(const StabilityRun& run, std::string caption, const ShapeSet& shapes,
                              const std::vector<ProbeRay>& rays, const IsFaulty& is_faulty) {
  const EmbreeIntersector tracer(shapes, run.tracer_options());
  const std::vector<Hit> hits = hits_of(tracer, rays);
  return painted_picture(std::move(caption), kBallPixels, kBallPixels, [&](int x, int y) {
    const auto i = static_cast<std::size_t>(y * kBallPixels + x);
    if (is_faulty(i, hits[i])) return kFaultColor;
    if (hits[i].geometry == kNoGeometry) return kPaperColor;
    const double cosine =
        -surface_at(shapes, rays[i].origin, rays[i].direction, hits[i], false).geometric_normal.dot(rays[i].direction);
    return cosine > 0 ? gray(0.05 + 0.6 * cosine) : scaled_color(kSoundColor, -0.5 * cosine);
  });
}

StabilityResult run_poisoned_vertices(const StabilityRun& run) {
  ProbeRandom random(46);
  const ShapeSet ball = ball_of_triangles(48, 24, 1, {0, 0, 0});
  PolygonMesh mesh = polygons_of(ball);
  for (std::size_t i = 7; i < mesh.positions.size(); i += 31) mesh.positions[i].y = i % 2 == 0 ? kPoison : kInfinity;
  std::size_t poisoned = 0, untreated = 0;
  std::vector<bool> is_poisoned(mesh.face_count());
  for (std::size_t t = 0; t < mesh.face_count(); ++t) {
    const Vec3f &a = mesh.positions[mesh.corners[3 * t]], &b = mesh.positions[mesh.corners[3 * t + 1]],
                &c = mesh.positions[mesh.corners[3 * t + 2]];
    if (is_finite_vector(a) && is_finite_vector(b) && is_finite_vector(c)) continue;
    ++poisoned;
    is_poisoned[t] = true;
    untreated += !is_finite_vector(detail::solve_triangle(a, b, c, 0.25f, 0.25f).position);
  }
  const std::size_t before = mesh.face_count();
  const std::int64_t counted = settled_drops(mesh);
  const ShapeSet settled = shapes_of(mesh);
  std::size_t left = 0;
  for (const Vec3f& p : settled.meshes[0].mesh.positions) left += !is_finite_vector(p);
  StabilityResult result;
  const auto share = [&](std::size_t n) { return static_cast<double>(n) / static_cast<double>(poisoned); };
  result.figures.push_back(known_failure("triangles as they were read",
                                         "share of poisoned ones whose points are no numbers", share(untreated), 1, 1,
                                         "1; Embree drops such triangles without a word"));
  result.figures.push_back(
      held("settled mesh", "faces dropped, of the poisoned ones", share(before - mesh.face_count()), 1, 1, "1"));
  result.figures.push_back(held("settled mesh", "faces counted in the warning, of the poisoned ones",
                                static_cast<double>(counted) / static_cast<double>(poisoned), 1, 1, "1"));
  result.figures.push_back(held("settled mesh", "positions and hits that are not finite",
                                static_cast<double>(left + not_finite_surfaces(run, settled, random)), 0, 0, "0"));
  if (run.pictures) {
    const std::vector<ProbeRay> rays = rays_at_ball();
    result.pictures.push_back(ball_picture(
        run, "Faces with a corner that is no number (orange), where they would be", ball, rays,
        [&](std::size_t, const Hit& hit) { return hit.geometry != kNoGeometry && is_poisoned[hit.primitive]; }));
    result.pictures.push_back(ball_picture(run, "Settled: they are dropped, counted and warned of, the others stay",
                                           settled, rays, [](std::size_t, const Hit&) { return false; }));
  }
  return result;
}

/// A ball with a triangle without area on one edge in 61, lit by normals of its corners: sums of n / |n|, or as the
/// renderer makes them.
LitTriangles ball_with_empty_triangles(bool as_rendered) {
  PolygonMesh mesh = polygons_of(ball_of_triangles(32, 16, 1, {0, 0, 0}));
  const std::size_t sound = mesh.face_count();
  for (std::uint32_t t = 0; t < sound; t += 61) {
    const std::uint32_t a = mesh.corners[3 * t], b = mesh.corners[3 * t + 1];
    const Vec3f place = mesh.positions[b];
    for (const std::uint32_t corner : {a, b, static_cast<std::uint32_t>(mesh.positions.size())})
      mesh.corners.push_back(corner);
    mesh.positions.push_back(place);
  }
  std::vector<Vec3f> normals(mesh.positions.size(), Vec3f(0));
  std::vector<Vec3f> corners;
  for (std::size_t t = 0; t < mesh.face_count(); ++t) {
    const std::uint32_t* const face = &mesh.corners[3 * t];
    const Vec3f& a = mesh.positions[face[0]];
    const Vec3f n = unit((mesh.positions[face[1]] - a).cross(mesh.positions[face[2]] - a));
    for (int c = 0; c < 3; ++c) normals[face[c]] += n;
  }
  if (as_rendered) {
    compute_vertex_normals(mesh, kPi);
    normals.assign(mesh.normals.begin(), mesh.normals.end());
  }
  LitTriangles lit;
  for (std::size_t i = 0; i < 3 * sound; ++i) {
    corners.push_back(mesh.positions[mesh.corners[i]]);
    lit.normals.push_back(
        normals[as_rendered && !mesh.normal_corners.empty() ? mesh.normal_corners[i] : mesh.corners[i]]);
  }
  lit.shapes = triangle_soup(corners);
  return lit;
}

StabilityResult run_degenerate_triangles(const StabilityRun& run) {
  ProbeRandom random(47);
  const ShapeSet ball = ball_of_triangles(48, 24, 1, {0, 0, 0});
  PolygonMesh mesh = polygons_of(ball);
  const std::size_t sound = mesh.face_count();
  // On every fifth triangle's edge one more: with a corner used twice, with two corners in one place, or with a third
  // corner on the edge, as near as single precision has it.
  std::size_t repeated = 0, empty = 0, without_normal = 0;
  for (std::uint32_t t = 0; t < sound; t += 5) {
    const std::uint32_t a = mesh.corners[3 * t], b = mesh.corners[3 * t + 1];
    const Vec3f p = mesh.positions[a], q = mesh.positions[b];
    std::uint32_t third = a;
    if (t % 3 == 0) {
      ++repeated;
    } else {
      third = static_cast<std::uint32_t>(mesh.positions.size());
      mesh.positions.push_back(t % 3 == 1 ? q : (p + q) * 0.5f);
      if (t % 3 == 1) {
        ++empty;
        without_normal += !is_finite_vector(unit((q - p).cross(mesh.positions[third] - p)));
      }
    }
    for (const std::uint32_t corner : {a, b, third}) mesh.corners.push_back(corner);
  }
  const std::size_t planted = mesh.face_count();
  const std::int64_t counted = settled_drops(mesh);
  const ShapeSet settled = shapes_of(mesh);
  const EmbreeIntersector tracer(settled, run.tracer_options());
  const TriangleReference truth(settled);
  const RayJudge judge(settled, tracer, settled, truth);
  // Rays at the triangles without area themselves.
  std::size_t on_empty = 0, unexplained = 0;
  for (std::size_t t = sound; t < settled.meshes[0].mesh.triangle_count(); ++t) {
    std::vector<ProbeRay> rays;
    for (int i = 0; i < 20; ++i) {
      const double s = random.uniform(0, 1);
      rays.push_back(ray_to(random.in_cube(0.3), corner_of(settled, t, 0) * (1 - s) + corner_of(settled, t, 1) * s));
    }
    const auto hits = hits_of(tracer, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const ComparedRay ray{rays[i].origin, rays[i].direction, kInfinity, false};
      unexplained += judge.nearest(ray, hits[i], judge.ask_truth(ray)).verdict == RayVerdict::defect;
      if (hits[i].geometry == kNoGeometry || hits[i].primitive < sound) continue;
      on_empty += corner_of(settled, hits[i].primitive, 1) == corner_of(settled, hits[i].primitive, 2);
    }
  }
  StabilityResult result;
  result.figures.push_back(known_failure("cross product over its length", "triangles of area 0 without a normal, share",
                                         static_cast<double>(without_normal) / static_cast<double>(empty), 1, 1,
                                         "1: 0 / 0"));
  result.figures.push_back(held("settled mesh", "faces that use a corner twice: dropped, share",
                                static_cast<double>(planted - mesh.face_count()) / static_cast<double>(repeated), 1, 1,
                                "1"));
  result.figures.push_back(held("settled mesh", "faces that use a corner twice: counted in the warning, share",
                                static_cast<double>(counted) / static_cast<double>(repeated), 1, 1, "1"));
  result.figures.push_back(held("the renderer's tracer", "rays at triangles of area 0 that hit them",
                                static_cast<double>(on_empty), 0, 0, "0"));
  result.figures.push_back(held("the renderer's tracer", "answers there that no bound on rounding allows",
                                static_cast<double>(unexplained), 0, 0, "0 (docs/validation.md)"));
  result.figures.push_back(held("the renderer's tracer", "hits without a place or a normal",
                                static_cast<double>(not_finite_surfaces(run, settled, random)), 0, 0, "0"));
  if (run.pictures) {
    ParallelView view;
    view.to_light = {0.6, 0.7, 1};
    result.pictures.push_back(
        lit_picture(run, "Vertex normals as sums of n / |n|: a triangle without area takes the light about its corners",
                    ball_with_empty_triangles(false), view));
    result.pictures.push_back(lit_picture(run, "The renderer's vertex normals: what has no area counts for nothing",
                                          ball_with_empty_triangles(true), view));
  }
  return result;
}

/// Rays from all sides that start up to eight half ulps under and over a quad's plane, five rows each, and aim into the
/// quad: blue where they meet it, orange where the test in double says otherwise.
StabilityPicture coplanar_picture(const StabilityRun& run, std::string caption, const Vec3d& normal,
                                  const Vec3d& place) {
  constexpr int kWidth = 240, kSteps = 8, kRows = 5;
  const Vec3d x = unit(normal.cross(Vec3d(0, 0, 1))), y = normal.cross(x);
  const ShapeSet quad = quad_of_triangles(place - x - y, x * 2.0, y * 2.0);
  const EmbreeIntersector tracer(quad, run.tracer_options());
  const TriangleReference truth(quad);
  return painted_picture(std::move(caption), kWidth, (2 * kSteps + 1) * kRows, [&](int column, int row) {
    const double azimuth = 2 * kPi * (column + 0.5) / kWidth, above = (kSteps - row / kRows) * double(kRoundoff);
    const Vec3d from = place + (x * std::cos(azimuth) + y * std::sin(azimuth)) * 3.0;
    const ProbeRay ray = ray_to(from + normal * above, place + x * 0.31 + y * 0.17);
    const bool hit = hit_of(tracer, ray).geometry != kNoGeometry;
    const bool is_hit = truth.nearest(Vec3d(ray.origin), Vec3d(ray.direction), kInfinity).hit();
    return hit != is_hit ? kFaultColor : hit ? kSoundColor : kDarkColor;
  });
}

StabilityResult run_coplanar_rays(const StabilityRun& run) {
  ProbeRandom random(48);
  std::size_t level_hits = 0, level_truth = 0, unexplained = 0, tilted_hits = 0, rays_each = 0;
  for (const bool level : {true, false}) {
    const Vec3d n = level ? Vec3d(0, 1, 0) : unit(Vec3d(1, 2, 3)), x = unit(n.cross(Vec3d(0, 0, 1))), y = n.cross(x);
    const Vec3d place = level ? Vec3d(0, 0.3, 0) : Vec3d(0.1, 0.2, 0.3);
    const ShapeSet quad = quad_of_triangles(place - x - y, x * 2.0, y * 2.0);
    const EmbreeIntersector tracer(quad, run.tracer_options());
    const TriangleReference truth(quad);
    const RayJudge judge(quad, tracer, quad, truth);
    std::vector<ProbeRay> rays;
    for (std::size_t i = 0; i < probe_count(run, 10000, 4000); ++i) {
      const double azimuth = random.uniform(0, 7);
      const Vec3d from = place + (x * std::cos(azimuth) + y * std::sin(azimuth)) * 3.0;
      rays.push_back(ray_to(from, place + x * random.uniform(-0.9, 0.9) + y * random.uniform(-0.9, 0.9)));
      if (level) rays.back().direction.y = 0, rays.back().origin.y = 0.3f;
    }
    rays_each = rays.size();
    const auto hits = hits_of(tracer, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const ComparedRay ray{rays[i].origin, rays[i].direction, kInfinity, false};
      const ReferenceHit found = judge.ask_truth(ray);
      const bool hit = hits[i].geometry != kNoGeometry;
      (level ? level_hits : tilted_hits) += hit;
      if (level) level_truth += found.hit();
      unexplained += judge.nearest(ray, hits[i], found).verdict == RayVerdict::defect;
    }
  }
  StabilityResult result;
  const auto share = [&](std::size_t n) { return static_cast<double>(n) / static_cast<double>(rays_each); };
  result.figures.push_back(held("the renderer's tracer", "rays in a level quad's plane that hit it", share(level_hits),
                                0, 0, "0 by convention (Embree issue 298)"));
  result.figures.push_back(held("watertight test in double", "the same", share(level_truth), 0, 0, "0 by convention"));
  result.figures.push_back(known_failure("rays rounded about a tilted plane", "rays that hit", share(tilted_hits), 0.05,
                                         0.95, "no limit known: rounding decides on which side each end lies"));
  result.figures.push_back(held("the renderer's tracer", "answers that no bound on rounding allows",
                                static_cast<double>(unexplained), 0, 0, "0 (docs/validation.md)"));
  if (run.pictures) {
    result.pictures.push_back(coplanar_picture(
        run, "Rays along a level quad from 8 half ulps over its plane to 8 under it: met (blue) but from within (dark)",
        {0, 1, 0}, {0, double(0.3f), 0}));
    result.pictures.push_back(
        coplanar_picture(run, "A tilted quad: near its plane rounding decides (orange: otherwise than in double)",
                         unit(Vec3d(1, 2, 3)), {0.1, 0.2, 0.3}));
  }
  return result;
}

/// Rays at a ball of which one in 36 is none, and the same without those.
void add_bad_ray_pictures(StabilityResult& result, const StabilityRun& run, const ShapeSet& ball) {
  const std::vector<ProbeRay> sane = rays_at_ball();
  std::vector<ProbeRay> poisoned = sane;
  for (std::size_t i = 0; i < poisoned.size(); ++i)
    if (i % kBallPixels % 6 == 3 && i / kBallPixels % 6 == 3)
      poisoned[i].direction.y = i % 4 == 0 ? kPoison : kInfinity;
  const EmbreeIntersector tracer(ball, run.tracer_options());
  const std::vector<Hit> expected = hits_of(tracer, sane);
  result.pictures.push_back(
      ball_picture(run, "One ray in 36 is no ray: without an answer (orange), those beside it as ever", ball, poisoned,
                   [&](std::size_t i, const Hit& hit) {
                     return hit.primitive != expected[i].primitive || hit.geometry != expected[i].geometry ||
                            !is_finite_vector(poisoned[i].direction);
                   }));
  result.pictures.push_back(
      ball_picture(run, "Sound rays alone", ball, sane, [](std::size_t, const Hit&) { return false; }));
}

StabilityResult run_bad_rays(const StabilityRun& run) {
  ProbeRandom random(49);
  const ShapeSet ball = ball_of_triangles(32, 16, 1, {0, 0, 0});
  const EmbreeIntersector tracer(ball, run.tracer_options());
  std::size_t found = 0, bad_rays = 0, moved = 0;
  const Vec3f poisons[] = {{kPoison, 0, 0}, {0, kInfinity, 0}, {0, 0, -kInfinity}};
  for (int round = 0; round < 40; ++round) {
    std::vector<ProbeRay> sane, poisoned;
    for (int i = 0; i < 16; ++i) sane.push_back(ray_to(random.direction() * 2.0, random.in_cube(0.4)));
    poisoned = sane;
    const std::size_t at = random.below(16), kind = random.below(7);
    if (kind < 3)
      poisoned[at].origin += poisons[kind];
    else if (kind < 6)
      poisoned[at].direction += poisons[kind - 3];
    else
      poisoned[at].direction = Vec3f(0, 0, 0);
    ++bad_rays;
    const auto expected = hits_of(tracer, sane), got = hits_of(tracer, poisoned);
    for (std::size_t i = 0; i < 16; ++i)
      if (i == at)
        found += got[i].geometry != kNoGeometry;
      else
        moved += got[i].geometry != expected[i].geometry || got[i].primitive != expected[i].primitive;
  }
  StabilityResult result;
  result.figures.push_back(held("check before the tracer", "rays without direction or number that hit",
                                static_cast<double>(found), 0, 0,
                                "0; Debian's Embree 3 ends the process at a NaN without the check"));
  result.figures.push_back(
      held("check before the tracer", "rays beside them whose answer changed", static_cast<double>(moved), 0, 0, "0"));
  result.figures.push_back(held("this case", "bad rays asked about", static_cast<double>(bad_rays), 40, 40, "40"));
  if (run.pictures) add_bad_ray_pictures(result, run, ball);
  return result;
}

}  // namespace

std::vector<StabilityCase> bad_input_cases() {
  return {{46, "poisoned-vertices", "Vertices that are no numbers", "NaN and infinities among a ball's vertices",
           "faces are dropped, counted and warned of when the mesh is read; off in the first figure",
           "Embree README (invalid geometry)", run_poisoned_vertices},
          {47, "degenerate-triangles", "Triangles without area", "corners used twice, corners on the opposite edge",
           "dropped and counted when the mesh is read; normals that hold for any area", "pbrt-v4 shapes tests",
           run_degenerate_triangles},
          {48, "coplanar-rays", "Rays in a triangle's plane", "rays along a level and a tilted quad",
           "no hit, by convention", "Embree issue 298", run_coplanar_rays},
          {49, "bad-rays", "Rays that are no rays", "NaN, infinities and directions of length 0 in packets",
           "every ray is checked before the tracer has it", "Embree's nan_test", run_bad_rays}};
}

}  // namespace raytree::benchmarks
