// A scene of Embree's alone that can be built in every way that benchmarks compare, and asked by every call: packets
// are filled and read outside the clock. Everything that bounds hold is Embree's here; planes are not in it.
#pragma once

#include <Imath/ImathBox.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "geometry/embree_intersector.h"
#include "geometry/ray_batch.h"

namespace raytree {

/// What the triangles of meshes are handed over as.
enum class BenchGeometry : std::uint8_t { triangles, quads, grids };
inline constexpr std::size_t kBenchGeometryCount = 3;

/// A shape of another type that stands beside the meshes, too small to be met by more than a stray ray: what its
/// hierarchy costs all others.
enum class BenchCompany : std::uint8_t { none, quad, quad_and_sphere };

/// Instruction sets that Embree has kernels of.
inline constexpr const char* kEmbreeIsas[] = {"sse2", "sse4.2", "avx", "avx2", "avx512"};

struct BenchSceneOptions {
  BenchGeometry geometry = BenchGeometry::triangles;
  BenchCompany company = BenchCompany::none;
  bool robust = true, compact = false;
  EmbreeOptions::Quality quality = EmbreeOptions::Quality::medium;
  int threads = 0;                          ///< of the build; 0: all of the arena
  const std::atomic<bool>* stop = nullptr;  ///< ends the build early
  std::string isa;                          ///< one of kEmbreeIsas that Embree is held to; empty: the processor's best
};

/// rtcIntersect1, 4, 8 or 16, with Embree's coherent flag or without.
struct BenchCall {
  int width = 1;
  bool coherent = false;
};

class EmbreeBenchScene {
 public:
  /// Over shapes, which must outlive it. Throws Error as EmbreeIntersector does, and where the processor lacks the
  /// instruction set.
  EmbreeBenchScene(const ShapeSet& shapes, const BenchSceneOptions& options);
  ~EmbreeBenchScene();

  /// Embree's own time: what prepares quads and grids is not in it.
  double build_seconds() const noexcept { return build_seconds_; }
  std::size_t memory_bytes() const noexcept;       ///< Embree's own, less the arrays that it shares
  std::size_t peak_memory_bytes() const noexcept;  ///< while it was built
  /// Triangles a primitive handed over, in the mean; 1 for triangles, 2 at most for quads, 128 for grids.
  double triangles_per_primitive() const noexcept { return triangles_per_primitive_; }

  /// Width of the largest packets that Embree has calls of its own for on this processor, held to an instruction set
  /// if one is named: 1, 4, 8 or 16.
  static int widest_call(const std::string& isa = {});

  /// Whether Embree's triangles are others than the meshes': grids halve their quads their own way.
  bool has_own_surface() const noexcept;
  /// Embree's triangles; shapes are numbered as those of the scene.
  ShapeSet surface() const;
  /// What holds the shapes that keep company; empty where none do.
  Imath::Box3f company_bounds() const noexcept;

  /// The batch's nearest hits, in Embree's own numbers of geometry and primitive; returns the seconds that
  /// the thread ran inside the calls.
  /// Rays that no Embree may have (not finite, no direction) miss.
  double intersect(const RayBatch& rays, BenchCall call, HitBatch& hits) const noexcept;
  /// 1 for rays that something stops, else 0. Packets of 16 lose their coherent flag where Embree would not come back.
  double occluded(const RayBatch& rays, BenchCall call, std::uint8_t* occluded) const noexcept;

 private:
  struct Parts;
  const ShapeSet& shapes_;
  std::unique_ptr<const Parts> parts_;  ///< arrays that Embree shares: before the tracer, so that they outlive it
  std::unique_ptr<const EmbreeIntersector> tracer_;
  double build_seconds_ = 0, triangles_per_primitive_ = 1;
  bool compact_ = false;
};

}  // namespace raytree
