// Trees without any file: trunk and branches as tapered tubes, leaves or sprays of needles as folded rhombs. Wood and
// leaves are meshes of their own, since they take different materials; the two of equal parameters fit.
#pragma once

#include <cstdint>

#include "geometry/triangle_mesh.h"

namespace raytree {

enum class TreeForm {
  broadleaf,  ///< a forked crown: a trunk, limbs, branches, twigs
  conifer     ///< a straight trunk with whorls of drooping boughs
};

inline constexpr std::int64_t kMostTreeLeaves = 10'000'000;

struct TreeParameters {
  TreeForm form = TreeForm::broadleaf;
  double height = 10;          ///< of the trunk's tip, scene units, > 0; the foot stands on the origin, +y is up
  std::int64_t leaves = 8000;  ///< in [1, kMostTreeLeaves]
  double leaf_size = 0.3;      ///< length of a leaf, about, > 0
  std::uint32_t seed = 1980;
};

/// Branches of one level: how many there are in a tree, and what tube each is.
struct TreeLevel {
  int branches, segments, sides;
};
inline constexpr TreeLevel kBroadleafLevels[] = {{1, 8, 10}, {8, 6, 7}, {40, 4, 5}, {200, 3, 4}};
inline constexpr TreeLevel kConiferLevels[] = {{1, 12, 9}, {96, 5, 4}};

/// Two triangles for each side of each segment of each branch: 7232 and 4056.
constexpr std::int64_t tree_wood_triangles(TreeForm form) {
  std::int64_t sum = 0;
  const auto add = [&](const TreeLevel& level) {
    sum += std::int64_t(2) * level.branches * level.segments * level.sides;
  };
  if (form == TreeForm::broadleaf)
    for (const TreeLevel& level : kBroadleafLevels) add(level);
  else
    for (const TreeLevel& level : kConiferLevels) add(level);
  return sum;
}
constexpr std::int64_t tree_leaf_triangles(std::int64_t leaves) { return 2 * leaves; }

/// Tubes are open at both ends, normals smooth and outward.
/// Both throw Error (bad_input) for parameters out of range. Results depend on the parameters alone.
TriangleMesh make_tree_wood(const TreeParameters& parameters);
/// Leaf i is triangles 2 i and 2 i + 1. Their normals lean away from the middle of the crown, which shades it as a
/// whole: light finds a crown's lit side though its leaves point everywhere. Faces are wound to agree.
TriangleMesh make_tree_leaves(const TreeParameters& parameters);

}  // namespace raytree
