// What the figures were measured on.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace raytree::benchmarks {

/// Processor, cores, compiler, kind of build, instruction set, Embree: name and value, in the order of printing.
std::vector<std::pair<std::string, std::string>> machine_lines();

}  // namespace raytree::benchmarks
