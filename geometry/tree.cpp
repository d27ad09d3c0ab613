// A skeleton of branches grown level by level, each a chain of points with radii; tubes about it, leaves along its last
// levels. Every number comes from a hash of the seed and the branch or leaf that it is for.
#include "geometry/tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "geometry/angle.h"
#include "geometry/error.h"
#include "geometry/surface.h"

namespace raytree {
namespace {

constexpr double kTurn = 2 * kPi;
constexpr double kGoldenAngle = 2.399963229728653;  ///< successive branches stand so far round their parent

class Random {
 public:
  Random(std::uint32_t seed, std::uint64_t key) : state_((std::uint64_t(seed) << 32) ^ (key * 0xd1342543de82ef95u)) {}
  double uniform() {
    std::uint64_t x = state_ += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return double((x ^ (x >> 31)) >> 11) * 0x1p-53;
  }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  Vec3d in_ball() {
    for (;;) {
      // One draw a statement: the order of arguments is the compiler's.
      const double z = uniform(-1, 1), y = uniform(-1, 1), x = uniform(-1, 1);
      const Vec3d v(x, y, z);
      if (v.dot(v) <= 1) return v;
    }
  }

 private:
  std::uint64_t state_;
};

struct Branch {
  std::vector<Vec3d> points;
  std::vector<double> radii;
  int sides = 3;

