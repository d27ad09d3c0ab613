#include "geometry/quad_pairs.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

namespace raytree {
namespace {

/// Triangles behind one that are looked at for its partner: the halves of a quad stand side by side in most files.
constexpr std::size_t kPartnerWindow = 4;

/// Triangles that one task pairs among themselves.
constexpr std::size_t kBlockOfTriangles = 8192;

/// Blocks, spread over a mesh, that an estimate counts.
constexpr std::size_t kBlocksLookedAt = 64;

/// Which edge of triangle `a` triangle `b` has too, the other way round; -1: none.
int shared_edge(const std::uint32_t* a, const std::uint32_t* b) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (a[i] == b[(j + 1) % 3] && a[(i + 1) % 3] == b[j]) return i;
  return -1;
}

/// The corner of triangle `b` that is neither of an edge's, if the two triangles make a quad.
int far_corner(const std::uint32_t* a, const std::uint32_t* b, int edge) {
  const std::uint32_t from = a[edge], to = a[(edge + 1) % 3], apex = a[(edge + 2) % 3];
  for (int j = 0; j < 3; ++j)
    if (b[j] != from && b[j] != to) return b[j] == apex ? -1 : j;
  return -1;
}

/// Calls found(triangle, behind) for every quad among triangles [begin, end), in their order.
template <class Found>
void pair_block(const std::uint32_t* corners, std::size_t begin, std::size_t end, Found&& found) {
  bool taken[kBlockOfTriangles] = {};
  for (std::size_t i = begin; i < end; ++i) {
    if (taken[i - begin]) continue;
    std::size_t partner = i;
    for (std::size_t k = i + 1; k < std::min(end, i + 1 + kPartnerWindow) && partner == i; ++k) {
      if (taken[k - begin]) continue;
      const int edge = shared_edge(corners + 3 * i, corners + 3 * k);
      if (edge >= 0 && far_corner(corners + 3 * i, corners + 3 * k, edge) >= 0) partner = k;
    }
    if (partner != i) taken[partner - begin] = true;
    found(i, partner - i);
  }
}

std::size_t blocks_of(std::size_t triangles) { return (triangles + kBlockOfTriangles - 1) / kBlockOfTriangles; }

struct BlockOfQuads {
  std::size_t quads = 0;
  bool neighbors = true;  ///< each quad is of a triangle and the next one
};

BlockOfQuads quads_of_block(std::span<const std::uint32_t> corners, std::size_t block) {
  const std::size_t begin = block * kBlockOfTriangles;
  BlockOfQuads found;
  pair_block(corners.data(), begin, std::min(corners.size() / 3, begin + kBlockOfTriangles),
             [&](std::size_t, std::size_t behind) { ++found.quads, found.neighbors &= behind == 1; });
  return found;
}

}  // namespace

std::size_t estimate_joined_quads(std::span<const std::uint32_t> corners) {
  const std::size_t triangles = corners.size() / 3, blocks = blocks_of(triangles);
  const std::size_t step = std::max<std::size_t>(1, blocks / kBlocksLookedAt);
  std::size_t quads = 0, of = 0;
  for (std::size_t block = 0; block < blocks; block += step) {
    quads += quads_of_block(corners, block).quads;
    of += std::min(triangles - block * kBlockOfTriangles, kBlockOfTriangles);
  }
  if (of == triangles) return quads;
  return static_cast<std::size_t>(static_cast<double>(triangles) * static_cast<double>(quads) /
                                  static_cast<double>(of));
}

QuadList joined_quads(std::span<const std::uint32_t> corners) {
  const std::size_t triangles = corners.size() / 3;
  std::vector<BlockOfQuads> blocks(blocks_of(triangles));
  tbb::parallel_for(std::size_t(0), blocks.size(),
                    [&](std::size_t block) { blocks[block] = quads_of_block(corners, block); });
  std::vector<std::size_t> begins;
  std::size_t count = 0;
  bool neighbors = true;
  for (const BlockOfQuads& block : blocks) {
    begins.push_back(count);
    count += block.quads, neighbors &= block.neighbors;
  }
  QuadList quads;
  quads.corners.resize(4 * count);
  if (!neighbors) quads.first.resize(count);
  quads.halves.resize(count);
  quads.paired = triangles - count;
  tbb::parallel_for(std::size_t(0), begins.size(), [&](std::size_t block) {
    const std::size_t begin = block * kBlockOfTriangles;
    std::size_t quad = begins[block];
    pair_block(corners.data(), begin, std::min(triangles, begin + kBlockOfTriangles),
               [&](std::size_t triangle, std::size_t behind) {
                 const std::uint32_t* a = &corners[3 * triangle];
                 std::uint32_t* out = &quads.corners[4 * quad];
                 if (!neighbors) quads.first[quad] = static_cast<std::uint32_t>(triangle);
                 if (behind == 0) {
                   out[0] = a[0], out[1] = a[1], out[2] = out[3] = a[2];
                   quads.halves[quad] = QuadHalves();
                 } else {
                   // The shared edge becomes the diagonal between corners 1 and 3.
                   const std::uint32_t* b = a + 3 * behind;
                   const int edge = shared_edge(a, b), far = far_corner(a, b, edge), apex = (edge + 2) % 3;
                   out[0] = a[apex], out[1] = a[edge], out[2] = b[far], out[3] = a[(edge + 1) % 3];
                   quads.halves[quad] = QuadHalves(static_cast<unsigned>(behind), static_cast<unsigned>(apex),
                                                   static_cast<unsigned>(far));
                 }
                 ++quad;
               });
  });
  return quads;
}

}  // namespace raytree
