// The plan (tessellation_plan.h) numbers every point, normal and triangle before any is made. Then faces are evaluated
// and written in any order, each straight to its place.
#include "geometry/tessellation.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <vector>

#include "geometry/error.h"
#include "geometry/tessellation_plan.h"

namespace raytree {
namespace {

constexpr std::size_t kPointsAtOnce = 4096;  ///< evaluated in one call; a larger face goes in several, side by side

class Tessellator {
 public:
  Tessellator(const ParametricSurface& surface, const TessellationRates& rates, FacetParameters* parameters)
      : surface_(surface), rates_(rates), facet_parameters_(parameters), plan_(surface, rates) {}

  TriangleMesh make();

 private:
  struct Scratch;

  void make_face(std::size_t face, Scratch& scratch);
  void evaluate_boundary(std::size_t face, const FacetPattern& pattern, Scratch& scratch);
  void evaluate_inside(std::size_t face, const FacetPattern& pattern, std::size_t begin, std::size_t end);
  void write_point(std::size_t point, const SurfaceSample& sample, std::size_t face) {
    if (const Vec3f& p = sample.position; !(p.x * 0 + p.y * 0 + p.z * 0 == 0)) note_bad_face(face);
    mesh_.positions[point] = sample.position;
    mesh_.normals[point] = sample.normal;
  }
  void write_facets(std::size_t face, const FacetPattern& pattern, const Scratch& scratch);
  void note_bad_face(std::size_t face) {
    std::size_t current = first_bad_face_.load(std::memory_order_relaxed);
    while (face < current && !first_bad_face_.compare_exchange_weak(current, face, std::memory_order_relaxed)) {
    }
  }

  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  const ParametricSurface& surface_;
  const TessellationRates& rates_;
  FacetParameters* facet_parameters_;  ///< null: not wanted
  TessellationPlan plan_;
  std::atomic<std::size_t> first_bad_face_{kNone};
  TriangleMesh mesh_;
};

/// What one task keeps from face to face.
struct Tessellator::Scratch {
  FacetPattern pattern;  ///< of a face whose pattern is not kept
  BoundaryNumbers boundary;
  std::vector<std::uint32_t> wanted;  ///< those of the boundary that are evaluated here
  std::vector<Vec2f> parameters;
  std::vector<SurfaceSample> samples;
  std::vector<Vec2f> textures;
};

TriangleMesh Tessellator::make() {
  const TessellationCounts& total = plan_.total();
  mesh_.origin = surface_.origin();
  mesh_.positions.resize(total.points);
  mesh_.normals.resize(total.points + total.normals);
  mesh_.corners.resize(3 * total.triangles);
  mesh_.triangle_faces.resize(total.triangles);
  if (total.normals > 0) mesh_.normal_corners.resize(3 * total.triangles);
  if (facet_parameters_ != nullptr) {
    facet_parameters_->faces.resize(total.triangles);
    facet_parameters_->corners.resize(3 * total.triangles);
  }
  if (surface_.has_texture()) {
    mesh_.texture_coordinates.resize(total.points + total.textures);
    if (total.textures > 0) mesh_.texture_corners.resize(3 * total.triangles);
  }
  // A few faces of many points are as good for many threads as many faces of a few.
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, surface_.face_count()), [&](const auto& range) {
    Scratch scratch;
    for (std::size_t face = range.begin(); face != range.end(); ++face) make_face(face, scratch);
  });
  if (first_bad_face_ != kNone)
    throw Error(ErrorKind::bad_input, {},
                fmt::format("the surface is not finite in face {}", surface_.source_face(first_bad_face_) + 1));
  return std::move(mesh_);
}

void Tessellator::make_face(std::size_t face, Scratch& scratch) {
  if (surface_.sides(face).empty()) return;
  const FacetPattern& pattern = plan_.pattern(face, scratch.pattern);
  plan_.number_boundary(face, scratch.boundary);
  const std::size_t begin = pattern.boundary_count, end = pattern.parameters.size();
  evaluate_boundary(face, pattern, scratch);
  if (end - begin > kPointsAtOnce)
    tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, kPointsAtOnce), [&](const auto& range) {
      for (std::size_t first = range.begin(); first < range.end(); first += kPointsAtOnce)
        evaluate_inside(face, pattern, first, std::min(range.end(), first + kPointsAtOnce));
    });
  write_facets(face, pattern, scratch);
}

