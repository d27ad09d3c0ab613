// What a part of an OBJ file holds: counted before anything is parsed, so that arrays are allocated once.
#pragma once

#include <cstddef>

namespace raytree {

/// Of statements; `corners` of all faces together. `names_normals`, `names_texture`: some face does.
struct ObjCounts {
  std::size_t positions = 0, normals = 0, texture_coordinates = 0, faces = 0, corners = 0;
  bool all_triangles = true, names_normals = false, names_texture = false;

  void add(const ObjCounts& other) {
    positions += other.positions;
    normals += other.normals;
    texture_coordinates += other.texture_coordinates;
    faces += other.faces;
    corners += other.corners;
    all_triangles = all_triangles && other.all_triangles;
    names_normals = names_normals || other.names_normals;
    names_texture = names_texture || other.names_texture;
  }
};

/// Counts whole lines of the text from `begin` to `end`. Nothing is checked.
ObjCounts count_obj(const char* begin, const char* end, char newline);

}  // namespace raytree
