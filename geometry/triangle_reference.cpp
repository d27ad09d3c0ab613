#include "geometry/triangle_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "geometry/cone.h"
#include "geometry/instance_transform.h"
#include "geometry/surface.h"
#include "geometry/watertight_triangle.h"

namespace raytree {
namespace {

constexpr std::uint32_t kLeafItems = 4;

/// By how much boxes are enlarged, as a share of the coordinates of ray and boxes: what is found on a shape lies within
/// its box but for a few roundings of 2^-53.
constexpr double kBoxSlack = 0x1p-46;

double largest(const Vec3d& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// What is found of a shape: at most two distances, nearer first; triangles have one.
struct Crossings {
  double distance[2] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  double u = 0, v = 0;
};

/// By way of the line's point closest to the center, which keeps its digits for far and small spheres.
Crossings sphere_crossings(const Vec3d& center, double radius, const Vec3d& origin, const Vec3d& direction) {
  const double square = direction.dot(direction);
  const Vec3d to = center - origin;
  const double along = to.dot(direction) / square;
  const Vec3d closest = direction * along - to;
  const double chord_square = (radius * radius - closest.dot(closest)) / square;
  Crossings result;
  if (!(chord_square >= 0)) return result;
  const double half = std::sqrt(chord_square);
  result.distance[0] = along - half, result.distance[1] = along + half;
  return result;
}

double plane_crossing(const Vec3d& point, const Vec3d& normal, const Vec3d& origin, const Vec3d& direction) {
  const double distance = normal.dot(point - origin) / normal.dot(direction);
  return std::isfinite(distance) ? distance : std::numeric_limits<double>::infinity();
}

Vec3d center_of(const Imath::V4f& round) { return {round.x, round.y, round.z}; }

Crossings crossings_of(const BoundedShapes& shapes, GeometryId geometry, std::uint32_t primitive, const Vec3d& origin,
                       const Vec3d& direction, const WatertightRay& ray) {
  Crossings result;
  if (geometry >= kFirstMeshGeometry) {
    const TriangleMesh& mesh = shapes.meshes[geometry - kFirstMeshGeometry].mesh;
    const std::uint32_t* corner = &mesh.corners[std::size_t(primitive) * 3];
    const std::optional<TriangleCrossing> crossing = ray.crossing(
        Vec3d(mesh.positions[corner[0]]), Vec3d(mesh.positions[corner[1]]), Vec3d(mesh.positions[corner[2]]));
    if (crossing) result.distance[0] = crossing->distance, result.u = crossing->u, result.v = crossing->v;
  } else if (geometry == kSphereGeometry) {
    const Imath::V4f& sphere = shapes.spheres.center_radius[primitive];
    result = sphere_crossings(center_of(sphere), sphere.w, origin, direction);
  } else if (geometry == kDiscGeometry) {
    const Imath::V4f& disc = shapes.discs.center_radius[primitive];
    const double distance = plane_crossing(center_of(disc), Vec3d(shapes.discs.normal[primitive]), origin, direction);
    const Vec3d across = origin + direction * distance - center_of(disc);
    if (across.dot(across) <= double(disc.w) * disc.w) result.distance[0] = distance;
  } else {
    const double length = direction.length();
    const ConeCrossings cone = cone_crossings(ConeFrame(shapes.cones[primitive]), origin, direction * (1 / length));
    result.distance[0] = cone.near / length, result.distance[1] = cone.far / length;
  }
  return result;
}

/// Unit, outward, in the space of the shapes. Zero where a triangle has no area.
Vec3d normal_of(const BoundedShapes& shapes, GeometryId geometry, std::uint32_t primitive, const Vec3d& point) {
  if (geometry >= kFirstMeshGeometry) {
    const TriangleMesh& mesh = shapes.meshes[geometry - kFirstMeshGeometry].mesh;
    const std::uint32_t* corner = &mesh.corners[std::size_t(primitive) * 3];
    const Vec3d a(mesh.positions[corner[0]]), b(mesh.positions[corner[1]]), c(mesh.positions[corner[2]]);
    return (b - a).cross(c - a).normalized();
  }
  if (geometry == kSphereGeometry) return (point - center_of(shapes.spheres.center_radius[primitive])).normalized();
  if (geometry == kDiscGeometry) return Vec3d(shapes.discs.normal[primitive]).normalized();
  return cone_normal(ConeFrame(shapes.cones[primitive]), point);
}

/// Whether a hit at `distance` stands before another.
bool is_before(double distance, InstanceId instance, GeometryId geometry, std::uint32_t primitive,
               const ReferenceHit& other) {
  if (distance != other.distance) return distance < other.distance;
  if (instance != other.instance) return instance < other.instance;
  if (geometry != other.geometry) return geometry < other.geometry;
  return primitive < other.primitive;
}

}  // namespace

/// Distances at which a ray is inside something.
struct TriangleReference::Range {
  double enter = 0, leave = std::numeric_limits<double>::infinity();

