// The fast tracer: Embree behind the seam. No Embree type is seen outside embree_*.cpp.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <string>

#include "geometry/few_shapes.h"
#include "geometry/ray_intersector.h"
#include "geometry/shape_set.h"

namespace raytree {

namespace embree {
struct SceneParts;  // embree_state.h
}

/// Instances from which packets without Embree's coherent flag are the fastest call for every class of rays (`./run
/// measure instances` compares).
inline constexpr std::size_t kManyInstances = 100;

struct EmbreeOptions {
  enum class Quality { low, medium, high };
  /// What the triangles of meshes are handed over as; hits name triangles either way.
  enum class Primitives {
    triangles,
    quads,  ///< pairs of them, see quad_pairs.h: built in half the time, in two thirds of the memory, at .84 of the
            ///< speed
    grids   ///< see lattice_grids.h: of lattices built in a sixth of the time, in a third of the memory, at two thirds
            ///< to .8 of the speed; of other meshes no sooner than quads, and slower to trace
  };
  int threads = 0;       ///< of the build; 0: all of the arena
  bool robust = true;    ///< watertight edges at .85-.91 of the speed
  bool compact = false;  ///< half the memory at .6 of the speed
  Quality quality = Quality::medium;
  Primitives primitives = Primitives::triangles;
  /// Up to so many spheres, and as many discs, are tested beside Embree; 0: all go to Embree. Answers do not depend on
  /// it but for rounding; benchmarks vary it.
  std::size_t most_few_shapes = kMostFewShapes;
  /// From so many instances on no packet is followed together; see follows_packets_together().
  std::size_t many_instances = kManyInstances;
  const std::atomic<bool>* stop = nullptr;  ///< ends the build early
};

class EmbreeIntersector final : public RayIntersector {
 public:
  /// Builds over shapes, which must outlive it: meshes and spheres are shared, not copied. Every index must be in range
  /// and every number finite. Throws Error (failure) with Embree's word, or "interrupted".
  EmbreeIntersector(const ShapeSet& shapes, const EmbreeOptions& options);
  ~EmbreeIntersector() override;

  void intersect(const RayBatch& rays, Coherence coherence, HitBatch& hits) const noexcept override;
  void occluded(const RayBatch& rays, Coherence coherence, std::uint8_t* occluded) const noexcept override;
  std::size_t memory_bytes() const noexcept override;
  std::size_t peak_memory_bytes() const noexcept override;

  /// One ray by Embree's single-ray calls: for recursion, which benchmarks compare with.
  Hit intersect_one(const Vec3f& origin, const Vec3f& direction, float max_distance) const noexcept;
  bool occluded_one(const Vec3f& origin, const Vec3f& direction, float max_distance) const noexcept;

  /// Whether packets of rays that run alike are followed together, with Embree's coherent flag; else every packet goes
  /// without it. A function of the scene alone.
  bool follows_packets_together() const noexcept;

  /// e.g. "Embree 3.13.5".
  static std::string version();

 private:
  friend class BareReplay;
  friend class EmbreeBenchScene;
  struct State;
  EmbreeIntersector(const ShapeSet& shapes, const EmbreeOptions& options, const embree::SceneParts& parts);
  static void throw_if_failed(State& state, const std::atomic<bool>* stop);
  /// Triangles in place of the quads or grids that Embree named.
  void name_triangles(std::size_t count, HitBatch& hits) const noexcept;
  void name_triangles_of_quads(std::size_t count, HitBatch& hits) const noexcept;
  void name_triangles_of_grids(std::size_t count, HitBatch& hits) const noexcept;
  void nearest_bounded(const RayBatch& rays, Coherence coherence, const float* max_distance,
                       HitBatch& hits) const noexcept;

  std::unique_ptr<State> state_;
};

}  // namespace raytree
