#include "renderer/small_objects.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/angle.h"
#include "geometry/instance_transform.h"
#include "geometry/surface.h"
#include "renderer/render.h"

namespace raytree {
namespace {

double cross(const Vec2d& a, const Vec2d& b) { return a.x * b.y - a.y * b.x; }

/// Round outlines are polygons of so many corners, on a circle so much larger that they have its area.
constexpr int kRoundCorners = 16;
const double kRoundScale = std::sqrt(2 * kPi / kRoundCorners / std::sin(2 * kPi / kRoundCorners));

/// Gathers the image of one object point by point, for as long as it may be small.
class OutlineBuilder {
 public:
  explicit OutlineBuilder(const Camera& camera) : camera_(camera) {}

  /// False: the object is not small, or is not all before the eye.
  bool add(const Vec3d& point) {
    Vec2d p;
    if (!camera_.project(point, p) || !std::isfinite(p.x) || !std::isfinite(p.y)) return false;
    if (points_.empty()) first_ = far_ = p;
    if (points_.size() == kMostPoints) points_ = convex_hull(points_);
    points_.push_back(p);
    // The hull holds the triangle of the first point, the farthest one from it and this one, so it is at least as wide
    // as that triangle, whose least height stands on its longest edge.
    const Vec2d a = far_ - first_, b = p - first_, c = p - far_;
    const double longest = std::sqrt(std::max(a.dot(a), std::max(b.dot(b), c.dot(c))));
    if (std::abs(cross(a, b)) > kSmallWidth * longest) return false;
    if (b.dot(b) > a.dot(a)) far_ = p;
    return true;
  }

  /// The circle about `center` in the plane across `axis` (unit).
  bool add_circle(const Vec3d& center, const Vec3d& axis, double radius) {
    const Vec3d any = std::abs(axis.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
    const Vec3d u = unit(axis.cross(any)), v = axis.cross(u);
    for (int i = 0; i < kRoundCorners; ++i) {
      const double angle = 2 * kPi * i / kRoundCorners, r = radius * kRoundScale;
      if (!add(center + u * (r * std::cos(angle)) + v * (r * std::sin(angle)))) return false;
    }
    return true;
  }

  /// What the eye sees of a sphere: the circle in which its cone of tangents touches it (across the line of sight for
  /// parallel rays).
  bool add_sphere(const Vec3d& center, double radius) {
    const Vec3d forward(camera_.forward());
    if (!camera_.is_perspective()) return add_circle(center, forward, radius);
    const Vec3d to_center = center - Vec3d(camera_.position());
    const double square = to_center.dot(to_center);
    if (square <= radius * radius || to_center.dot(forward) <= radius) return false;
    const double nearer = radius * radius / square;
    return add_circle(center - to_center * nearer, unit(to_center), radius * std::sqrt(1 - nearer));
  }

  /// Its outline is the hull of its two ends.
  bool add_cone(const Cone& cone) {
    const Vec3d axis = (cone.apex - cone.base).normalized();
    return add_circle(cone.base, axis, cone.base_radius) && add_circle(cone.apex, axis, cone.apex_radius);
  }

  std::optional<SmallObject> finish(ShapeId shape) {
    SmallObject object;
    object.outline = convex_hull(points_);
    if (object.outline.size() < 3) return std::nullopt;  // seen edge on: it covers nothing
    object.box = narrowest_rectangle(object.outline);
    object.shape = shape;
    if (!(object.width() > 0 && object.width() < kSmallWidth)) return std::nullopt;
    return object;
  }

 private:
  /// Before a hull is taken in between.
  static constexpr std::size_t kMostPoints = 1 << 14;

  const Camera& camera_;
  std::vector<Vec2d> points_;
  Vec2d first_, far_;
};

/// A few points that stand for all that a group holds, so that an instance's outline costs next to nothing: most
/// instances show after a few of them that they are not small.
class GroupOutline {
 public:
  explicit GroupOutline(const BoundedShapes& group) : group_(group) {}

