#include "benchmarks/callgrind_profile.h"

#include <cctype>
#include <charconv>
#include <sstream>

#include "geometry/error.h"

namespace raytree::benchmarks {
namespace {

/// "(3) /path" names number 3, "(3)" alone uses the name.
std::string resolved_name(const std::string& text, std::map<std::string, std::string>& names) {
  const std::size_t end = text.find(')');
  if (text.empty() || text[0] != '(' || end == std::string::npos) return text;
  std::string& name = names[text.substr(0, end + 1)];
  if (end + 2 <= text.size()) name = text.substr(end + 2);
  return name;
}

}  // namespace

InstructionCounts read_callgrind_profile(const std::string& text, const std::string& name) {
  InstructionCounts counts;
  std::map<std::string, std::string> names;
  std::string object, line;
  bool is_profile = false, skips = false;
  std::istringstream stream(text);
  for (std::int64_t number = 1; std::getline(stream, line); ++number) {
    if (line == "events: Ir") is_profile = true;
    if (line.rfind("ob=", 0) == 0) object = resolved_name(line.substr(3), names);
    // Names of called objects share the numbering.
    if (line.rfind("cob=", 0) == 0) resolved_name(line.substr(4), names);
    // The line after "calls=" holds the cost of the call, which the callee's own lines hold already.
    if (line.rfind("calls=", 0) == 0) {
      skips = true;
      continue;
    }
    const bool is_cost = !line.empty() && (std::isdigit(static_cast<unsigned char>(line[0])) || line[0] == '+' ||
                                           line[0] == '-' || line[0] == '*');
    if (!is_cost) continue;
    if (skips) {
      skips = false;
      continue;
    }
    const std::size_t space = line.find(' ');
    if (space == std::string::npos) continue;  // a position without a cost
    std::uint64_t cost = 0;
    if (std::from_chars(line.data() + space + 1, line.data() + line.size(), cost).ec != std::errc())
      throw Error(ErrorKind::bad_input, {name, number, ""}, "no cost after the position");
    counts.total += cost;
    counts.by_object[object] += cost;
  }
  if (!is_profile) throw Error(ErrorKind::bad_input, {name, 0, ""}, "is no callgrind profile of instructions");
  return counts;
}

}  // namespace raytree::benchmarks
