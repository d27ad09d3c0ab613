// Parametric surfaces with closed forms, for tests of tessellation: topology given as polygons, positions and normals
// by a formula.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "geometry/angle.h"
#include "geometry/parametric_surface.h"

namespace raytree::test {

/// Faces as polygons over numbered vertices; edges are numbered as they are met, with the direction of the face that
/// meets them first.
class AnalyticSurface : public ParametricSurface {
 public:
  using Evaluate = std::function<SurfaceSample(std::size_t face, Vec2d parameter)>;

  AnalyticSurface(std::size_t vertex_count, Evaluate evaluate)
      : evaluate_(std::move(evaluate)), vertex_count_(vertex_count) {}

  /// With edges of its own numbering: for surfaces where two vertices are joined by more than one edge.
  void add_face(FaceDomain domain, std::vector<FaceEdge> sides) {
    for (const FaceEdge& side : sides) edge_count_ = std::max<std::size_t>(edge_count_, side.edge + 1);
    domains_.push_back(domain);
    sides_.push_back(std::move(sides));
  }
  void add_face(FaceDomain domain, const std::vector<std::uint32_t>& vertices) {
    std::vector<FaceEdge> sides;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const std::uint32_t a = vertices[i], b = vertices[(i + 1) % vertices.size()];
      const auto [found, added] = numbers_.try_emplace(std::minmax(a, b), std::uint32_t(numbers_.size()), a);
      sides.push_back({found->second.first, a, found->second.second != a, false, false});
    }
    add_face(domain, std::move(sides));
  }
  void add_hole() { add_face(FaceDomain::quad, std::vector<FaceEdge>()); }
  FaceEdge& side(std::size_t face, std::size_t i) { return sides_[face][i]; }

  Vec3d origin() const override { return {0, 0, 0}; }
  std::size_t face_count() const override { return sides_.size(); }
  std::size_t edge_count() const override { return edge_count_; }
  std::size_t vertex_count() const override { return vertex_count_; }
  bool has_texture() const override { return textured; }
  FaceDomain domain(std::size_t face) const override { return domains_[face]; }
  std::span<const FaceEdge> sides(std::size_t face) const override { return sides_[face]; }
  void evaluate(std::size_t face, std::span<const Vec2f> parameters, std::span<SurfaceSample> samples) const override {
    for (std::size_t i = 0; i < parameters.size(); ++i) samples[i] = evaluate_(face, Vec2d(parameters[i]));
  }
  /// Texture coordinates are the parameters.
  void evaluate_texture(std::size_t, std::span<const Vec2f> parameters, std::span<Vec2f> coordinates) const override {
    std::copy(parameters.begin(), parameters.end(), coordinates.begin());
  }
  std::uint32_t source_face(std::size_t face) const override { return std::uint32_t(face) + 100; }

  bool textured = false;

 private:
  Evaluate evaluate_;
  std::size_t vertex_count_, edge_count_ = 0;
  std::vector<FaceDomain> domains_;
  std::vector<std::vector<FaceEdge>> sides_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::uint32_t, std::uint32_t>> numbers_;
};

inline constexpr double kTorusRadius = 2, kTubeRadius = 0.75;

