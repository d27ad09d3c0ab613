// What a chart sweeps: settings, each the words that `raytree render` takes for it. What is rendered is parsed from
// those very words, so that a point's command line and its picture cannot disagree.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "renderer/scene.h"
#include "renderer/scene_description.h"

namespace raytree::benchmarks {

using Words = std::vector<std::string>;

/// Words as a shell reads them back: quoted where they must be.
std::string command_text(const Words& words);

/// What flags make of a scene: all that a render depends on.
struct ChartScene {
  SceneDescription description;
  PrepareOptions prepare;
};

/// Reads the charted scene under the flags that the whole chart has (size, camera, --set...) and these ones behind
/// them.
using ChartSceneMaker = std::function<ChartScene(const Words& flags)>;

enum class SweepPart : std::uint8_t {
  defaults,  ///< the scene as it is
  ends,      ///< one knob turned to its cheapest or dearest value
  between,   ///< one knob turned to another value
  added,     ///< given by the user
  crossed    ///< several knobs turned
};

struct ChartSetting {
  std::string knob;   ///< "antialias"; "defaults", "crossed", "added"
  std::string value;  ///< as the table shows it: "grid:4"
  Words flags;        ///< behind those of the whole chart
  SweepPart part = SweepPart::between;
  double expected_rays = 0;  ///< of its picture, by a small one; 0: not known
  double dearness = 0;       ///< place among the values of its knob: 0 the cheapest, 1 the dearest
};

/// What a scene has that knobs could turn.
struct SceneTraits {
  bool facets = false;     ///< something is shaded in one of the four ways
  bool curved = false;     ///< something is tessellated
  bool triangles = false;  ///< the tracer holds a hierarchy of them
  bool lattices = false;   ///< and some mesh of them may be one, see may_be_lattices()
  bool branches = false;   ///< something reflects or transmits
  bool rough = false;
  std::vector<std::string> sided_shapes;  ///< names of round shapes made of facets
  RenderSettings render;

  /// Whether facets stand for a surface that the reference can show.
  bool knows_surface() const { return curved || !sided_shapes.empty(); }
};
SceneTraits scene_traits(const Scene& scene);

/// All settings, in the order in which they are to be measured: the defaults, what the user adds, the ends of each
/// knob, the values between, a crossed set that covers the space evenly from its first members on. Each knob from cheap
/// to dear. Grids of `reference_grid` and one more samples an edge are left out: a picture with the reference's own
/// samples would be nearer to it than to the truth.
std::vector<ChartSetting> sweep_of(const SceneTraits& traits, const std::vector<Words>& added, int reference_grid);

/// The order in which a budget sees most of the knobs: the defaults, what the user adds, then by expected rays, where
/// values between the ends of a knob count as twice as dear as they are. Then come those whose rays are not known, by
/// their places among the values of their knobs.
void sort_cheap_first(std::vector<ChartSetting>& settings);

/// Flags of the reference: limit normals, finest facets; depth, cutoff and samples are chart_reference.h's to say.
Words reference_surface_flags(const SceneTraits& traits, double tolerance);

/// What tells two renders of one scene apart: settings and tracer, as text.
std::string render_key(const ChartScene& scene);

/// 16 hexadecimal digits over all that the scene's picture depends on: description, meshes, and the files that it
/// names.
std::string scene_hash(const ChartScene& scene);
/// 16 hexadecimal digits of a text (FNV-1a).
std::string text_hash(const std::string& text);

}  // namespace raytree::benchmarks
