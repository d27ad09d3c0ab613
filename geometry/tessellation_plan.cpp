#include "geometry/tessellation_plan.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

#include "geometry/error.h"

namespace raytree {
namespace {

constexpr std::uint32_t kNoSide = 0xffffffffu;
constexpr std::uint64_t kMostIndices = kNoSide - 1;
constexpr std::size_t kAtOnce = 4096;  ///< faces, edges or vertices of one task

void lower(std::uint32_t& value, std::uint32_t candidate) {
  std::atomic_ref<std::uint32_t> shared(value);
  std::uint32_t current = shared.load(std::memory_order_relaxed);
  while (candidate < current && !shared.compare_exchange_weak(current, candidate, std::memory_order_relaxed)) {
  }
}

/// Numbers things one after another on many threads: sums of blocks first, then each block from where it starts.
template <class Sum>
class Numbering {
 public:
  /// count_of(i): what the thing `i` adds.
  template <class CountOf>
  Numbering(std::size_t count, const CountOf& count_of) : count_(count), starts_((count + kAtOnce - 1) / kAtOnce + 1) {
    tbb::parallel_for(std::size_t(0), starts_.size() - 1, [&](std::size_t block) {
      for (std::size_t i = block * kAtOnce; i < end(block); ++i) starts_[block + 1] += count_of(i);
    });
    for (std::size_t block = 1; block < starts_.size(); ++block) starts_[block] += Sum(starts_[block - 1]);
  }

  const Sum& total() const { return starts_.back(); }

  /// put(i, sum of all before i).
  template <class CountOf, class Put>
  void assign(const CountOf& count_of, const Put& put) const {
    tbb::parallel_for(std::size_t(0), starts_.size() - 1, [&](std::size_t block) {
      Sum sum = starts_[block];
      for (std::size_t i = block * kAtOnce; i < end(block); ++i) {
        put(i, sum);
        sum += count_of(i);
      }
    });
  }

 private:
  std::size_t end(std::size_t block) const { return std::min(count_, (block + 1) * kAtOnce); }

