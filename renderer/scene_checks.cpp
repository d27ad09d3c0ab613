#include "renderer/scene_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "geometry/angle.h"
#include "renderer/groups.h"
#include "renderer/material.h"
#include "renderer/suggestion.h"

namespace raytree::reading {

void check(const Place& at, std::int64_t line, const ImageDescription& image) {
  if (std::int64_t{image.width} * image.height > kMaxPixels)
    at.fail(line, std::to_string(image.width) + " x " + std::to_string(image.height) +
                      " pixels are too many: width times height is at most " + std::to_string(kMaxPixels));
}

void check(const Place& at, std::int64_t line, const CameraDescription& camera) {
  const Vec3d sight = camera.target - camera.position;
  if (sight == Vec3d(0, 0, 0)) at.fail(line, "position and target are the same point");
  // Closer than this to parallel, the directions of the picture would be rounding errors.
  constexpr double kLeastSine = 1e-9;
  const Vec3d a = sight.normalized(), b = camera.up.normalized();
  if (a.cross(b).length() < kLeastSine) at.fail(line, "up points along the line of sight; give another direction");
}

namespace {

template <std::size_t Count>
void check_indices(const Place& at, std::int64_t line, const IndexLists<Count>& lists, std::size_t positions) {
  for (std::size_t i = 0; i < lists.size(); ++i)
    for (const std::uint32_t index : lists[i])
      if (index >= positions)
        Place(at, static_cast<std::int64_t>(i))
            .fail(line, "index " + std::to_string(index) + " is out of range: there are " + std::to_string(positions) +
                            " positions, counted from 0");
}

void check_patches(const Place& at, std::int64_t line, const PatchesShape& shape) {
  const bool patches = !shape.bezier.empty() || !shape.coons.empty() || !shape.lathe.empty();
  if (!shape.file.empty()) {
    if (patches || !shape.positions.empty() || !shape.weights.empty())
      at.fail(line, "give either \"file\" or \"positions\" and patches, not both");
    return;
  }
  if (!patches || shape.positions.empty())
    at.fail(line, "patches need \"file\", or \"positions\" and one of \"bezier\", \"coons\" and \"lathe\"");
  if (!shape.weights.empty() && shape.weights.size() != shape.positions.size())
    Place(at, "weights")
        .fail(line, std::to_string(shape.weights.size()) + " for " + std::to_string(shape.positions.size()) +
                        " positions; give one a position");
  check_indices(Place(at, "bezier"), line, shape.bezier, shape.positions.size());
  check_indices(Place(at, "coons"), line, shape.coons, shape.positions.size());
  check_indices(Place(at, "lathe"), line, shape.lathe, shape.positions.size());
  for (std::size_t i = 0; i < shape.lathe.size(); ++i)
    for (const std::uint32_t index : shape.lathe[i])
      if (shape.positions[index].x < 0)
        Place(Place(at, "lathe"), static_cast<std::int64_t>(i)).fail(line, "a radius must not be negative");
}

}  // namespace

void check(const Place& at, std::int64_t line, const ShapeDescription& shape) {
  if (const auto* patches = std::get_if<PatchesShape>(&shape.kind)) check_patches(at, line, *patches);
  const auto* scatter = std::get_if<ScatterShape>(&shape.kind);
  if (scatter == nullptr) return;
  if (scatter->least_scale > scatter->largest_scale) at.fail(line, "least_scale is larger than largest_scale");
  if (scatter->lowest > scatter->highest) at.fail(line, "lowest lies above highest");
}

void check(const Place& at, std::int64_t line, const MaterialDescription& material) {
  if (const std::string problem = material_problem(material); !problem.empty()) at.fail(line, problem);
}

void check_references(const Place& root, const SceneDescription& scene) {
  std::unordered_map<std::string_view, bool> known;
  for (const MaterialDescription& material : scene.materials) known.emplace(material.name, true);
  const auto check_materials = [&](const Place& shapes, const std::vector<ShapeDescription>& list) {
    for (const ShapeDescription& shape : list) {
      if (shape.material.empty() || known.contains(shape.material)) continue;
      Place(shapes, shape.name)
          .fail(shape.where.line,
                "unknown material " + in_quotes(shape.material) + "; " +
                    choices_text("materials of this scene", shape.material, names_of(scene.materials)));
    }
  };
  const Place shapes(root, "shapes"), groups(root, "groups");
  check_materials(shapes, scene.shapes);
  for (const GroupDescription& group : scene.groups) {
    const Place at(groups, group.name);
    check_materials(Place(at, "shapes"), group.shapes);
  }
  check_groups(scene, [&](const GroupDescription* group, const ShapeDescription& shape, const std::string& message) {
    if (group == nullptr) Place(shapes, shape.name).fail(shape.where.line, message);
    const Place at(groups, group->name), inside(at, "shapes");
    Place(inside, shape.name).fail(shape.where.line, message);
  });
}

namespace {

/// Sine and cosine of an angle in degrees, exact at multiples of 90.
std::pair<double, double> sine_and_cosine(double degrees) {
  const double within = std::remainder(degrees, 360.0);  // exact
  if (within == 0) return {0, 1};
  if (within == 90) return {1, 0};
  if (within == -90) return {-1, 0};
  if (std::abs(within) == 180) return {0, -1};
  const double radians = within * kDegree;
  return {std::sin(radians), std::cos(radians)};
}

}  // namespace

Matrix44d matrix_of(const TransformStep& step) {
  if (step.matrix) return *step.matrix;
  Matrix44d m;
  if (step.scale)
    for (int i = 0; i < 3; ++i) m[i][i] = step.scale->value[i];
  if (step.rotate) {
    const auto [sx, cx] = sine_and_cosine(step.rotate->x);
    const auto [sy, cy] = sine_and_cosine(step.rotate->y);
    const auto [sz, cz] = sine_and_cosine(step.rotate->z);
    m = m * Matrix44d(1, 0, 0, 0, 0, cx, sx, 0, 0, -sx, cx, 0, 0, 0, 0, 1) *
        Matrix44d(cy, 0, -sy, 0, 0, 1, 0, 0, sy, 0, cy, 0, 0, 0, 0, 1) *
        Matrix44d(cz, sz, 0, 0, -sz, cz, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
  }
  if (step.translate)
    for (int i = 0; i < 3; ++i) m[3][i] = (*step.translate)[i];
  return m;
}

bool invertible(const Matrix44d& m) {
  constexpr double kLeastVolume = 1e-12;  // of the axes made unit; float has 7 digits, double 16
  std::array<Vec3d, 3> axes;
  for (int i = 0; i < 3; ++i) {
    Vec3d axis(m[i][0], m[i][1], m[i][2]);
    const double largest = std::max({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)});
    if (!(largest > 0) || !std::isfinite(largest)) return false;
    axes[static_cast<std::size_t>(i)] = (axis / largest).normalized();
  }
  return std::abs(axes[0].dot(axes[1].cross(axes[2]))) > kLeastVolume;
}

}  // namespace raytree::reading
