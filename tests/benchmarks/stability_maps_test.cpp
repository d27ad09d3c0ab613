// Inside the envelope that docs/stability.md states no ray hits the surface that it left, and none misses or is told of
// a surface that is not there but where the docs say so.
#include "benchmarks/stability/stability_maps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/sanitized.h"
#include "benchmarks/stability/heat_map_svg.h"

namespace raytree::benchmarks {
namespace {

StabilityRun small_map_run() {
  StabilityRun run;
  run.effort = 0.01;
  return run;
}

/// Made once: several tests look at them.
const std::vector<StabilityMap>& small_maps() {
  static const std::vector<StabilityMap> maps = stability_maps(small_map_run());
  return maps;
}

std::string stability_document() {
  std::ifstream file(RAYTREE_SOURCE_DIR "/docs/stability.md");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(StabilityMaps, KeepWhatTheDocumentPromises) {
  const std::string document = stability_document();
  EXPECT_EQ(small_maps().size(), 5u);
  for (const StabilityMap& map : small_maps()) {
    EXPECT_NE(document.find(map.promise), std::string::npos) << "docs/stability.md does not say: " << map.promise;
    for (const std::string& broken : broken_promises(map)) ADD_FAILURE() << broken;
  }
}

TEST(StabilityMaps, KeepItWithAllTheirRays) {
  StabilityRun run;
  run.effort = kAddressSanitized ? 0.1 : 1;
  for (const StabilityMap& map : stability_maps(run)) {
    EXPECT_GE(map.rays, kAddressSanitized ? 400u : 4000u);
    for (const std::string& broken : broken_promises(map)) ADD_FAILURE() << broken;
    const std::size_t corners = map.rows.values.size();
    if (map.name == "edges-corners" && !kAddressSanitized)
      for (std::size_t column = 0; column < map.columns.values.size(); ++column)
        std::printf("misses at corners, %s triangles: %.2g\n", map.columns.values[column].c_str(),
                    map.quantities[0].rates[map.cell(corners - 1, column)]);
  }
}

TEST(StabilityMaps, PromiseSomethingOfEveryQuantityAndHaveCellsBeyond) {
  std::size_t self_hits_promised = 0, beyond = 0;
  for (const StabilityMap& map : small_maps()) {
    const std::size_t cells = map.rows.values.size() * map.columns.values.size();
    EXPECT_GE(cells, 25u);
    for (const MapQuantity& quantity : map.quantities) {
      ASSERT_EQ(quantity.rates.size(), cells);
      ASSERT_EQ(quantity.promised.size(), cells);
      std::size_t promised = 0;
      for (const double most : quantity.promised) promised += !std::isnan(most);
      EXPECT_GT(promised, cells / 4) << map.name << " " << quantity.name;
      beyond += cells - promised;
      if (quantity.name == "self-hits") self_hits_promised += promised == cells;
    }
    EXPECT_FALSE(map.envelope.empty());
  }
  // Of no size below 1e-9 units: all other maps promise it everywhere.
  EXPECT_EQ(self_hits_promised, small_maps().size() - 1);
  EXPECT_GT(beyond, 0u);
}

/// Maps whose promise is broken once a fault is planted.
std::string broken_by(const StabilityFaults& faults) {
  StabilityRun run = small_map_run();
  run.faults = faults;
  std::string names;
  for (const StabilityMap& map : stability_maps(run))
    if (!broken_promises(map).empty()) names += map.name + " ";
  return names;
}

TEST(StabilityMaps, ShowOffsetsThatAreNotThere) {
  StabilityFaults faults;
  faults.no_offsets = true;
  EXPECT_EQ(broken_by(faults), "scale-offset grazing-distance slab-offset index-critical edges-corners ");
}

TEST(StabilityMaps, ShowATracerThatIsNotRobust) {
  StabilityFaults faults;
  faults.not_robust = true;
  EXPECT_NE(broken_by(faults).find("edges-corners"), std::string::npos);
}

/// Two rows, three columns: clean everywhere, and up to the first column.
StabilityMap example_map() {
  StabilityMap map;
  map.name = "example";
  map.title = "A <title>";
  map.rays = 100;
  map.rows = {"size", {"1", "10"}};
  map.columns = {"place", {"0", "5", "6"}};
  map.quantities = {{"misses", {0, 0, kNothingPromised, 0, 0.25, 0}, {0, 0, 0, 0, 0, kNothingPromised}}};
  return map;
}

TEST(StabilityMaps, SayHowFarTheyAreClean) {
  EXPECT_EQ(clean_envelope(example_map()),
            "No miss, false hit or self-hit of 100 rays a cell (size: place): 1: everywhere; 10: 0 to 0.");
  EXPECT_EQ(broken_promises(example_map()),
            (std::vector<std::string>{"example: misses at size 10, place 5: 0.25 instead of 0"}));
}

TEST(StabilityMaps, AreDrawnWithAFigureInEachCell) {
  const StabilityMap map = example_map();
  const std::string svg = heat_map_svg(map, 0);
  const auto count = [&](const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = svg.find(part); at != std::string::npos; at = svg.find(part, at + 1)) ++found;
    return found;
  };
  EXPECT_EQ(count("<rect"), 6u);
  EXPECT_EQ(count(">.25<"), 1u);
  EXPECT_EQ(count("stroke-width=\"3\""), 1u) << "the broken promise stands out";
  EXPECT_EQ(count("var(--good"), 4u) << "promised and kept";
  EXPECT_EQ(count("A &lt;title&gt;"), 1u);
  EXPECT_NE(stability_map_html(map).find("example: misses at size 10"), std::string::npos);
}

TEST(StabilityMaps, AreJsonWithTheirCells) {
  const auto json = nlohmann::json::parse(stability_maps_json({example_map()}));
  EXPECT_EQ(json[0]["quantities"][0]["rates"][4], 0.25);
  EXPECT_TRUE(json[0]["quantities"][0]["rates"][2].is_null());
  EXPECT_EQ(json[0]["broken"].size(), 1u);
}

}  // namespace
}  // namespace raytree::benchmarks