  bool empty() const { return !(enter <= leave); }
  double clamp(double distance) const { return std::min(std::max(distance, enter), leave); }
};

/// A ray in the space of one list of shapes.
class TriangleReference::Ray {
 public:
  Ray(const Vec3d& origin_, const Vec3d& direction_, double reach)
      : origin(origin_),
        direction(direction_),
        watertight(origin_, direction_),
        inverse_(1 / direction_.x, 1 / direction_.y, 1 / direction_.z),
        slack_(kBoxSlack * (largest(origin_) + reach)) {}

  /// Where the ray is inside the box, made larger by the slack. A box within another never has the wider range: each
  /// step below keeps order, whatever it rounds.
  Range range(const Box& box) const {
    Range range;
    for (int axis = 0; axis < 3; ++axis) {
      const double to_least = (box.least[axis] - slack_ - origin[axis]) * inverse_[axis],
                   to_most = (box.most[axis] + slack_ - origin[axis]) * inverse_[axis];
      const double first = to_least < to_most ? to_least : to_most, last = to_least < to_most ? to_most : to_least;
      // Along a slab's very border 0 times infinity is not a number, which fails comparisons and so bounds nothing.
      range.enter = first > range.enter ? first : range.enter;
      range.leave = last < range.leave ? last : range.leave;
    }
    return range;
  }

  const Vec3d origin, direction;
  const WatertightRay watertight;

 private:
  Vec3d inverse_;
  double slack_;
};

TriangleReference::TriangleReference(const ShapeSet& shapes, Search search)
    : shapes_(shapes), search_(search), top_(tree_of(shapes)) {
  for (const BoundedShapes& group : shapes.groups) groups_.push_back(tree_of(group));
  instances_ = tree_of_instances();
}

TriangleReference::Tree TriangleReference::tree_of(std::vector<Item> items, const std::vector<Box>& boxes) {
  Tree tree;
  for (const Box& box : boxes) tree.reach = std::max({tree.reach, largest(box.least), largest(box.most)});
  std::vector<std::uint32_t> order(items.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto build = [&](auto&& self, std::size_t begin, std::size_t end) -> void {
    const std::size_t index = tree.nodes.size();
    Box box = boxes[order[begin]], centers{box.least + box.most, box.least + box.most};
    for (std::size_t i = begin; i < end; ++i) {
      const Box& b = boxes[order[i]];
      const Vec3d center = b.least + b.most;
      for (int axis = 0; axis < 3; ++axis) {
        box.least[axis] = std::min(box.least[axis], b.least[axis]);
        box.most[axis] = std::max(box.most[axis], b.most[axis]);
        centers.least[axis] = std::min(centers.least[axis], center[axis]);
        centers.most[axis] = std::max(centers.most[axis], center[axis]);
      }
    }
    if (end - begin <= kLeafItems) {
      tree.nodes.push_back({box, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end - begin)});
      return;
    }
    tree.nodes.push_back({box, 0, 0});
    const Vec3d size = centers.most - centers.least;
    const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
      const double x = boxes[a].least[axis] + boxes[a].most[axis], y = boxes[b].least[axis] + boxes[b].most[axis];
      return x != y ? x < y : a < b;
    });
    self(self, begin, middle);
    tree.nodes[index].first = static_cast<std::uint32_t>(tree.nodes.size());
    self(self, middle, end);
  };
  if (!items.empty()) build(build, 0, items.size());
  for (const std::uint32_t i : order) tree.items.push_back(items[i]);
  return tree;
}

