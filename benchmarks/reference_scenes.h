// The scenes that rows measure.
#pragma once

#include <cstdint>
#include <string>

#include "renderer/scene.h"
#include "renderer/scene_description.h"

namespace raytree::benchmarks {

/// spheres-1980 at 1280x960 without anti-aliasing; depth and cutoff are the scene's own.
SceneDescription reference_scene();

/// The same with a terrain of about a million triangles behind the spheres, seen straight, mirrored and refracted.
SceneDescription reference_scene_with_mesh();

/// That without its spheres: triangles alone.
SceneDescription reference_mesh_alone();

/// The built-in terrain with so many triangles, 1920x1080; all else is the scene's own.
SceneDescription terrain_scene(std::int64_t triangles);
inline constexpr const char* kTerrainSceneName = "terrain";                   ///< as `raytree render` takes it
inline constexpr const char* kTerrainCountPath = "shapes.terrain.triangles";  ///< as `--set` takes it

/// The built-in terrain with so many triangles and without its lake, from above, so that it fills the picture;
/// 800x600.
SceneDescription bare_terrain(std::int64_t triangles);

/// So many small triangles that share no corner, turned and placed at random in a cube; 1280x960.
SceneDescription scattered_triangles(int count);

/// A ball with dents of about so many triangles, rows of cells on the six sides of a cube blown up, before a background
/// that most eye rays meet: rays that take little time; 800x600.
SceneDescription dented_ball(std::int64_t triangles);

/// edge^2 instances of a terrain of a million triangles, turned and scaled each in its own way, side by side before the
/// camera; 1280x960 without anti-aliasing.
SceneDescription instances_scene(int edge = 100);

/// One sphere, 64x64: what is left of a render's time is the program's start.
SceneDescription trivial_scene();

/// "spheres-1980, 1280x960, 2 threads": what a row says of the picture it traces.
std::string picture_text(const Scene& scene, int threads);

/// Prepares a scene for any number of threads.
Scene prepared(SceneDescription description);

}  // namespace raytree::benchmarks
