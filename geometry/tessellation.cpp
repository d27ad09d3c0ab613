// Two passes. The plan numbers every point, normal and triangle before any is made: who evaluates a shared corner or
// edge (its owner, the side of the lowest number), and where each face's own begin. Then faces are evaluated and
// written in any order, each straight to its place.
#include "geometry/tessellation.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <vector>

#include "geometry/error.h"

namespace raytree {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
constexpr std::uint64_t kMostIndices = kNone - 1;
constexpr std::size_t kFacesAtOnce = 64;     ///< at least, per task
constexpr std::size_t kPointsAtOnce = 4096;  ///< evaluated in one call; a larger face goes in several, side by side

/// What a face owns and where it begins. Sides, and the corners they begin at, are numbered through all faces.
struct FacePlan {
  std::uint64_t first_triangle = 0;
  std::uint32_t first_side = 0;
  std::uint32_t first_point = 0;    ///< of its inside
  std::uint32_t first_normal = 0;   ///< of its own at sharp sides, behind those of the points
  std::uint32_t first_texture = 0;  ///< of its own along its boundary, behind those of the points
  std::uint32_t pattern = FacetPatternSet::kNotKept;
};

bool has_collapsed(std::span<const FaceEdge> sides) {
  return std::any_of(sides.begin(), sides.end(), [](const FaceEdge& side) { return side.collapsed; });
}

void lower(std::uint32_t& value, std::uint32_t candidate) {
  std::atomic_ref<std::uint32_t> shared(value);
  std::uint32_t current = shared.load(std::memory_order_relaxed);
  while (candidate < current && !shared.compare_exchange_weak(current, candidate, std::memory_order_relaxed)) {
  }
}

class Tessellator {
 public:
  Tessellator(const ParametricSurface& surface, const TessellationRates& rates, FacetParameters* parameters)
      : surface_(surface), rates_(rates), facet_parameters_(parameters) {
    check_rates();
    number_sides();
    find_owners();
    number_points();
  }

  TriangleMesh make();

 private:
  struct Scratch;

  void check_rates() const;
  void number_sides();
  void find_owners();
  void number_points();
  std::size_t flat_facets(std::size_t face, const std::vector<std::uint16_t>& rates) const;

  void make_face(std::size_t face, Scratch& scratch);
  void number_boundary(std::size_t face, std::span<const FaceEdge> sides, Scratch& scratch) const;
  void evaluate_boundary(std::size_t face, const FacetPattern& pattern, Scratch& scratch);
  void evaluate_inside(std::size_t face, const FacetPattern& pattern, std::size_t begin, std::size_t end,
                       std::vector<SurfaceSample>& samples);
  void write_facets(std::size_t face, const FacetPattern& pattern, const Scratch& scratch);
  void note_if_not_finite(const Vec3f& position, std::size_t face) {
    if (!(position.x * 0 + position.y * 0 + position.z * 0 == 0))
      lower(first_bad_face_, static_cast<std::uint32_t>(face));
  }

  bool own_normal(const FaceEdge& side, std::uint32_t id) const {
    return side.sharp_edge && edge_owner_[side.edge] != id;
  }
  bool own_corner_normal(const FaceEdge& side, std::uint32_t id) const {
    return side.sharp_vertex && vertex_owner_[side.vertex] != id;
  }

