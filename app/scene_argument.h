// The SCENE argument: a scene file, a bare mesh, or the name of a built-in scene, and what flags change in it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/usage.h"
#include "renderer/scene.h"
#include "renderer/scene_description.h"

namespace CLI {
class App;
}

namespace raytree::app {

/// Flags that change the scene before it is prepared; `render` and `info` share them.
struct SceneFlags {
  std::string scene;              ///< the positional argument
  std::string size;               ///< WxH
  std::string camera;             ///< name
  std::vector<std::string> sets;  ///< PATH=VALUE
  std::string depth, cutoff, antialias, threshold, levels, minimum_level, rough_samples;
  std::string tolerance, rate;
  std::string shading, terminator, reflections;
  bool classic = false;
  std::string hierarchy, memory;
  std::string intersector, edges, sphere_size, sphere_search;
};

/// Adds --size, --camera, --set, --tolerance and --rate; with `tracing` also what else changes the
/// picture.
void add_scene_flags(CLI::App& command, SceneFlags& flags, bool tracing);

/// Adds --shading.
void add_shading_flag(CLI::App& command, SceneFlags& flags);

/// Adds --hierarchy and --memory, for commands that trace.
void add_hierarchy_flags(CLI::App& command, SceneFlags& flags);

/// Adds --intersector, --edges, --sphere-size and --sphere-search.
void add_intersector_flags(CLI::App& command, SceneFlags& flags);

/// What the flags say of the tracer and what it builds. Throws Error (bad_input).
void apply_tracer_flags(const SceneFlags& flags, PrepareOptions& options);

/// Bytes: a number, or one with K, M, G or T (powers of 1024) behind it; 0 for none given.
std::uint64_t parse_memory(const std::string& text);

/// Throws Error (bad_input) for whatever can be said of the flags without the scene.
void check_scene_flags(const SceneFlags& flags);

/// Reads or makes the scene and applies --set in the order given, then the other flags. A bare mesh is read here; the
/// meshes that a scene file names are not. Throws Error.
SceneDescription load_scene(const SceneFlags& flags, Warnings& warnings);

struct ImageSize {
  int width = 0, height = 0;
};
/// "WxH".
ImageSize parse_size(const std::string& flag, const std::string& text);

}  // namespace raytree::app
