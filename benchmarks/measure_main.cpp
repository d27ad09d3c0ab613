// The program `raytree_measure [ROW...] [--json FILE] [--chart FILE]`: measures the rows asked for, prints the table of
// README, and ends with status 3 when a figure falls short of its bound or a line is not expected.
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/child_process.h"
#include "benchmarks/measured_table.h"
#include "benchmarks/rows.h"
#include "benchmarks/scratch_folder.h"
#include "geometry/error.h"
#include "renderer/machine.h"

namespace {

using namespace raytree;
using namespace raytree::benchmarks;

constexpr int kSuccess = 0, kFailure = 1, kBadUsage = 2, kFallsShort = 3;

std::string row_names() {
  std::string names;
  for (const Row& row : kRows) names += (names.empty() ? "" : ", ") + std::string(row.name);
  return names;
}

std::string charted_row_names() {
  std::string names;
  for (const Row& row : kRows)
    if (row.chart_svg != nullptr) names += (names.empty() ? "" : ", ") + std::string(row.name);
  return names;
}

std::string help() {
  return "Usage: raytree_measure [ROW...] [--json FILE] [--chart FILE]\n\nMeasures the rows named, all without any: " +
         row_names() +
         "\nPrints a table; exit status 3 when a figure falls short of its bound, or is of a line that README's "
         "table\nis not checked for.\n--json writes the figures for "
         "programs, --chart the row's chart as SVG (of: " +
         charted_row_names() + ").\ndocs/benchmarks.md describes each row.\n";
}

struct Outputs {
  std::string json, chart;  ///< files; empty: none
};

/// The one row whose chart is asked for. Throws Error (bad_input) where none or several of the rows have one.
const Row& charted_row(const std::vector<const Row*>& rows) {
  const Row* found = nullptr;
  for (const Row* row : rows) {
    if (row->chart_svg == nullptr) continue;
    if (found != nullptr) throw Error(ErrorKind::bad_input, {}, "--chart takes one row that has a chart");
    found = row;
  }
  if (found == nullptr)
    throw Error(ErrorKind::bad_input, {}, "--chart: no row asked for has a chart; these have: " + charted_row_names());
  return *found;
}

void write_text(const std::string& name, const std::string& text) {
  std::ofstream file(name);
  file << text;
  if (!file.flush()) throw Error(ErrorKind::failure, {name, 0, ""}, "cannot be written");
}

/// Measuring takes minutes: that a result has no place is said before. Throws Error (bad_input).
void check_output(const char* flag, const std::string& name) {
  if (name.empty()) return;
  const bool is_new = !std::filesystem::exists(name);
  if (!std::ofstream(name, std::ios::app))
    throw Error(ErrorKind::bad_input, {name, 0, ""}, fmt::format("{}: the file cannot be written", flag));
  if (is_new) std::filesystem::remove(name);
}

/// What the figures were measured on: name and value, in the order of printing.
std::vector<std::pair<std::string, std::string>> machine_lines() {
  const Machine here = machine();
  return {{"processor", here.processor}, {"cores", std::to_string(here.hardware_threads)}, {"compiler", here.compiler},
          {"build", here.build_type},    {"instruction set", here.instruction_set},        {"tracer", here.tracer}};
}

/// A row that cannot be measured falls short: a missing program must not read as a bound that holds.
std::vector<Figure> measured(const Row& row, const MeasureContext& context) {
  try {
    return row.measure(context);
  } catch (const std::exception& error) {
    Figure figure;
    figure.row = row.name;
    figure.what = "the row could not be measured";
    figure.problem = error.what();
    for (char& c : figure.problem)
      if (c == '\n' || c == '|') c = ' ';
    return {figure};
  }
}

int measure(const std::vector<const Row*>& rows, const Outputs& outputs) {
  const Row* const charted = outputs.chart.empty() ? nullptr : &charted_row(rows);
  if (charted != nullptr && std::filesystem::path(outputs.chart).extension() != ".svg")
    throw Error(ErrorKind::bad_input, {outputs.chart, 0, ""}, "--chart writes SVG: the file's name ends in .svg");
  check_output("--chart", outputs.chart);
  check_output("--json", outputs.json);
  const ScratchFolder scratch;
  const MeasureContext context{std::filesystem::read_symlink("/proc/self/exe").parent_path(), scratch.path(),
                               [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); }};
  const auto machine = machine_lines();
  std::string header;
  for (const auto& [key, value] : machine) header += fmt::format("{}{}: {}", header.empty() ? "" : "; ", key, value);
  std::printf("%s\n\n%s", header.c_str(), table_head().c_str());
  std::fflush(stdout);

