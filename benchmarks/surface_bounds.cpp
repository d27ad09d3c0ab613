#include "benchmarks/surface_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/bounding_sphere.h"
#include "geometry/few_shapes.h"
#include "geometry/instance_transform.h"

namespace raytree::benchmarks {
namespace {

constexpr double kUnit = 0x1p-24;  ///< of single precision
/// What is reckoned in double beside Embree takes directions for unit whose length is off by up to 2^-22: the square of
/// that is left.
constexpr double kFewUnit = 0x1p-44;

double gamma(int n, double unit = kUnit) { return n * unit / (1 - n * unit); }

Vec3d absolute(const Vec3d& v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.z)}; }
/// Of vectors without signs: the products of a cross product, added up.
Vec3d added_cross(const Vec3d& a, const Vec3d& b) {
  return {a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x};
}
double middle(double a, double b, double c) { return std::max(std::min(a, b), std::min(std::max(a, b), c)); }

/// A ray in the space of the shapes that it is asked about, and how far it may be off there.
struct LocalRay {
  Vec3d origin, direction;
  std::optional<InstanceTransform> transform;  ///< none: scene space

  /// Bound on where the tracer's way into the group puts points of the ray `away` along it, per component.
  Vec3d shift(const Vec3d& scene_origin, const Vec3d& scene_direction, double away) const {
    if (!transform) return Vec3d(0);
    const Vec3d largest =
        absolute(scene_origin) + absolute(transform->origin()) + absolute(scene_direction) * std::abs(away);
    return bound(largest);
  }
  Vec3d direction_shift(const Vec3d& scene_direction) const {
    return transform ? bound(absolute(scene_direction)) : Vec3d(0);
  }
  double scale() const { return transform ? transform->scale() : 1; }

 private:
  Vec3d bound(const Vec3d& largest) const {
    return Vec3d(transform->inverse_error({1, 0, 0}, largest), transform->inverse_error({0, 1, 0}, largest),
                 transform->inverse_error({0, 0, 1}, largest)) *
           double(kInstanceError);
  }
};

struct Question {
  const BoundedShapes& shapes;
  LocalRay ray;
  Vec3d scene_origin, scene_direction;
  double near_distance;
  FastArithmetic arithmetic;

  Vec3d shift(double away) const { return ray.shift(scene_origin, scene_direction, away); }
};

SurfaceBounds::Side side_of(double margin, double error) {
  if (std::abs(margin) <= error) return SurfaceBounds::Side::uncertain;
  return margin > 0 ? SurfaceBounds::Side::inside : SurfaceBounds::Side::outside;
}

/// Distance to a plane as (point - origin).n / d.n; `error`: of point - origin, per component.
void bound_plane(const Vec3d& to, const Vec3d& error, const Vec3d& normal, const Vec3d& direction,
                 const Vec3d& direction_error, double unit, SurfaceBounds& bounds) {
  const Vec3d n = absolute(normal);
  const double slope = normal.dot(direction);
  const double slope_error = gamma(4, unit) * n.dot(absolute(direction)) + n.dot(direction_error);
  bounds.distance = normal.dot(to) / slope;
  bounds.grazing = !(std::abs(slope) > slope_error);
  bounds.distance_error =
      bounds.grazing ? kInfinity
                     : (n.dot(error) + gamma(4, unit) * n.dot(absolute(to)) + std::abs(bounds.distance) * slope_error) /
                               (std::abs(slope) - slope_error) +
                           2 * kUnit * std::abs(bounds.distance);
}

/// What the test without watertight edges may be off by, in the terms of triangle_bounds(): bounds on its edge
/// functions U = (C x D) . e2, V = (C x D) . e1, W = D . N - U - V (C = v0 - O, e1 = v0 - v1, e2 = v2 - v0, N = e2 x
/// e1), on its slope D . N and on T = N . C. Which corner is v0 depends on what the triangle became a part of: the
/// largest counts. What lies at the very border of a box may be missed by the boxes too, whose planes are met at b / d
/// - o / d: that is off by some ulps of the coordinates themselves.
struct PlainErrors {
  double edge = 0, slope = 0, numerator = 0, box = 0;
};

