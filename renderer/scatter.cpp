#include "renderer/scatter.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "geometry/angle.h"

namespace raytree {
namespace {

constexpr std::int64_t kTries = 16;  ///< for each use

std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Number `which` of the random numbers that belong to `key`, in [0, 1).
double random(std::uint64_t key, std::uint64_t which) {
  return static_cast<double>(mixed(key * 0x9e3779b97f4a7c15u + which * 0xd1342543de82ef95u + 1) >> 11) * 0x1p-53;
}

double smooth(double t) { return t * t * (3 - 2 * t); }

/// Value noise with cells of edge 1: smooth, in [0, 1), about evenly spread over the middle of its range.
double noise(std::uint64_t seed, double x, double z) {
  const double column = std::floor(x), row = std::floor(z);
  const auto corner = [&](double i, double k) {
    const auto a = static_cast<std::uint64_t>(static_cast<std::int64_t>(column + i));
    const auto b = static_cast<std::uint64_t>(static_cast<std::int64_t>(row + k));
    return random(seed ^ mixed(a * 0x8cb92ba72f3d8dd7u + b), 7);
  };
  const double u = smooth(x - column), v = smooth(z - row);
  const double near = corner(0, 0) * (1 - u) + corner(1, 0) * u, far = corner(0, 1) * (1 - u) + corner(1, 1) * u;
  return near * (1 - v) + far * v;
}

/// Two octaves, so that patches have ragged edges.
double patchiness(std::uint64_t seed, double x, double z) {
  return (2 * noise(seed, x, z) + noise(seed + 1, 2.7 * x, 2.7 * z)) / 3;
}

/// A point of the terrain and its upward normal, from the place on its grid, both in [0, 1).
struct Ground {
  Vec3d point, normal;
};
Ground ground_at(const TriangleMesh& terrain, const TerrainGrid& grid, double u, double v) {
  const double x = u * static_cast<double>(grid.columns), z = v * static_cast<double>(grid.rows);
  const auto column = std::min(static_cast<std::int64_t>(x), grid.columns - 1);
  const auto row = std::min(static_cast<std::int64_t>(z), grid.rows - 1);
  const double fx = x - static_cast<double>(column), fz = z - static_cast<double>(row);
  const auto cell = static_cast<std::size_t>(row * grid.columns + column);
  const auto stride = static_cast<std::uint32_t>(grid.columns + 1);
  const auto first = static_cast<std::uint32_t>(row) * stride + static_cast<std::uint32_t>(column);
  const auto position = [&](std::uint32_t index) { return terrain.origin + Vec3d(terrain.positions[index]); };
  // The cell's corners a b / c d; it is split along a d or along b c, whichever its first triangle holds.
  const std::uint32_t a = first, b = first + 1, c = first + stride, d = c + 1;
  const std::uint32_t* corner = &terrain.corners[6 * cell];
  const bool along_ad = corner[0] != b && corner[1] != b && corner[2] != b;
  Vec3d p, along_x, along_z;
  if (along_ad) {
    const bool upper = fx >= fz;  // a b d, else a c d
    along_x = upper ? position(b) - position(a) : position(d) - position(c);
    along_z = upper ? position(d) - position(b) : position(c) - position(a);
    p = position(a) + along_x * fx + along_z * fz;
  } else {
    const bool upper = fx + fz <= 1;  // a b c, else b c d
    along_x = upper ? position(b) - position(a) : position(d) - position(c);
    along_z = upper ? position(c) - position(a) : position(d) - position(b);
    p = upper ? position(a) + along_x * fx + along_z * fz : position(d) - along_x * (1 - fx) - along_z * (1 - fz);
  }
  Vec3d normal = along_z.cross(along_x);
  if (normal.y < 0) normal = -normal;
  return {p, normal.normalized()};
}

}  // namespace

std::vector<Matrix44d> scattered(const ScatterShape& scatter, const TriangleMesh& terrain, const TerrainGrid& grid) {
  std::vector<Matrix44d> uses;
  const std::uint64_t seed = mixed(scatter.seed + 0x632be59bd9b4e019u);
  const double least_cosine = std::cos(scatter.steepest * kDegree);
  // Powers of the inverse of the plastic number, the root of x^3 = x + 1.
  constexpr double kStepU = 0.7548776662466927, kStepV = 0.5698402909980532;
  // Half the edge of a place's share of the square.
  const double shake = 0.5 / std::sqrt(static_cast<double>(std::max<std::int64_t>(scatter.count, 1)));
  const auto within = [](double x) { return x - std::floor(x); };
  for (std::int64_t i = 0; i < kTries * scatter.count; ++i) {
    if (static_cast<std::int64_t>(uses.size()) >= scatter.count) break;
    const std::uint64_t key = seed + static_cast<std::uint64_t>(i);
    const double number = static_cast<double>(i) + random(seed, 0) * 1e4;
    const double u = within(number * kStepU + (random(key, 1) - 0.5) * shake);
    const double v = within(number * kStepV + (random(key, 2) - 0.5) * shake);
    const Ground ground = ground_at(terrain, grid, u, v);
    if (ground.normal.y < least_cosine || ground.point.y < scatter.lowest || ground.point.y > scatter.highest) continue;
    if (scatter.clearings > 0) {
      const double patch =
          patchiness(seed, ground.point.x / scatter.clearing_size, ground.point.z / scatter.clearing_size);
      // The middle two thirds of the noise's range hold nearly all of it; borders are loose over a tenth.
      const double share = (patch - 1.0 / 6) * 1.5 + (random(key, 3) - 0.5) * 0.1;
      if (share < scatter.clearings || scatter.clearings >= 1) continue;
    }
    const double scale = scatter.least_scale + (scatter.largest_scale - scatter.least_scale) * random(key, 4);
    const double turn = 2 * kPi * random(key, 5);
    const double sine = scale * std::sin(turn), cosine = scale * std::cos(turn);
    const Vec3d& p = ground.point;
    uses.push_back(
        Matrix44d(cosine, 0, -sine, 0, 0, scale, 0, 0, sine, 0, cosine, 0, p.x, p.y - scatter.sink * scale, p.z, 1));
  }
  return uses;
}

}  // namespace raytree
