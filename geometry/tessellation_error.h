// What a tessellation claims, measured: the largest distance between its facets and the limit surface, and how far
// normals are off, found by sampling all of them densely.
#pragma once

#include <cstdint>

#include "geometry/facet_deviation.h"
#include "geometry/parametric_surface.h"
#include "geometry/tessellation.h"
#include "geometry/tessellation_view.h"

namespace raytree {

/// Of facets that are held to the same.
struct NormalError {
  std::uint64_t facets = 0;
  std::uint64_t over = 0;  ///< of these, whose shading is off by more than the tolerance
  double angle = 0;        ///< largest, radians
  double shading = 0;      ///< largest, pixels as FacetDeviation has them

  void include(const NormalError& other) {
    facets += other.facets, over += other.over;
    angle = std::max(angle, other.angle);
    shading = std::max(shading, other.shading);
  }
};

/// Distances that are proved, not sampled (FacetBound): of facets of faces that are one bicubic polynomial, but for
/// those with a hard edge, along which what points slide counts in full.
struct ProvedDistance {
  std::uint64_t facets = 0;
  std::uint64_t over = 0;  ///< of these, whose bound is over the tolerance
  double pixels = 0;       ///< the largest bound
  double exceeded = 0;     ///< pixels by which a sample of one of them lies beyond its bound, at most: rounding's

  void include(const ProvedDistance& other) {
    facets += other.facets, over += other.over;
    pixels = std::max(pixels, other.pixels), exceeded = std::max(exceeded, other.exceeded);
  }
};

struct TessellationError {
  std::uint64_t faces = 0;      ///< of the surface, without holes
  std::uint64_t triangles = 0;  ///< of the tessellation
  std::uint64_t samples = 0;    ///< points of the limit surface compared
  FacetDeviation largest;
  /// Facets of kShortestShadedEdge and more, of regular faces (see is_regular(): held to the tolerance) and of all
  /// others (to kLooseShading times as much); and smaller ones, held to as much as those.
  NormalError regular, irregular, small;
  ProvedDistance proved;  ///< in addition: the same facets are sampled
  /// Pixels between the points that faces share and each face's own: what the surface's faces disagree about where they
  /// meet, as OpenSubdiv's do at Chaikin's creases. No rates make facets better than that.
  double seam = 0;

  void include(const TessellationError& other) {
    faces += other.faces, triangles += other.triangles, samples += other.samples;
    largest.include(other.largest);
    regular.include(other.regular), irregular.include(other.irregular), small.include(other.small);
    proved.include(other.proved);
    seam = std::max(seam, other.seam);
  }
};

/// Compares each facet of `mesh`, which tessellate(surface, rates) has made, with the limit surface at kSamplesPerFacet
/// points. `tolerance`: for NormalError::over. Runs on the task arena's threads; the result does not depend on their
/// number.
TessellationError measure_tessellation(const ParametricSurface& surface, const TessellationRates& rates,
                                       const TriangleMesh& mesh, const TessellationView& view, double tolerance);

}  // namespace raytree