PlainErrors plain_errors(const Vec3d (&v)[3], const LocalRay& ray, double shift) {
  PlainErrors errors;
  const Vec3d d = absolute(ray.direction);
  for (int base = 0; base < 3; ++base) {
    const Vec3d e1 = absolute(v[base] - v[(base + 1) % 3]), e2 = absolute(v[(base + 2) % 3] - v[base]);
    const Vec3d c = absolute(v[base]), turned = added_cross(c, d), n = added_cross(e1, e2);
    // C and each edge are rounded once, a cross product's component 3 times, a scalar product 3 times.
    const double first = (gamma(8) * turned + added_cross(Vec3d(shift), d)).dot(e2),
                 second = (gamma(8) * turned + added_cross(Vec3d(shift), d)).dot(e1);
    const double slope = gamma(8) * n.dot(d);
    // The third is the sum of the others and of the slope, and rounded twice more.
    errors.edge = std::max(errors.edge, first + second + slope + gamma(2) * (turned.dot(e1) + turned.dot(e2)));
    errors.slope = std::max(errors.slope, slope);
    errors.numerator = std::max(errors.numerator, gamma(9) * n.dot(c) + n.dot(Vec3d(shift)));
  }
  for (const Vec3d& corner : v)
    errors.box = std::max(errors.box, gamma(4) * (absolute(corner + ray.origin) + absolute(ray.origin)).length());
  return errors;
}

