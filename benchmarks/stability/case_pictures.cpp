#include "benchmarks/stability/case_pictures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "benchmarks/stability/ray_probes.h"
#include "geometry/bezier_patch.h"
#include "geometry/embree_intersector.h"

namespace raytree::benchmarks {

StabilityPicture painted_picture(std::string caption, int width, int height,
                                 const std::function<PaintedColor(int x, int y)>& color, int magnified) {
  ProbeCanvas canvas(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const PaintedColor light = color(x, y);
      canvas.set(x, y, light.r, light.g, light.b);
    }
  return {std::move(caption), std::move(canvas.image), magnified};
}

StabilityPicture part_of(StabilityPicture picture, const PixelWindow& part, int magnified) {
  StabilityPicture result{std::move(picture.caption), picture.image, magnified};
  result.image.width = part.width, result.image.height = part.height;
  for (std::size_t c = 0; c < 3; ++c) {
    result.image.planes[c].clear();
    for (int y = part.y0; y < part.y0 + part.height; ++y) {
      const auto row = picture.image.planes[c].begin() + static_cast<std::ptrdiff_t>(y) * picture.image.width + part.x0;
      result.image.planes[c].insert(result.image.planes[c].end(), row, row + part.width);
    }
  }
  return result;
}

StabilityPicture difference_picture(std::string caption, const Film& a, const Film& b, double gain, int magnified) {
  const PixelWindow& window = a.window();
  return painted_picture(
      std::move(caption), window.width, window.height,
      [&](int x, int y) {
        const std::size_t i =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(window.width) + static_cast<std::size_t>(x);
        double most = 0;
        for (int c = 0; c < 3; ++c)
          most = std::max(
              most, std::abs(double(a.plane(ChannelGroup::color, c)[i]) - double(b.plane(ChannelGroup::color, c)[i])));
        if (most == 0) return kSoundColor;
        return scaled_color(kFaultColor, std::clamp(most * gain, 0.1, 1.0));
      },
      magnified);
}

LitTriangles cut_patches(const std::vector<BezierPatch>& patches, int along, int across, DegenerateNormal method) {
  LitTriangles result;
  std::vector<Vec3f> corners;
  for (const BezierPatch& patch : patches) {
    const double scale = derivative_scale(patch);
    const auto add = [&](int i, int j) {
      const double u = double(i) / along, v = double(j) / across;
      const PatchDerivatives at = evaluate(patch, u, v);
      const Vec3d normal = patch_normal(patch, at, u, v, scale, method);
      corners.push_back(Vec3f(at.position));
      result.normals.push_back(Vec3f(normal / normal.length()));
    };
    for (int j = 0; j < across; ++j)
      for (int i = 0; i < along; ++i) {
        add(i, j), add(i + 1, j), add(i + 1, j + 1);
        add(i, j), add(i + 1, j + 1), add(i, j + 1);
      }
  }
  result.shapes = triangle_soup(corners);
  return result;
}

StabilityPicture lit_picture(const StabilityRun& run, std::string caption, const LitTriangles& triangles,
                             const ParallelView& view) {
  const EmbreeIntersector tracer(triangles.shapes, run.tracer_options());
  const Vec3d toward = unit(view.toward), right = unit(view.up.cross(toward)), up = toward.cross(right);
  const Vec3f to_light(unit(view.to_light));
  const double pixel = view.window / view.size;
  return painted_picture(std::move(caption), view.size, view.size, [&](int x, int y) {
    const Vec3d at =
        view.middle + right * ((x + 0.5 - view.size / 2.0) * pixel) + up * ((view.size / 2.0 - y - 0.5) * pixel);
    const Hit hit = tracer.intersect_one(Vec3f(at + toward * (4 * view.window)), Vec3f(-toward), kInfinity);
    if (hit.geometry == kNoGeometry) return kPaperColor;
    const Vec3f* const normals = triangles.normals.data() + 3 * std::size_t(hit.primitive);
    const Vec3f sum = normals[0] * (1 - hit.u - hit.v) + normals[1] * hit.u + normals[2] * hit.v;
    Vec3f normal = sum / sum.length();
    if (!std::isfinite(normal.x + normal.y + normal.z)) return kFaultColor;
    if (normal.dot(Vec3f(toward)) < 0) normal = -normal;
    return gray(0.04 + 0.8 * std::max(0.0, double(normal.dot(to_light))));
  });
}

}  // namespace raytree::benchmarks
