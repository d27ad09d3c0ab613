// Scenes of one round shape made of facets, seen from straight ahead, and how the cases on shading look at them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "benchmarks/stability/stability_case.h"
#include "renderer/film.h"
#include "renderer/scene.h"
#include "renderer/scene_description.h"

namespace raytree::benchmarks::facets {

/// Radiance near 1 in single precision: a dozen roundings of half an ulp, each taken `exponent` times by the power.
inline double float_error(double exponent = 1) { return 0x1p-20 * exponent; }

ShapeDescription painted(ShapeKind kind, const std::string& name = "shape");
ShapeDescription painted_mesh(std::shared_ptr<PolygonMesh> mesh, NormalSource normals);
LightDescription sunlight(const Vec3d& travels);

/// An open cylinder about y, radius 1, 4 high, one of its edges toward x = 1 before it is turned.
ShapeDescription faceted_cylinder(int sides, ShadingMethod shading, double turned_degrees = 0);
/// About the origin, radius 1, poles on y, a meridian through z where the sides are a multiple of 4.
ShapeDescription faceted_sphere(int sides, int stacks, ShadingMethod shading);

/// `cells`^2 squares cut in two triangles each, in the plane z = 0 about the origin, facing +z.
std::shared_ptr<PolygonMesh> flat_grid(int cells, double spacing);

/// The shape in white matte paint in the light of a lamp at the viewer, who is at infinity toward z, `width` x `height`
/// pixels that show `window` units up and down. One sample at each pixel's center, nothing else gives light.
SceneDescription headlit_scene(ShapeDescription shape, int width, int height, double window);

/// The same with a white highlight (N.H)^n alone, which is (N.z)^n here.
SceneDescription highlit_scene(ShapeDescription shape, int width, int height, double window, double exponent);

Film film_of(SceneDescription scene, const StabilityRun& run, const ChannelSet& channels = {ChannelGroup::color});
/// Green of all pixels, row by row.
std::vector<float> green_of(SceneDescription scene, const StabilityRun& run);
float largest_of(const std::vector<float>& values);

/// The scene at width x height, four samples a pixel; nothing where the run wants no pictures.
void add_picture(StabilityResult& result, const StabilityRun& run, std::string caption, SceneDescription scene,
                 int width, int height);
/// Radiance [height][width] in gray.
void add_gray_picture(StabilityResult& result, const StabilityRun& run, std::string caption,
                      const std::vector<float>& values, int width, int height);

/// A figure that must lie within `error` of what is predicted.
StabilityFigure predicted_figure(std::string method, std::string quantity, double measured, double predicted,
                                 double error, std::string known, StabilityExpectation expectation);

}  // namespace raytree::benchmarks::facets
