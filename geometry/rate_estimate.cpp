// Differences of first derivatives from one sample to the next stand for second derivatives there.
#include "geometry/rate_estimate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/facet_pattern.h"
#include "geometry/tessellation_rates.h"

namespace raytree {
namespace {

constexpr int kFirstGrid = 2;        ///< cells along a side
constexpr int kLargestGrid = 16;     ///< of faces that turn out to need many segments
constexpr int kSegmentsPerCell = 4;  ///< of those: one cell for so many
constexpr double kTurnsMuch = 0.5;   ///< cosine of 60 degrees
constexpr std::size_t kNoFaceSide = std::size_t(-1);

class Estimator {
 public:
  Estimator(const ParametricSurface& surface, std::size_t face, const RateGoal& goal, EstimateScratch& scratch,
            RateDemand& demand)
      : surface_(surface), face_(face), goal_(goal), scratch_(scratch), demand_(demand) {}

  void estimate();

 private:
  void estimate_cells(const Vec2d& corner, double extent, int cells, const std::array<std::size_t, 4>& sides,
                      bool together);
  void estimate_triangle(int cells);

  /// What of the displacement `d` takes the surface away from its facets: what is along the surface does not, unless
  /// the surface ends there, at a hard edge that runs along `edge` (zero: there is none).
  static Vec3d away(const SurfaceSample& at, const Vec3d& d, const Vec3d& edge) {
    const double square = edge.dot(edge);
    if (square > 0) return d - edge * (edge.dot(d) / square);
    const Vec3d normal(at.normal);
    return normal * normal.dot(d);
  }
  /// An eighth of a second derivative, in units of the tolerance aimed at; the larger of what it is at its two ends.
  double size(const SurfaceSample& a, const SurfaceSample& b, const Vec3d& second,
              const Vec3d& edge = Vec3d(0, 0, 0)) const {
    const auto at = [&](const SurfaceSample& s) {
      return goal_.view.pixels(goal_.origin + Vec3d(s.position), away(s, second * 0.125, edge));
    };
    // Where normals turn this much from one sample to the next, neither says what is along the surface between.
    if (Vec3d(a.normal).dot(Vec3d(b.normal)) < kTurnsMuch)
      return goal_.view.pixels(goal_.origin + Vec3d(a.position), second * 0.125) / (goal_.tolerance * kRateAim);
    return std::max(at(a), at(b)) / (goal_.tolerance * kRateAim);
  }

