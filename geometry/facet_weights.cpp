#include "geometry/facet_weights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace raytree {
namespace {

/// Of the polygon's own plane: the two axes that its normal has least of are kept.
struct PlaneAxes {
  explicit PlaneAxes(std::span<const Vec3f> corners) {
    Vec3d normal(0, 0, 0);
    const Vec3d first(corners[0]);
    for (std::size_t i = 2; i < corners.size(); ++i)
      normal += (Vec3d(corners[i - 1]) - first).cross(Vec3d(corners[i]) - first);
    const Vec3d size(std::abs(normal.x), std::abs(normal.y), std::abs(normal.z));
    const int dropped = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    x = (dropped + 1) % 3, y = (dropped + 2) % 3;
  }
  Vec2d operator()(const Vec3f& corner, const Vec3f& point) const {
    return {double(corner[x]) - double(point[x]), double(corner[y]) - double(point[y])};
  }
  int x, y;
};

double cross(const Vec2d& a, const Vec2d& b) { return a.x * b.y - a.y * b.x; }

void only(std::size_t corner, std::span<float> weights) {
  std::fill(weights.begin(), weights.end(), 0.0f);
  weights[corner] = 1;
}

/// Share of the way from a to b as a perspective picture shows it, `share` of it being gone in space; depths of the
/// two.
double pictured_share(double share, double depth_a, double depth_b) {
  if (!(depth_a > 0 && depth_b > 0)) return share;
  return share * depth_b / ((1 - share) * depth_a + share * depth_b);
}

/// Where a scan line meets an edge.
struct Crossing {
  double place;  ///< along the scan line, from the point
  double depth;
  std::size_t edge;
  double share;  ///< of the way along the edge, in the picture
};

}  // namespace

void mean_value_weights(std::span<const Vec3f> corners, const Vec3f& point, std::span<float> weights) {
  const std::size_t count = corners.size();
  const PlaneAxes axes(corners);
  double extent = 0;
  for (const Vec3f& corner : corners) extent = std::max(extent, axes(corner, point).length());
  // Nearer than single precision tells apart, a corner or an edge is met.
  const double near = extent * 1e-7;
  const auto at = [&](std::size_t i) { return axes(corners[i % count], point); };
  for (std::size_t i = 0; i < count; ++i)
    if (at(i).length() <= near) return only(i, weights);
  // tan(a / 2) = sin a / (1 + cos a) of the angle that each edge is seen under.
  const auto half_tangent = [&](std::size_t i) {
    const Vec2d a = at(i), b = at(i + 1);
    return cross(a, b) / (a.length() * b.length() + a.dot(b));
  };
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2d a = at(i), b = at(i + 1);
    const double length = (b - a).length();
    if (a.dot(b) > 0 || std::abs(cross(a, b)) > near * length) continue;
    std::fill(weights.begin(), weights.end(), 0.0f);
    const double share = a.length() / (a.length() + b.length());
    weights[i] = static_cast<float>(1 - share);
    weights[(i + 1) % count] = static_cast<float>(share);
    return;
  }
  double sum = 0, before = half_tangent(count - 1);
  for (int pass = 0; pass < 2; ++pass) {
    const double scale = pass == 0 ? 0 : 1 / sum;
    for (std::size_t i = 0; i < count; ++i) {
      const double after = half_tangent(i), weight = (before + after) / at(i).length();
      before = after;
      if (pass == 0) sum += weight;
      weights[i] = static_cast<float>(weight * scale);
    }
  }
}

void bilinear_weights(std::span<const Vec3f> corners, const Vec3f& point, std::span<float> weights) {
  const PlaneAxes axes(corners);
  const Vec2d a = axes(corners[0], point), b = axes(corners[1], point), c = axes(corners[2], point),
              d = axes(corners[3], point);
  // 0 = a + u e + v f + u v g; crossed with e + v g it leaves a quadratic in v alone.
  const Vec2d e = b - a, f = d - a, g = a - b + c - d;
  const double q2 = cross(g, f), q1 = cross(e, f) + cross(g, a), q0 = cross(e, a);
  std::array<double, 2> roots{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  const double discriminant = q1 * q1 - 4 * q2 * q0;
  if (discriminant >= 0) {
    const double q = -(q1 + std::copysign(std::sqrt(discriminant), q1)) / 2;
    if (q != 0) roots[0] = q0 / q;
    if (q2 != 0) roots[1] = q / q2;
  }
  double best_error = 1e-3, u = 0, v = 0;  // rounding and the hit's own error leave the square by much less
  for (const double root : roots) {
    const Vec2d along = e + g * root, rest = a + f * root;
    const double square = along.dot(along);
    if (!(square > 0) || !std::isfinite(root)) continue;
    const double other = -rest.dot(along) / square;
    const auto outside = [](double x) { return std::max(0.0, std::max(-x, x - 1)); };
    const double error = std::max(outside(root), outside(other));
    if (error < best_error) best_error = error, v = root, u = other;
  }
  if (best_error == 1e-3) {
    mean_value_weights(corners, point, weights);
    return;
  }
  u = std::clamp(u, 0.0, 1.0), v = std::clamp(v, 0.0, 1.0);
  const double all[4] = {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
  for (std::size_t i = 0; i < 4; ++i) weights[i] = static_cast<float>(all[i]);
}

bool scanline_weights(std::span<const Vec3f> corners, const Vec3f& point, const ScanPlane& scan,
                      std::span<float> weights) {
  const std::size_t count = corners.size();
  const Vec3d normal(scan.normal), along(scan.along), origin(point);
  const auto height = [&](std::size_t i) { return (Vec3d(corners[i]) - origin).dot(normal); };
  const auto depth = [&](const Vec3d& p) {
    return scan.perspective ? (p - Vec3d(scan.eye)).dot(Vec3d(scan.forward)) : 1.0;
  };
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Crossing left{-kFar, 1, 0, 0}, right{kFar, 1, 0, 0};
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = (i + 1) % count;
    const double from = height(i), to = height(k);
    // An edge owns its lower end, so that a line through a corner meets one edge there or two, never a wrong number.
    if ((from < 0) == (to < 0)) continue;
    const double share = from / (from - to);
    const Vec3d a(corners[i]), b(corners[k]), place = a + (b - a) * share;
    const Crossing crossing{(place - origin).dot(along), depth(place), i, pictured_share(share, depth(a), depth(b))};
    if (crossing.place <= 0 && crossing.place > left.place) left = crossing;
    if (crossing.place > 0 && crossing.place < right.place) right = crossing;
  }
  if (left.place == -kFar && right.place == kFar) return false;
  // Rounding may put a point just outside: there the edge itself.
  double share = 0;
  if (left.place == -kFar)
    left = right;
  else if (right.place == kFar)
    right = left;
  else
    share = pictured_share(left.place / (left.place - right.place), left.depth, right.depth);
  std::fill(weights.begin(), weights.end(), 0.0f);
  const auto add = [&](const Crossing& crossing, double weight) {
    weights[crossing.edge] += static_cast<float>((1 - crossing.share) * weight);
    weights[(crossing.edge + 1) % count] += static_cast<float>(crossing.share * weight);
  };
  add(left, 1 - share);
  add(right, share);
  return true;
}

}  // namespace raytree
