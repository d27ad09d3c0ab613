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

  /// As they were given, from the lowest bit on: `behind` in three bits, the turns in two each.
  std::uint32_t bits() const { return bits_; }

 private:
  std::uint8_t bits_ = 0;
};

struct QuadList {
  /// [quad][4]: the quad's triangles are its corners (0, 1, 3) and (2, 3, 1), as Embree halves a quad. A triangle that
  /// found no partner has corners 2 and 3 alike.
  Buffer<std::uint32_t> corners;
  /// [quad] its first triangle. Empty: quad q is of triangles 2q and 2q + 1 for all q, as in what was made of quads.
  Buffer<std::uint32_t> first;
  Buffer<QuadHalves> halves;  ///< [quad]
  std::size_t paired = 0;     ///< quads of two triangles

  std::size_t size() const { return halves.size(); }
  std::uint32_t first_triangle(std::uint32_t quad) const { return first.empty() ? 2 * quad : first[quad]; }
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
/// 1 - u - v, u and v where that is not negative, else corners 2, 3 and 1 weigh u + v - 1, 1 - u and 1 - v. `triangle`:
/// the quad's first, on return the one there; `halves`: QuadHalves::bits(). Of one point, or of as many as vectors have
/// elements: g++ 12 does not vectorize a loop over it.
template <class Integers, class Reals>
inline void find_triangle_point(const Integers& halves, Integers& triangle, Reals& u, Reals& v) {
  const Reals rest = (1 - u) - v;
  const auto second = rest < 0;
  const Reals weight_0 = second ? -rest : rest, weight_1 = second ? 1 - u : u, weight_2 = second ? 1 - v : v;
  const Integers turn = second ? halves >> 5 & 3u : halves >> 3 & 3u;
  // Corner (turn + i) mod 3 of the triangle has weight i.
  const auto unturned = turn == 0u, once = turn == 1u;
  triangle += second ? halves & 7u : halves & 0u;
  u = unturned ? weight_1 : (once ? weight_0 : weight_2);
  v = unturned ? weight_2 : (once ? weight_1 : weight_0);
}

/// The same of a point of `quad`.
inline TrianglePoint triangle_point(const QuadList& quads, std::uint32_t quad, float u, float v) {
  TrianglePoint point{quads.first_triangle(quad), u, v};
  find_triangle_point(quads.halves[quad].bits(), point.triangle, point.u, point.v);
  return point;
}

}  // namespace raytree
