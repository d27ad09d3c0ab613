// Scene files. Whatever is refused is named with its place: file, line, and the path of the object.
#include "renderer/scene_reader.h"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>
#include <vector>

#include "renderer/json_document.h"
#include "renderer/scene_value_reader.h"

namespace raytree {

using namespace reading;

SceneDescription read_scene(std::string_view json, const std::string& name, const std::string& folder) {
  if (json.find_first_not_of(" \t\r\n") == json.npos)
    throw Error(ErrorKind::bad_input, {name, 1, ""}, "the file is empty");
  const JsonDocument document = JsonDocument::parse(json, name);
  SceneDescription scene;
  scene.name = name;
  scene.folder = folder;
  const Place root(name);
  read_table(root, document.root(), scene);
  check_references(root, scene);
  return scene;
}

SceneDescription read_scene_file(const std::string& path) {
  const auto fail = [&](const std::string& message) { throw Error(ErrorKind::bad_input, {path, 0, ""}, message); };
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) fail("is a folder, not a scene file");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) fail("cannot open: " + std::generic_category().message(errno));
  std::string text;
  // A file tells its size, so that reading it takes no second copy; a pipe does not.
  if (const auto size = std::filesystem::file_size(path, ignored); !ignored && size <= kMaxJsonText) text.reserve(size);
  std::vector<char> block(std::size_t(1) << 16);
  while (const std::size_t count = std::fread(block.data(), 1, block.size(), file.get())) {
    if (text.size() + count > kMaxJsonText) fail("larger than 1 GiB; put large meshes into OBJ or PLY files");
    text.append(block.data(), count);
  }
  if (std::ferror(file.get())) fail("cannot read: " + std::generic_category().message(errno));
  return read_scene(text, path, std::filesystem::path(path).parent_path().string());
}

}  // namespace raytree
