// Scene files: JSON in, SceneDescription out, strictly. Keys, types, ranges and defaults come from scene_fields.h,
// which the schema is printed from too, so the two cannot drift.
#pragma once

#include <string>
#include <string_view>

#include "renderer/scene_description.h"

namespace raytree {

/// Reads a scene file (format: docs/scene-format.md). Mesh files are named, not loaded. Throws Error (bad_input) with
/// file, line and object; an unknown key or value lists what would be right.
SceneDescription read_scene_file(const std::string& path);

/// The same from text; `name` stands for the file in messages, `folder` is what mesh files are relative to.
SceneDescription read_scene(std::string_view json, const std::string& name, const std::string& folder);

/// Sets one value by its path, e.g. "render.depth" "12", "materials.glass.index_of_refraction" "1.33",
/// "shapes.terrain.triangles" "10000000". The value is JSON; what does not parse as JSON is taken as a string.
/// Components go by index ("ambient[0]"), names with dots by the longest that fits or in quotes, whole objects as JSON;
/// setting a "type" resets what depends on it. A mesh left without file and faces is for the loader to refuse.
/// Throws Error (bad_input, its file is `flag`) naming the path's unknown part and listing what exists there; the scene
/// is then unchanged.
void set_scene_value(SceneDescription& scene, const std::string& path, const std::string& value,
                     const std::string& flag = "--set");

/// JSON Schema (draft 2020-12) of a scene file.
std::string scene_schema();

/// The tables of docs/scene-format.md, in Markdown: every key with its type, default, range and meaning.
std::string scene_reference();

/// The scene as a scene file that reads back equal (in-memory meshes as vertex and face lists).
std::string write_scene(const SceneDescription& scene);

}  // namespace raytree
