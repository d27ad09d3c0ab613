// A search among bounding spheres for those that a ray pierces: one after the other as in Whitted 1980, or through a
// hierarchy of spheres (Clark 1976). Both find the same.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geometry/bounding_sphere.h"

namespace raytree {

/// Knows the objects by their spheres and numbers alone.
class SphereHierarchy {
 public:
  /// Over spheres[0, size), which are not kept: search() is given them again.
  void build(std::span<const BoundingSphere> spheres);

  bool built() const { return !nodes_.empty(); }
  std::size_t memory_bytes() const {
    return nodes_.capacity() * sizeof(Node) + order_.capacity() * sizeof(std::uint32_t);
  }
  /// Held by build() beside that.
  static std::size_t build_bytes(std::size_t objects) { return objects * sizeof(Bounds3d); }

  /// Calls visit(object, interval) for the objects whose spheres the ray pierces between 0 and `limit`, interval being
  /// where it lies in the sphere, until visit returns true: then so does search. visit may lower `limit` as it finds
  /// hits; a sphere that begins at `limit` itself is visited, so that of equal hits all are found whatever the order.
  template <class Visit>
  bool search(std::span<const BoundingSphere> spheres, const SphereRay& ray, const double& limit,
              const Visit& visit) const {
    const auto test = [&](std::uint32_t object) {
      const RayInterval interval = spheres[object].inside(ray);
      return !interval.empty() && interval.leave >= 0 && interval.enter <= limit && visit(object, interval);
    };
    if (!built()) {
      for (std::uint32_t object = 0; object < spheres.size(); ++object)
        if (test(object)) return true;
      return false;
    }
    // Each level leaves one node behind.
    std::array<Waiting, kMostLevels> stack;
    std::size_t waiting = 0;
    stack[waiting++] = {0, -std::numeric_limits<double>::infinity()};
    while (waiting > 0) {
      const Waiting next = stack[--waiting];
      if (next.enter > limit) continue;
      const Node& node = nodes_[next.node];
      if (node.count > 0) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
          if (test(order_[i])) return true;
        continue;
      }
      // The farther child waits.
      std::array<RayInterval, 2> parts{nodes_[node.first].sphere.inside(ray),
                                       nodes_[node.first + 1].sphere.inside(ray)};
      const std::uint32_t near = parts[1].enter < parts[0].enter ? 1 : 0;
      for (const std::uint32_t child : {1 - near, near}) {
        const RayInterval& part = parts[child];
        if (!part.empty() && part.leave >= 0 && part.enter <= limit)
          stack[waiting++] = {node.first + child, part.enter};
      }
    }
    return false;
  }

 private:
  struct Node {
    BoundingSphere sphere;
    std::uint32_t first;  ///< of the two children, which stand side by side, or of a leaf's objects in order_
    std::uint32_t count;  ///< objects of a leaf; 0: not a leaf
  };
  struct Waiting {
    std::uint32_t node;
    double enter;
  };
  static constexpr std::size_t kMostLevels = 96;

  void split(std::span<const BoundingSphere> spheres, std::vector<Bounds3d>& boxes, std::uint32_t node,
             std::uint32_t first, std::uint32_t count, std::size_t level);

  std::vector<Node> nodes_;           ///< empty: not built
  std::vector<std::uint32_t> order_;  ///< objects, those of a leaf side by side
};

}  // namespace raytree
