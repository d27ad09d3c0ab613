#include "geometry/patch_subdivision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace raytree {
namespace {

/// Homogeneous control points of a part, [v][u]; (w P, w) also where all weights are 1.
struct Control {
  struct Point {
    double x, y, z, w;
    Vec3d place() const { return Vec3d(x, y, z) * (1 / w); }
  };
  std::array<Point, 16> points;
};

Control::Point middle(const Control::Point& a, const Control::Point& b) {
  return {(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2, (a.w + b.w) / 2};
}

/// De Casteljau's at 1/2 of the four points first, first + step, ...: both halves in place of `low` and `high`.
void halve(const Control& whole, std::size_t first, std::size_t step, Control& low, Control& high) {
  const auto& p = whole.points;
  const auto a = p[first], b = p[first + step], c = p[first + 2 * step], d = p[first + 3 * step];
  const auto ab = middle(a, b), bc = middle(b, c), cd = middle(c, d);
  const auto abc = middle(ab, bc), bcd = middle(bc, cd), all = middle(abc, bcd);
  low.points[first] = a, low.points[first + step] = ab, low.points[first + 2 * step] = abc;
  low.points[first + 3 * step] = high.points[first] = all;
  high.points[first + step] = bcd, high.points[first + 2 * step] = cd, high.points[first + 3 * step] = d;
}

/// The four parts, (u, v) halves low or high: 0 both low, 1 u high, 2 v high, 3 both.
std::array<Control, 4> quartered(const Control& whole) {
  Control left, right;
  std::array<Control, 4> parts;
  for (std::size_t row = 0; row < 4; ++row) halve(whole, 4 * row, 1, left, right);
  for (std::size_t column = 0; column < 4; ++column) {
    halve(left, column, 4, parts[0], parts[2]);
    halve(right, column, 4, parts[1], parts[3]);
  }
  return parts;
}

/// The patch lies in the hull of its control points, weights being positive.
std::array<Vec3d, 16> places(const Control& control) {
  std::array<Vec3d, 16> result;
  for (std::size_t i = 0; i < 16; ++i) result[i] = control.points[i].place();
  return result;
}

/// The plane through the middle of a part, along its diagonals, and how far its control points lie off it.
struct MiddlePlane {
  Vec3d point, normal;  ///< unit; zero where the part has no area
  double off = 0;

  explicit MiddlePlane(const std::array<Vec3d, 16>& p) : point((p[0] + p[3] + p[12] + p[15]) / 4) {
    normal = (p[15] - p[0]).cross(p[12] - p[3]);
    const double length = normal.length();
    normal = length > 0 ? normal / length : Vec3d(0, 0, 0);
    for (const Vec3d& q : p) off = std::max(off, std::abs((q - point).dot(normal)));
  }
  bool defined() const { return normal != Vec3d(0, 0, 0); }
};

/// One patch, one ray: the nearest hit so far is the limit of what follows.
class Search {
 public:
  Search(const BezierPatch& patch, const SphereRay& ray, double limit, const LeastRadius& least_radius)
      : patch_(patch), ray_(ray), least_radius_(least_radius), limit_(limit) {}

  struct Part {
    Control control;
    std::array<Vec3d, 16> places;
    BoundingSphere sphere;
    RayInterval interval;  ///< where the ray lies in this sphere and in all those about it
    double u, v, size;     ///< its corner and its width in the patch's parameters
    int level = 0, levels_too_small = 0;
  };

  void descend(const Part& part) {
    if (part.interval.empty() || part.interval.leave < 0 || part.interval.enter > limit_) return;
    const double least = least_radius_(part.sphere.center);
    const bool small = part.sphere.radius <= least;
    if (small || part.level == kMostPatchLevels) {
      const MiddlePlane plane(part.places);
      if (plane.off <= kFlatShare * least || part.levels_too_small == kMostFlatteningLevels ||
          part.level == kMostPatchLevels) {
        offer(part, plane);
        return;
      }
    }
    const std::array<Control, 4> controls = quartered(part.control);
    std::array<Part, 4> parts;
    std::array<const Part*, 4> order;
    for (std::size_t i = 0; i < 4; ++i) {
      Part& child = parts[i];
      child.control = controls[i];
      child.places = places(child.control);
      child.sphere = raytree::sphere_about(child.places);
      child.interval = child.sphere.inside(ray_);
      child.interval.intersect(part.interval.enter, part.interval.leave);
      child.size = part.size / 2;
      child.u = part.u + (i % 2 == 1 ? child.size : 0);
      child.v = part.v + (i >= 2 ? child.size : 0);
      child.level = part.level + 1;
      child.levels_too_small = part.levels_too_small + (small ? 1 : 0);
      order[i] = &child;
    }
    std::stable_sort(order.begin(), order.end(),
                     [](const Part* a, const Part* b) { return a->interval.enter < b->interval.enter; });
    for (const Part* child : order) descend(*child);
  }

  bool found() const { return found_; }
  const PatchHit& hit() const { return hit_; }

 private:
  /// A part that is small enough, and pierced.
  void offer(const Part& part, const MiddlePlane& plane) {
    RayInterval interval = part.interval;
    double guess = (part.sphere.center - ray_.origin).dot(ray_.direction) * ray_.inverse_square;
    if (plane.defined()) {
      const Vec3d to_plane = plane.point - ray_.origin;
      const double height = to_plane.dot(plane.normal), climb = ray_.direction.dot(plane.normal);
      const double off = plane.off + kSphereSlack * (to_plane.length() + part.sphere.radius);
      if (climb != 0) {
        const double a = (height - off) / climb, b = (height + off) / climb;
        interval.intersect(std::min(a, b), std::max(a, b));
        guess = height / climb;
      } else if (std::abs(height) > off) {
        return;
      }
    }
    // What is found must not depend on the limit, only whether it counts: so hits are the same in any order of objects.
    interval.intersect(0, std::numeric_limits<double>::infinity());
    if (interval.empty() || interval.enter > limit_) return;
    PatchHit hit{std::clamp(guess, interval.enter, interval.leave), part.u + part.size / 2, part.v + part.size / 2,
                 part.level};
    polish(part, interval, hit);
    if (hit.distance > limit_) return;
    // Of parts hit at one distance the one that comes first in (v, u) counts, whichever is met first.
    if (found_ && hit.distance == hit_.distance && !(hit.v < hit_.v || (hit.v == hit_.v && hit.u < hit_.u))) return;
    hit_ = hit, found_ = true, limit_ = hit.distance;
  }

  /// Newton's iteration on P(u, v) = origin + t direction, taken where it ends in the part or up to two of them beside:
  /// the planes about a part may let pass what its neighbor then meets.
  void polish(const Part& part, const RayInterval& interval, PatchHit& hit) const {
    constexpr int kMostSteps = 8;
    double u = hit.u, v = hit.v, t = hit.distance, last = std::numeric_limits<double>::infinity();
    for (int step = 0; step < kMostSteps; ++step) {
      const PatchDerivatives at = evaluate(patch_, u, v);
      const Vec3d off = ray_.origin + ray_.direction * t - at.position;
      // Cramer's rule on du P_u + dv P_v - dt direction = off.
      const Vec3d normal = at.du.cross(at.dv);
      const double determinant = -normal.dot(ray_.direction);
      if (determinant == 0) return;
      const Vec3d across = off.cross(ray_.direction);
      const double du = across.dot(at.dv) / determinant, dv = -across.dot(at.du) / determinant;
      const double dt = normal.dot(off) / determinant;
      const double moved = std::max(std::abs(du), std::abs(dv));
      u += du, v += dv, t += dt;
      if (!(std::abs(u - hit.u) <= 2 * part.size && std::abs(v - hit.v) <= 2 * part.size)) return;
      u = std::clamp(u, 0.0, 1.0), v = std::clamp(v, 0.0, 1.0);
      if (moved <= 0x1p-48 || (moved >= last && moved <= 0x1p-40)) {
        // Not before the part: what is skipped for beginning behind another hit must not lie in front of it.
        const double beyond = 2 * part.sphere.radius * std::sqrt(ray_.inverse_square);
        if (t >= interval.enter && t <= interval.leave + beyond) hit = {t, u, v, hit.level};
        return;
      }
      last = moved;
    }
  }

  const BezierPatch& patch_;
  const SphereRay& ray_;
  const LeastRadius& least_radius_;
  double limit_;
  bool found_ = false;
  PatchHit hit_;
};

Control homogeneous(const BezierPatch& patch) {
  Control control;
  for (std::size_t i = 0; i < 16; ++i) {
    const Vec3d p = patch.points[i] * patch.weights[i];
    control.points[i] = {p.x, p.y, p.z, patch.weights[i]};
  }
  return control;
}

}  // namespace

BoundingSphere sphere_about(const BezierPatch& patch) { return sphere_about(patch.points); }

bool intersect_patch(const BezierPatch& patch, const SphereRay& ray, const RayInterval& within, double limit,
                     const LeastRadius& least_radius, PatchHit& hit) {
  Search search(patch, ray, limit, least_radius);
  Search::Part whole;
  whole.control = homogeneous(patch);
  whole.places = places(whole.control);
  whole.sphere = sphere_about(whole.places);
  whole.interval = within;
  whole.u = whole.v = 0, whole.size = 1;
  search.descend(whole);
  if (search.found()) hit = search.hit();
  return search.found();
}

}  // namespace raytree