  const ParametricSurface& surface_;
  std::size_t face_;
  const RateGoal& goal_;
  EstimateScratch& scratch_;
  RateDemand& demand_;
};

/// The square of parameters from `corner` on, `extent` wide. sides: those along its bottom, right, top and left;
/// kNoFaceSide for none. together: both directions take the larger rate.
void Estimator::estimate_cells(const Vec2d& corner, double extent, int cells, const std::array<std::size_t, 4>& sides,
                               bool together) {
  const auto points = static_cast<std::size_t>(cells) + 1;
  const double step = extent / cells;
  scratch_.parameters.clear();
  for (std::size_t j = 0; j < points; ++j)
    for (std::size_t i = 0; i < points; ++i)
      scratch_.parameters.emplace_back(static_cast<float>(corner.x + step * double(i)),
                                       static_cast<float>(corner.y + step * double(j)));
  scratch_.samples.resize(scratch_.parameters.size());
  surface_.evaluate(face_, scratch_.parameters, scratch_.samples);
  std::array<bool, 4> hard{};
  for (std::size_t i = 0; i < 4; ++i) hard[i] = sides[i] != kNoFaceSide && surface_.sides(face_)[sides[i]].sharp_edge;
  for (std::size_t j = 0; j + 1 < points; ++j)
    for (std::size_t i = 0; i + 1 < points; ++i) {
      const SurfaceSample& p00 = scratch_.samples[j * points + i];
      const SurfaceSample& p10 = scratch_.samples[j * points + i + 1];
      const SurfaceSample& p01 = scratch_.samples[(j + 1) * points + i];
      const SurfaceSample& p11 = scratch_.samples[(j + 1) * points + i + 1];
      const auto second_u = [&](const SurfaceSample& a, const SurfaceSample& b) {
        return (Vec3d(b.du) - Vec3d(a.du)) / step;
      };
      const auto second_v = [&](const SurfaceSample& a, const SurfaceSample& b) {
        return (Vec3d(b.dv) - Vec3d(a.dv)) / step;
      };
      auto [u, v] = segments(std::max(size(p00, p10, second_u(p00, p10)), size(p01, p11, second_u(p01, p11))),
                             std::max(size(p00, p01, second_u(p00, p01)), size(p10, p11, second_u(p10, p11))),
                             std::max(size(p00, p01, second_v(p00, p01)), size(p10, p11, second_v(p10, p11))));
      if (together) u = v = std::max(u, v);
      demand_.inner[0] = std::max(demand_.inner[0], u);
      demand_.inner[1] = std::max(demand_.inner[1], v);
      // A side takes the rate along it of the cells there; a hard one also that of its own outline.
      const auto raise_side = [&](bool there, std::size_t side, double rate, const SurfaceSample& a,
                                  const SurfaceSample& b, const Vec3d& along, const Vec3d& second) {
        if (!there || sides[side] == kNoFaceSide) return;
        demand_.raise_side(sides[side], rate);
        if (hard[side]) demand_.raise_side(sides[side], std::sqrt(size(a, b, second, along)));
      };
      raise_side(j == 0, 0, u, p00, p10, Vec3d(p00.du), second_u(p00, p10));
      raise_side(i + 2 == points, 1, v, p10, p11, Vec3d(p10.dv), second_v(p10, p11));
      raise_side(j + 2 == points, 2, u, p01, p11, Vec3d(p01.du), second_u(p01, p11));
      raise_side(i == 0, 3, v, p00, p01, Vec3d(p00.dv), second_v(p00, p01));
    }
}

/// The interpolation error at barycentric (l, m, n) is half of the sum of l m D over the edges, D the second derivative
/// along each: at most a sixth of the largest D, where that of one edge alone is an eighth.
void Estimator::estimate_triangle(int cells) {
  scratch_.parameters.clear();
  std::vector<std::array<int, 2>> places;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i + j <= cells; ++i) {
      scratch_.parameters.emplace_back(float(i) / float(cells), float(j) / float(cells));
      places.push_back({i, j});
    }
  scratch_.samples.resize(scratch_.parameters.size());
  surface_.evaluate(face_, scratch_.parameters, scratch_.samples);
  const auto index = [&](int i, int j) { return static_cast<std::size_t>(j * (cells + 1) - j * (j - 1) / 2 + i); };
  const auto look = [&](std::size_t a, std::size_t b, double along_u, double along_v) {
    const SurfaceSample &p = scratch_.samples[a], &q = scratch_.samples[b];
    const auto along = [&](const SurfaceSample& s) { return Vec3d(s.du) * along_u + Vec3d(s.dv) * along_v; };
    const auto on = [&](const std::array<int, 2>& place, std::size_t side) {
      return side == 0 ? place[1] == 0 : side == 1 ? place[0] + place[1] == cells : place[0] == 0;
    };
    const Vec3d second = (along(q) - along(p)) * double(cells);
    const double rate = std::sqrt(size(p, q, second) * (4.0 / 3));
    for (std::size_t side = 0; side < 3; ++side) {
      const bool a_on = on(places[a], side), b_on = on(places[b], side);
      if (a_on || b_on) demand_.raise_side(side, rate);
      if (a_on && b_on && surface_.sides(face_)[side].sharp_edge)
        demand_.raise_side(side, std::sqrt(size(p, q, second, along(p))));
    }
    for (double& inner : demand_.inner) inner = std::max(inner, rate);
  };
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i + j < cells; ++i) {
      look(index(i, j), index(i + 1, j), 1, 0);
      look(index(j, i), index(j, i + 1), 0, 1);
      look(index(i + 1, j), index(i, j + 1), -1, 1);
    }
}

void Estimator::estimate() {
  const std::size_t sides = surface_.sides(face_).size();
  const auto run = [&](int cells) {
    demand_.reset(sides);
    switch (surface_.domain(face_)) {
      case FaceDomain::quad:
        estimate_cells({0, 0}, 1, cells, {0, 1, 2, 3}, false);
        break;
      case FaceDomain::triangle:
        estimate_triangle(cells);
        break;
      case FaceDomain::quad_subfaces:
        for (std::size_t i = 0; i < sides; ++i)
          estimate_cells(subface_corner(sides, i), 0.5, (cells + 1) / 2,
                         {i, kNoFaceSide, kNoFaceSide, (i + sides - 1) % sides}, true);
        break;
    }
  };
  run(kFirstGrid);
  const double most = demand_.largest();
  if (most > kFirstGrid * kSegmentsPerCell)
    run(std::clamp(static_cast<int>(std::min<double>(most, kLargestViewRate)) / kSegmentsPerCell, kFirstGrid,
                   kLargestGrid));
}

}  // namespace

void estimate_demand(const ParametricSurface& surface, std::size_t face, const RateGoal& goal, EstimateScratch& scratch,
                     RateDemand& demand) {
  Estimator(surface, face, goal, scratch, demand).estimate();
}

}  // namespace raytree
