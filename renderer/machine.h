// What figures were measured on: processor, threads, compiler, kind of build, instruction set, tracer.
#pragma once

#include <string>

namespace raytree {

struct Machine {
  std::string processor;        ///< model name; "unknown" where the system does not tell
  int hardware_threads = 0;     ///< that this process may use
  std::string compiler;         ///< "g++ 12.2.0"
  std::string build_type;       ///< "Release"
  std::string instruction_set;  ///< the widest vector instructions that the compiler was allowed to use: "AVX2"
  std::string tracer;           ///< "Embree 3.13.5"
};
Machine machine();

}  // namespace raytree
