// The documentation of the command line, which tests hold to what the program does.
#pragma once

#include <string>

#include "tests/app/program.h"

namespace raytree::test {

/// The part of the documentation under "## raytree NAME".
inline std::string documentation_of(const std::string& command) {
  const std::string text = file_text(RAYTREE_SOURCE_DIR "/docs/command-line.md");
  const std::size_t begin = text.find("## raytree " + command + "\n");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find("\n## ", begin + 1) - begin);
}

}  // namespace raytree::test
