#include "renderer/inline_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace raytree {
namespace {

// A float at distance d from 0 is off by d 2^-25 at most. Where d is within twice the range, moving the origin to the
// middle gains two bits at most and is left undone, so that ordinary models keep origin 0.
double chosen_origin(double low, double high) {
  const double distance = std::max(std::abs(low), std::abs(high));
  return distance > 2 * (high - low) ? low + (high - low) / 2 : 0;
}

Vec3d chosen_origin(const std::vector<Vec3d>& positions) {
  if (positions.empty()) return {0, 0, 0};
  Bounds3d box;
  for (const Vec3d& p : positions) box.extendBy(p);
  return {chosen_origin(box.min.x, box.max.x), chosen_origin(box.min.y, box.max.y),
          chosen_origin(box.min.z, box.max.z)};
}

FaceLists face_lists(const PolygonMesh& mesh, const Buffer<std::uint32_t>& corners) {
  FaceLists faces;
  if (corners.empty()) return faces;
  if (mesh.all_triangles())
    faces.sizes.assign(mesh.face_count(), 3);
  else
    faces.sizes.assign(mesh.face_sizes.begin(), mesh.face_sizes.end());
  faces.corners.assign(corners.begin(), corners.end());
  return faces;
}

}  // namespace

std::shared_ptr<PolygonMesh> polygon_mesh(
    const InlineMesh& lists, const std::function<void(const std::string& key, std::int64_t index, std::int64_t line,
                                                      const std::string& message)>& refuse) {
  const auto check_indices = [&](const std::string& key, const FaceLists& faces, const std::string& target,
                                 std::size_t count) {
    std::size_t corner = 0;
    for (std::size_t face = 0; face < faces.sizes.size(); ++face)
      for (std::uint32_t i = 0; i < faces.sizes[face]; ++i, ++corner)
        if (faces.corners[corner] >= count)
          refuse(key, static_cast<std::int64_t>(face), face < faces.lines.size() ? faces.lines[face] : 0,
                 "index " + std::to_string(faces.corners[corner]) + " is out of range: there are " +
                     std::to_string(count) + " " + target + ", counted from 0");
  };
  const auto check_attribute = [&](const std::string& list_key, std::size_t count, const std::string& face_key,
                                   const FaceLists& faces) {
    if (faces.sizes.empty()) {
      if (count > 0 && count != lists.positions.size())
        refuse(list_key, -1, 0,
               std::to_string(count) + " for " + std::to_string(lists.positions.size()) +
                   " positions; give one a position, or \"" + face_key + "\"");
      return;
    }
    check_indices(face_key, faces, list_key, count);
    if (faces.sizes != lists.faces.sizes) refuse(face_key, -1, 0, "not in the shape of \"faces\"");
  };

  constexpr std::size_t kMostIndices = 0xFFFFFFFF;
  if (lists.positions.empty()) refuse("positions", -1, 0, "a mesh needs at least one position");
  if (lists.faces.sizes.empty()) refuse("faces", -1, 0, "a mesh needs at least one face");
  if (lists.positions.size() > kMostIndices) refuse("positions", -1, 0, "more than 2^32 - 1 positions");
  check_indices("faces", lists.faces, "positions", lists.positions.size());
  check_attribute("vertex_normals", lists.vertex_normals.size(), "normal_faces", lists.normal_faces);
  check_attribute("texture_coordinates", lists.texture_coordinates.size(), "texture_faces", lists.texture_faces);
  std::uint64_t grouped = 0;
  for (std::size_t i = 0; i < lists.groups.size(); ++i) {
    const FaceGroup& group = lists.groups[i];
    const std::uint64_t end = std::uint64_t{group.first_face} + group.face_count;
    if (group.first_face < grouped || end > lists.faces.sizes.size())
      refuse("groups", static_cast<std::int64_t>(i), 0,
             "faces " + std::to_string(group.first_face) + " to " + std::to_string(end) +
                 " (excluded) overlap the group before or end past the " + std::to_string(lists.faces.sizes.size()) +
                 " faces");
    grouped = end;
  }

  auto mesh = std::make_shared<PolygonMesh>();
  mesh->origin = lists.origin ? *lists.origin : chosen_origin(lists.positions);
  // A given origin is part of the positions' meaning; a chosen one must be taken off them.
  const Vec3d taken_off = lists.origin ? Vec3d(0, 0, 0) : mesh->origin;
  mesh->positions.reserve(lists.positions.size());
  for (const Vec3d& p : lists.positions) mesh->positions.push_back(Vec3f(p - taken_off));
  if (std::any_of(lists.faces.sizes.begin(), lists.faces.sizes.end(), [](std::uint32_t size) { return size != 3; }))
    mesh->face_sizes.assign(lists.faces.sizes.begin(), lists.faces.sizes.end());
  mesh->corners.assign(lists.faces.corners.begin(), lists.faces.corners.end());
  mesh->normals.assign(lists.vertex_normals.begin(), lists.vertex_normals.end());
  mesh->normal_corners.assign(lists.normal_faces.corners.begin(), lists.normal_faces.corners.end());
  mesh->texture_coordinates.assign(lists.texture_coordinates.begin(), lists.texture_coordinates.end());
  mesh->texture_corners.assign(lists.texture_faces.corners.begin(), lists.texture_faces.corners.end());
  mesh->groups = lists.groups;
  return mesh;
}

InlineMesh inline_mesh(const PolygonMesh& mesh) {
  InlineMesh lists;
  lists.origin = mesh.origin;
  lists.positions.assign(mesh.positions.begin(), mesh.positions.end());
  lists.faces = face_lists(mesh, mesh.corners);
  lists.vertex_normals.assign(mesh.normals.begin(), mesh.normals.end());
  lists.normal_faces = face_lists(mesh, mesh.normal_corners);
  lists.texture_coordinates.assign(mesh.texture_coordinates.begin(), mesh.texture_coordinates.end());
  lists.texture_faces = face_lists(mesh, mesh.texture_corners);
  lists.groups = mesh.groups;
  return lists;
}

}  // namespace raytree