  /// Spheres and discs one by one where they are few and alone; their outlines are then exact.
  bool is_few_rounds() const {
    return group_.meshes.empty() &&
           group_.spheres.shape.size() + group_.discs.shape.size() + group_.cones.shape.size() <= kFewRounds;
  }

  /// The farthest points of the group in directions all around. Their hull lies inside the group's own; of a sphere it
  /// has 98 % of the outline's area.
  const std::vector<Vec3d>& farthest_points() {
    if (!farthest_.empty()) return farthest_;
    std::vector<Vec3d> directions(kDirections);
    for (int i = 0; i < kDirections; ++i) {  // a spiral of equal steps in height and the golden angle about it
      const double y = 1 - (2 * i + 1.0) / kDirections, ring = std::sqrt(1 - y * y), angle = 2.399963229728653 * i;
      directions[static_cast<std::size_t>(i)] = {ring * std::cos(angle), y, ring * std::sin(angle)};
    }
    std::vector<double> reach(kDirections, -std::numeric_limits<double>::infinity());
    farthest_.resize(kDirections);
    for_each_point([&](const Vec3d& point, double radius) {
      for (std::size_t i = 0; i < kDirections; ++i)
        if (const double r = point.dot(directions[i]) + radius; r > reach[i])
          reach[i] = r, farthest_[i] = point + directions[i] * radius;
    });
    return farthest_;
  }

 private:
  static constexpr int kDirections = 128;
  static constexpr std::size_t kFewRounds = 16;

  template <class Function>
  void for_each_point(Function&& function) const {
    for (const Imath::V4f& s : group_.spheres.center_radius) function(Vec3d(s.x, s.y, s.z), double(s.w));
    for (const Imath::V4f& d : group_.discs.center_radius) function(Vec3d(d.x, d.y, d.z), double(d.w));
    for (std::size_t i = 0; i < group_.cones.shape.size(); ++i) {
      // A ball about each end holds that end's circle.
      const Cone cone = group_.cones[i];
      function(cone.base, cone.base_radius);
      function(cone.apex, cone.apex_radius);
    }
    for (const MeshEntry& entry : group_.meshes)
      for (const Vec3f& position : entry.mesh.positions) function(Vec3d(position), 0.0);
  }

  const BoundedShapes& group_;
  std::vector<Vec3d> farthest_;
};

/// The outline of one instance, where it is small.
std::optional<SmallObject> instance_outline(const BoundedShapes& group, GroupOutline& points, const Instance& instance,
                                            const Camera& camera) {
  const InstanceTransform transform(instance);
  OutlineBuilder outline(camera);
  if (points.is_few_rounds()) {
    const double scale = transform.scale();
    for (const Imath::V4f& s : group.spheres.center_radius)
      if (!outline.add_sphere(transform.point({s.x, s.y, s.z}), s.w * scale)) return std::nullopt;
    for (std::size_t i = 0; i < group.discs.shape.size(); ++i) {
      const Imath::V4f& d = group.discs.center_radius[i];
      const Vec3d normal = unit(transform.normal(Vec3d(group.discs.normal[i])));
      if (!outline.add_circle(transform.point({d.x, d.y, d.z}), normal, d.w * scale)) return std::nullopt;
    }
    for (std::size_t i = 0; i < group.cones.shape.size(); ++i) {
      const Cone inside = group.cones[i];
      if (!outline.add_cone({transform.point(inside.base), transform.point(inside.apex), inside.base_radius * scale,
                             inside.apex_radius * scale}))
        return std::nullopt;
    }
    return outline.finish(instance.object);
  }
  for (const Vec3d& point : points.farthest_points())
    if (!outline.add(transform.point(point))) return std::nullopt;
  return outline.finish(instance.object);
}

}  // namespace

std::vector<Vec2d> convex_hull(std::vector<Vec2d>& points) {
  // Andrew's monotone chain.
  std::sort(points.begin(), points.end(),
            [](const Vec2d& a, const Vec2d& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Vec2d> hull;
  const auto add = [&](const Vec2d& p, std::size_t base) {
    while (hull.size() >= base + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull[hull.size() - 2]) <= 0)
      hull.pop_back();
    hull.push_back(p);
  };
  for (const Vec2d& p : points) add(p, 0);
  const std::size_t lower = hull.size() - 1;
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], lower);
  hull.pop_back();
  return hull;
}

ImageRectangle narrowest_rectangle(std::span<const Vec2d> polygon) {
  // The narrowest strip about a convex polygon lies along one of its edges; the corner farthest from the edge moves
  // round as the edge does (rotating calipers).
  const std::size_t count = polygon.size();
  const auto corner = [&](std::size_t i) { return polygon[i % count]; };
  double least = std::numeric_limits<double>::infinity();
  Vec2d along(1, 0);
  std::size_t opposite = 1;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2d edge = corner(i + 1) - corner(i);
    opposite = std::max(opposite, i + 1);
    while (opposite < i + count && cross(edge, corner(opposite + 1) - corner(opposite)) > 0) ++opposite;
    const double length = edge.length();
    const double width = cross(edge, corner(opposite) - corner(i)) / length;
    if (width < least) least = width, along = edge / length;
  }
  double low_u = std::numeric_limits<double>::infinity(), high_u = -low_u, low_v = low_u, high_v = -low_u;
  for (const Vec2d& p : polygon) {
    const double u = p.dot(along), v = cross(along, p);
    low_u = std::min(low_u, u), high_u = std::max(high_u, u);
    low_v = std::min(low_v, v), high_v = std::max(high_v, v);
  }
  const Vec2d across(-along.y, along.x);
  ImageRectangle box{along * ((low_u + high_u) / 2) + across * ((low_v + high_v) / 2), along, (high_u - low_u) / 2,
                     (high_v - low_v) / 2};
  if (box.half_width > box.half_length) {
    std::swap(box.half_width, box.half_length);
    box.along = across;
  }
  return box;
}

