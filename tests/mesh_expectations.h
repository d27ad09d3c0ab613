// What every mesh that a reader returns must satisfy, equality of meshes in bits, and the run over damaged files.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numeric>

#include "geometry/mesh_file.h"
#include "geometry/polygon_mesh.h"
#include "tests/test_data.h"

namespace raytree::test {

inline void expect_valid(const PolygonMesh& mesh) {
  EXPECT_GT(mesh.face_count(), 0u);
  std::size_t corners = 3 * mesh.face_count();
  if (!mesh.all_triangles()) {
    corners = std::accumulate(mesh.face_sizes.begin(), mesh.face_sizes.end(), std::size_t(0));
    EXPECT_GE(*std::min_element(mesh.face_sizes.begin(), mesh.face_sizes.end()), 3u);
  }
  EXPECT_EQ(mesh.corners.size(), corners);
  const auto below = [](const Buffer<std::uint32_t>& indices, std::size_t count) {
    return std::all_of(indices.begin(), indices.end(), [&](std::uint32_t i) { return i < count; });
  };
  EXPECT_TRUE(below(mesh.corners, mesh.positions.size()));
  EXPECT_TRUE(std::all_of(mesh.positions.begin(), mesh.positions.end(), [](const Vec3f& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  }));
  EXPECT_TRUE(below(mesh.normal_corners, mesh.normals.size()));
  EXPECT_TRUE(below(mesh.texture_corners, mesh.texture_coordinates.size()));
  if (mesh.normal_corners.empty())
    EXPECT_TRUE(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
  else
    EXPECT_EQ(mesh.normal_corners.size(), corners);
  if (mesh.texture_corners.empty())
    EXPECT_TRUE(mesh.texture_coordinates.empty() || mesh.texture_coordinates.size() == mesh.positions.size());
  else
    EXPECT_EQ(mesh.texture_corners.size(), corners);
  std::size_t end = mesh.groups.empty() ? 0 : mesh.groups.front().first_face;
  for (const FaceGroup& group : mesh.groups) {
    EXPECT_GE(group.first_face, end);
    EXPECT_GT(group.face_count, 0u);
    end = std::size_t(group.first_face) + group.face_count;
  }
  EXPECT_LE(end, mesh.face_count());
}

template <class T>
bool same_bits(const Buffer<T>& a, const Buffer<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

inline bool same_mesh(const PolygonMesh& a, const PolygonMesh& b) {
  const auto same_group = [](const FaceGroup& g, const FaceGroup& h) {
    return g.name == h.name && g.material == h.material && g.first_face == h.first_face && g.face_count == h.face_count;
  };
  return a.origin == b.origin && same_bits(a.positions, b.positions) && same_bits(a.corners, b.corners) &&
         same_bits(a.face_sizes, b.face_sizes) && same_bits(a.normals, b.normals) &&
         same_bits(a.normal_corners, b.normal_corners) && same_bits(a.texture_coordinates, b.texture_coordinates) &&
         same_bits(a.texture_corners, b.texture_corners) &&
         std::equal(a.groups.begin(), a.groups.end(), b.groups.begin(), b.groups.end(), same_group);
}

/// Reads every file of the folder: each must give a valid mesh or an error that names it, within a second.
inline void read_all_damaged(const std::string& folder, const std::string& extension) {
  std::size_t loaded = 0, refused = 0;
  for (const auto& path : test_data_files(folder)) {
    if (path.extension() != extension) continue;
    SCOPED_TRACE(path.string());
    const auto start = std::chrono::steady_clock::now();
    Warnings warnings;
    try {
      expect_valid(read_mesh_file(path.string(), warnings));
      ++loaded;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      EXPECT_EQ(error.where().file, path.string());
      ++refused;
    }
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
  }
  std::fprintf(stderr, "%s: %zu loaded, %zu refused\n", folder.c_str(), loaded, refused);
}

}  // namespace raytree::test
