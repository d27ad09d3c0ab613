// Which hierarchy the tracer builds: a cost model of building and tracing, from the number of rays that a picture will
// take and the memory allowed. A function of the scene, the full frame and the flags, never of threads or of a crop, so
// that pictures do not depend on those.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/embree_intersector.h"
#include "renderer/scene_description.h"

namespace raytree {

/// What was measured of one kind of hierarchy over a million triangles and more, on a processor with AVX-512 and Embree
/// 3.13.5. Of quads: where every triangle has a partner; each without one counts as two. Of grids: where every grid has
/// all its cells; each counts as the eight triangles of one that has.
///
/// Embree's highest quality, which may split triangles between nodes, is none of them: in watertight scenes the
/// hierarchy is the very one of medium quality, to the byte, also of long thin triangles across each other; in others
/// it took a sixth longer to build and was no faster (`raytree bench` compares).
struct HierarchyCost {
  const char* name;
  EmbreeOptions::Primitives primitives;
  EmbreeOptions::Quality quality;
  bool compact;
  double bytes;          ///< a triangle, Embree's and our own beside the mesh
  double build_seconds;  ///< a million triangles, one core
  double speed;          ///< of tracing, the balanced one's is 1
  /// Whether it is the same for any number of threads that build it. Embree's quick one is not where surfaces coincide:
  /// which of them a ray meets may differ. Such a kind is taken only where it is asked for by name.
  bool repeatable;
};

/// In the order of preference where times are alike.
const std::vector<HierarchyCost>& hierarchy_costs();

struct HierarchyDemand {
  std::uint64_t primitives = 0;      ///< triangles, spheres and the like, each once however often it is used
  std::uint64_t quads = 0;           ///< the same with triangles joined in pairs, estimated
  double rays = 0;                   ///< expected
  std::uint64_t memory_allowed = 0;  ///< bytes, of the hierarchy; 0: any
  /// Grids that hold the same, and points that are copied for them; 0: not known to be lattices, each triangle would be
  /// a grid of its own. (A sphere counts as one.)
  std::uint64_t grids = 0, grid_points = 0;
};

struct HierarchyChoice {
  const HierarchyCost* chosen = nullptr;
  std::string reason;  ///< one line for --verbose
};

/// Bytes that a kind of hierarchy takes, ours and Embree's, estimated.
double hierarchy_bytes(const HierarchyCost& cost, const HierarchyDemand& demand);

/// Primitives of a scene and, where they may be worth the time, those of the same with triangles joined in pairs (else:
/// as many as primitives) and as grids (else: 0). The scene's arrays must be in place.
HierarchyDemand hierarchy_demand(const ShapeSet& shapes, std::uint64_t primitives, double rays,
                                 std::uint64_t memory_allowed);

/// The kind for which building and tracing together take least time, among the repeatable ones that fit in the memory
/// allowed; the first of these, mostly the balanced one, unless another saves kLeastSaving of its time. When none fits,
/// the smallest.
HierarchyChoice choose_hierarchy(const HierarchyDemand& demand);

/// That of the name, e.g. "compact". Throws Error (bad_input) with the names there are.
HierarchyChoice hierarchy_named(const std::string& name);

inline constexpr double kLeastSaving = 0.2;

/// Rays that a full frame takes, roughly: samples of the eye by the kind of anti-aliasing, .6 of a shadow ray a light
/// each, and as much again where materials reflect or transmit.
double expected_rays(const SceneDescription& scene);

}  // namespace raytree
