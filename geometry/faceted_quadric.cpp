#include "geometry/faceted_quadric.h"

#include <cmath>
#include <initializer_list>

#include "geometry/angle.h"

namespace raytree {
namespace {

/// Directions across an axis: toward `first` at angle 0, to `second` at a right angle, counter-clockwise about the
/// axis.
struct AcrossAxis {
  explicit AcrossAxis(const Vec3d& axis) {
    // Which reference it is does not depend on the axis's sign, nor does `first`.
    const Vec3d reference = std::abs(axis.x) < 0.9 ? Vec3d(1, 0, 0) : Vec3d(0, 0, 1);
    first = (reference - axis * reference.dot(axis)).normalized();
    second = axis.cross(first);
  }
  Vec3d at(int side, int sides) const {
    const double angle = 2 * kPi * side / sides;
    return first * std::cos(angle) + second * std::sin(angle);
  }
  Vec3d first, second;
};

std::uint32_t count_of(const Buffer<Vec3f>& array) { return static_cast<std::uint32_t>(array.size()); }

void add_face(PolygonMesh& mesh, std::initializer_list<std::uint32_t> corners,
              std::initializer_list<std::uint32_t> normals) {
  mesh.face_sizes.push_back(static_cast<std::uint32_t>(corners.size()));
  mesh.corners.insert(mesh.corners.end(), corners.begin(), corners.end());
  mesh.normal_corners.insert(mesh.normal_corners.end(), normals.begin(), normals.end());
}

}  // namespace

PolygonMesh faceted_sphere(const Vec3d& center, double radius, int sides, int stacks) {
  PolygonMesh mesh;
  mesh.origin = center;
  const auto add = [&](const Vec3d& direction) {
    mesh.positions.push_back(Vec3f(direction * radius));
    mesh.normals.push_back(Vec3f(direction));
  };
  add({0, 1, 0});
  for (int ring = 1; ring < stacks; ++ring)
    for (int side = 0; side < sides; ++side) {
      const double polar = kPi * ring / stacks, around = 2 * kPi * side / sides;
      add({std::sin(polar) * std::sin(around), std::cos(polar), std::sin(polar) * std::cos(around)});
    }
  add({0, -1, 0});
  const std::uint32_t south = count_of(mesh.positions) - 1;
  const auto at = [&](int ring, int side) { return static_cast<std::uint32_t>(1 + (ring - 1) * sides + side % sides); };
  const auto face = [&](std::initializer_list<std::uint32_t> corners) { add_face(mesh, corners, corners); };
  for (int side = 0; side < sides; ++side) face({0, at(1, side), at(1, side + 1)});
  for (int ring = 1; ring + 1 < stacks; ++ring)
    for (int side = 0; side < sides; ++side)
      face({at(ring, side), at(ring + 1, side), at(ring + 1, side + 1), at(ring, side + 1)});
  for (int side = 0; side < sides; ++side) face({south, at(stacks - 1, side + 1), at(stacks - 1, side)});
  mesh.normal_corners = {};
  return mesh;
}

PolygonMesh faceted_cone(const Cone& cone, int sides, int stacks) {
  PolygonMesh mesh;
  mesh.origin = cone.base;
  const ConeFrame frame(cone);
  const AcrossAxis across(frame.axis);
  const auto normal_of = [&](const Vec3d& outward) { return Vec3f((outward - frame.axis * frame.slope).normalized()); };
  for (int ring = 0; ring <= stacks; ++ring) {
    const double share = double(ring) / stacks;
    const double radius = cone.base_radius + (cone.apex_radius - cone.base_radius) * share;
    for (int side = 0; side < sides; ++side) {
      const Vec3d outward = across.at(side, sides);
      mesh.positions.push_back(Vec3f(frame.axis * (frame.length * share) + outward * radius));
      mesh.normals.push_back(normal_of(outward));
    }
  }
  // The ends that are a point: their ring's first vertex stands for all, with a normal for each side.
  const std::uint32_t middle_normals = count_of(mesh.normals);
  if (cone.base_radius == 0 || cone.apex_radius == 0)
    for (int side = 0; side < sides; ++side) mesh.normals.push_back(normal_of(across.at(2 * side + 1, 2 * sides)));
  const auto at = [&](int ring, int side) { return static_cast<std::uint32_t>(ring * sides + side % sides); };
  for (int ring = 0; ring < stacks; ++ring)
    for (int side = 0; side < sides; ++side) {
      const std::uint32_t a = at(ring, side), b = at(ring, side + 1), c = at(ring + 1, side + 1),
                          d = at(ring + 1, side);
      const std::uint32_t tip_normal = middle_normals + static_cast<std::uint32_t>(side);
      if (ring == 0 && cone.base_radius == 0)
        add_face(mesh, {0, c, d}, {tip_normal, c, d});
      else if (ring + 1 == stacks && cone.apex_radius == 0)
        add_face(mesh, {a, b, at(stacks, 0)}, {a, b, tip_normal});
      else
        add_face(mesh, {a, b, c, d}, {a, b, c, d});
    }
  return mesh;
}

PolygonMesh faceted_disc(const Vec3d& center, const Vec3d& normal, double radius, int sides) {
  PolygonMesh mesh;
  mesh.origin = center;
  const Vec3d axis = normal.normalized();
  const AcrossAxis across(axis);
  mesh.face_sizes.push_back(static_cast<std::uint32_t>(sides));
  for (int side = 0; side < sides; ++side) {
    mesh.positions.push_back(Vec3f(across.at(side, sides) * radius));
    mesh.normals.push_back(Vec3f(axis));
    mesh.corners.push_back(static_cast<std::uint32_t>(side));
  }
  return mesh;
}

}  // namespace raytree
