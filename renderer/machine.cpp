#include "renderer/machine.h"

#include <fmt/format.h>
#include <tbb/info.h>

#include <fstream>

#include "geometry/embree_intersector.h"

namespace raytree {
namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0)
      if (const std::size_t colon = line.find(": "); colon != std::string::npos) return line.substr(colon + 2);
  return "unknown";
}

std::string compiler() {
#if defined(__clang__)
  return fmt::format("clang++ {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#elif defined(__GNUC__)
  return fmt::format("g++ {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#else
  return "unknown compiler";
#endif
}

/// The widest vector instructions that the compiler was allowed to use.
const char* instruction_set() {
#if defined(__AVX512F__)
  return "AVX-512";
#elif defined(__AVX2__)
  return "AVX2";
#elif defined(__AVX__)
  return "AVX";
#elif defined(__SSE4_2__)
  return "SSE4.2";
#elif defined(__SSE2__)
  return "SSE2";
#elif defined(__ARM_NEON)
  return "NEON";
#else
  return "unknown";
#endif
}

}  // namespace

Machine machine() {
  return {processor(),       tbb::info::default_concurrency(), compiler(), RAYTREE_BUILD_TYPE,
          instruction_set(), EmbreeIntersector::version()};
}

}  // namespace raytree
