// What `raytree bench` found, as text and as JSON, and beside what an earlier run found.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/bench_run.h"
#include "benchmarks/significance.h"

namespace raytree::benchmarks {

/// A row's figures in an earlier run and in this one.
struct BenchChange {
  std::string scene, row;
  Comparison speed;
  double before = 0, after = 0;  ///< medians, million rays a second
  bool same_answers = true;      ///< hits and checksum; true where not the same number of rays was traced
};

struct BenchRunReport {
  std::string program;  ///< version
  int threads = 1, repetitions = 0;
  double seconds = 0;  ///< that were set; 0: none
  std::string isa;     ///< instruction set that Embree was held to; empty: none
  std::vector<BenchReport> scenes;
  std::vector<std::string> scenes_left_out;  ///< "name: why"
  std::string before;                        ///< file of the earlier run; empty: none
  std::vector<BenchChange> changes;
  std::vector<std::string> before_warnings;  ///< in what the earlier run was another one: machine, threads
};

std::string bench_text(const BenchRunReport& report);
std::string bench_json(const BenchRunReport& report);

/// Compares with the rows of the same scene and name of a file that bench_json() wrote. Throws Error (bad_input) naming
/// the file where it is none, or has no such row.
void compare_with(BenchRunReport& report, const std::string& path);

}  // namespace raytree::benchmarks
