#include "geometry/open_edges.h"

#include <tbb/parallel_sort.h>

#include <utility>

namespace raytree {

std::int64_t count_open_edges(const TriangleMesh& mesh) {
  // An edge is keyed by its smaller and larger end; its direction counts +1 or -1, and a closed mesh sums to zero.
  struct Edge {
    std::uint32_t low, high;
    bool operator<(const Edge& other) const {
      return std::pair(low, high >> 1) < std::pair(other.low, other.high >> 1);
    }
  };
  Buffer<Edge> edges(mesh.corners.size());
  for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
    const std::uint32_t a = mesh.corners[i], b = mesh.corners[i % 3 == 2 ? i - 2 : i + 1];
    // The lowest bit of `high` holds the direction: vertex numbers stay below 2^31.
    edges[i] = a < b ? Edge{a, b << 1} : Edge{b, a << 1 | 1u};
  }
  tbb::parallel_sort(edges.begin(), edges.end());
  std::int64_t open = 0;
  for (std::size_t i = 0; i < edges.size();) {
    std::int64_t sum = 0;
    const Edge first = edges[i];
    for (; i < edges.size() && edges[i].low == first.low && edges[i].high >> 1 == first.high >> 1; ++i)
      sum += (edges[i].high & 1u) != 0 ? -1 : 1;
    open += sum < 0 ? -sum : sum;
  }
  return open;
}

}  // namespace raytree
