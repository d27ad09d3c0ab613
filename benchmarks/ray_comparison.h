// One ray, two answers: whether the fast tracer and the truth agree, and if not, why. A disagreement is excused only by
// what a bound of surface_bounds.h says of this ray and this surface; whatever none explains is a defect.
#pragma once

#include <array>
#include <cstdint>

#include "benchmarks/surface_bounds.h"
#include "benchmarks/surface_deviation.h"
#include "geometry/ray_intersector.h"
#include "geometry/reference_tracer.h"

namespace raytree::benchmarks {

enum class RayVerdict : std::uint8_t {
  agree,
  edge,          ///< within its bound of an edge, a vertex or a silhouette
  coplanar,      ///< two surfaces, or a surface and the ray's end, within their bounds of one distance
  grazing,       ///< so low over a surface that the sign of its slope is lost, and with it the distance
  tessellation,  ///< the truth is the limit surface, within what was asked of its facets
  nonplanar,     ///< a polygon whose corners lie in no plane: triangles on the one side, one plane on the other
  self,          ///< at the ray's origin, within the bound on the distance
  defect         ///< anything else
};
inline constexpr int kRayVerdictCount = 8;
inline constexpr std::array<const char*, kRayVerdictCount> kRayVerdictNames = {
    "agree", "edge", "coplanar", "grazing", "tessellation", "nonplanar", "self", "defect"};

/// As it was asked of the fast tracer.
struct ComparedRay {
  Vec3f origin{0}, direction{0};  ///< scene space
  float max_distance = 0;
  bool occlusion = false;
};

struct RayComparison {
  RayVerdict verdict = RayVerdict::agree;
  double distance_ulps = 0;  ///< where both hit one surface: between the two distances, in ulps of the fast one
  double edge_distance = 0;  ///< of what excuses the disagreement; see SurfaceBounds
  double edge_error = 0;
  double distance_error = 0;
  double position_error = 0;
};

/// What the two tracers are told of: `shapes` and `truth_shapes` are the same unless a test makes them differ.
class RayJudge {
 public:
  /// All must outlive it. `of_facets`, for a truth that knows what facets stand for: a judge of the same rays whose
  /// truth has the facets.
  RayJudge(const ShapeSet& shapes, const RayIntersector& tracer, const ShapeSet& truth_shapes,
           const ReferenceTracer& truth, const FacetTolerance& tolerance = {}, const RayJudge* of_facets = nullptr)
      : shapes_(shapes),
        tracer_(tracer),
        truth_shapes_(truth_shapes),
        truth_(truth),
        tolerance_(tolerance),
        of_facets_(of_facets) {}

  /// For a fast tracer that reckons otherwise than the renderer's.
  void set_arithmetic(const FastArithmetic& arithmetic) { arithmetic_ = arithmetic; }

  /// Compares nearest hits. `found`: the truth's.
  RayComparison nearest(const ComparedRay& ray, const Hit& hit, const ReferenceHit& found) const;
  /// Compares whether something is in the way.
  RayComparison occlusion(const ComparedRay& ray, bool occluded, const ReferenceHit& found) const;

  /// Whether rounding can make a tracer say that a ray's nearest hit is about `distance` away, whatever it is that it
  /// hit: closer than `share` of the distance nothing must be told apart. Infinite: that there is no hit. Of an
  /// occlusion ray any distance but infinity says that something is in the way.
  bool is_possible(const ComparedRay& ray, float distance, double share) const;

  ReferenceHit ask_truth(const ComparedRay& ray) const;
  /// The fast tracer's answer to the ray alone.
  Hit ask_tracer(const ComparedRay& ray) const;

 private:
  RayComparison nearest_on_facets(const ComparedRay& ray, const Hit& hit, const ReferenceHit& found) const;
  RayComparison deviating(const ComparedRay& ray, const Hit& hit, const ReferenceHit& found,
                          const RayComparison& otherwise) const;
  RayComparison missed(const ComparedRay& ray, const ReferenceHit& found, double end, double end_error) const;
  RayComparison extra(const ComparedRay& ray, const SurfaceBounds& bounds, const ReferenceHit& found) const;
  bool is_near_outline(const ComparedRay& ray, double begin, double end) const;
  SurfaceBounds bounds_of(const ShapeSet& shapes, const ComparedRay& ray, const SurfaceId& id, double near) const;

  const ShapeSet& shapes_;
  const RayIntersector& tracer_;
  const ShapeSet& truth_shapes_;
  const ReferenceTracer& truth_;
  FacetTolerance tolerance_;
  const RayJudge* of_facets_;
  FastArithmetic arithmetic_;
};

}  // namespace raytree::benchmarks
