// A scene around a bare mesh: camera, ground, lights, background and material chosen so that the object fills the frame
// and looks good, whatever its size and place.
#pragma once

#include <memory>
#include <string>

#include "geometry/error.h"
#include "geometry/polygon_mesh.h"
#include "renderer/scene_description.h"

namespace raytree {

/// Share of the frame that stays free on each side of the object, in the direction in which it fills the frame.
inline constexpr double kMeshSceneMargin = 0.06;

/// Reads a mesh file and makes its scene for an image of this size. The file's axes are kept (Y up). Throws Error
/// (bad_input) as read_mesh_file() does, and for a mesh without faces.
SceneDescription mesh_scene(const std::string& path, Warnings& warnings, const ImageDescription& image = {});

/// The same for a mesh in memory; `name` stands for the file in messages. Throws Error (bad_input) for one without
/// faces.
SceneDescription mesh_scene(std::shared_ptr<PolygonMesh> mesh, const std::string& name,
                            const ImageDescription& image = {});

}  // namespace raytree
