// How far flat facets with interpolated normals stray from the surface that they stand for, at sampled points.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/parametric_surface.h"
#include "geometry/tessellation_view.h"
#include "geometry/vec.h"

namespace raytree {

struct FacetDeviation {
  double pixels = 0;    ///< distance to the limit surface, as TessellationView weighs it
  double distance = 0;  ///< the same in the surface's units, in any direction
  double angle = 0;     ///< between the normals, radians
  double shading = 0;   ///< the same in pixels: see kTurnPerPixel

  void include(const FacetDeviation& other) {
    pixels = std::max(pixels, other.pixels);
    distance = std::max(distance, other.distance);
    angle = std::max(angle, other.angle);
    shading = std::max(shading, other.shading);
  }
};

/// Radians. A normal that is off by an angle shades as if its point were off by some pixels: by the angle over what the
/// normal turns in a pixel, along the facet or from a corner of it to the point, where it turns most; so what moves a
/// highlight by as much as facets may lie off anyway is no fault. And where it hardly turns by this instead: turning a
/// normal by a changes Lambert's cosine by at most a, so that the default tolerance of 1/4 pixel lets shades differ by
/// one level of 255.
inline constexpr double kTurnPerPixel = 4.0 / 255;

/// What normals are held to, in units of the tolerance. Over a regular face what facets miss goes with the square of
/// their size, and the tolerance itself costs little (is_regular()). At extraordinary vertices and tips it goes with a
/// power below 2, beside semi-sharp creases it is what the normal turns over the crease until facets are as narrow as
/// that: there normals are held to more, and the tolerance is aimed at.
inline constexpr double kLooseShading = 8;

/// And of facets all of whose edges look shorter than this, in pixels: their normals are blends of the surface's own
/// less than that far away, so that they are off by a share of so many pixels.
inline constexpr double kShortestShadedEdge = 6;

/// Where facets are sampled densely: quarters of their edges and inside, but for their corners; barycentric
/// coordinates.
inline constexpr std::size_t kSamplesPerFacet = 12;
inline constexpr std::array<std::array<double, 3>, kSamplesPerFacet> kDenseSamples = [] {
  std::array<std::array<double, 3>, kSamplesPerFacet> weights{};
  std::size_t count = 0;
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4 && a + b <= 4; ++b)
      if (a + b > 0) weights[count++] = {a / 4.0, b / 4.0, (4 - a - b) / 4.0};
  return weights;
}();

/// The point of the triangle nearest to `p` (Ericson, Real-Time Collision Detection, 5.1.5).
inline Vec3d nearest_on_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 > 0 ? d1 / (d1 - d3) : 0);
  const Vec3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 > 0 ? d2 / (d2 - d6) : 0);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  const double denominator = va + vb + vc;
  return denominator > 0 ? a + ab * (vb / denominator) + ac * (vc / denominator) : a;
}

/// Where a facet ends.
struct FacetCorner {
  Vec3d position;  ///< in the surface's space, less its origin
  Vec3d normal;
};

