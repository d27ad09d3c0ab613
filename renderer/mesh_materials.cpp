#include "renderer/mesh_materials.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>
#include <sstream>

#include "renderer/mtl_reader.h"
#include "renderer/suggestion.h"

namespace raytree {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

/// Calls visit(path) for each file that the statement `mtllib NAMES` means: NAMES is one name that may hold blanks, or
/// several between blanks; which, the file system says.
void for_each_library(const std::string& names, const fs::path& folder,
                      const std::function<void(const fs::path&)>& visit) {
  if (is_file(folder / names)) {
    visit(folder / names);
    return;
  }
  std::istringstream words(names);
  for (std::string word; words >> word;) visit(folder / word);
}

}  // namespace

bool has_material_library(const PolygonMesh& mesh, const std::string& mesh_file) {
  bool found = false;
  for (const std::string& names : mesh.material_libraries)
    for_each_library(names, fs::path(mesh_file).parent_path(), [&](const fs::path& path) { found |= is_file(path); });
  return found;
}

MeshMaterials::Library* MeshMaterials::library(const std::string& path) {
  const auto [place, is_new] = libraries_.try_emplace(path);
  if (is_new && is_file(path)) {
    Library& library = place->second.emplace();
    for (MaterialDescription& material : read_mtl_file(path, warnings_)) {
      std::string name = material.name;
      library.unused.emplace(std::move(name), std::move(material));
    }
  }
  return place->second ? &*place->second : nullptr;
}

std::vector<MeshMaterials::Library*> MeshMaterials::libraries_of(const PolygonMesh& mesh,
                                                                 const std::string& mesh_file) {
  std::vector<Library*> libraries;
  for (const std::string& names : mesh.material_libraries)
    for_each_library(names, fs::path(mesh_file).parent_path(), [&](const fs::path& path) {
      if (Library* const found = library(path.string()))
        libraries.push_back(found);
      else
        warnings_.push_back({{mesh_file, 0, {}}, "material library " + in_quotes(path.string()) + " is not there"});
    });
  return libraries;
}

std::uint32_t MeshMaterials::add_to_scene(MaterialDescription&& material) {
  const auto is_taken = [&](const std::string& name) {
    return std::any_of(scene_.materials.begin(), scene_.materials.end(),
                       [&](const MaterialDescription& m) { return m.name == name; });
  };
  const std::string name = material.name;
  for (int number = 2; is_taken(material.name); ++number) material.name = name + " " + std::to_string(number);
  scene_.materials.push_back(std::move(material));
  return static_cast<std::uint32_t>(scene_.materials.size() - 1);
}

std::optional<std::uint32_t> MeshMaterials::find(const std::string& name, const std::vector<Library*>& libraries) {
  for (Library* const library : libraries) {
    if (const auto used = library->used.find(name); used != library->used.end()) return used->second;
    const auto unused = library->unused.find(name);
    if (unused == library->unused.end()) continue;
    const std::uint32_t index = add_to_scene(std::move(unused->second));
    library->unused.erase(unused);
    library->used.emplace(name, index);
    return index;
  }
  return std::nullopt;
}

std::vector<std::optional<std::uint32_t>> MeshMaterials::of_groups(const PolygonMesh& mesh,
                                                                   const std::string& mesh_file) {
  std::vector<std::optional<std::uint32_t>> result(mesh.groups.size());
  const bool names_any = std::any_of(mesh.groups.begin(), mesh.groups.end(),
                                     [](const FaceGroup& group) { return !group.material.empty(); });
  if (!names_any) return result;
  // Materials of the scene file come before those of the libraries, so that a scene can replace some of them.
  std::map<std::string, std::optional<std::uint32_t>> known;
  for (std::size_t i = 0; i < own_count_; ++i) known.emplace(scene_.materials[i].name, static_cast<std::uint32_t>(i));
  const std::vector<Library*> libraries = libraries_of(mesh, mesh_file);
  std::string first_missing;
  std::set<std::string> missing;
  for (std::size_t i = 0; i < mesh.groups.size(); ++i) {
    const std::string& name = mesh.groups[i].material;
    if (name.empty()) continue;
    const auto [place, is_new] = known.try_emplace(name);
    if (is_new) place->second = find(name, libraries);
    result[i] = place->second;
    if (!result[i]) {
      if (missing.empty()) first_missing = name;
      missing.insert(name);
    }
  }
  if (!missing.empty())
    warnings_.push_back({{mesh_file, 0, {}},
                         "materials that no library defines, the first is " + in_quotes(first_missing) +
                             ": the default material serves",
                         static_cast<std::int64_t>(missing.size())});
  return result;
}

}  // namespace raytree