  std::size_t count_;
  std::vector<Sum> starts_;
};

const TessellationRates& checked(const ParametricSurface& surface, const TessellationRates& rates) {
  const auto in_range = [](std::uint16_t rate) { return rate >= 1 && rate <= kLargestRate; };
  bool valid = rates.edges.size() == surface.edge_count() && rates.inner.size() == surface.face_count();
  valid = valid && std::all_of(rates.edges.begin(), rates.edges.end(), in_range);
  valid = valid && std::all_of(rates.inner.begin(), rates.inner.end(),
                               [&](const auto& inner) { return in_range(inner[0]) && in_range(inner[1]); });
  if (!valid)
    throw Error(ErrorKind::bad_input, {},
                fmt::format("tessellation needs a rate from 1 to {} for every edge and face", kLargestRate));
  return rates;
}

void check(std::uint64_t count, const char* what) {
  if (count > kMostIndices)
    throw Error(ErrorKind::bad_input, {},
                fmt::format("the tessellation has more than {} {}; take a lower rate or a larger tolerance",
                            kMostIndices, what));
}

}  // namespace

TessellationPlan::TessellationPlan(const ParametricSurface& surface, const TessellationRates& rates)
    : surface_(surface), rates_(checked(surface, rates)), patterns_(surface, rates), faces_(surface.face_count()) {
  const auto side_count = [&](std::size_t face) { return std::uint64_t(surface_.sides(face).size()); };
  const Numbering<std::uint64_t> sides(faces_.size(), side_count);
  if (sides.total() > kMostIndices || faces_.size() > kMostIndices)
    throw Error(ErrorKind::bad_input, {}, "a surface of more than 4 thousand million sides cannot be tessellated");
  edge_owner_.assign(surface.edge_count(), kNoSide);
  vertex_owner_.assign(surface.vertex_count(), kNoSide);
  sides.assign(side_count, [&](std::size_t face, std::uint64_t first) {
    faces_[face] = {};
    faces_[face].sides = first;
    auto id = static_cast<std::uint32_t>(first);
    for (const FaceEdge& side : surface_.sides(face)) {
      if (!side.collapsed) lower(edge_owner_[side.edge], id);
      lower(vertex_owner_[side.vertex], id);
      ++id;
    }
  });

  const auto vertex_points = [&](std::size_t i) { return std::uint64_t(vertex_owner_[i] != kNoSide); };
  const auto edge_points = [&](std::size_t i) {
    return edge_owner_[i] == kNoSide ? std::uint64_t(0) : rates_.edges[i] - std::uint64_t(1);
  };
  const auto face_counts = [&](std::size_t face) { return counts_of(face); };
  const Numbering<std::uint64_t> vertices(vertex_owner_.size(), vertex_points), edges(edge_owner_.size(), edge_points);
  const Numbering<TessellationCounts> faces(faces_.size(), face_counts);
  total_ = faces.total();
  total_.points += vertices.total() + edges.total();
  check(total_.points, "points");
  check(total_.points + total_.normals, "normals");
  check(total_.points + total_.textures, "texture coordinates");
  check(total_.triangles, "triangles");

  vertex_index_.resize(vertex_owner_.size());
  vertices.assign(vertex_points, [&](std::size_t i, std::uint64_t first) {
    vertex_index_[i] = vertex_owner_[i] == kNoSide ? kNoSide : static_cast<std::uint32_t>(first);
  });
  edge_first_.resize(edge_owner_.size());
  edges.assign(edge_points, [&](std::size_t i, std::uint64_t first) {
    edge_first_[i] = static_cast<std::uint32_t>(vertices.total() + first);
  });
  faces.assign(face_counts, [&](std::size_t face, TessellationCounts first) {
    first.points += vertices.total() + edges.total();
    first.normals += total_.points;
    first.textures += total_.points;
    faces_[face] = first;
  });
}

/// What a face has of its own. Its sides are numbered already.
TessellationCounts TessellationPlan::counts_of(std::size_t face) const {
  const std::span<const FaceEdge> sides = surface_.sides(face);
  TessellationCounts counts;
  if (sides.empty()) return counts;
  counts.sides = sides.size();
  counts.points = patterns_.counts(face).interior;
  counts.triangles = patterns_.counts(face).facets - flat_facets(face);
  const bool textured = surface_.has_texture();
  auto id = static_cast<std::uint32_t>(faces_[face].sides);
  for (const FaceEdge& side : sides) {
    const std::uint32_t inner = rates_.edges[side.edge] - 1u;
    counts.normals += (own_corner_normal(side, id) ? 1u : 0u) + (own_normal(side, id) ? inner : 0u);
    if (textured) counts.textures += (owns_vertex(side, id) ? 0u : 1u) + (owns_edge(side, id) ? 0u : inner);
    ++id;
  }
  return counts;
}

/// How many of a face's facets lose their area along its collapsed sides.
std::size_t TessellationPlan::flat_facets(std::size_t face) const {
  std::vector<std::uint16_t> rates;
  std::vector<std::uint64_t> points;
  if (!has_collapsed_side(surface_.sides(face))) return 0;
  rates_of_face(surface_, rates_, face, rates);
  identify_boundary(surface_.sides(face), rates, points);
  FacetPattern own;
  const FacetPattern& whole = pattern(face, own);
  std::size_t count = 0;
  for (std::size_t i = 0; i < whole.facet_count(); ++i) count += has_no_area(&whole.facets[3 * i], points);
  return count;
}

const FacetPattern& TessellationPlan::pattern(std::size_t face, FacetPattern& own) const {
  if (const FacetPattern* const kept = patterns_.kept(face)) return *kept;
  std::vector<std::uint16_t> rates;
  rates_of_face(surface_, rates_, face, rates);
  own = make_facet_pattern(surface_.domain(face), rates);
  return own;
}

void TessellationPlan::number_boundary(std::size_t face, BoundaryNumbers& numbers) const {
  const TessellationCounts& first = faces_[face];
  const bool textured = surface_.has_texture();
  numbers.point.clear();
  numbers.normal.clear();
  numbers.texture.clear();
  numbers.owned.clear();
  auto normal = static_cast<std::uint32_t>(first.normals), texture = static_cast<std::uint32_t>(first.textures),
       id = static_cast<std::uint32_t>(first.sides);
  for (const FaceEdge& side : surface_.sides(face)) {
    const auto add = [&](std::uint32_t point, bool owned, bool own_normal) {
      numbers.point.push_back(point);
      numbers.owned.push_back(owned);
      numbers.normal.push_back(own_normal ? normal++ : point);
      if (textured) numbers.texture.push_back(owned ? point : texture++);
    };
    add(vertex_index_[side.vertex], owns_vertex(side, id), own_corner_normal(side, id));
    const std::uint32_t inner = rates_.edges[side.edge] - 1u, start = edge_first_[side.edge];
    const bool owned = owns_edge(side, id), own = own_normal(side, id);
    // Every point of a collapsed side is its corner.
    for (std::uint32_t i = 0; i < inner && side.collapsed; ++i) add(vertex_index_[side.vertex], false, own);
    for (std::uint32_t i = 0; i < inner && !side.collapsed; ++i)
      add(side.reversed ? start + inner - 1 - i : start + i, owned, own);
    ++id;
  }
}

}  // namespace raytree