class SampledFacet {
 public:
  /// hard: whether the surface ends, or bends sharply, at the edge from corner i to the next.
  SampledFacet(const TessellationView& view, const Vec3d& origin, const std::array<FacetCorner, 3>& corners,
               const std::array<bool, 3>& hard)
      : view_(view), origin_(origin), corners_(corners), hard_(hard) {
    const auto turn_over = [&](const Vec3d& turn, double pixels) {
      if (pixels > 0) turn_ = std::max(turn_, turn.length() / pixels);
    };
    std::size_t longest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const FacetCorner &a = corners[i], &b = corners[(i + 1) % 3];
      const double pixels = view.pixels(origin + a.position, b.position - a.position);
      if (pixels > longest_) longest_ = pixels, longest = i;
      turn_over(b.normal - a.normal, pixels);
      corner_turn_ = std::max(corner_turn_, (b.normal - a.normal).length());
    }
    // A narrow facet's edges all run along it.
    const FacetCorner &a = corners[longest], &b = corners[(longest + 1) % 3], &c = corners[(longest + 2) % 3];
    const Vec3d along = b.position - a.position;
    if (const double square = along.dot(along); square > 0) {
      const double foot = (c.position - a.position).dot(along) / square;
      turn_over(c.normal - a.normal - (b.normal - a.normal) * foot,
                view.pixels(origin + c.position, c.position - a.position - along * foot));
    }
    normal_ = (corners[1].position - corners[0].position).cross(corners[2].position - corners[0].position);
    const double length = normal_.length();
    if (length > 0) normal_ /= length;
    for (const FacetCorner& corner : corners) bend_ = std::max(bend_, 2 * normal_.cross(corner.normal).length());
    bend_ = length > 0 ? std::min(bend_, 1.0) : 1;
  }

  bool is_small() const { return longest_ < kShortestShadedEdge; }
  /// Between the normals at its corners: the chord of the largest angle.
  double bend() const { return corner_turn_; }

  /// Unit; zero for a facet without area.
  const Vec3d& normal() const { return normal_; }
  /// The share of a displacement along the facet that counts, at most.
  double sideways() const { return ends_surface() ? 1 : bend_; }
  /// Whether one of its edges is hard.
  bool ends_surface() const { return hard_[0] || hard_[1] || hard_[2]; }

  /// At the surface's point of barycentric coordinates `weights` in the face's parameters.
  FacetDeviation at(const SurfaceSample& truth, const std::array<double, 3>& weights) const {
    const Vec3d p(truth.position);
    const Vec3d away = displacement(p);
    FacetDeviation deviation;
    deviation.pixels = view_.pixels(origin_ + p, away);
    deviation.distance = away.length();
    const Vec3d normal =
        corners_[0].normal * weights[0] + corners_[1].normal * weights[1] + corners_[2].normal * weights[2];
    const Vec3d expected(truth.normal);
    const double across = normal.cross(expected).length(), along = normal.dot(expected);
    const double tangent = across / along;
    // atan x = x - x^3 / 3 + O(x^5): to 2e-7 of itself below this.
    constexpr double kSmall = 0.03;
    deviation.angle = along > 0 && tangent < kSmall ? tangent * (1 - tangent * tangent / 3) : std::atan2(across, along);
    deviation.shading = deviation.angle / std::max({kTurnPerPixel, turn_, turn_to(p, expected)});
    return deviation;
  }

 private:
  /// What the normal turns in a pixel from a corner to a point of the surface: where the normals of all corners agree,
  /// as they may about a cusp, they do not tell.
  double turn_to(const Vec3d& p, const Vec3d& normal) const {
    double turn = 0;
    for (const FacetCorner& corner : corners_)
      if (const double pixels = view_.pixels(origin_ + p, p - corner.position); pixels > 0)
        turn = std::max(turn, (normal - corner.normal).length() / pixels);
    return turn;
  }
  /// From the limit surface to the tessellation. Parameters stretch, so that a point may lie beside its own facet: then
  /// over the next one, which is turned against this one by no more than the normals at the corners say, and only so
  /// much of the way back counts; but at a hard edge there is no next one.
  Vec3d displacement(const Vec3d& p) const {
    const Vec3d &a = corners_[0].position, &b = corners_[1].position, &c = corners_[2].position;
    const Vec3d whole = nearest_on_triangle(p, a, b, c) - p;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d& from = corners_[i].position;
      const Vec3d& to = corners_[(i + 1) % 3].position;
      if (hard_[i] && (to - from).cross(p - from).dot(normal_) < 0) return whole;
    }
    const Vec3d across = normal_ * whole.dot(normal_);
    return across + (whole - across) * bend_;
  }

  const TessellationView& view_;
  Vec3d origin_;
  std::array<FacetCorner, 3> corners_;
  std::array<bool, 3> hard_;
  Vec3d normal_;     ///< of the facet, unit; zero for one without area
  double bend_ = 0;  ///< sine of the angle that the next facet may be turned by
  double longest_ = 0, corner_turn_ = 0;
  double turn_ = 0;  ///< of the normal along the facet, largest, radians a pixel
};

/// What the normals of a facet are held to, in units of the tolerance.
inline double shading_bound(const SampledFacet& facet, bool regular) {
  return regular && !facet.is_small() ? 1 : kLooseShading;
}

/// Which pieces of a face's boundary are hard: [boundary points], the piece from each point to the next.
inline void find_hard_pieces(std::span<const FaceEdge> sides, std::span<const std::uint16_t> rates,
                             std::vector<std::uint8_t>& hard) {
  hard.clear();
  for (std::size_t i = 0; i < sides.size(); ++i) hard.insert(hard.end(), rates[i], sides[i].sharp_edge ? 1 : 0);
}
inline std::array<bool, 3> hard_edges(const std::uint32_t* facet, const std::vector<std::uint8_t>& hard) {
  std::array<bool, 3> result{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t a = facet[i], b = facet[(i + 1) % 3];
    result[i] = a < hard.size() && b == (a + 1) % hard.size() && hard[a] != 0;
  }
  return result;
}

}  // namespace raytree
