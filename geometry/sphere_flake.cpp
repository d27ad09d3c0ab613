// The recursion of the sphere-flake, laid out flat: a subtree of known size per child lets every subtree be written
// in place and in parallel.
#include "geometry/sphere_flake.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <limits>

#include "geometry/angle.h"
#include "geometry/error.h"

namespace raytree {
namespace {

constexpr int kChildren = 9;
constexpr double kScale = 1.0 / 3.0;  ///< child radius over parent radius

/// Unit directions of the nine children about the axis +z, in the order of SPD's program.
std::array<Vec3d, kChildren> child_directions() {
  const double sine = std::sqrt(2.0 / 3.0), cosine = std::sqrt(1.0 / 3.0);
  std::array<Vec3d, kChildren> directions;
  for (int turn = 0; turn < 3; ++turn) {
    const double azimuth = 120.0 * turn;
    const double upper = (azimuth + 45) * kDegree, first = (azimuth + 15) * kDegree, second = (azimuth + 75) * kDegree;
    directions[3 * turn] = Vec3d(cosine * std::cos(upper), cosine * std::sin(upper), sine);
    directions[3 * turn + 1] = Vec3d(std::cos(first), std::sin(first), 0);
    directions[3 * turn + 2] = Vec3d(std::cos(second), std::sin(second), 0);
  }
  return directions;
}

/// `local` turned by the shortest rotation that takes +z onto the unit vector `axis`. Near the poles, where that
/// rotation is ill-defined (-z) or next to nothing (+z), SPD's program takes half a turn about y and none at all; its
/// threshold shows in its output, of which 54 spheres of level 6 differ with one half or twice as large.
Vec3d turned(const Vec3d& local, const Vec3d& axis) {
  constexpr double kPole = 1e-4;  // of 1 - |cos| of the angle from the pole, 0.81 degrees
  const double above = 1 + axis.z;
  if (above < kPole) return {-local.x, local.y, -local.z};
  if (axis.z > 1 - kPole) return local;
  const double shared = (local.x * axis.x + local.y * axis.y) / above;
  return {local.x - axis.x * shared + axis.x * local.z, local.y - axis.y * shared + axis.y * local.z,
          axis.z * local.z - (local.x * axis.x + local.y * axis.y)};
}

class Flake {
 public:
  Flake(SphereArrays& spheres, double radius) : spheres_(spheres), root_radius_(radius) {}

  /// Writes a sphere at `index` and all that it carries behind it. center in radii of the root, axis +z up.
  void write(std::size_t index, int levels, const Vec3d& center, const Vec3d& axis, double radius) const {
    const Vec3d place = center * root_radius_;
    spheres_.centers[index] = Vec3f(float(place.x), float(place.z), float(-place.y));
    spheres_.radii[index] = float(radius * root_radius_);
    if (levels == 0) return;
    const auto subtree = std::size_t(sphere_flake_count(levels - 1));
    const auto write_child = [&](int child) {
      const Vec3d direction = turned(directions_[std::size_t(child)], axis).normalized();
      write(index + 1 + std::size_t(child) * subtree, levels - 1, center + direction * (radius * (1 + kScale)),
            direction, radius * kScale);
    };
    if (levels >= kParallelLevels)
      tbb::parallel_for(0, kChildren, write_child);
    else
      for (int child = 0; child < kChildren; ++child) write_child(child);
  }

 private:
  static constexpr int kParallelLevels = 5;  ///< a task is at least a subtree of 7381 spheres

  SphereArrays& spheres_;
  double root_radius_;
  std::array<Vec3d, kChildren> directions_ = child_directions();
};

[[noreturn]] void refuse(const std::string& message) {
  throw Error(ErrorKind::bad_input, {"", 0, "sphere-flake"}, message);
}

void check(const SphereFlakeParameters& parameters) {
  if (parameters.levels < 0 || parameters.levels > kLargestSphereFlakeLevel)
    refuse(fmt::format("levels must be from 0 to {}, not {}", kLargestSphereFlakeLevel, parameters.levels));
  if (!(parameters.radius > 0) || !std::isfinite(parameters.radius))
    refuse(fmt::format("radius must be positive and finite, not {}", parameters.radius));
  if (!std::isfinite(parameters.center.x) || !std::isfinite(parameters.center.y) || !std::isfinite(parameters.center.z))
    refuse("center must be finite");
  const double smallest = parameters.radius * std::pow(kScale, parameters.levels);
  if (smallest < std::numeric_limits<float>::min() ||
      sphere_flake_bounding_radius(parameters) > std::numeric_limits<float>::max())
    refuse(fmt::format("radius {} with {} levels does not fit single precision", parameters.radius, parameters.levels));
}

}  // namespace

std::int64_t sphere_flake_count(int levels) {
  std::int64_t count = 1;
  for (int level = 0; level < levels; ++level) count = kChildren * count + 1;
  return count;
}

double sphere_flake_bounding_radius(const SphereFlakeParameters& parameters) {
  return parameters.radius * (2 - std::pow(kScale, parameters.levels));
}

SphereArrays make_sphere_flake(const SphereFlakeParameters& parameters) {
  check(parameters);
  SphereArrays spheres;
  spheres.origin = parameters.center;
  const auto count = std::size_t(sphere_flake_count(parameters.levels));
  spheres.centers.resize(count);
  spheres.radii.resize(count);
  Flake(spheres, parameters.radius).write(0, parameters.levels, Vec3d(0), Vec3d(0, 0, 1), 1);
  return spheres;
}

}  // namespace raytree