TriangleReference::Box TriangleReference::box_of(const BoundedShapes& shapes, const Item& item) {
  if (item.geometry >= kFirstMeshGeometry) {
    const TriangleMesh& mesh = shapes.meshes[item.geometry - kFirstMeshGeometry].mesh;
    const std::uint32_t* corner = &mesh.corners[std::size_t(item.primitive) * 3];
    const Vec3d a(mesh.positions[corner[0]]), b(mesh.positions[corner[1]]), c(mesh.positions[corner[2]]);
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
      box.least[axis] = std::min({a[axis], b[axis], c[axis]});
      box.most[axis] = std::max({a[axis], b[axis], c[axis]});
    }
    return box;
  }
  if (item.geometry == kConeGeometry) {
    const Bounds3d box = bounds(shapes.cones[item.primitive]);
    return {box.min, box.max};
  }
  const Imath::V4f& round = item.geometry == kSphereGeometry ? shapes.spheres.center_radius[item.primitive]
                                                             : shapes.discs.center_radius[item.primitive];
  return {center_of(round) - Vec3d(round.w), center_of(round) + Vec3d(round.w)};
}

TriangleReference::Tree TriangleReference::tree_of(const BoundedShapes& shapes) {
  std::vector<Item> items;
  const auto add = [&](GeometryId geometry, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) items.push_back({geometry, static_cast<std::uint32_t>(i)});
  };
  add(kSphereGeometry, shapes.spheres.center_radius.size());
  add(kDiscGeometry, shapes.discs.center_radius.size());
  add(kConeGeometry, shapes.cones.shape.size());
  for (std::size_t m = 0; m < shapes.meshes.size(); ++m)
    add(kFirstMeshGeometry + static_cast<GeometryId>(m), shapes.meshes[m].mesh.triangle_count());
  std::vector<Box> boxes;
  boxes.reserve(items.size());
  for (const Item& item : items) boxes.push_back(box_of(shapes, item));
  return tree_of(std::move(items), boxes);
}

/// About the corners of what the group's box becomes; of a group without shapes empty, the wrong way round.
TriangleReference::Box TriangleReference::box_of(const Instance& instance) const {
  const double infinity = std::numeric_limits<double>::infinity();
  Box result{Vec3d(infinity), Vec3d(-infinity)};
  const Tree& group = groups_[instance.group];
  if (group.nodes.empty()) return result;
  const InstanceTransform transform(instance);
  const Box& box = group.nodes.front().box;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d p = transform.point({corner & 1 ? box.most.x : box.least.x, corner & 2 ? box.most.y : box.least.y,
                                     corner & 4 ? box.most.z : box.least.z});
    for (int axis = 0; axis < 3; ++axis) {
      result.least[axis] = std::min(result.least[axis], p[axis]);
      result.most[axis] = std::max(result.most[axis], p[axis]);
    }
  }
  return result;
}

TriangleReference::Tree TriangleReference::tree_of_instances() const {
  std::vector<Item> items;
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < shapes_.instances.size(); ++i) {
    if (groups_[shapes_.instances[i].group].nodes.empty()) continue;
    items.push_back({0, static_cast<std::uint32_t>(i)});
    boxes.push_back(box_of(shapes_.instances[i]));
  }
  return tree_of(std::move(items), boxes);
}

std::size_t TriangleReference::memory_bytes() const noexcept {
  const auto bytes = [](const Tree& tree) {
    return tree.nodes.capacity() * sizeof(Node) + tree.items.capacity() * sizeof(Item);
  };
  std::size_t sum = bytes(top_) + bytes(instances_);
  for (const Tree& group : groups_) sum += bytes(group);
  return sum;
}