double area_in_square(std::span<const Vec2d> polygon, double x0, double y0, double size, Vec2d& centroid) {
  // Sutherland and Hodgman, one side of the square after the other.
  std::vector<Vec2d> kept(polygon.begin(), polygon.end()), clipped;
  for (int side = 0; side < 4; ++side) {
    const int axis = side / 2;
    const double sign = side % 2 == 0 ? 1 : -1, end = (axis == 0 ? x0 : y0) + (side % 2 == 0 ? 0 : size);
    const auto inside = [&](const Vec2d& p) { return sign * (p[axis] - end); };
    clipped.clear();
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const Vec2d &a = kept[i], &b = kept[(i + 1) % kept.size()];
      const double da = inside(a), db = inside(b);
      if (da >= 0) clipped.push_back(a);
      if ((da > 0 && db < 0) || (da < 0 && db > 0)) clipped.push_back(a + (b - a) * (da / (da - db)));
    }
    kept.swap(clipped);
  }
  if (kept.size() < 3) return 0;
  double twice_area = 0;
  Vec2d moment(0, 0);
  for (std::size_t i = 1; i + 1 < kept.size(); ++i) {
    const Vec2d a = kept[i] - kept[0], b = kept[i + 1] - kept[0];
    const double part = cross(a, b);
    twice_area += part;
    moment += (a + b) * part;
  }
  if (!(twice_area > 0)) return 0;
  centroid = kept[0] + moment / (3 * twice_area);
  return twice_area / 2;
}

