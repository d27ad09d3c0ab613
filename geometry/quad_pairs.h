// Triangles joined in pairs: the same surface to the last triangle, in half as many primitives. Embree builds and holds
// quads for less than the triangles they are made of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "geometry/buffer.h"

namespace raytree {

/// Where a quad's triangles are among those it was made of.
class QuadHalves {
 public:
  QuadHalves() = default;
  /// `behind`: how far the second triangle stands behind the first, 0 for none; `first_turn`, `second_turn`: which
  /// corner of either is the quad's corner 0, or 2.
  QuadHalves(unsigned behind, unsigned first_turn, unsigned second_turn)
      : bits_(static_cast<std::uint8_t>(behind | first_turn << 3 | second_turn << 5)) {}

  unsigned behind() const { return bits_ & 7u; }
  unsigned first_turn() const { return bits_ >> 3 & 3u; }
  unsigned second_turn() const { return bits_ >> 5 & 3u; }

 private:
  std::uint8_t bits_ = 0;
};

struct QuadList {
  /// [quad][4]: the quad's triangles are its corners (0, 1, 3) and (2, 3, 1), as Embree halves a quad. A triangle that
  /// found no partner has corners 2 and 3 alike.
  Buffer<std::uint32_t> corners;
  Buffer<std::uint32_t> first;  ///< [quad] its first triangle
  Buffer<QuadHalves> halves;    ///< [quad]
  std::size_t paired = 0;       ///< quads of two triangles

  std::size_t size() const { return first.size(); }
  std::size_t memory_bytes() const { return array_bytes(corners) + array_bytes(first) + array_bytes(halves); }
};

/// Pairs each triangle with the first of the few behind it that shares an edge with it, wound alike. On all threads of
/// the arena; the result does not depend on them. corners: [triangle][3].
QuadList joined_quads(std::span<const std::uint32_t> corners);

/// How many quads joined_quads() would make: counted up to a million triangles, beyond that in parts of the mesh spread
/// over it.
std::size_t estimate_joined_quads(std::span<const std::uint32_t> corners);

/// A point of a triangle: weights of its corners 1 and 2.
struct TrianglePoint {
  std::uint32_t triangle = 0;
  float u = 0, v = 0;
};

/// The point of a quad that Embree calls (u, v), on the triangle that the quad has there: corners 0, 1 and 3 weigh
/// 1 - u - v, u and v where that is not negative, else corners 2, 3 and 1 weigh u + v - 1, 1 - u and 1 - v.
inline TrianglePoint triangle_point(const QuadList& quads, std::uint32_t quad, float u, float v) {
  const QuadHalves halves = quads.halves[quad];
  const float rest = (1 - u) - v;
  const bool second = rest < 0;
  const float weights[3] = {second ? -rest : rest, second ? 1 - u : u, second ? 1 - v : v};
  const unsigned turn = second ? halves.second_turn() : halves.first_turn();
  // Corner (turn + i) mod 3 of the triangle has weight i.
  return {quads.first[quad] + (second ? halves.behind() : 0), weights[(4 - turn) % 3], weights[(5 - turn) % 3]};
}

}  // namespace raytree