/// The edge functions and the distance of Embree's robust test, which reckons in Pluecker coordinates about the ray's
/// origin: U = D . ((q - p) x (q + p)) for the edge from p to q; T = v0 . N, t = T / (D . N), N of the triangle's
/// edges.
SurfaceBounds triangle_bounds(const Question& question, const TriangleMesh& mesh, std::uint32_t triangle) {
  SurfaceBounds bounds;
  const Vec3d direction = question.ray.direction, d = absolute(direction);
  const std::uint32_t* corner = &mesh.corners[std::size_t(triangle) * 3];
  Vec3d v[3], error[3];
  double farthest = 0;
  for (int i = 0; i < 3; ++i) {
    v[i] = Vec3d(mesh.positions[corner[i]]) - question.ray.origin;
    farthest = std::max(farthest, v[i].length());
  }
  const Vec3d shift = question.shift(farthest / direction.length());
  for (int i = 0; i < 3; ++i) error[i] = absolute(v[i]) * kUnit;

  double edge[3], edge_error[3], sum = 0;
  for (int i = 0; i < 3; ++i) {
    const Vec3d &p = v[i], &q = v[(i + 1) % 3];
    const Vec3d ep = error[i] + shift, eq = error[(i + 1) % 3] + shift;
    edge[i] = 2 * direction.dot(p.cross(q));
    // D . (e x q) = e . (q x D), and |q x D| is how far the ray passes q by.
    edge_error[i] =
        2 * (ep.dot(absolute(q.cross(direction))) + eq.dot(absolute(p.cross(direction))) + d.dot(added_cross(ep, eq))) +
        gamma(7) * d.dot(added_cross(absolute(q - p), absolute(q + p)));
    sum += edge[i];
  }
  bounds.edge_distance = kInfinity;
  const bool is_plain = question.arithmetic.triangles == FastArithmetic::Triangles::plain;
  const PlainErrors plain = is_plain ? plain_errors(v, question.ray, shift.length()) : PlainErrors();
  // The test lets pass what lies outside by an ulp of the edge functions' sum.
  const double pass = 0x1p-23 * std::abs(sum);
  bool is_certain[3];
  for (int i = 0; i < 3; ++i) {
    const double across = 2 * direction.cross(v[(i + 1) % 3] - v[i]).length();
    edge_error[i] = is_plain ? 2 * plain.edge + plain.box * across : edge_error[i] + pass;
    is_certain[i] = std::abs(edge[i]) > edge_error[i];
    const double to_distance = question.ray.scale() / across;
    if (std::abs(edge[i]) * to_distance < bounds.edge_distance) {
      bounds.edge_distance = std::abs(edge[i]) * to_distance;
      bounds.edge_error = edge_error[i] * to_distance;
    }
  }
  // u = U / (U + V + W), likewise v: off by both parts' errors, and rounded.
  const double longest = std::max({(v[1] - v[0]).length(), (v[2] - v[1]).length(), (v[0] - v[2]).length()});
  const double sum_error = edge_error[0] + edge_error[1] + edge_error[2];
  bounds.u = edge[2] / sum;
  bounds.v = edge[0] / sum;
  bounds.weight_error = std::abs(sum) > sum_error ? 2 * sum_error / (std::abs(sum) - sum_error) + gamma(8) : kInfinity;
  bounds.position_error = bounds.weight_error * longest * question.ray.scale();
  bool has_positive = false, has_negative = false;
  for (int i = 0; i < 3; ++i) {
    has_positive |= is_certain[i] && edge[i] > 0;
    has_negative |= is_certain[i] && edge[i] < 0;
  }
  bounds.side = has_positive && has_negative                      ? SurfaceBounds::Side::outside
                : is_certain[0] && is_certain[1] && is_certain[2] ? SurfaceBounds::Side::inside
                                                                  : SurfaceBounds::Side::uncertain;

  // N is the cross product of two of the edges, which two is chosen by component so that its products are small: of any
  // two of the three pairs the better one is no worse than the middle one. Moving vertices moves N alike by any pair.
  const Vec3d normal = (v[1] - v[0]).cross(v[2] - v[0]);
  Vec3d moved(kInfinity), products[3];
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const Vec3d a = absolute(v[j] - v[i]), b = absolute(v[k] - v[i]);
    const Vec3d by_move = added_cross(error[i] + error[j], b) + added_cross(a, error[i] + error[k]);
    products[i] = added_cross(a, b);
    for (int axis = 0; axis < 3; ++axis) moved[axis] = std::min(moved[axis], by_move[axis]);
  }
  Vec3d normal_error;
  for (int axis = 0; axis < 3; ++axis)
    normal_error[axis] = moved[axis] + gamma(4) * (middle(products[0][axis], products[1][axis], products[2][axis]) +
                                                   2 * std::abs(normal[axis]));
  const Vec3d n = absolute(normal);
  const double slope = normal.dot(direction);
  const double direction_shift = n.dot(question.ray.direction_shift(question.scene_direction));
  const double slope_error =
      is_plain ? plain.slope + direction_shift : normal_error.dot(d) + gamma(3) * n.dot(d) + direction_shift;
  bounds.distance = normal.dot(v[0]) / slope;
  bounds.grazing = !(std::abs(slope) > slope_error);
  // An error of N moves T and D . N together: what is left of it is its part along the way from v0 to the hit.
  const Vec3d in_plane = absolute(v[0] - direction * bounds.distance);
  if (is_plain)
    bounds.distance_error =
        bounds.grazing ? kInfinity
                       : (plain.numerator + std::abs(bounds.distance) * slope_error) / (std::abs(slope) - slope_error) +
                             gamma(4) * std::abs(bounds.distance);
  else
    bounds.distance_error =
        bounds.grazing ? kInfinity
                       : (normal_error.dot(in_plane) + n.dot(error[0] + shift) + gamma(3) * n.dot(absolute(v[0])) +
                          std::abs(bounds.distance) * (gamma(3) * n.dot(d) + direction_shift)) /
                                 (std::abs(slope) - slope_error) +
                             gamma(4) * std::abs(bounds.distance);

  // The renderer's normal: the cross product of two edges (geometry/surface.h, solve_triangle()), made unit.
  double turn = gamma(4) * products[0].length() / normal.length();
  if (question.ray.transform) {
    const InstanceTransform& transform = *question.ray.transform;
    const double size = std::sqrt(transform.normal({1, 0, 0}).dot(transform.normal({1, 0, 0})) +
                                  transform.normal({0, 1, 0}).dot(transform.normal({0, 1, 0})) +
                                  transform.normal({0, 0, 1}).dot(transform.normal({0, 0, 1})));
    turn = (turn + gamma(4)) * size / transform.normal(normal * (1 / normal.length())).length();
  }
  bounds.normal_error = turn + gamma(8);
  return bounds;
}