SmallObjects::SmallObjects(const ShapeSet& shapes, const Camera& camera, int width, int height) {
  const auto keep = [&](std::optional<SmallObject>&& object) {
    if (object) objects_.push_back(std::move(*object));
  };
  // A shape of several spheres is one object; they stand together.
  const SphereArray& spheres = shapes.spheres;
  for (std::size_t i = 0, end = 0; i < spheres.shape.size(); i = end) {
    while (end < spheres.shape.size() && spheres.shape[end] == spheres.shape[i]) ++end;
    OutlineBuilder outline(camera);
    bool small = true;
    for (std::size_t k = i; small && k < end; ++k) {
      const Imath::V4f& sphere = spheres.center_radius[k];
      small = outline.add_sphere(Vec3d(sphere.x, sphere.y, sphere.z), sphere.w);
    }
    if (small) keep(outline.finish(spheres.shape[i]));
  }
  for (std::size_t i = 0; i < shapes.discs.shape.size(); ++i) {
    const Imath::V4f& disc = shapes.discs.center_radius[i];
    OutlineBuilder outline(camera);
    if (outline.add_circle(Vec3d(disc.x, disc.y, disc.z), Vec3d(shapes.discs.normal[i]), disc.w))
      keep(outline.finish(shapes.discs.shape[i]));
  }
  for (std::size_t i = 0; i < shapes.cones.shape.size(); ++i) {
    OutlineBuilder outline(camera);
    if (outline.add_cone(shapes.cones[i])) keep(outline.finish(shapes.cones.shape[i]));
  }
  for (const MeshEntry& entry : shapes.meshes) {
    OutlineBuilder outline(camera);
    bool small = true;
    for (std::size_t i = 0; small && i < entry.mesh.corners.size(); ++i)
      small = outline.add(Vec3d(entry.mesh.positions[entry.mesh.corners[i]]));
    if (small) keep(outline.finish(entry.shape));
  }
  std::vector<GroupOutline> groups;
  groups.reserve(shapes.groups.size());
  for (const BoundedShapes& group : shapes.groups) groups.emplace_back(group);
  for (const Instance& instance : shapes.instances)
    keep(instance_outline(shapes.groups[instance.group], groups[instance.group], instance, camera));
  sort_into_tiles(width, height);
}

void SmallObjects::sort_into_tiles(int width, int height) {
  if (objects_.empty()) return;
  tile_columns_ = (width + kTileSize - 1) / kTileSize;
  const int rows = (height + kTileSize - 1) / kTileSize;
  const auto for_each_tile = [&](const SmallObject& object, auto&& function) {
    const ImageRectangle& box = object.box;
    const double reach_x = box.half_length * std::abs(box.along.x) + box.half_width * std::abs(box.along.y);
    const double reach_y = box.half_length * std::abs(box.along.y) + box.half_width * std::abs(box.along.x);
    // Limits are clamped before they become whole: a box may reach past any integer.
    const auto tile = [](double x, int count) {
      return static_cast<int>(std::clamp(std::floor(x / kTileSize), -1.0, static_cast<double>(count)));
    };
    const int left = std::max(0, tile(box.center.x - reach_x, tile_columns_)),
              right = std::min(tile_columns_ - 1, tile(box.center.x + reach_x, tile_columns_)),
              top = std::max(0, tile(box.center.y - reach_y, rows)),
              bottom = std::min(rows - 1, tile(box.center.y + reach_y, rows));
    for (int y = top; y <= bottom; ++y)
      for (int x = left; x <= right; ++x)
        if (box.overlaps({(x + 0.5) * kTileSize, (y + 0.5) * kTileSize}, kTileSize / 2.0))
          function(static_cast<std::size_t>(y) * tile_columns_ + x);
  };
  tile_begin_.assign(static_cast<std::size_t>(tile_columns_) * rows + 1, 0);
  for (const SmallObject& object : objects_) for_each_tile(object, [&](std::size_t t) { ++tile_begin_[t + 1]; });
  for (std::size_t t = 1; t < tile_begin_.size(); ++t) tile_begin_[t] += tile_begin_[t - 1];
  tile_objects_.resize(tile_begin_.back());
  std::vector<std::uint32_t> next = tile_begin_;
  for (std::uint32_t i = 0; i < objects_.size(); ++i)
    for_each_tile(objects_[i], [&](std::size_t t) { tile_objects_[next[t]++] = i; });
}

std::span<const std::uint32_t> SmallObjects::of_tile(int x0, int y0) const {
  if (objects_.empty()) return {};
  const std::size_t t = static_cast<std::size_t>(y0 / kTileSize) * tile_columns_ + x0 / kTileSize;
  return {tile_objects_.data() + tile_begin_[t], tile_objects_.data() + tile_begin_[t + 1]};
}

}  // namespace raytree