  std::vector<Figure> figures;
  std::vector<std::string> complaints;
  for (const Row* row : rows) {
    std::vector<Figure> of_row = measured(*row, context);
    for (const Figure& figure : of_row) std::printf("%s", table_line(figure).c_str());
    std::fflush(stdout);
    if (row == charted) write_text(outputs.chart, row->chart_svg(of_row));
    for (std::string& complaint : complaints_of_row(row->name, of_row)) complaints.push_back(std::move(complaint));
    figures.insert(figures.end(), std::move_iterator(of_row.begin()), std::move_iterator(of_row.end()));
  }
  std::printf("\n");
  for (const Figure& figure : figures)
    if (!figure.note.empty())
      std::printf("- %s, %s: %s\n", figure.row.c_str(), figure.what.c_str(), figure.note.c_str());

  if (!outputs.json.empty()) write_text(outputs.json, figures_json(machine, figures));
  // README is checked against the list, so the list has to be what is measured.
  for (const std::string& complaint : complaints)
    std::fprintf(stderr, "raytree_measure: not as benchmarks/expected_lines.cpp has it: %s\n", complaint.c_str());
  if (!complaints.empty()) return kFallsShort;
  for (const Figure& figure : figures)
    if (!figure.holds()) return kFallsShort;
  return kSuccess;
}

int run(const std::vector<std::string>& words) {
  if (!words.empty() && words[0] == kLaunchFlag) {
    std::printf("%s\n", launch_apart({words.begin() + 1, words.end()}).c_str());
    return kSuccess;
  }
  if (words.size() == 2 && words[0] == kBareLargeFlag) {
    std::printf("%s\n", bare_large_json(words[1]).c_str());
    return kSuccess;
  }
  if (words.size() == 1 && words[0] == kInstancesMemoryFlag) {
    std::printf("%s\n", instances_memory_json().c_str());
    return kSuccess;
  }
  std::vector<const Row*> rows;
  Outputs outputs;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--help" || words[i] == "-h") {
      std::printf("%s", help().c_str());
      return kSuccess;
    }
    if (words[i] == "--json" || words[i] == "--chart") {
      if (i + 1 == words.size()) throw Error(ErrorKind::bad_input, {}, words[i] + " takes a file name");
      std::string& file = words[i] == "--json" ? outputs.json : outputs.chart;
      file = words[++i];
      continue;
    }
    const Row* found = nullptr;
    for (const Row& row : kRows)
      if (words[i] == row.name) found = &row;
    if (found == nullptr)
      throw Error(ErrorKind::bad_input, {}, fmt::format("no row \"{}\"; rows: {}", words[i], row_names()));
    rows.push_back(found);
  }
  if (rows.empty())
    for (const Row& row : kRows) rows.push_back(&row);
  return measure(rows, outputs);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run({argv + 1, argv + argc});
  } catch (const Error& error) {
    std::fprintf(stderr, "raytree_measure: %s\n", error.what());
    return error.kind() == ErrorKind::bad_input ? kBadUsage : kFailure;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "raytree_measure: %s\n", error.what());
    return kFailure;
  }
}
