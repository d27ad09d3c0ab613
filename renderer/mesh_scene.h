// A scene around a bare mesh or a bare set of patches: camera, ground, lights, background and material chosen so that
// the object fills the frame and looks good, whatever its size and place.
#pragma once

#include <memory>
#include <string>

#include "geometry/error.h"
#include "geometry/polygon_mesh.h"
#include "renderer/scene_description.h"

namespace raytree {

/// Share of the frame that stays free on each side of the object, in the direction in which it fills the frame.
inline constexpr double kMeshSceneMargin = 0.06;

/// Reads a mesh file and makes its scene for an image of this size. The file's axes are kept (Y up). Patches (.bpt) are
/// turned from the z up that their files have to y up. Throws Error (bad_input) as read_mesh_file() or
/// read_patch_file() does, and for a mesh without faces.
SceneDescription mesh_scene(const std::string& path, Warnings& warnings, const ImageDescription& image = {});

/// The same for a mesh in memory; `name` stands for the file in messages. Throws Error (bad_input) for one without
/// faces.
SceneDescription mesh_scene(std::shared_ptr<PolygonMesh> mesh, const std::string& name,
                            const ImageDescription& image = {});

}  // namespace raytree
