// Pictures of the stability suite that no renderer makes: painted pixel by pixel, parts of others, differences, and
// meshes whose corners' normals are taken as they are.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "benchmarks/samples/patches.h"
#include "benchmarks/stability/stability_case.h"
#include "geometry/patch_normal.h"
#include "geometry/shape_set.h"
#include "renderer/film.h"

namespace raytree::benchmarks {

/// Light in [0, 1], shown as its square root.
struct PaintedColor {
  double r = 0, g = 0, b = 0;
};
/// Orange where a method fails, blue where it holds: told apart by everyone. Dark where nothing was asked.
inline constexpr PaintedColor kFaultColor{0.85, 0.4, 0.02}, kSoundColor{0.02, 0.2, 0.5}, kDarkColor{0.02, 0.05, 0.1};
/// What is seen behind a shape.
inline constexpr PaintedColor kPaperColor{0.9, 0.9, 0.88};

inline PaintedColor gray(double light) { return {light, light, light}; }
inline PaintedColor scaled_color(const PaintedColor& color, double light) {
  return {color.r * light, color.g * light, color.b * light};
}

/// `color` is asked for every pixel, row 0 on top, from one thread.
StabilityPicture painted_picture(std::string caption, int width, int height,
                                 const std::function<PaintedColor(int x, int y)>& color, int magnified = 1);

/// A part of the picture, its pixels `magnified` times as large.
StabilityPicture part_of(StabilityPicture picture, const PixelWindow& part, int magnified);

/// Where two films of one size differ in color: their largest difference times `gain`, from dark to orange; blue where
/// they are equal to the bit.
StabilityPicture difference_picture(std::string caption, const Film& a, const Film& b, double gain, int magnified = 1);

/// Triangles, each with corners of its own: [3 n] of the one mesh, and as many normals.
struct LitTriangles {
  ShapeSet shapes;
  std::vector<Vec3f> normals;
};

/// Patches cut in `along` x `across` cells; normals by the method and made unit as n / |n|, which is no number where it
/// finds none.
LitTriangles cut_patches(const std::vector<BezierPatch>& patches, int along, int across, DegenerateNormal method);

/// Seen from infinity against `toward`, `size` pixels for `window` units about `middle`, in the light from `to_light`.
/// Normals are interpolated and made unit, whatever comes of it: orange where that is no number.
struct ParallelView {
  Vec3d middle{0, 0, 0}, toward{0, 0, 1}, up{0, 1, 0}, to_light{0, 0, 1};
  int size = 160;
  double window = 2.2;
};
StabilityPicture lit_picture(const StabilityRun& run, std::string caption, const LitTriangles& triangles,
                             const ParallelView& view);

}  // namespace raytree::benchmarks