  const ParametricSurface& surface_;
  const TessellationRates& rates_;
  FacetParameters* facet_parameters_;  ///< null: not wanted
  Buffer<FacePlan> faces_;
  std::uint32_t side_count_ = 0;
  Buffer<std::uint32_t> edge_owner_, vertex_owner_;  ///< number of a side; kNone: no face is there
  Buffer<std::uint32_t> edge_first_, vertex_index_;  ///< positions
  FacetPatternSet patterns_;
  std::uint64_t points_ = 0, triangles_ = 0, normals_ = 0, textures_ = 0;
  std::uint32_t first_bad_face_ = kNone;
  TriangleMesh mesh_;
};

/// What one task keeps from face to face.
struct Tessellator::Scratch {
  std::vector<std::uint16_t> rates;
  FacetPattern pattern;                ///< of a face whose pattern is not kept
  std::vector<std::uint32_t> point;    ///< [boundary_count] index of the position
  std::vector<std::uint32_t> normal;   ///< [boundary_count]
  std::vector<std::uint32_t> texture;  ///< [boundary_count]
  std::vector<std::uint8_t> owned;     ///< [boundary_count] whether this face evaluates the position
  std::vector<std::uint32_t> wanted;   ///< those of the boundary that are evaluated here
  std::vector<Vec2f> parameters;
  std::vector<SurfaceSample> samples;
};

void Tessellator::check_rates() const {
  const auto in_range = [](std::uint16_t rate) { return rate >= 1 && rate <= kLargestRate; };
  bool valid = rates_.edges.size() == surface_.edge_count() && rates_.inner.size() == surface_.face_count();
  valid = valid && std::all_of(rates_.edges.begin(), rates_.edges.end(), in_range);
  valid = valid && std::all_of(rates_.inner.begin(), rates_.inner.end(),
                               [&](const auto& inner) { return in_range(inner[0]) && in_range(inner[1]); });
  if (!valid)
    throw Error(ErrorKind::bad_input, {},
                fmt::format("tessellation needs a rate from 1 to {} for every edge and face", kLargestRate));
}

void Tessellator::number_sides() {
  const std::size_t count = surface_.face_count();
  faces_.resize(count);
  std::uint64_t sides = 0;
  for (std::size_t face = 0; face < count; ++face) {
    faces_[face] = FacePlan();
    faces_[face].first_side = static_cast<std::uint32_t>(sides);
    sides += surface_.sides(face).size();
    if (sides > kMostIndices || face > kMostIndices)
      throw Error(ErrorKind::bad_input, {}, "a surface of more than 4 thousand million sides cannot be tessellated");
  }
  side_count_ = static_cast<std::uint32_t>(sides);
}

void Tessellator::find_owners() {
  edge_owner_.assign(surface_.edge_count(), kNone);
  vertex_owner_.assign(surface_.vertex_count(), kNone);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, faces_.size(), kFacesAtOnce), [&](const auto& range) {
    for (std::size_t face = range.begin(); face != range.end(); ++face) {
      std::uint32_t id = faces_[face].first_side;
      for (const FaceEdge& side : surface_.sides(face)) {
        if (!side.collapsed) lower(edge_owner_[side.edge], id);
        lower(vertex_owner_[side.vertex], id);
        ++id;
      }
    }
  });
}

/// Points in the order of vertices, edges, insides of faces.
void Tessellator::number_points() {
  vertex_index_.resize(vertex_owner_.size());
  for (std::size_t i = 0; i < vertex_owner_.size(); ++i)
    vertex_index_[i] = vertex_owner_[i] == kNone ? kNone : static_cast<std::uint32_t>(points_++);
  edge_first_.resize(edge_owner_.size());
  const auto check = [&](std::uint64_t count, const char* what) {
    if (count > kMostIndices)
      throw Error(ErrorKind::bad_input, {},
                  fmt::format("the tessellation has more than {} {}; take a lower rate or a larger tolerance",
                              kMostIndices, what));
  };
  for (std::size_t i = 0; i < edge_owner_.size(); ++i) {
    check(points_, "points");
    edge_first_[i] = static_cast<std::uint32_t>(points_);
    if (edge_owner_[i] != kNone) points_ += rates_.edges[i] - 1u;
  }
  std::vector<std::uint16_t> rates;
  const bool textured = surface_.has_texture();
  for (std::size_t face = 0; face < faces_.size(); ++face) {
    const std::span<const FaceEdge> sides = surface_.sides(face);
    FacePlan& plan = faces_[face];
    plan.first_triangle = triangles_;
    plan.first_point = static_cast<std::uint32_t>(points_);
    plan.first_normal = static_cast<std::uint32_t>(normals_);
    plan.first_texture = static_cast<std::uint32_t>(textures_);
    if (sides.empty()) continue;
    const FaceDomain domain = surface_.domain(face);
    rates_of_face(surface_, rates_, face, rates);
    plan.pattern = patterns_.find(domain, rates);
    if (plan.pattern != FacetPatternSet::kNotKept) {
      const FacetPattern& pattern = patterns_[plan.pattern];
      points_ += pattern.parameters.size() - pattern.boundary_count;
      triangles_ += pattern.facet_count();
    } else {
      const FacetCounts counts = count_facets(domain, rates);
      points_ += counts.interior;
      triangles_ += counts.facets;
    }
    if (has_collapsed(sides)) triangles_ -= flat_facets(face, rates);
    std::uint32_t id = plan.first_side;
    for (const FaceEdge& side : sides) {
      const std::uint32_t inner = rates_.edges[side.edge] - 1u;
      normals_ += (own_corner_normal(side, id) ? 1u : 0u) + (own_normal(side, id) ? inner : 0u);
      if (textured)
        textures_ += (vertex_owner_[side.vertex] != id ? 1u : 0u) + (edge_owner_[side.edge] != id ? inner : 0u);
      ++id;
    }
    check(points_, "points");
    check(points_ + normals_, "normals");
    check(points_ + textures_, "texture coordinates");
    check(triangles_, "triangles");
  }
}

