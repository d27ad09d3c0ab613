#include "geometry/sphere_hierarchy.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace raytree {
namespace {

constexpr std::uint32_t kLeafObjects = 2;
/// Places at which a division is tried along each axis.
constexpr std::size_t kBins = 16;
/// From this level on lists are halved, whatever it costs: 2^32 objects then end within 64 + 32 levels.
constexpr std::size_t kMostCostedLevels = 62;

/// The chance that a ray meets a sphere about the box goes with its radius squared.
double cost(const Bounds3d& box, std::size_t count) {
  return box.isEmpty() ? 0 : box.size().length2() * static_cast<double>(count);
}

}  // namespace

void SphereHierarchy::build(std::span<const BoundingSphere> spheres) {
  nodes_.clear();
  order_.resize(spheres.size());
  std::iota(order_.begin(), order_.end(), 0u);
  if (spheres.empty()) return;
  std::vector<Bounds3d> boxes;
  boxes.reserve(spheres.size());
  for (const BoundingSphere& sphere : spheres)
    boxes.emplace_back(sphere.center - Vec3d(sphere.radius), sphere.center + Vec3d(sphere.radius));
  nodes_.reserve(spheres.size());
  nodes_.push_back({});
  split(spheres, boxes, 0, 0, static_cast<std::uint32_t>(spheres.size()), 0);
  nodes_.shrink_to_fit();
}

/// Makes `node` of order_[first, first + count): divided where the two parts' squared radii, times what they hold, add
/// up to least.
void SphereHierarchy::split(std::span<const BoundingSphere> spheres, std::vector<Bounds3d>& boxes, std::uint32_t node,
                            std::uint32_t first, std::uint32_t count, std::size_t level) {
  Bounds3d box, centers;
  for (std::uint32_t i = first; i < first + count; ++i) {
    box.extendBy(boxes[order_[i]]);
    centers.extendBy(spheres[order_[i]].center);
  }
  BoundingSphere about{box.center(), 0};
  for (std::uint32_t i = first; i < first + count; ++i) {
    const BoundingSphere& sphere = spheres[order_[i]];
    about.radius = std::max(about.radius, (sphere.center - about.center).length() + sphere.radius);
  }
  about.radius *= 1 + kSphereSlack;
  nodes_[node] = {about, first, count};
  if (count <= kLeafObjects) return;

  int best_axis = -1;
  std::size_t best_bin = 0;
  double best_cost = std::numeric_limits<double>::infinity();
  const auto bin_of = [&](std::uint32_t object, int axis) {
    const double extent = centers.max[axis] - centers.min[axis];
    const double place = (spheres[object].center[axis] - centers.min[axis]) / extent * double(kBins);
    return std::min(static_cast<std::size_t>(place), kBins - 1);
  };
  for (int axis = 0; axis < 3 && level < kMostCostedLevels; ++axis) {
    if (!(centers.max[axis] > centers.min[axis])) continue;
    std::array<Bounds3d, kBins> bins;
    std::array<std::size_t, kBins> counts{};
    for (std::uint32_t i = first; i < first + count; ++i) {
      const std::size_t bin = bin_of(order_[i], axis);
      bins[bin].extendBy(boxes[order_[i]]);
      ++counts[bin];
    }
    std::array<double, kBins> below;
    Bounds3d part;
    std::size_t held = 0;
    for (std::size_t bin = 0; bin + 1 < kBins; ++bin) {
      part.extendBy(bins[bin]);
      below[bin] = cost(part, held += counts[bin]);
    }
    part.makeEmpty();
    held = 0;
    for (std::size_t bin = kBins - 1; bin > 0; --bin) {
      part.extendBy(bins[bin]);
      const double sum = below[bin - 1] + cost(part, held += counts[bin]);
      if (sum < best_cost && held < count) best_cost = sum, best_axis = axis, best_bin = bin;
    }
  }
  const auto begin = order_.begin() + first, end = begin + count;
  auto middle = begin + count / 2;
  if (best_axis >= 0)
    middle = std::partition(begin, end, [&](std::uint32_t object) { return bin_of(object, best_axis) < best_bin; });
  const auto part = static_cast<std::uint32_t>(middle - begin);
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = children, nodes_[node].count = 0;
  split(spheres, boxes, children, first, part, level + 1);
  split(spheres, boxes, children + 1, first + part, count - part, level + 1);
}

}  // namespace raytree