  /// The point at a share of the branch's length, and the way it runs there.
  Vec3d at(double share, Vec3d& along) const {
    const double place = share * double(points.size() - 1);
    const std::size_t i = std::min(std::size_t(place), points.size() - 2);
    along = unit(points[i + 1] - points[i]);
    return points[i] + (points[i + 1] - points[i]) * (place - double(i));
  }
  double radius_at(double share) const {
    const double place = share * double(points.size() - 1);
    const std::size_t i = std::min(std::size_t(place), points.size() - 2);
    return radii[i] + (radii[i + 1] - radii[i]) * (place - double(i));
  }
};

/// Unit, across `axis`, at an angle about it.
Vec3d across(const Vec3d& axis, double angle) {
  const Vec3d any = std::abs(axis.y) < 0.9 ? Vec3d(0, 1, 0) : Vec3d(1, 0, 0);
  const Vec3d u = unit(axis.cross(any)), v = axis.cross(u);
  return u * std::cos(angle) + v * std::sin(angle);
}

/// A branch from `start` that bends by `bend` (added to its direction over its length) and wavers by `waver`.
Branch grown(const TreeLevel& level, const Vec3d& start, const Vec3d& direction, double length, double radius,
             double tip, const Vec3d& bend, double waver, Random& random) {
  Branch branch;
  branch.sides = level.sides;
  Vec3d place = start, way = direction;
  for (int i = 0; i <= level.segments; ++i) {
    branch.points.push_back(place);
    branch.radii.push_back(radius + (tip - radius) * i / level.segments);
    way = unit(way + bend / level.segments + random.in_ball() * waver);
    place += way * (length / level.segments);
  }
  return branch;
}

/// Branches level by level; the last ones carry the leaves.
struct Skeleton {
  std::vector<Branch> branches;
  std::size_t first_leafy = 0;
  Vec3d crown{0, 0, 0};       ///< its middle
  Vec3d flattening{1, 1, 1};  ///< of the crown's outward directions
};

Skeleton broadleaf(const TreeParameters& parameters) {
  const double height = parameters.height;
  Skeleton skeleton;
  Random random(parameters.seed, 1);
  const double lean_z = random.uniform(-0.08, 0.08), lean_x = random.uniform(-0.08, 0.08);
  skeleton.branches.push_back(grown(kBroadleafLevels[0], {0, 0, 0}, unit(Vec3d(lean_x, 1, lean_z)), 0.82 * height,
                                    0.026 * height, 0.006 * height, {0, 0.1, 0}, 0.07, random));
  // Lengths over the parent's, angles off it, and where along it the first one stands.
  constexpr double kLength[] = {0, 0.52, 0.5, 0.42}, kAngle[] = {0, 0.95, 0.75, 0.8}, kFirst[] = {0, 0.34, 0.3, 0.25};
  std::size_t first = 0;
  for (int l = 1; l < 4; ++l) {
    const TreeLevel& level = kBroadleafLevels[l];
    const std::size_t end = skeleton.branches.size();
    const int children = level.branches / kBroadleafLevels[l - 1].branches;
    for (std::size_t p = first; p < end; ++p) {
      const Branch parent = skeleton.branches[p];
      double parent_length = 0;
      for (std::size_t i = 1; i < parent.points.size(); ++i)
        parent_length += (parent.points[i] - parent.points[i - 1]).length();
      const double turn = random.uniform(0, kTurn);
      for (int c = 0; c < children; ++c) {
        const double share = kFirst[l] + (1 - kFirst[l]) * (c + random.uniform(0.2, 0.9)) / children;
        Vec3d along;
        const Vec3d start = parent.at(std::min(share, 1.0), along);
        const double angle = kAngle[l] * random.uniform(0.75, 1.2) * (1.15 - 0.5 * share);
        const Vec3d direction =
            unit(along * std::cos(angle) + across(along, turn + kGoldenAngle * c) * std::sin(angle));
        // The lower limbs reach furthest; twigs differ little.
        const double reach = l == 1 ? 1.15 - 0.75 * (share - kFirst[1]) : 1.05 - 0.35 * share;
        const double length = kLength[l] * parent_length * reach * random.uniform(0.8, 1.15);
        const double radius = 0.7 * parent.radius_at(std::min(share, 1.0));
        skeleton.branches.push_back(
            grown(level, start, direction, length, radius, 0.3 * radius, {0, l == 1 ? 0.55 : 0.3, 0}, 0.12, random));
      }
    }
    first = end;
  }
  skeleton.first_leafy = first;
  skeleton.crown = {0, 0.55 * height, 0};
  return skeleton;
}

Skeleton conifer(const TreeParameters& parameters) {
  const double height = parameters.height;
  Skeleton skeleton;
  Random random(parameters.seed, 2);
  skeleton.branches.push_back(
      grown(kConiferLevels[0], {0, 0, 0}, {0, 1, 0}, height, 0.017 * height, 0.001 * height, {0, 0, 0}, 0.008, random));
  const Branch trunk = skeleton.branches[0];
  const TreeLevel& level = kConiferLevels[1];
  const double spread = height * random.uniform(0.19, 0.24);
  for (int b = 0; b < level.branches; ++b) {
    // Whorls of six; closer together toward the tip, as a tree's last years are short.
    const int whorl = b / 6, whorls = level.branches / 6;
    const double rise = (whorl + random.uniform(-0.25, 0.25)) / (whorls - 1);
    const double share = std::clamp(0.1 + 0.88 * std::pow(std::max(rise, 0.0), 0.85), 0.05, 0.985);
    Vec3d along;
    const Vec3d start = trunk.at(share, along);
    const double azimuth = kTurn * (b % 6) / 6 + 0.5 * whorl + random.uniform(-0.3, 0.3);
    const double lift = -0.35 + 1.15 * share * share;
    const Vec3d direction = unit(Vec3d(std::cos(azimuth), lift, std::sin(azimuth)));
    const double length = spread * std::pow(1 - share, 0.8) * random.uniform(0.75, 1.1) + 0.012 * height;
    skeleton.branches.push_back(grown(level, start, direction, length, 0.3 * trunk.radius_at(share) + 0.0008 * height,
                                      0.0006 * height, {0, 0.35 - 0.25 * share, 0}, 0.05, random));
  }
  skeleton.first_leafy = 1;
  skeleton.crown = {0, 0.35 * height, 0};
  skeleton.flattening = {1, 0.35, 1};
  return skeleton;
}

[[noreturn]] void refuse_tree(const std::string& message) {
  throw Error(ErrorKind::bad_input, {"", 0, "tree"}, message);
}

Skeleton checked_skeleton(const TreeParameters& parameters) {
  static constexpr double kLeastLength = 1e-12, kMostLength = 1e12;
  const auto check_length = [](const char* what, double length) {
    if (!(length >= kLeastLength && length <= kMostLength))
      refuse_tree(fmt::format("{} must be from {} to {}, not {}", what, kLeastLength, kMostLength, length));
  };
  check_length("height", parameters.height);
  check_length("leaf_size", parameters.leaf_size);
  if (parameters.leaves < 1 || parameters.leaves > kMostTreeLeaves)
    refuse_tree(fmt::format("leaves must be from 1 to {}, not {}", kMostTreeLeaves, parameters.leaves));
  return parameters.form == TreeForm::broadleaf ? broadleaf(parameters) : conifer(parameters);
}

void add_tube(const Branch& branch, TriangleMesh& mesh) {
  const auto first = std::uint32_t(mesh.positions.size());
  const auto sides = std::uint32_t(branch.sides);
  Vec3d u(0);
  for (std::size_t i = 0; i < branch.points.size(); ++i) {
    const std::size_t last = branch.points.size() - 1;
    const Vec3d along = unit(branch.points[std::min(i + 1, last)] - branch.points[i == last ? i - 1 : i]);
    // The frame goes along with as little twist as can be.
    u = i == 0 ? across(along, 0) : unit(u - along * u.dot(along));
    const Vec3d v = along.cross(u);
    const double radius = branch.radii[i];
    for (std::uint32_t s = 0; s < sides; ++s) {
      const double angle = kTurn * s / sides;
      const Vec3d out = u * std::cos(angle) + v * std::sin(angle);
      mesh.positions.push_back(Vec3f(branch.points[i] + out * radius));
      mesh.normals.push_back(Vec3f(out));
    }
  }
  for (std::uint32_t i = 0; i + 1 < branch.points.size(); ++i)
    for (std::uint32_t s = 0; s < sides; ++s) {
      const std::uint32_t a = first + i * sides + s, b = first + i * sides + (s + 1) % sides;
      for (const std::uint32_t corner : {a, b, b + sides, a, b + sides, a + sides}) mesh.corners.push_back(corner);
    }
}

/// A leaf along `way` (unit), its blade across `side` (unit, across the way), folded upward along its midrib.
void add_leaf(const Vec3d& base, const Vec3d& way, const Vec3d& side, double length, double width, const Vec3d& outward,
              TriangleMesh& mesh) {
  const Vec3d up = way.cross(side) * (outward.dot(way.cross(side)) < 0 ? -1 : 1);
  const Vec3d middle = base + way * (0.45 * length), fold = up * (0.25 * width);
  const auto first = std::uint32_t(mesh.positions.size());
  for (const Vec3d& point :
       {base, middle + side * (width / 2) + fold, base + way * length, middle - side * (width / 2) + fold}) {
    mesh.positions.push_back(Vec3f(point));
    mesh.normals.push_back(Vec3f(unit(up * 0.45 + outward * 0.55)));
  }
  // Counter-clockwise as seen from `up`, which is along way x side or against it.
  const bool straight = way.cross(side).dot(up) > 0;
  const std::uint32_t left = first + (straight ? 3 : 1), right = first + (straight ? 1 : 3);
  for (const std::uint32_t corner : {first, first + 2, right, first, left, first + 2}) mesh.corners.push_back(corner);
}

void reserve(TriangleMesh& mesh, std::size_t vertices, std::size_t triangles) {
  mesh.positions.reserve(vertices);
  mesh.normals.reserve(vertices);
  mesh.corners.reserve(3 * triangles);
}

}  // namespace

TriangleMesh make_tree_wood(const TreeParameters& parameters) {
  const Skeleton skeleton = checked_skeleton(parameters);
  TriangleMesh mesh;
  std::size_t vertices = 0;
  for (const Branch& branch : skeleton.branches) vertices += branch.points.size() * std::size_t(branch.sides);
  reserve(mesh, vertices, std::size_t(tree_wood_triangles(parameters.form)));
  for (const Branch& branch : skeleton.branches) add_tube(branch, mesh);
  return mesh;
}

TriangleMesh make_tree_leaves(const TreeParameters& parameters) {
  const Skeleton skeleton = checked_skeleton(parameters);
  const bool needles = parameters.form == TreeForm::conifer;
  const std::span<const Branch> leafy(skeleton.branches.begin() + std::ptrdiff_t(skeleton.first_leafy),
                                      skeleton.branches.end());
  // Leaves go to branches by their length, so that boughs at the top are no denser than long ones below.
  std::vector<double> lengths;
  double sum = 0;
  for (const Branch& branch : leafy) {
    for (std::size_t i = 1; i < branch.points.size(); ++i) sum += (branch.points[i] - branch.points[i - 1]).length();
    lengths.push_back(sum);
  }
  TriangleMesh mesh;
  const auto count = std::size_t(parameters.leaves);
  reserve(mesh, 4 * count, 2 * count);
  for (std::size_t i = 0; i < count; ++i) {
    Random random(parameters.seed, 16 + i);
    const double place = sum * (double(i) + random.uniform()) / double(count);
    const std::size_t b = std::min(
        std::size_t(std::upper_bound(lengths.begin(), lengths.end(), place) - lengths.begin()), leafy.size() - 1);
    const double begin = b == 0 ? 0 : lengths[b - 1];
    const double share = std::clamp((place - begin) / (lengths[b] - begin), 0.0, 1.0);
    Vec3d along;
    const Vec3d stem = leafy[b].at(needles ? 0.12 + 0.88 * share : share, along);
    const auto outward_from = [&](const Vec3d& point) {
      const Vec3d out = (point - skeleton.crown) * skeleton.flattening + Vec3d(0, 0.1 * parameters.height, 0);
      return unit(out);
    };
    if (needles) {
      // Sprays stand out from the bough to both sides, forward and a little down, shorter toward its tip.
      const Vec3d up(0, 1, 0), sideways = unit(along.cross(up) + random.in_ball() * 1e-6);
      const double side = i % 2 == 0 ? 1 : -1;
      const double opening = random.uniform(0.5, 1.1);
      const Vec3d waver = random.in_ball() * 0.15, droop(0, random.uniform(-0.35, 0.1), 0);
      const Vec3d way = unit(along * std::cos(opening) + sideways * (side * std::sin(opening)) + droop + waver);
      const Vec3d blade = unit(way.cross(unit(up + random.in_ball() * 0.6)));
      const double length = parameters.leaf_size * random.uniform(0.7, 1.2) * (1.15 - 0.6 * share);
      add_leaf(stem, way, blade, length, 0.38 * length, outward_from(stem), mesh);
    } else {
      const double cloud = 0.04 * parameters.height;
      const Vec3d base = stem + random.in_ball() * cloud;
      const Vec3d way = unit(along * 0.4 + random.in_ball() + Vec3d(0, -0.15, 0));
      const Vec3d blade = across(way, random.uniform(0, kTurn));
      const double length = parameters.leaf_size * random.uniform(0.7, 1.25);
      add_leaf(base, way, blade, length, 0.62 * length, outward_from(base), mesh);
    }
  }
  return mesh;
}

}  // namespace raytree
