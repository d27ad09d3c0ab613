// Which settings a chart measures.
#include "benchmarks/chart/chart_settings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "renderer/scene.h"

namespace raytree::benchmarks {
namespace {

bool names_grid(const ChartSetting& setting, int grid) {
  const std::string word = "grid:" + std::to_string(grid);
  return std::find(setting.flags.begin(), setting.flags.end(), word) != setting.flags.end();
}

TEST(ChartSettings, LeaveOutTheReferencesOwnSamples) {
  SceneTraits traits;
  traits.branches = true;
  for (int reference = 3; reference <= 8; ++reference) {
    std::set<int> grids;
    for (const ChartSetting& setting : sweep_of(traits, {}, reference))
      for (int grid = 2; grid <= 12; ++grid)
        if (names_grid(setting, grid)) grids.insert(grid);
    EXPECT_EQ(grids.count(reference), 0u) << reference;
    EXPECT_EQ(grids.count(reference + 1), 0u) << reference;
    EXPECT_GE(grids.size(), 4u) << reference;
  }
}

// The knobs, with their ends, and no other; docs/chart.md has a row for each.
TEST(ChartSettings, TurnEveryKnobOfASceneThatHasAUseForAll) {
  SceneTraits traits;
  traits.branches = traits.rough = traits.curved = traits.facets = traits.triangles = true;
  traits.sided_shapes = {"cone"};
  traits.curved = true;
  std::map<std::string, std::set<std::string>> knobs;
  for (const ChartSetting& setting : sweep_of(traits, {}, 20))
    if (setting.part == SweepPart::ends || setting.part == SweepPart::between)
      knobs[setting.knob].insert(setting.value);
  const std::map<std::string, std::vector<std::string>> expected = {
      {"antialias", {"none", "whitted", "grid:2", "grid:8"}},
      {"threshold", {"0.5", "0"}},
      {"levels", {"0", "5"}},
      {"minimum level", {"0", "2"}},
      {"depth", {"1", "64"}},
      {"cutoff", {"0.1", "0"}},
      {"rough samples", {"1", "64"}},
      {"tolerance", {"8", "0.125"}},
      {"sides", {"8", "exact"}},
      {"shading", {"flat", "gouraud", "phong", "limit"}},
      {"terminator", {"classic", "offset"}},
      {"reflections", {"classic", "clamped", "consistent"}},
      {"hierarchy", {"quick", "balanced", "quads", "compact", "compact-quads"}},
      {"edges", {"fast", "watertight"}},
      {"tracer", {"embree", "spheres"}}};
  std::ifstream file(RAYTREE_SOURCE_DIR "/docs/chart.md");
  const std::string document{std::istreambuf_iterator<char>(file), {}};
  for (const auto& [knob, values] : expected) {
    for (const std::string& value : values) EXPECT_EQ(knobs[knob].count(value), 1u) << knob << " " << value;
    EXPECT_NE(document.find(knob == "terminator"    ? "| terminator, reflections |"
                            : knob == "reflections" ? "reflections |"
                                                    : "| " + knob + " |"),
              std::string::npos)
        << knob;
  }
  EXPECT_EQ(knobs.size(), expected.size());
}

TEST(ChartSettings, BeginWithTheScenesOwnThenWhatIsAddedAndTheEndsOfKnobs) {
  const std::vector<ChartSetting> sweep = sweep_of({}, {{"--depth", "4"}}, 3);
  EXPECT_EQ(sweep.front().part, SweepPart::defaults);
  EXPECT_TRUE(std::is_sorted(sweep.begin(), sweep.end(), [](const ChartSetting& a, const ChartSetting& b) {
    return (a.part == SweepPart::crossed) < (b.part == SweepPart::crossed);
  })) << "crossed settings come last";
  EXPECT_EQ(std::count_if(sweep.begin(), sweep.end(),
                          [](const ChartSetting& setting) { return setting.part == SweepPart::added; }),
            1);
}

TEST(ChartSettings, CheapOnesComeFirst) {
  const auto setting = [](const std::string& value, SweepPart part, double rays) {
    ChartSetting made{"knob", value, {}, part};
    made.expected_rays = rays;
    return made;
  };
  std::vector<ChartSetting> settings{setting("naive", SweepPart::ends, 0),      setting("dear", SweepPart::ends, 100),
                                     setting("middle", SweepPart::between, 30), setting("other", SweepPart::ends, 50),
                                     setting("cheap", SweepPart::ends, 10),     setting("added", SweepPart::added, 999),
                                     setting("own", SweepPart::defaults, 20),   setting("like", SweepPart::ends, 10)};
  settings.insert(settings.begin(), setting("late", SweepPart::between, 0));
  settings.front().dearness = 0.5;
  sort_cheap_first(settings);
  std::string order;
  for (const ChartSetting& s : settings) order += s.value + " ";
  EXPECT_EQ(order, "own added cheap like other middle dear naive late ") << "30 between two ends count as 60";
}

// Grids are what meshes of lattices may be handed over as; of others they would be pairs.
TEST(ChartSettings, TryGridsWhereAMeshIsALattice) {
  const auto tries_grids = [](const SceneTraits& traits) {
    const std::vector<ChartSetting> sweep = sweep_of(traits, {}, 3);
    return std::any_of(sweep.begin(), sweep.end(), [](const ChartSetting& setting) {
      return setting.knob == "hierarchy" && setting.value == "grids";
    });
  };
  SceneTraits traits;
  traits.triangles = true;
  EXPECT_FALSE(tries_grids(traits));
  traits.lattices = true;
  EXPECT_TRUE(tries_grids(traits));

  const auto traits_of = [](const ShapeKind& kind) {
    SceneDescription scene;
    scene.cameras.resize(1);
    scene.shapes.resize(1);
    scene.shapes[0].kind = kind;
    Warnings warnings;
    return scene_traits(prepare(std::move(scene), PrepareOptions(), warnings));
  };
  TerrainShape terrain;
  terrain.triangles = 2000;
  EXPECT_TRUE(traits_of(terrain).lattices);
  EXPECT_FALSE(traits_of(SphereShape()).lattices);
}

}  // namespace
}  // namespace raytree::benchmarks
