#include "geometry/tessellation_error.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/facet_bound.h"
#include "geometry/facet_pattern_set.h"
#include "geometry/polynomial_rates.h"

namespace raytree {
namespace {

constexpr std::size_t kFacetsAtOnce = 128;

/// Triangles [begin, end) of one face, which start at `first` in the mesh; facets: the pattern's, as the mesh has them;
/// boundary: [boundary points] the face's own. polynomial: the face, null where it is none.
TessellationError measure(const ParametricSurface& surface, std::size_t face, const FacetPattern& pattern,
                          const std::vector<std::uint32_t>& facets, const std::vector<std::uint8_t>& hard,
                          const std::vector<SurfaceSample>& boundary, const TriangleMesh& mesh, std::size_t first,
                          std::size_t begin, std::size_t end, const TessellationView& view, double tolerance,
                          bool regular, const BezierPatch* polynomial) {
  const std::size_t sides = surface.sides(face).size();
  const FaceDomain domain = surface.domain(face);
  std::vector<Vec2f> parameters((end - begin) * kSamplesPerFacet);
  std::vector<SurfaceSample> samples(parameters.size());
  for (std::size_t f = begin; f < end; ++f) {
    const std::uint32_t* corners = &facets[3 * f];
    parameters_in_facet(
        domain, sides, {pattern.parameters[corners[0]], pattern.parameters[corners[1]], pattern.parameters[corners[2]]},
        kDenseSamples, &parameters[(f - begin) * kSamplesPerFacet]);
  }
  surface.evaluate(face, parameters, samples);
  TessellationError error;
  const SurfaceSample* sample = samples.data();
  for (std::size_t f = begin; f < end; ++f) {
    std::array<FacetCorner, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t c = 3 * (first + f) + k;
      corners[k] = {Vec3d(mesh.positions[mesh.corners[c]]),
                    Vec3d(mesh.normals[mesh.normal_corners.empty() ? mesh.corners[c] : mesh.normal_corners[c]])};
    }
    const SampledFacet facet(view, surface.origin(), corners, hard_edges(&facets[3 * f], hard));
    for (std::size_t k = 0; k < 3; ++k)
      if (const std::uint32_t point = facets[3 * f + k]; point < pattern.boundary_count)
        error.seam = std::max(error.seam, view.pixels(surface.origin() + corners[k].position,
                                                      Vec3d(boundary[point].position) - corners[k].position));
    FacetDeviation largest;
    for (const auto& weights : kDenseSamples) largest.include(facet.at(*sample++, weights));
    NormalError& normals = facet.is_small() ? error.small : regular ? error.regular : error.irregular;
    normals.include({1, largest.shading > tolerance ? 1u : 0u, largest.angle, largest.shading});
    error.largest.include(largest);
    if (polynomial == nullptr || facet.ends_surface()) continue;
    const std::uint32_t* const c = &facets[3 * f];
    const FacetBound bound(*polynomial, view, surface.origin(),
                           {pattern.parameters[c[0]], pattern.parameters[c[1]], pattern.parameters[c[2]]});
    const double most = bound.pixels(facet);
    error.proved.include({1, most > tolerance ? 1u : 0u, most, largest.pixels - most});
  }
  error.triangles = end - begin;
  error.samples = samples.size();
  return error;
}

std::vector<std::uint32_t> facets_with_area(const ParametricSurface& surface, std::size_t face,
                                            const std::vector<std::uint16_t>& rates, const FacetPattern& pattern) {
  std::vector<std::uint64_t> points;
  identify_boundary(surface.sides(face), rates, points);
  std::vector<std::uint32_t> facets;
  for (std::size_t f = 0; f < pattern.facet_count(); ++f)
    if (const auto* facet = &pattern.facets[3 * f]; !has_no_area(facet, points))
      facets.insert(facets.end(), facet, facet + 3);
  return facets;
}

TessellationError merged_errors(TessellationError a, const TessellationError& b) {
  a.include(b);
  return a;
}

}  // namespace

TessellationError measure_tessellation(const ParametricSurface& surface, const TessellationRates& rates,
                                       const TriangleMesh& mesh, const TessellationView& view, double tolerance) {
  const FacetPatternSet patterns(surface, rates);
  std::vector<std::size_t> first(surface.face_count() + 1, 0);
  std::vector<std::uint16_t> face_rates;
  for (std::size_t face = 0; face < surface.face_count(); ++face) {
    first[face + 1] = first[face];
    if (surface.sides(face).empty()) continue;
    if (has_collapsed_side(surface.sides(face))) {
      rates_of_face(surface, rates, face, face_rates);
      const FacetPattern pattern = make_facet_pattern(surface.domain(face), face_rates);
      first[face + 1] += facets_with_area(surface, face, face_rates, pattern).size() / 3;
    } else {
      first[face + 1] += patterns.counts(face).facets;
    }
  }
  using Range = tbb::blocked_range<std::size_t>;
  return tbb::parallel_reduce(
      Range(0, surface.face_count()), TessellationError(),
      [&](const Range& range, TessellationError error) {
        std::vector<std::uint16_t> own_rates;
        for (std::size_t face = range.begin(); face != range.end(); ++face) {
          if (surface.sides(face).empty()) continue;
          rates_of_face(surface, rates, face, own_rates);
          FacetPattern own;
          const FacetPattern* const kept = patterns.kept(face);
          if (kept == nullptr) own = make_facet_pattern(surface.domain(face), own_rates);
          std::vector<std::uint8_t> hard;
          find_hard_pieces(surface.sides(face), own_rates, hard);
          const FacetPattern& pattern = kept == nullptr ? own : *kept;
          std::vector<std::uint32_t> with_area;
          if (has_collapsed_side(surface.sides(face))) with_area = facets_with_area(surface, face, own_rates, pattern);
          const std::vector<std::uint32_t>& corners =
              has_collapsed_side(surface.sides(face)) ? with_area : pattern.facets;
          const bool regular = is_regular(surface, face);
          std::optional<BezierPatch> polynomial(std::in_place);
          if (!surface.polynomial_patch(face, *polynomial)) polynomial.reset();
          std::vector<SurfaceSample> boundary(pattern.boundary_count);
          surface.evaluate(face, std::span(pattern.parameters).first(pattern.boundary_count), boundary);
          ++error.faces;
          error.include(tbb::parallel_reduce(
              Range(0, corners.size() / 3, kFacetsAtOnce), TessellationError(),
              [&](const Range& facets, TessellationError so_far) {
                for (std::size_t begin = facets.begin(); begin < facets.end(); begin += kFacetsAtOnce)
                  so_far.include(measure(surface, face, pattern, corners, hard, boundary, mesh, first[face], begin,
                                         std::min(facets.end(), begin + kFacetsAtOnce), view, tolerance, regular,
                                         polynomial ? &*polynomial : nullptr));
                return so_far;
              },
              merged_errors));
        }
        return error;
      },
      merged_errors);
}

}  // namespace raytree