/// How many of a face's facets lose their area along its collapsed sides.
std::size_t Tessellator::flat_facets(std::size_t face, const std::vector<std::uint16_t>& rates) const {
  const std::uint32_t kept = faces_[face].pattern;
  FacetPattern made;
  if (kept == FacetPatternSet::kNotKept) made = make_facet_pattern(surface_.domain(face), rates);
  const FacetPattern& pattern = kept == FacetPatternSet::kNotKept ? made : patterns_[kept];
  std::vector<std::uint64_t> points;
  identify_boundary(surface_.sides(face), rates, points);
  std::size_t count = 0;
  for (std::size_t i = 0; i < pattern.facet_count(); ++i) count += has_no_area(&pattern.facets[3 * i], points);
  return count;
}

TriangleMesh Tessellator::make() {
  mesh_.origin = surface_.origin();
  mesh_.positions.resize(points_);
  mesh_.normals.resize(points_ + normals_);
  mesh_.corners.resize(3 * triangles_);
  mesh_.triangle_faces.resize(triangles_);
  if (normals_ > 0) mesh_.normal_corners.resize(3 * triangles_);
  if (facet_parameters_ != nullptr) {
    facet_parameters_->faces.resize(triangles_);
    facet_parameters_->corners.resize(3 * triangles_);
  }
  if (surface_.has_texture()) {
    mesh_.texture_coordinates.resize(points_ + textures_);
    if (textures_ > 0) mesh_.texture_corners.resize(3 * triangles_);
  }
  // A few faces of many points are as good for many threads as many faces of a few.
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, faces_.size()), [&](const auto& range) {
    Scratch scratch;
    for (std::size_t face = range.begin(); face != range.end(); ++face) make_face(face, scratch);
  });
  if (first_bad_face_ != kNone)
    throw Error(ErrorKind::bad_input, {},
                fmt::format("the surface is not finite in face {}", surface_.source_face(first_bad_face_) + 1));
  return std::move(mesh_);
}

void Tessellator::make_face(std::size_t face, Scratch& scratch) {
  const std::span<const FaceEdge> sides = surface_.sides(face);
  if (sides.empty()) return;
  if (faces_[face].pattern == FacetPatternSet::kNotKept) {
    rates_of_face(surface_, rates_, face, scratch.rates);
    scratch.pattern = make_facet_pattern(surface_.domain(face), scratch.rates);
  }
  const FacetPattern& pattern =
      faces_[face].pattern == FacetPatternSet::kNotKept ? scratch.pattern : patterns_[faces_[face].pattern];
  number_boundary(face, sides, scratch);
  const std::size_t begin = pattern.boundary_count, end = pattern.parameters.size();
  evaluate_boundary(face, pattern, scratch);
  if (end - begin > kPointsAtOnce)
    tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, kPointsAtOnce), [&](const auto& range) {
      std::vector<SurfaceSample> samples;
      for (std::size_t first = range.begin(); first < range.end(); first += kPointsAtOnce)
        evaluate_inside(face, pattern, first, std::min(range.end(), first + kPointsAtOnce), samples);
    });
  write_facets(face, pattern, scratch);
}

