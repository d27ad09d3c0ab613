// Row idle: what the parts of the renderer that a scene does not use cost it, in instructions: the same scene by the
// renderer as it is and by one that was compiled without them.
#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "benchmarks/callgrind_profile.h"
#include "benchmarks/child_process.h"
#include "benchmarks/row_bounds.h"
#include "benchmarks/rows.h"
#include "geometry/error.h"

namespace raytree::benchmarks {
namespace {

/// Instructions inside render(), the program's own and the libraries'.
struct RenderInstructions {
  std::uint64_t own = 0, total = 0;
  std::string picture;  ///< what the probe says of its picture
};

RenderInstructions count_instructions(const MeasureContext& context, const std::string& program) {
  const std::string path = context.programs / program;
  const std::filesystem::path profile = context.scratch / (program + ".callgrind");
  const ChildResult child = run_child({"valgrind", "--tool=callgrind", "--toggle-collect=raytree::render(*",
                                       "--callgrind-out-file=" + profile.string(), path},
                                      context.scratch);
  require_success(child, "valgrind on " + program);
  std::ifstream file(profile);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const InstructionCounts counts = read_callgrind_profile(text, profile.string());
  RenderInstructions result;
  result.total = counts.total;
  for (const auto& [object, cost] : counts.by_object)
    if (std::filesystem::path(object).filename() == program) result.own += cost;
  result.picture = child.output;
  return result;
}

Figure idle_figure(const char* what, std::uint64_t with, std::uint64_t without) {
  Figure figure;
  figure.row = "idle";
  figure.what = what;
  figure.unit = std::string("%");
  const double percent = 100 * (static_cast<double>(with) / static_cast<double>(without) - 1);
  figure.measured = {percent, percent, percent, without > 0 ? 1 : 0};
  figure.kind = BoundKind::at_most;
  figure.bound = kMostIdlePercent;
  figure.note = fmt::format("{:.3f} M instructions with, {:.3f} M without", static_cast<double>(with) * 1e-6,
                            static_cast<double>(without) * 1e-6);
  return figure;
}

}  // namespace

std::vector<Figure> measure_idle(const MeasureContext& context) {
  context.progress("idle: two renders under callgrind");
  const RenderInstructions with = count_instructions(context, "idle_probe");
  const RenderInstructions without = count_instructions(context, "idle_probe_minimal");
  // The bound is on one feature; all of them together keep it.
  std::vector<Figure> figures = {
      idle_figure("all features that a scene does not use together, instructions of a render, 256x256, 1 thread",
                  with.total, without.total),
      idle_figure("the same, of Raytree's own code alone, without Embree's", with.own, without.own)};
  figures.back().kind = BoundKind::none;
  if (with.picture != without.picture)
    for (Figure& figure : figures) figure.problem = "the two renderers made different pictures";
  return figures;
}

}  // namespace raytree::benchmarks