/// Calls visit(item) for the items of all leaves that the ray reaches before `most`, which visit() may lower.
template <class Visit>
void TriangleReference::visit(const Tree& tree, const Ray& ray, const double& most, Visit&& visit) const {
  if (search_ == Search::linear) {
    for (const Item& item : tree.items) visit(item);
    return;
  }
  if (tree.nodes.empty()) return;
  std::uint32_t stack[64];
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t index = stack[--depth];
    const Node& node = tree.nodes[index];
    const Range range = ray.range(node.box);
    if (range.empty() || range.enter > most) continue;
    if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) visit(tree.items[i]);
      continue;
    }
    const Range left = ray.range(tree.nodes[index + 1].box), right = ray.range(tree.nodes[node.first].box);
    const bool left_first = left.enter <= right.enter;
    stack[depth++] = left_first ? node.first : index + 1;
    stack[depth++] = left_first ? index + 1 : node.first;
  }
}

/// A shape is met within its own box alone, which is where the hierarchy looks for it.
void TriangleReference::search(const BoundedShapes& shapes, const Tree& tree, const Ray& ray, const Range& within,
                               InstanceId instance, ReferenceHit& nearest) const {
  visit(tree, ray, nearest.distance, [&](const Item& item) {
    const Range range = ray.range(box_of(shapes, item));
    if (range.empty() || range.enter > nearest.distance) return;
    const Crossings crossings =
        crossings_of(shapes, item.geometry, item.primitive, ray.origin, ray.direction, ray.watertight);
    for (const double crossing : crossings.distance) {
      if (!(crossing >= 0 && crossing < std::numeric_limits<double>::infinity())) continue;
      const double distance = within.clamp(range.clamp(crossing));
      if (!is_before(distance, instance, item.geometry, item.primitive, nearest)) return;
      nearest = {item.geometry, item.primitive, kNoFace, crossings.u, crossings.v, distance, Vec3d(0), instance};
      return;
    }
  });
}

void TriangleReference::search_planes(const Ray& ray, double max_distance, ReferenceHit& nearest) const {
  for (std::size_t i = 0; i < shapes_.planes.size(); ++i) {
    const Plane& plane = shapes_.planes[i];
    const double distance = plane_crossing(plane.point, plane.normal, ray.origin, ray.direction);
    const auto primitive = static_cast<std::uint32_t>(i);
    if (distance >= 0 && distance <= max_distance && distance < std::numeric_limits<double>::infinity() &&
        is_before(distance, kNoInstance, kPlaneGeometry, primitive, nearest))
      nearest = {kPlaneGeometry, primitive, kNoFace, 0, 0, distance, plane.normal, kNoInstance};
  }
}

ReferenceHit TriangleReference::nearest(const Vec3d& origin, const Vec3d& direction, double max_distance) const {
  // kNoGeometry stands behind all geometries, so that a hit at the very end is before it.
  ReferenceHit nearest;
  nearest.distance = max_distance;
  const Ray ray(origin, direction, std::max(top_.reach, instances_.reach));
  search_planes(ray, max_distance, nearest);
  search(shapes_, top_, ray, Range(), kNoInstance, nearest);
  visit(instances_, ray, nearest.distance, [&](const Item& item) {
    const Instance& instance = shapes_.instances[item.primitive];
    const Range range = ray.range(box_of(instance));
    if (range.empty() || range.enter > nearest.distance) return;
    const InstanceTransform transform(instance);
    const Ray inside(transform.inverse_point(origin), transform.inverse_vector(direction),
                     groups_[instance.group].reach);
    search(shapes_.groups[instance.group], groups_[instance.group], inside, range, item.primitive, nearest);
  });
  if (!nearest.hit()) {
    nearest.distance = std::numeric_limits<double>::infinity();
  } else if (nearest.instance != kNoInstance) {
    const Instance& instance = shapes_.instances[nearest.instance];
    const InstanceTransform transform(instance);
    const Vec3d point = transform.inverse_point(origin + direction * nearest.distance);
    nearest.normal =
        unit(transform.normal(normal_of(shapes_.groups[instance.group], nearest.geometry, nearest.primitive, point)));
  } else if (nearest.geometry != kPlaneGeometry) {
    nearest.normal = normal_of(shapes_, nearest.geometry, nearest.primitive, origin + direction * nearest.distance);
  }
  return nearest;
}

}  // namespace raytree
