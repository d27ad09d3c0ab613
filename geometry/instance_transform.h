// What the transform of an instance does to points, normals and errors. The group's shapes are where the instance's
// single-precision matrix puts them, exactly: everything here reckons from that matrix in double. The transform that a
// shape is described with is one of these, too.
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/shape_set.h"
#include "geometry/vec.h"

namespace raytree {

/// Bound on what a tracer's way into a group and back adds to the error of a point, in units of half an ulp of the
/// coordinates, magnified as inverse_error() says. A tracer inverts the matrix in float: each entry of the inverse is
/// a difference of two products over a determinant (3 roundings of the products, 3 of the determinant's, 2 of the
/// quotient); the inverse's translation, three products and two sums, rounds 4 times more, as does the ray's origin.
inline constexpr float kInstanceError = 16 * kRoundoff;

/// A transform whose determinant is so much smaller than the products that it is made of cannot be inverted in single
/// precision with an error below 2^-24 * 16 * kMostCancellation = 0.4 % of what it magnifies.
inline constexpr double kMostCancellation = 4096;
/// Inverses of single-precision matrices go over the determinant, which must not leave the range of float.
inline constexpr double kLeastDeterminant = 1e-30, kMostDeterminant = 1e30;

class InstanceTransform {
 public:
  explicit InstanceTransform(const Instance& instance)
      : InstanceTransform(Vec3d(instance.axis(0)), Vec3d(instance.axis(1)), Vec3d(instance.axis(2)),
                          Vec3d(instance.origin())) {}
  /// The axes inside and where they meet, as they lie outside.
  InstanceTransform(const Vec3d& x, const Vec3d& y, const Vec3d& z, const Vec3d& origin)
      : x_(x), y_(y), z_(z), origin_(origin) {
    minor_[0] = y_.cross(z_), minor_[1] = z_.cross(x_), minor_[2] = x_.cross(y_);
    determinant_ = x_.dot(minor_[0]);
  }

  double determinant() const { return determinant_; }
  /// The products that the determinant is made of over the determinant, without their signs: 1 where nothing cancels.
  double cancellation() const {
    const Vec3d m = absolute_cross(y_, z_);
    return (std::abs(x_.x) * m.x + std::abs(x_.y) * m.y + std::abs(x_.z) * m.z) / std::abs(determinant_);
  }

  Vec3d point(const Vec3d& p) const { return x_ * p.x + y_ * p.y + z_ * p.z + origin_; }
  Vec3d vector(const Vec3d& v) const { return x_ * v.x + y_ * v.y + z_ * v.z; }
  /// The ways back, from scene to group space.
  Vec3d inverse_vector(const Vec3d& v) const {
    return Vec3d(minor_[0].dot(v), minor_[1].dot(v), minor_[2].dot(v)) * (1 / determinant_);
  }
  Vec3d inverse_point(const Vec3d& p) const { return inverse_vector(p - origin_); }
  /// Of any length: normals go by the inverse transpose, which the minors are but for the determinant. A mirroring
  /// transform turns triangles over and their normals with them, so the outside stays outside.
  Vec3d normal(const Vec3d& n) const {
    return (minor_[0] * n.x + minor_[1] * n.y + minor_[2] * n.z) * (1 / determinant_);
  }
  /// The way back of normals, of any length.
  Vec3d normal_inside(const Vec3d& n) const { return {x_.dot(n), y_.dot(n), z_.dot(n)}; }
  /// The way from scene space into the group, in double.
  Vec3d vector_inside(const Vec3d& v) const {
    return Vec3d(v.dot(minor_[0]), v.dot(minor_[1]), v.dot(minor_[2])) * (1 / determinant_);
  }
  Vec3d point_inside(const Vec3d& p) const { return vector_inside(p - origin_); }
  /// Bound on the factor by which lengths grow on the way to scene space, the largest singular value: met where the
  /// axes are at right angles, by a sum of a row of |M M^T| (Gershgorin), and to 2^-24 of itself elsewhere, by the
  /// closed form for the largest eigenvalue of M M^T (Smith 1961, "Eigenvalues of a symmetric 3 x 3 matrix").
  double stretch() const {
    const double xx = x_.dot(x_), yy = y_.dot(y_), zz = z_.dot(z_);
    const double xy = x_.dot(y_), yz = y_.dot(z_), zx = z_.dot(x_);
    const double row_sum = std::max(
        {xx + std::abs(xy) + std::abs(zx), yy + std::abs(xy) + std::abs(yz), zz + std::abs(yz) + std::abs(zx)});
    const double mean = (xx + yy + zz) / 3, a = xx - mean, b = yy - mean, c = zz - mean;
    const double spread = std::sqrt((a * a + b * b + c * c + 2 * (xy * xy + yz * yz + zx * zx)) / 6);
    if (!(spread > 0)) return std::sqrt(row_sum);
    const double determinant = a * (b * c - yz * yz) - xy * (xy * c - yz * zx) + zx * (xy * yz - b * zx);
    const double cosine = std::clamp(determinant / (2 * spread * spread * spread), -1.0, 1.0);
    const double largest = mean + 2 * spread * std::cos(std::acos(cosine) / 3);
    // The cosine rounds by less than 26 ulps; where two eigenvalues fall together at -1, that moves `largest` by the
    // root of it, 5e-8 of the mean.
    return std::sqrt(std::min(row_sum, largest * (1 + 0x1p-23)));
  }
  /// Factor of a transform that scales all directions alike.
  double scale() const { return std::cbrt(std::abs(determinant_)); }
  const Vec3d& origin() const { return origin_; }

  /// Bound on the distance in group space, along its unit normal n, by which a point is off that a tracer takes there
  /// from scene space, with coordinates of up to `largest` on the way, over kInstanceError.
  double inverse_error(const Vec3d& n, const Vec3d& largest) const {
    const Vec3d mx = absolute_cross(y_, z_), my = absolute_cross(z_, x_), mz = absolute_cross(x_, y_);
    const double products = std::abs(x_.x) * mx.x + std::abs(x_.y) * mx.y + std::abs(x_.z) * mx.z;
    const double sum =
        std::abs(n.x) * mx.dot(largest) + std::abs(n.y) * my.dot(largest) + std::abs(n.z) * mz.dot(largest);
    return sum * products / (determinant_ * determinant_);
  }

 private:
  static Vec3d absolute_cross(const Vec3d& a, const Vec3d& b) {
    return {std::abs(a.y * b.z) + std::abs(a.z * b.y), std::abs(a.z * b.x) + std::abs(a.x * b.z),
            std::abs(a.x * b.y) + std::abs(a.y * b.x)};
  }

  Vec3d x_, y_, z_, origin_, minor_[3];
  double determinant_;
};

}  // namespace raytree