/// The numbers of what lies on the face's boundary, in the pattern's order.
void Tessellator::number_boundary(std::size_t face, std::span<const FaceEdge> sides, Scratch& scratch) const {
  const FacePlan& plan = faces_[face];
  const bool textured = surface_.has_texture();
  scratch.point.clear();
  scratch.normal.clear();
  scratch.texture.clear();
  scratch.owned.clear();
  auto normal = static_cast<std::uint32_t>(points_ + plan.first_normal);
  auto texture = static_cast<std::uint32_t>(points_ + plan.first_texture);
  std::uint32_t id = plan.first_side;
  for (const FaceEdge& side : sides) {
    const auto add = [&](std::uint32_t point, bool owned, bool own_normal) {
      scratch.point.push_back(point);
      scratch.owned.push_back(owned);
      scratch.normal.push_back(own_normal ? normal++ : point);
      if (textured) scratch.texture.push_back(owned ? point : texture++);
    };
    add(vertex_index_[side.vertex], vertex_owner_[side.vertex] == id, own_corner_normal(side, id));
    const std::uint32_t inner = rates_.edges[side.edge] - 1u, first = edge_first_[side.edge];
    const bool owned = edge_owner_[side.edge] == id, own = own_normal(side, id);
    // Every point of a collapsed side is its corner.
    for (std::uint32_t i = 0; i < inner && side.collapsed; ++i) add(vertex_index_[side.vertex], false, own);
    for (std::uint32_t i = 0; i < inner && !side.collapsed; ++i)
      add(side.reversed ? first + inner - 1 - i : first + i, owned, own);
    ++id;
  }
}

/// What this face evaluates of its boundary and, unless that is large, its inside, in one call.
void Tessellator::evaluate_boundary(std::size_t face, const FacetPattern& pattern, Scratch& scratch) {
  const bool textured = surface_.has_texture();
  scratch.wanted.clear();
  scratch.parameters.clear();
  for (std::uint32_t i = 0; i < pattern.boundary_count; ++i)
    if (scratch.owned[i] || scratch.normal[i] != scratch.point[i] || textured) {
      scratch.wanted.push_back(i);
      scratch.parameters.push_back(pattern.parameters[i]);
    }
  const std::size_t inside = pattern.parameters.size() - pattern.boundary_count;
  const bool together = inside <= kPointsAtOnce;
  if (together)
    scratch.parameters.insert(scratch.parameters.end(), pattern.parameters.begin() + pattern.boundary_count,
                              pattern.parameters.end());
  if (scratch.parameters.empty()) return;
  if (scratch.samples.size() < scratch.parameters.size()) scratch.samples.resize(scratch.parameters.size());
  const std::span<SurfaceSample> samples(scratch.samples.data(), scratch.parameters.size());
  surface_.evaluate(face, scratch.parameters, samples);
  for (std::size_t k = 0; k < scratch.wanted.size(); ++k) {
    const std::uint32_t i = scratch.wanted[k];
    const SurfaceSample& sample = samples[k];
    if (scratch.owned[i]) {
      note_if_not_finite(sample.position, face);
      mesh_.positions[scratch.point[i]] = sample.position;
    }
    if (scratch.owned[i] || scratch.normal[i] != scratch.point[i]) mesh_.normals[scratch.normal[i]] = sample.normal;
    if (textured) mesh_.texture_coordinates[scratch.texture[i]] = sample.texture;
  }
  if (!together) return;
  const SurfaceSample* sample = samples.data() + scratch.wanted.size();
  std::size_t point = faces_[face].first_point;
  for (std::size_t i = 0; i < inside; ++i, ++sample, ++point) {
    note_if_not_finite(sample->position, face);
    mesh_.positions[point] = sample->position;
    mesh_.normals[point] = sample->normal;
    if (textured) mesh_.texture_coordinates[point] = sample->texture;
  }
}

/// Points [begin, end) of the pattern, all inside.
void Tessellator::evaluate_inside(std::size_t face, const FacetPattern& pattern, std::size_t begin, std::size_t end,
                                  std::vector<SurfaceSample>& samples) {
  const bool textured = surface_.has_texture();
  samples.resize(end - begin);
  surface_.evaluate(face, std::span(pattern.parameters).subspan(begin, end - begin), samples);
  std::size_t point = faces_[face].first_point + (begin - pattern.boundary_count);
  for (const SurfaceSample& sample : samples) {
    note_if_not_finite(sample.position, face);
    mesh_.positions[point] = sample.position;
    mesh_.normals[point] = sample.normal;
    if (textured) mesh_.texture_coordinates[point] = sample.texture;
    ++point;
  }
}