/// Embree's points: half the chord from the distance of the center from the ray.
SurfaceBounds sphere_bounds(const Question& question, const Imath::V4f& sphere, double unit) {
  SurfaceBounds bounds;
  const Vec3d direction = question.ray.direction, d = absolute(direction);
  const Vec3d to = Vec3d(sphere.x, sphere.y, sphere.z) - question.ray.origin, c = absolute(to);
  const double radius = sphere.w, square = direction.dot(direction);
  const Vec3d error = c * unit + question.shift((to.length() + radius) / std::sqrt(square));
  const double along = to.dot(direction) / square;
  const double along_error = (gamma(8, unit) * c.dot(d) + error.dot(d)) / square;
  const Vec3d closest = to - direction * along;
  const Vec3d closest_error = error + d * along_error + (c + d * std::abs(along)) * gamma(2, unit);
  const double closest_square = closest.dot(closest);
  const double square_error = 2 * absolute(closest).dot(closest_error) + closest_error.dot(closest_error) +
                              gamma(3, unit) * closest_square + gamma(2, unit) * radius * radius;
  const double chord_square = (radius * radius - closest_square) / square;
  const double chord_error = square_error / square + gamma(6, unit) * std::abs(chord_square);
  bounds.side = side_of(chord_square, chord_error);
  bounds.edge_distance = std::abs(closest.length() - radius) * question.ray.scale();
  bounds.edge_error = square_error / (closest.length() + radius) * question.ray.scale();
  const double half = std::sqrt(std::max(0.0, chord_square));
  const double near = along - half, far = along + half;
  bounds.distance = std::abs(near - question.near_distance) <= std::abs(far - question.near_distance) ? near : far;
  const double half_error = chord_square > chord_error ? chord_error / (half + std::sqrt(chord_square - chord_error))
                                                       : std::sqrt(std::max(0.0, chord_square) + chord_error);
  bounds.distance_error = along_error + half_error + 3 * kUnit * std::abs(bounds.distance);
  bounds.normal_error = (error.length() + std::sqrt(square) * bounds.distance_error) / radius + gamma(8);
  return bounds;
}

SurfaceBounds disc_bounds(const Question& question, const Imath::V4f& disc, const Vec3f& disc_normal, double unit) {
  SurfaceBounds bounds;
  const Vec3d direction = question.ray.direction;
  const Vec3d to = Vec3d(disc.x, disc.y, disc.z) - question.ray.origin;
  const Vec3d error = absolute(to) * unit + question.shift((to.length() + disc.w) / direction.length());
  bound_plane(to, error, Vec3d(disc_normal), direction, question.ray.direction_shift(question.scene_direction), unit,
              bounds);
  const Vec3d across = direction * bounds.distance - to;
  const Vec3d across_error = absolute(direction) * (bounds.grazing ? 0 : bounds.distance_error) + error +
                             (absolute(direction) * std::abs(bounds.distance) + absolute(to)) * gamma(4);
  const double margin = disc.w - across.length(), margin_error = across_error.length() + gamma(4) * disc.w;
  bounds.side = bounds.grazing ? SurfaceBounds::Side::uncertain : side_of(margin, margin_error);
  bounds.edge_distance = std::abs(margin) * question.ray.scale();
  bounds.edge_error = margin_error * question.ray.scale();
  bounds.normal_error = gamma(16);
  return bounds;
}

