#include "geometry/facet_bound.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace raytree {
namespace {

/// [new control point][old one]: weights that make the control points of a cubic over [begin, end] of its own [0, 1].
using CubicPart = std::array<std::array<double, 4>, 4>;

/// The new points are values of the polar form at (begin, begin, begin), (begin, begin, end) ... (end, end, end).
CubicPart part_of_cubic(double begin, double end) {
  CubicPart part;
  for (std::size_t i = 0; i < 4; ++i) {
    std::array<double, 4> weights{1, 0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      const double t = k < 3 - i ? begin : end;
      for (std::size_t w = 4; w-- > 0;) weights[w] = weights[w] * (1 - t) + (w > 0 ? weights[w - 1] * t : 0);
    }
    part[i] = weights;
  }
  return part;
}

std::array<Vec3d, 16> part_of_patch(const std::array<Vec3d, 16>& points, const CubicPart& along_u,
                                    const CubicPart& along_v) {
  const auto sum = [](const std::array<double, 4>& w, const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    return a * w[0] + b * w[1] + c * w[2] + d * w[3];
  };
  std::array<Vec3d, 16> rows, part;
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 4; ++i)
      rows[4 * j + i] = sum(along_u[i], points[4 * j], points[4 * j + 1], points[4 * j + 2], points[4 * j + 3]);
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 4; ++i)
      part[4 * j + i] = sum(along_v[j], rows[i], rows[4 + i], rows[8 + i], rows[12 + i]);
  return part;
}

/// What a linear map makes of a unit vector at most: the root of the largest row sum of its square. Exact for a turn
/// with one scale.
double largest_stretch(const Matrix44d& m) {
  double most = 0;
  for (int i = 0; i < 3; ++i) {
    double sum = 0;
    for (int j = 0; j < 3; ++j) sum += std::abs(m[i][0] * m[j][0] + m[i][1] * m[j][1] + m[i][2] * m[j][2]);
    most = std::max(most, sum);
  }
  return std::sqrt(most);
}

constexpr double kNoBound = std::numeric_limits<double>::infinity();

}  // namespace

PixelBound::PixelBound(const TessellationView& view, const Vec3d& origin, const std::array<Vec3d, 16>& points)
    : view_(view), stretch_(largest_stretch(view.to_world)) {
  using Projection = TessellationView::Projection;
  if (view.projection == Projection::any_direction) {
    least_scale_ = view.pixel;
    return;
  }
  const bool perspective = view.projection == Projection::perspective;
  const double margin = (1 + kFrameMargin) * view.pixel;
  std::array<bool, 5> beyond{true, true, true, true, perspective};  // right, left, top, bottom; behind the eye
  double nearest = kNoBound, distance = kNoBound;
  Vec3d middle(0);
  for (const Vec3d& point : points) {
    Vec3d p;
    view.to_world.multDirMatrix(origin + point, p);
    p += view.to_world.translation() - view.eye;
    middle += p;
  }
  middle = middle.normalized();
  for (const Vec3d& point : points) {
    Vec3d p;
    view.to_world.multDirMatrix(origin + point, p);
    p += view.to_world.translation() - view.eye;
    const double x = p.dot(view.right), y = p.dot(view.up), z = p.dot(view.forward);
    const double reach = perspective ? margin * z : margin;
    beyond[0] = beyond[0] && x > view.half_width * reach;
    beyond[1] = beyond[1] && -x > view.half_width * reach;
    beyond[2] = beyond[2] && y > view.half_height * reach;
    beyond[3] = beyond[3] && -y > view.half_height * reach;
    beyond[4] = beyond[4] && z <= 0;
    nearest = std::min(nearest, z);
    distance = std::min(distance, p.dot(middle));
    if (perspective) slopes_[slope_count_++] = {x / z, y / z};
  }
  seen_ = std::none_of(beyond.begin(), beyond.end(), [](bool all) { return all; });
  least_scale_ = perspective ? view.pixel * (seen_ ? nearest : distance) : view.pixel;
  if (!seen_) least_scale_ *= kUnseenSlack, slope_count_ = 0;
  if (seen_ && !perspective) slopes_[slope_count_++] = {0, 0};
}

double PixelBound::of(const Vec3d& displacement) const {
  if (!(least_scale_ > 0)) return kNoBound;
  Vec3d d;
  view_.to_world.multDirMatrix(displacement, d);
  if (!seen_) return d.length() / least_scale_;
  const double across = d.dot(view_.right), upwards = d.dot(view_.up), forward = d.dot(view_.forward);
  double square = d.length2() / (kDepthSlack * kDepthSlack);
  for (std::size_t i = 0; i < slope_count_; ++i) {
    const double x = across - slopes_[i].x * forward, y = upwards - slopes_[i].y * forward;
    square = std::max(square, x * x + y * y);
  }
  return std::sqrt(square) / least_scale_;
}

double PixelBound::of_any(double length) const {
  if (!(least_scale_ > 0)) return kNoBound;
  double square = 1;  // sideways, and along the line of sight
  for (std::size_t i = 0; i < slope_count_; ++i) square = std::max(square, 1 + slopes_[i].length2());
  return length * stretch_ * std::sqrt(square) / least_scale_;
}

FacetBound::FacetBound(const BezierPatch& patch, const TessellationView& view, const Vec3d& origin,
                       const std::array<Vec2f, 3>& corners) {
  Vec2d low(corners[0]), high(corners[0]);
  for (const Vec2f& corner : corners)
    for (unsigned k = 0; k < 2; ++k)
      low[k] = std::min<double>(low[k], corner[k]), high[k] = std::max<double>(high[k], corner[k]);
  const std::array<Vec3d, 16> p =
      part_of_patch(patch.points, part_of_cubic(low.x, high.x), part_of_cubic(low.y, high.y));
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 2; ++i) {
      along_u_[4 * i + j] = (p[4 * j + i] - p[4 * j + i + 1] * 2.0 + p[4 * j + i + 2]) * 6.0;
      along_v_[4 * i + j] = (p[4 * i + j] - p[4 * i + 4 + j] * 2.0 + p[4 * i + 8 + j]) * 6.0;
    }
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i)
      mixed_[3 * j + i] = (p[4 * j + 5 + i] - p[4 * j + 4 + i] - p[4 * j + 1 + i] + p[4 * j + i]) * 9.0;
  pixels_.emplace(view, origin, p);
}

double FacetBound::pixels(const SampledFacet& facet) const {
  const Vec3d& n = facet.normal();
  const auto most = [&](const auto& control, const auto& size) {
    double largest = 0;
    for (const Vec3d& c : control) largest = std::max(largest, size(c));
    return largest;
  };
  const auto error = [&](const auto& size) {
    return (most(along_u_, size) + 2 * most(mixed_, size) + most(along_v_, size)) / 8;
  };
  const double across = error([&](const Vec3d& c) { return std::abs(n.dot(c)); });
  const double along = error([&](const Vec3d& c) { return (c - n * n.dot(c)).length(); });
  return across * pixels_->of(n) + facet.sideways() * pixels_->of_any(along);
}

}  // namespace raytree
