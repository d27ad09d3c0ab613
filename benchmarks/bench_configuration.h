// The ways of intersecting rays that `raytree bench` compares, each with a name, and which of them by default: one
// factor at a time around the way that most renderers go.
#pragma once

#include <regex>
#include <string>
#include <vector>

#include "geometry/embree_bench_scene.h"

namespace raytree::benchmarks {

enum class BenchTracer : std::uint8_t {
  bare,  ///< Embree's calls and nothing else
  seam,  ///< the renderer's own tracer, batch by batch
  naive  ///< SphereBoundedIntersector: Whitted's, in double
};

struct BenchConfiguration {
  BenchTracer tracer = BenchTracer::bare;
  BenchSceneOptions build;  ///< of `bare`; `threads` and `stop` do not count
  BenchCall call;           ///< of `bare`
  int threads = 0;          ///< that trace; 0: those of the run

  /// "triangles/robust/medium"; "seam"; "naive".
  std::string scene_name() const;
  /// "triangles/robust/medium/8-coherent", "quads/robust/medium-compact/1", "seam", "naive"; "/1-thread" behind it
  /// where the number of threads is the configuration's own.
  std::string name() const;
};

/// What everything is compared with unless another is named: triangles, robust, medium quality, one ray a call.
inline constexpr const char* kBenchBaseline = "triangles/robust/medium/1";

/// What decides which configurations make sense.
struct BenchSubject {
  bool meshes = true;     ///< the scene has triangles
  int widest_call = 8;    ///< native packets
  int threads = 1;        ///< of the run
  double primitives = 0;  ///< that a hierarchy holds
  bool seam = true;       ///< the renderer's tracer is one of them
  bool coherent = true;   ///< the class's rays run alike: packets are followed together
};

/// The configurations of a class of rays, those of one scene_name() side by side, what matters most first. The first
/// is kBenchBaseline.
std::vector<BenchConfiguration> bench_configurations(const BenchSubject& subject);

/// The baseline's scene (the usual one where that is none of Embree's) asked by the same call: what a configuration
/// that differs in its scene is measured beside.
BenchConfiguration counterpart(const BenchConfiguration& configuration, const BenchConfiguration& baseline);

/// Chooses rows by a regular expression (ECMAScript) that is found somewhere in their names; empty: all.
class NameFilter {
 public:
  /// Throws Error (bad_input) naming --filter where the expression is none.
  explicit NameFilter(const std::string& expression);
  bool takes(const std::string& name) const;

 private:
  bool all_;
  std::regex expression_;
};

}  // namespace raytree::benchmarks