/// Roots of a s^2 + 2 half_b s + c, the lesser first; a >= 0, a and half_b not both 0. Where a is 0, one is infinite.
std::optional<RayInterval> roots_of(double a, double half_b, double c) {
  const double discriminant = half_b * half_b - a * c;
  if (!(discriminant >= 0)) return std::nullopt;
  const double q = -(half_b + std::copysign(std::sqrt(discriminant), half_b));
  if (q == 0) return RayInterval{0, 0};
  const double one = c / q, other = a > 0 ? q / a : std::copysign(kInfinity, q);
  return RayInterval{std::min(one, other), std::max(one, other)};
}

/// A stretch of a line along which a cone's equation is 0 to some error.
struct ConeStretch {
  RayInterval at{1, -1};
  bool crosses = false;  ///< the equation changes its sign from end to end: there is a crossing, however it errs
};

/// Both of them, one empty where there is but one.
std::array<ConeStretch, 2> stretches_of(double a, double half_b, double c, double error) {
  if (a == 0 && half_b == 0)
    return {std::abs(c) <= error ? ConeStretch{{-kInfinity, kInfinity}, false} : ConeStretch(), ConeStretch()};
  if (a < 0) a = -a, half_b = -half_b, c = -c;
  const auto outer = roots_of(a, half_b, c - error), inner = roots_of(a, half_b, c + error);
  if (!outer) return {};
  if (!inner) return {ConeStretch{*outer, false}, ConeStretch()};
  return {ConeStretch{{outer->enter, inner->enter}, true}, ConeStretch{{inner->leave, outer->leave}, true}};
}

/// The part of a stretch where the line's height lies within [low, high].
RayInterval clipped(RayInterval stretch, const ConeLine& line, double low, double high) {
  const double one = (low - line.start_height) / line.climb, other = (high - line.start_height) / line.climb;
  if (line.climb != 0)
    stretch.intersect(std::min(one, other), std::max(one, other));
  else if (!(line.start_height >= low && line.start_height <= high))
    stretch = {1, -1};
  return stretch;
}