/// What this face evaluates of its boundary and, unless that is large, its inside, in one call; of its boundary's
/// texture coordinates all.
void Tessellator::evaluate_boundary(std::size_t face, const FacetPattern& pattern, Scratch& scratch) {
  const BoundaryNumbers& boundary = scratch.boundary;
  scratch.wanted.clear();
  scratch.parameters.clear();
  for (std::uint32_t i = 0; i < pattern.boundary_count; ++i)
    if (boundary.owned[i] || boundary.normal[i] != boundary.point[i]) {
      scratch.wanted.push_back(i);
      scratch.parameters.push_back(pattern.parameters[i]);
    }
  const std::size_t inside = pattern.parameters.size() - pattern.boundary_count;
  const bool together = inside <= kPointsAtOnce;
  if (together)
    scratch.parameters.insert(scratch.parameters.end(), pattern.parameters.begin() + pattern.boundary_count,
                              pattern.parameters.end());
  if (scratch.samples.size() < scratch.parameters.size()) scratch.samples.resize(scratch.parameters.size());
  const std::span<SurfaceSample> samples(scratch.samples.data(), scratch.parameters.size());
  if (!samples.empty()) surface_.evaluate(face, scratch.parameters, samples);
  for (std::size_t k = 0; k < scratch.wanted.size(); ++k) {
    const std::uint32_t i = scratch.wanted[k];
    if (boundary.owned[i]) write_point(boundary.point[i], samples[k], face);
    if (boundary.normal[i] != boundary.point[i]) mesh_.normals[boundary.normal[i]] = samples[k].normal;
  }
  const std::size_t first = plan_.first(face).points;
  for (std::size_t i = scratch.wanted.size(); i < samples.size(); ++i)
    write_point(first + i - scratch.wanted.size(), samples[i], face);

  if (!surface_.has_texture()) return;
  scratch.textures.resize(pattern.boundary_count + (together ? inside : 0));
  surface_.evaluate_texture(face, std::span(pattern.parameters).first(scratch.textures.size()), scratch.textures);
  for (std::size_t i = 0; i < pattern.boundary_count; ++i)
    mesh_.texture_coordinates[boundary.texture[i]] = scratch.textures[i];
  std::copy(scratch.textures.begin() + pattern.boundary_count, scratch.textures.end(),
            mesh_.texture_coordinates.begin() + static_cast<std::ptrdiff_t>(first));
}

/// Points [begin, end) of the pattern, all inside.
void Tessellator::evaluate_inside(std::size_t face, const FacetPattern& pattern, std::size_t begin, std::size_t end) {
  std::vector<SurfaceSample> samples(end - begin);
  const std::span<const Vec2f> parameters = std::span(pattern.parameters).subspan(begin, end - begin);
  surface_.evaluate(face, parameters, samples);
  const std::size_t first = plan_.first(face).points + (begin - pattern.boundary_count);
  for (std::size_t i = 0; i < samples.size(); ++i) write_point(first + i, samples[i], face);
  if (surface_.has_texture())
    surface_.evaluate_texture(face, parameters, std::span(mesh_.texture_coordinates).subspan(first, end - begin));
}

void Tessellator::write_facets(std::size_t face, const FacetPattern& pattern, const Scratch& scratch) {
  const TessellationCounts& plan = plan_.first(face);
  const std::uint32_t boundary = pattern.boundary_count,
                      inside = static_cast<std::uint32_t>(plan.points) - boundary;  // wraps around, and back
  const bool collapsed = has_collapsed_side(surface_.sides(face));
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
    std::uint32_t* out = corners.data() + 3 * plan.triangles;
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
  write(mesh_.corners, scratch.boundary.point);
  write(mesh_.normal_corners, scratch.boundary.normal);
  write(mesh_.texture_corners, scratch.boundary.texture);
  std::fill_n(mesh_.triangle_faces.begin() + static_cast<std::ptrdiff_t>(plan.triangles), facets.size() / 3,
              surface_.source_face(face));
  if (facet_parameters_ == nullptr) return;
  std::fill_n(facet_parameters_->faces.begin() + static_cast<std::ptrdiff_t>(plan.triangles), facets.size() / 3,
              static_cast<std::uint32_t>(face));
  Vec2f* out = facet_parameters_->corners.data() + 3 * plan.triangles;
  for (const std::uint32_t point : facets) *out++ = pattern.parameters[point];
}

}  // namespace

bool has_collapsed_side(std::span<const FaceEdge> sides) {
  return std::any_of(sides.begin(), sides.end(), [](const FaceEdge& side) { return side.collapsed; });
}

void identify_boundary(std::span<const FaceEdge> sides, std::span<const std::uint16_t> rates,
                       std::vector<std::uint64_t>& points) {
  points.clear();
  if (!has_collapsed_side(sides)) return;
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
