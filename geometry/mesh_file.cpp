// The choice of reader by a file's extension.
#include "geometry/mesh_file.h"

#include <algorithm>

#include "geometry/mapped_file.h"
#include "geometry/obj_reader.h"
#include "geometry/ply_reader.h"

namespace raytree {
std::string lower_extension(const std::string& path) {
  const std::size_t dot = path.find_last_of("./");
  if (dot == std::string::npos || path[dot] == '/') return {};
  std::string result = path.substr(dot);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return result;
}

bool is_mesh_file_name(const std::string& path) {
  const std::string ending = lower_extension(path);
  return ending == ".obj" || ending == ".ply";
}

PolygonMesh read_mesh_file(const std::string& path, Warnings& warnings) {
  if (!is_mesh_file_name(path))
    throw Error(ErrorKind::bad_input, {path, 0, {}}, "not the name of a mesh file: .obj and .ply are read");
  const MappedFile file(path);
  const std::string_view bytes = file.bytes();
  if (bytes.substr(0, 2) == "\x1f\x8b")
    throw Error(ErrorKind::bad_input, {path, 0, {}}, "the file is compressed (gzip): unpack it first");
  return lower_extension(path) == ".ply" ? read_ply(bytes, path, warnings) : read_obj(bytes, path, warnings);
}

}  // namespace raytree