/// Cones are reckoned in double; what is off is the ray in instances, whose points lie up to `off` from where they
/// should. F(p) = |across|^2 - radius(height)^2 has a gradient of 2 sqrt(F + k^2 radius^2) and second derivatives of up
/// to 2 k^2, k^2 = 1 + slope^2: where the ray as it is meets the cone, at most E = 2 k radius off + 6 (k off)^2 is left
/// of F on the ray as it should be; and wherever |F| <= E on this, the two rays' F differ by no more than E.
SurfaceBounds cone_bounds(const Question& question, const Cone& cone) {
  SurfaceBounds bounds;
  const ConeFrame frame(cone);
  const double length = question.ray.direction.length();
  const Vec3d direction = question.ray.direction * (1 / length);
  const double reach = (cone.base - question.ray.origin).length() + frame.length + cone.base_radius + cone.apex_radius;
  const double off = question.shift(reach / length).length() + kFewUnit * reach;
  const double steepness = std::sqrt(1 + frame.slope * frame.slope), moved = steepness * off;
  const double error = 2 * steepness * std::max(cone.base_radius, cone.apex_radius) * off + 6 * moved * moved;

  const ConeLine line(frame, question.ray.origin, direction);
  const double wanted = question.near_distance * length - line.shift;
  ConeStretch nearest;
  double nearest_way = kInfinity;
  for (const ConeStretch& stretch : stretches_of(line.a, line.half_b, line.c, error)) {
    const RayInterval possible = clipped(stretch.at, line, -off, frame.length + off);
    if (possible.empty()) continue;
    const double way = std::max({0.0, possible.enter - wanted, wanted - possible.leave});
    if (!nearest.at.empty() && !(way < nearest_way)) continue;
    const RayInterval certain = clipped(stretch.at, line, off, frame.length - off);
    const bool is_certain = stretch.crosses && certain.enter == stretch.at.enter && certain.leave == stretch.at.leave;
    nearest = {possible, is_certain}, nearest_way = way;
  }
  bounds.edge_error = off * question.ray.scale();
  if (nearest.at.empty()) {
    bounds.side = SurfaceBounds::Side::outside;
    bounds.distance = bounds.distance_error = bounds.edge_distance = kInfinity;
    return bounds;
  }
  bounds.side = nearest.crosses ? SurfaceBounds::Side::inside : SurfaceBounds::Side::uncertain;
  bounds.edge_distance = nearest.crosses ? kInfinity : 0;
  // The crossing as it should be, or where there is none the middle of where one may be.
  double own = (nearest.at.enter + nearest.at.leave) / 2;
  const ConeCrossings crossings = cone_crossings(frame, question.ray.origin, direction);
  for (const double crossing : {crossings.near - line.shift, crossings.far - line.shift})
    if (crossing >= nearest.at.enter && crossing <= nearest.at.leave) own = crossing;
  const double way = std::max(own - nearest.at.enter, nearest.at.leave - own);
  bounds.distance = (own + line.shift) / length;
  bounds.distance_error = way / length + 2 * kUnit * std::abs(bounds.distance);
  // Of two vectors across the axis, one as long as the radius here: 2 |u - v| / (|u| + |v|) apart, once they are unit.
  const double radius = cone.base_radius + frame.slope * line.height(own),
               turned = off + length * bounds.distance_error;
  bounds.normal_error = gamma(16) + (turned < radius ? 2 * turned / (2 * radius - turned) : 2);
  return bounds;
}

}  // namespace

SurfaceBounds surface_bounds(const ShapeSet& shapes, const Vec3f& origin, const Vec3f& direction, const SurfaceId& id,
                             double near_distance, const FastArithmetic& arithmetic) {
  const Vec3d o(origin), d(direction);
  if (id.geometry == kPlaneGeometry) {
    const Plane& plane = shapes.planes[id.primitive];
    SurfaceBounds bounds;
    const Vec3d to = plane.point - o;
    bound_plane(to, absolute(to) * kFewUnit, plane.normal, d, Vec3d(0), kFewUnit, bounds);
    bounds.side = SurfaceBounds::Side::inside;
    bounds.edge_distance = kInfinity;
    bounds.normal_error = gamma(4);
    return bounds;
  }
  const bool instanced = id.instance != kNoInstance;
  const BoundedShapes& list = instanced ? shapes.groups[shapes.instances[id.instance].group] : shapes;
  Question question{list, {o, d, std::nullopt}, o, d, near_distance, arithmetic};
  if (instanced) {
    const InstanceTransform transform(shapes.instances[id.instance]);
    question.ray = {transform.inverse_point(o), transform.inverse_vector(d), transform};
  }
  if (id.geometry >= kFirstMeshGeometry)
    return triangle_bounds(question, list.meshes[id.geometry - kFirstMeshGeometry].mesh, id.primitive);
  // A few spheres and discs are tested beside Embree, in double.
  const FewShapes few(shapes, arithmetic.most_few_shapes);
  if (id.geometry == kSphereGeometry)
    return sphere_bounds(question, list.spheres.center_radius[id.primitive],
                         few.spheres && !instanced ? kFewUnit : kUnit);
  if (id.geometry == kDiscGeometry)
    return disc_bounds(question, list.discs.center_radius[id.primitive], list.discs.normal[id.primitive],
                       few.discs && !instanced ? kFewUnit : kUnit);
  return cone_bounds(question, list.cones[id.primitive]);
}

}  // namespace raytree::benchmarks
