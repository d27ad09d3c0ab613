// Names and sets of configurations, and the filter over names.
#include "benchmarks/bench_configuration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "geometry/error.h"

namespace raytree::benchmarks {
namespace {

std::vector<std::string> names_of(const BenchSubject& subject) {
  std::vector<std::string> names;
  for (const BenchConfiguration& configuration : bench_configurations(subject)) names.push_back(configuration.name());
  return names;
}

bool holds_name(const std::vector<std::string>& names, const char* name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

TEST(BenchConfiguration, EveryFactorIsVariedAroundTheBaseline) {
  BenchSubject subject;
  subject.threads = 2;
  const std::vector<std::string> names = names_of(subject);
  EXPECT_EQ(names.front(), kBenchBaseline);
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size()) << "names are unique";
  for (const char* name :
       {"triangles/robust/medium/4", "triangles/robust/medium/4-coherent", "triangles/robust/medium/8",
        "triangles/robust/medium/8-coherent", "triangles/robust/medium/8-coherent/1-thread", "seam",
        "triangles/plain/medium/1", "triangles/robust/medium-compact/8-coherent", "triangles/robust/low/1",
        "triangles/robust/high/1", "quads/robust/medium/1", "quads/robust/medium-compact/8-coherent",
        "grids/robust/medium/1", "triangles-and-quad/robust/medium/8-coherent",
        "triangles-and-quad-and-sphere/robust/medium/1", "naive"})
    EXPECT_TRUE(holds_name(names, name)) << name;
  EXPECT_FALSE(holds_name(names, "triangles/robust/medium/16"));
}

TEST(BenchConfiguration, WhatMakesNoSenseIsNotThere) {
  BenchSubject wide;
  wide.widest_call = 16;
  EXPECT_TRUE(holds_name(names_of(wide), "triangles/robust/medium/16-coherent"));
  EXPECT_FALSE(holds_name(names_of(wide), "triangles/robust/medium/8-coherent/1-thread")) << "one thread is all";
  // What is built otherwise is asked by the renderer's own calls, on whatever processor.
  EXPECT_TRUE(holds_name(names_of(wide), "quads/robust/medium/8-coherent"));
  EXPECT_FALSE(holds_name(names_of(wide), "quads/robust/medium/16-coherent"));
  BenchSubject spheres;
  spheres.meshes = false;
  for (const std::string& name : names_of(spheres)) EXPECT_EQ(name.find("quad"), std::string::npos) << name;
  BenchSubject large;
  large.primitives = 1e7;
  EXPECT_FALSE(holds_name(names_of(large), "naive"));
  // Rays that run apart are asked without the flag in other scenes than the baseline's.
  BenchSubject apart;
  apart.coherent = false;
  EXPECT_TRUE(holds_name(names_of(apart), "triangles/plain/medium/8"));
  EXPECT_FALSE(holds_name(names_of(apart), "triangles/plain/medium/8-coherent"));
}

TEST(BenchConfiguration, CounterpartsDifferInTheSceneAlone) {
  BenchConfiguration quads;
  quads.build.geometry = BenchGeometry::quads;
  quads.call = {8, true};
  EXPECT_EQ(counterpart(quads, BenchConfiguration()).name(), "triangles/robust/medium/8-coherent");
  BenchConfiguration plain;
  plain.build.robust = false;
  EXPECT_EQ(counterpart(quads, plain).name(), "triangles/plain/medium/8-coherent");
  plain.tracer = BenchTracer::naive;
  EXPECT_EQ(counterpart(quads, plain).name(), "triangles/robust/medium/8-coherent") << "no scene of Embree's";
}

TEST(NameFilter, FindsExpressionsAnywhereInNames) {
  EXPECT_TRUE(NameFilter("").takes("primary/naive"));
  EXPECT_TRUE(NameFilter("mary/.*/8-coherent$").takes("primary/triangles/robust/medium/8-coherent"));
  EXPECT_FALSE(NameFilter("^shadow|naive").takes("primary/seam"));
  EXPECT_TRUE(NameFilter("^shadow|naive").takes("primary/naive"));
  EXPECT_THROW(NameFilter("primary/("), Error);
}

}  // namespace
}  // namespace raytree::benchmarks
