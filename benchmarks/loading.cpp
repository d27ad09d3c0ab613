// Row loading: how fast mesh files are read, and in how much memory. A program of its own measures it, since the memory
// of a process is its own; its samples become figures here.
#include <nlohmann/json.hpp>

#include "benchmarks/child_process.h"
#include "benchmarks/rows.h"
#include "geometry/error.h"

namespace raytree::benchmarks {

std::vector<Figure> measure_loading(const MeasureContext& context) {
  context.progress("loading: mesh files");
  const std::filesystem::path program = context.programs / "loading_benchmark";
  const ChildResult child = run_child({program, "--json"}, context.scratch);
  require_success(child, "loading_benchmark");
  std::vector<Figure> figures;
  for (const nlohmann::json& line : nlohmann::json::parse(child.output)) {
    Figure figure;
    figure.row = "loading";
    figure.what = line.at("what");
    figure.unit = line.at("unit");
    figure.measured = spread_of(line.at("samples").get<std::vector<double>>());
    const bool at_least = line.contains("at_least");
    figure.bound = line.at(at_least ? "at_least" : "at_most");
    // A speed of at least 0 is no bound.
    if (figure.bound > 0) figure.kind = at_least ? BoundKind::at_least : BoundKind::at_most;
    figures.push_back(figure);
  }
  return figures;
}

}  // namespace raytree::benchmarks
