// Materials that a mesh file names (OBJ `usemtl`): found among the scene's own, else in the file's libraries.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "geometry/error.h"
#include "geometry/polygon_mesh.h"
#include "renderer/scene_description.h"

namespace raytree {

/// Looks names up for all meshes of one scene; what is found in a library joins the scene's materials.
class MeshMaterials {
 public:
  /// Both must outlive the object.
  MeshMaterials(SceneDescription& scene, Warnings& warnings)
      : scene_(scene), warnings_(warnings), own_count_(scene.materials.size()) {}

  /// [group] index into the scene's materials; none where the group names no material or one that is not to be found,
  /// which is counted in the warnings. `mesh_file`: libraries are relative to its folder. Throws Error (bad_input)
  /// where a library is damaged.
  std::vector<std::optional<std::uint32_t>> of_groups(const PolygonMesh& mesh, const std::string& mesh_file);

 private:
  struct Library {
    std::map<std::string, MaterialDescription> unused;
    std::map<std::string, std::uint32_t> used;  ///< index into the scene's materials
  };
  /// Null: there is no such file.
  Library* library(const std::string& path);
  std::vector<Library*> libraries_of(const PolygonMesh& mesh, const std::string& mesh_file);
  std::optional<std::uint32_t> find(const std::string& name, const std::vector<Library*>& libraries);
  std::uint32_t add_to_scene(MaterialDescription&& material);

  SceneDescription& scene_;
  Warnings& warnings_;
  const std::size_t own_count_;                              ///< materials of the scene file, which come first
  std::map<std::string, std::optional<Library>> libraries_;  ///< by path
};

/// Whether one of the files that the mesh names as its libraries is there.
bool has_material_library(const PolygonMesh& mesh, const std::string& mesh_file);

}  // namespace raytree
