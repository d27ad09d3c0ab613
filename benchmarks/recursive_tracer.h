// Whitted's tree by recursion and single rays, as the paper describes it: what the generations of render() are held
// against. The same tree, the same cuts, the same shading functions; kept here, not in the product.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/embree_intersector.h"
#include "renderer/render.h"
#include "renderer/scene.h"

namespace raytree::benchmarks {

struct RecursiveResult {
  std::vector<Rgb> pixels;  ///< [height][width] of the scene's image
  std::array<std::uint64_t, kRayKindCount> rays{};
  double wall_seconds = 0;
};

/// Renders the whole image, tiles over threads, one sample at each pixel's center whatever the scene's anti-aliasing.
RecursiveResult render_recursively(const Scene& scene, const EmbreeIntersector& intersector, int threads);

/// Empty where both found the same picture and the same tree, else what differs.
///
/// Hits found by packets and by single rays differ in their last bits, and curved mirrors and lenses spread that
/// difference (a bounce off a sphere multiplies it by up to about ten, so five bounces by 1e5). A color then changes
/// by up to 2^-24 * 1e5 * its slope, well under kColorTolerance but where a ray meets an edge: a border of the checker,
/// a silhouette, a shadow's border. Those pixels are counted: with d = 2^-24 * 1e5 = 6e-3 pixels of spread at the
/// worst, and edges that cross no more than every tenth pixel, less than one in a thousand flips.
std::string picture_mismatch(const RecursiveResult& recursive, const RenderResult& rendered);

}  // namespace raytree::benchmarks