/// around x across quads, both at least 1; v goes around the tube.
inline AnalyticSurface torus(std::uint32_t around, std::uint32_t across) {
  AnalyticSurface surface(std::size_t(around) * across, [=](std::size_t face, Vec2d p) {
    constexpr double kTurn = 2 * kPi;
    const double du = kTurn / around, dv = kTurn / across;
    const double u = (double(face % around) + p.x) * du, v = (double(face / around) + p.y) * dv;
    const double reach = kTorusRadius + kTubeRadius * std::cos(v);
    SurfaceSample s;
    s.position = Vec3f(Vec3d(reach * std::cos(u), kTubeRadius * std::sin(v), -reach * std::sin(u)));
    s.normal = Vec3f(Vec3d(std::cos(v) * std::cos(u), std::sin(v), -std::cos(v) * std::sin(u)));
    s.du = Vec3f(Vec3d(-std::sin(u), 0, -std::cos(u)) * (reach * du));
    s.dv = Vec3f(Vec3d(-std::sin(v) * std::cos(u), std::cos(v), std::sin(v) * std::sin(u)) * (kTubeRadius * dv));
    return s;
  });
  const auto wrapped = [=](std::uint32_t i, std::uint32_t j) { return i % around + j % across * around; };
  const std::uint32_t n = around * across;  // edges along u, then those along v, each by its first vertex
  for (std::uint32_t j = 0; j < across; ++j)
    for (std::uint32_t i = 0; i < around; ++i)
      surface.add_face(FaceDomain::quad, {{wrapped(i, j), wrapped(i, j), false, false, false},
                                          {n + wrapped(i + 1, j), wrapped(i + 1, j), false, false, false},
                                          {wrapped(i, j + 1), wrapped(i + 1, j + 1), true, false, false},
                                          {n + wrapped(i, j), wrapped(i, j + 1), true, false, false}});
  return surface;
}
inline double torus_area() { return 4 * kPi * kPi * kTorusRadius * kTubeRadius; }
inline double torus_volume() { return 2 * kPi * kPi * kTorusRadius * kTubeRadius * kTubeRadius; }