void Tessellator::write_facets(std::size_t face, const FacetPattern& pattern, const Scratch& scratch) {
  const FacePlan& plan = faces_[face];
  const std::uint32_t boundary = pattern.boundary_count,
                      inside = plan.first_point - boundary;  // wraps around, and back
  const bool collapsed = has_collapsed(surface_.sides(face));
  std::vector<std::uint32_t> with_area;
  if (collapsed) {
    std::vector<std::uint16_t> rates;
    std::vector<std::uint64_t> points;
    rates_of_face(surface_, rates_, face, rates);
    identify_boundary(surface_.sides(face), rates, points);
    for (std::size_t i = 0; i < pattern.facet_count(); ++i)
      if (const auto* facet = &pattern.facets[3 * i]; !has_no_area(facet, points))
        with_area.insert(with_area.end(), facet, facet + 3);
  }
  const std::vector<std::uint32_t>& facets = collapsed ? with_area : pattern.facets;
  const auto write = [&](Buffer<std::uint32_t>& corners, const std::vector<std::uint32_t>& numbers) {
    if (corners.empty()) return;
    std::uint32_t* out = corners.data() + 3 * plan.first_triangle;
    const auto copy = [&](std::size_t begin, std::size_t end) {
      const std::uint32_t* in = facets.data();
      for (std::size_t i = begin; i < end; ++i) out[i] = in[i] < boundary ? numbers[in[i]] : in[i] + inside;
    };
    const std::size_t count = facets.size();
    if (count <= 16 * kPointsAtOnce)
      copy(0, count);
    else
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 16 * kPointsAtOnce),
                        [&](const auto& range) { copy(range.begin(), range.end()); });
  };
  write(mesh_.corners, scratch.point);
  write(mesh_.normal_corners, scratch.normal);
  write(mesh_.texture_corners, scratch.texture);
  std::fill_n(mesh_.triangle_faces.begin() + static_cast<std::ptrdiff_t>(plan.first_triangle), facets.size() / 3,
              surface_.source_face(face));
  if (facet_parameters_ == nullptr) return;
  std::fill_n(facet_parameters_->faces.begin() + static_cast<std::ptrdiff_t>(plan.first_triangle), facets.size() / 3,
              static_cast<std::uint32_t>(face));
  Vec2f* out = facet_parameters_->corners.data() + 3 * plan.first_triangle;
  for (const std::uint32_t point : facets) *out++ = pattern.parameters[point];
}

}  // namespace

void identify_boundary(std::span<const FaceEdge> sides, std::span<const std::uint16_t> rates,
                       std::vector<std::uint64_t>& points) {
  points.clear();
  if (!has_collapsed(sides)) return;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const FaceEdge& side = sides[i];
    points.push_back(side.vertex);
    for (std::uint64_t k = 1; k < rates[i]; ++k)
      points.push_back(side.collapsed ? side.vertex
                                      : (std::uint64_t(side.edge) + 1) << 32 | (side.reversed ? rates[i] - k : k));
  }
}

bool has_no_area(const std::uint32_t* facet, std::span<const std::uint64_t> points) {
  const auto same = [&](std::uint32_t a, std::uint32_t b) {
    return a < points.size() && b < points.size() && points[a] == points[b];
  };
  return same(facet[0], facet[1]) || same(facet[1], facet[2]) || same(facet[2], facet[0]);
}

void rates_of_face(const ParametricSurface& surface, const TessellationRates& rates, std::size_t face,
                   std::vector<std::uint16_t>& face_rates) {
  face_rates.clear();
  for (const FaceEdge& side : surface.sides(face)) face_rates.push_back(rates.edges[side.edge]);
  const auto& inner = rates.inner[face];
  face_rates.insert(face_rates.end(), inner.begin(), inner.begin() + inner_rate_count(surface.domain(face)));
}

TessellationRates uniform_rates(const ParametricSurface& surface, int rate) {
  if (rate < 1 || rate > kLargestRate)
    throw Error(ErrorKind::bad_input, {}, fmt::format("a rate must lie from 1 to {}, not {}", kLargestRate, rate));
  const auto value = static_cast<std::uint16_t>(rate);
  TessellationRates rates;
  rates.edges.assign(surface.edge_count(), value);
  rates.inner.assign(surface.face_count(), {value, value});
  return rates;
}

TriangleMesh tessellate(const ParametricSurface& surface, const TessellationRates& rates, FacetParameters* parameters) {
  return Tessellator(surface, rates, parameters).make();
}

TriangleMesh tessellate_uniformly(const ParametricSurface& surface, int rate) {
  return tessellate(surface, uniform_rates(surface, rate));
}

}  // namespace raytree
