// The truth about what a fast tracer is given: its own triangles, spheres, discs, planes and cones, in double. Woop's
// watertight test for triangles, closed forms for the others; instances are entered by their single-precision matrix,
// inverted in double.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/reference_tracer.h"
#include "geometry/shape_set.h"

namespace raytree {

class TriangleReference final : public ReferenceTracer {
 public:
  enum class Search : std::uint8_t {
    hierarchy,  ///< boxes about halves of the shapes
    linear      ///< every shape by every ray: the same answers, bit for bit
  };

  /// `shapes` must outlive it.
  explicit TriangleReference(const ShapeSet& shapes, Search search = Search::hierarchy);

  /// Of two hits at one distance that of the lower instance, geometry and primitive; what stands in the scene itself
  /// comes behind all instances.
  ReferenceHit nearest(const Vec3d& origin, const Vec3d& direction, double max_distance) const override;
  std::size_t memory_bytes() const noexcept override;

 private:
  struct Box {
    Vec3d least, most;
  };
  /// Of a binary tree in depth-first order: the first child follows its parent.
  struct Node {
    Box box;
    std::uint32_t first;  ///< of a leaf's items; else the second child
    std::uint32_t count;  ///< of items; 0: no leaf
  };
  struct Item {
    GeometryId geometry;
    std::uint32_t primitive;
  };
  /// The shapes of a list, or the instances (geometry is then 0).
  struct Tree {
    std::vector<Node> nodes;
    std::vector<Item> items;
    double reach = 0;  ///< largest coordinate of all boxes
  };
  struct Range;
  class Ray;

  static Tree tree_of(std::vector<Item> items, const std::vector<Box>& boxes);
  static Tree tree_of(const BoundedShapes& shapes);
  static Box box_of(const BoundedShapes& shapes, const Item& item);
  Tree tree_of_instances() const;
  Box box_of(const Instance& instance) const;

  template <class Visit>
  void visit(const Tree& tree, const Ray& ray, const double& most, Visit&& visit) const;
  void search(const BoundedShapes& shapes, const Tree& tree, const Ray& ray, const Range& within, InstanceId instance,
              ReferenceHit& nearest) const;
  void search_planes(const Ray& ray, double max_distance, ReferenceHit& nearest) const;

  const ShapeSet& shapes_;
  const Search search_;
  Tree top_;
  std::vector<Tree> groups_;  ///< [shapes.groups.size()]
  Tree instances_;
};

}  // namespace raytree