/// The unit sphere as eight triangles, one an octant, projected from the octahedron.
inline AnalyticSurface octant_sphere() {
  static const Vec3d kCorners[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  static const std::vector<std::uint32_t> kFaces[8] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                                       {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  AnalyticSurface surface(6, [](std::size_t face, Vec2d p) {
    const Vec3d &a = kCorners[kFaces[face][0]], &b = kCorners[kFaces[face][1]], &c = kCorners[kFaces[face][2]];
    const Vec3d flat = a + (b - a) * p.x + (c - a) * p.y;
    const double length = flat.length();
    const Vec3d on = flat / length;
    const auto along = [&](const Vec3d& d) { return Vec3f((d - on * on.dot(d)) / length); };
    return SurfaceSample{Vec3f(on), Vec3f(on), along(b - a), along(c - a)};
  });
  for (const auto& face : kFaces) surface.add_face(FaceDomain::triangle, face);
  return surface;
}

/// z = height * x * y over [-1, 1]^2: one quad with a boundary.
inline AnalyticSurface saddle(double height) {
  AnalyticSurface surface(4, [=](std::size_t, Vec2d p) {
    const double x = 2 * p.x - 1, y = 2 * p.y - 1;
    SurfaceSample s;
    s.position = Vec3f(Vec3d(x, y, height * x * y));
    s.normal = Vec3f(Vec3d(-height * y, -height * x, 1).normalized());
    s.du = Vec3f(Vec3d(2, 0, 2 * height * y));
    s.dv = Vec3f(Vec3d(0, 2, 2 * height * x));
    return s;
  });
  surface.add_face(FaceDomain::quad, std::vector<std::uint32_t>{0, 1, 2, 3});
  for (std::size_t i = 0; i < 4; ++i) surface.side(0, i).sharp_edge = surface.side(0, i).sharp_vertex = true;
  return surface;
}

/// The disc of radius 1 in x and z as an n-gon cut in quads: where subface `corner` has (u, v), in the order of the
/// rim. A Coons patch between two arcs of the rim and two spokes; of its terms these remain, for spokes end at 0.
inline Vec2d on_disc(std::uint32_t sides, int corner, double u, double v) {
  const double step = 2 * kPi / sides;
  const auto rim = [&](double ahead) {
    const double angle = (corner + ahead / 2) * step;
    return Vec2d(std::cos(angle), -std::sin(angle));
  };
  return rim(u) * (1 - v) + rim(-v) * (1 - u) - rim(0) * ((1 - u) * (1 - v));
}
/// Subfaces lie in tiles of a square of ceil(sqrt(n)) a side, up to 0.5 from their tile's corner. Gives the corner's
/// number and where in the subface, both coordinates from 0 to 1.
inline std::pair<int, Vec2d> subface_of(std::uint32_t sides, Vec2d p) {
  const auto tiles = int(std::ceil(std::sqrt(double(sides)) - 1e-9));
  const auto tile = [](double x) { return int(x) + (x - int(x) > 0.75 ? 1 : 0); };
  return {tile(p.y) * tiles + tile(p.x), {2 * (p.x - tile(p.x)), 2 * (p.y - tile(p.y))}};
}

/// y = height * (1 - x^2 - z^2) over the unit disc.
inline SurfaceSample dome_sample(std::uint32_t sides, double height, Vec2d p) {
  const auto [corner, at] = subface_of(sides, p);
  const Vec2d q = on_disc(sides, corner, at.x, at.y);
  const auto lifted = [&](const Vec2d& d) { return Vec3f(Vec3d(d.x, -2 * height * q.dot(d), d.y)); };
  // The map's formula holds beyond its square; central differences of width 2e-5 are good to 1e-9. A parameter goes
  // half as far as the subface's own.
  constexpr double kStep = 1e-5;
  const auto slope = [&, corner = corner, at = at](double du, double dv) {
    return (on_disc(sides, corner, at.x + du, at.y + dv) - on_disc(sides, corner, at.x - du, at.y - dv)) / kStep;
  };
  SurfaceSample s;
  s.position = Vec3f(Vec3d(q.x, height * (1 - q.dot(q)), q.y));
  s.normal = Vec3f(Vec3d(2 * height * q.x, 1, 2 * height * q.y).normalized());
  s.du = lifted(slope(kStep, 0));
  s.dv = lifted(slope(0, kStep));
  return s;
}

/// One n-gon with a boundary.
inline AnalyticSurface dome(std::uint32_t sides, double height) {
  AnalyticSurface surface(sides, [=](std::size_t, Vec2d p) { return dome_sample(sides, height, p); });
  std::vector<std::uint32_t> rim;
  for (std::uint32_t i = 0; i < sides; ++i) rim.push_back(i);
  surface.add_face(FaceDomain::quad_subfaces, rim);
  for (std::size_t i = 0; i < sides; ++i) surface.side(0, i).sharp_edge = surface.side(0, i).sharp_vertex = true;
  return surface;
}

/// Radius 1, y from -1 to 1, `sides` quads around; the ends are n-gons cut in quads. Rims are sharp.
inline AnalyticSurface cylinder(std::uint32_t sides) {
  const double step = 2 * kPi / sides;
  const auto rim = [](double angle) { return Vec3d(std::cos(angle), 0, -std::sin(angle)); };
  AnalyticSurface surface(2 * std::size_t(sides), [=](std::size_t face, Vec2d p) {
    SurfaceSample s;
    if (face < sides) {
      const double angle = (double(face) + p.x) * step;
      s.position = Vec3f(rim(angle) + Vec3d(0, 2 * p.y - 1, 0));
      s.normal = Vec3f(rim(angle));
      s.du = Vec3f(Vec3d(-std::sin(angle), 0, -std::cos(angle)) * step);
      s.dv = Vec3f(0, 2, 0);
      return s;
    }
    s = dome_sample(sides, 0, p);
    const float up = face == sides ? 1.0f : -1.0f;
    for (Vec3f* v : {&s.position, &s.normal, &s.du, &s.dv}) *v *= Vec3f(1, up, up);
    s.position.y = up;
    return s;
  });
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t next = (i + 1) % sides;
    surface.add_face(FaceDomain::quad, std::vector<std::uint32_t>{i, next, sides + next, sides + i});
  }
  std::vector<std::uint32_t> top, bottom;
  for (std::uint32_t i = 0; i < sides; ++i) {
    top.push_back(sides + i);
    bottom.push_back((sides - i) % sides);
  }
  surface.add_face(FaceDomain::quad_subfaces, top);
  surface.add_face(FaceDomain::quad_subfaces, bottom);
  for (std::size_t face = 0; face < surface.face_count(); ++face)
    for (std::size_t i = 0; i < surface.sides(face).size(); ++i) {
      FaceEdge& side = surface.side(face, i);
      side.sharp_vertex = true;
      side.sharp_edge = face >= sides || i % 2 == 0;
    }
  return surface;
}

}  // namespace raytree::test
