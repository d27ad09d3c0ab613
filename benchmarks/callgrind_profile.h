// Instruction counts out of a profile that callgrind wrote.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace raytree::benchmarks {

struct InstructionCounts {
  std::uint64_t total = 0;
  std::map<std::string, std::uint64_t> by_object;  ///< path of the program or library -> instructions of its own
};

/// Reads the text of a callgrind.out file with one event, instructions. Costs of called functions are not counted
/// again. Throws Error (bad_input) where the text is no such profile.
InstructionCounts read_callgrind_profile(const std::string& text, const std::string& name);

}  // namespace raytree::benchmarks
