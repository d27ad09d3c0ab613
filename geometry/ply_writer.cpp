#include "geometry/ply_writer.h"

#include <algorithm>
#include <bit>
#include <type_traits>
#include <vector>

namespace raytree {
namespace {

static_assert(std::endian::native == std::endian::little, "values are appended as they lie in memory");

constexpr std::uint32_t kNone = 0xffffffffu;

/// One vertex of the file: indices into the mesh's arrays.
struct Vertex {
  std::uint32_t position, normal, texture;
};

/// Vertices as PLY wants them, and the corners that refer to them.
struct WeldedMesh {
  std::vector<Vertex> vertices;
  Buffer<std::uint32_t> corners;
};

WeldedMesh weld(const PolygonMesh& mesh) {
  WeldedMesh result;
  const auto count = static_cast<std::uint32_t>(mesh.positions.size());
  if (mesh.normal_corners.empty() && mesh.texture_corners.empty()) {
    for (std::uint32_t i = 0; i < count; ++i) result.vertices.push_back({i, i, i});
    result.corners = mesh.corners;
    return result;
  }
  // Per position a chain of the vertices made of it, in the order of the corners.
  std::vector<std::uint32_t> first(count, kNone), next;
  const auto own = [&](const Buffer<std::uint32_t>& indices, std::size_t i) {
    return indices.empty() ? mesh.corners[i] : indices[i];
  };
  for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
    const Vertex wanted{mesh.corners[i], mesh.normals.empty() ? 0 : own(mesh.normal_corners, i),
                        mesh.texture_coordinates.empty() ? 0 : own(mesh.texture_corners, i)};
    std::uint32_t vertex = first[wanted.position];
    while (vertex != kNone &&
           (result.vertices[vertex].normal != wanted.normal || result.vertices[vertex].texture != wanted.texture))
      vertex = next[vertex];
    if (vertex == kNone) {
      vertex = static_cast<std::uint32_t>(result.vertices.size());
      result.vertices.push_back(wanted);
      next.push_back(first[wanted.position]);
      first[wanted.position] = vertex;
    }
    result.corners.push_back(vertex);
  }
  return result;
}

template <class T>
void append(std::string& bytes, T value) {
  static_assert(std::is_trivially_copyable_v<T>);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

std::string ply_bytes(const PolygonMesh& mesh) {
  const WeldedMesh welded = weld(mesh);
  const bool wide = mesh.origin != Vec3d(0, 0, 0);
  const std::uint32_t largest =
      mesh.all_triangles() ? 3 : *std::max_element(mesh.face_sizes.begin(), mesh.face_sizes.end());
  std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment written by raytree\nelement vertex " +
                      std::to_string(welded.vertices.size()) + "\n";
  const std::string type = wide ? "property double " : "property float ";
  for (const char* name : {"x", "y", "z"}) bytes += type + name + "\n";
  if (!mesh.normals.empty()) bytes += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!mesh.texture_coordinates.empty()) bytes += "property float s\nproperty float t\n";
  bytes += "element face " + std::to_string(mesh.face_count()) + "\nproperty list " +
           (largest < 256 ? "uchar" : "uint") + " uint vertex_indices\nend_header\n";
  for (const Vertex& vertex : welded.vertices) {
    const Vec3f& p = mesh.positions[vertex.position];
    for (int axis = 0; axis < 3; ++axis)
      if (wide)
        append(bytes, mesh.origin[axis] + double(p[axis]));
      else
        append(bytes, p[axis]);
    if (!mesh.normals.empty())
      for (int axis = 0; axis < 3; ++axis) append(bytes, mesh.normals[vertex.normal][axis]);
    if (!mesh.texture_coordinates.empty())
      for (int axis = 0; axis < 2; ++axis) append(bytes, mesh.texture_coordinates[vertex.texture][axis]);
  }
  std::size_t corner = 0;
  for (std::size_t face = 0; face < mesh.face_count(); ++face) {
    const std::uint32_t size = mesh.all_triangles() ? 3 : mesh.face_sizes[face];
    if (largest < 256)
      append(bytes, static_cast<std::uint8_t>(size));
    else
      append(bytes, size);
    for (std::uint32_t i = 0; i < size; ++i) append(bytes, welded.corners[corner++]);
  }
  return bytes;
}

}  // namespace raytree
