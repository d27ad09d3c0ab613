// Where the third-party test data lies, and a loud word where it does not.
#pragma once

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace raytree::test {

/// Files of RAYTREE_TEST_DATA/folder, sorted; says on stderr how many there are, or that the cases are left out.
inline std::vector<std::filesystem::path> test_data_files(const std::string& folder) {
  const std::filesystem::path path = std::filesystem::path(RAYTREE_TEST_DATA) / folder;
  std::vector<std::filesystem::path> files;
  if (std::filesystem::is_directory(path))
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path))
      if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  if (files.empty())
    std::fprintf(stderr, "LEFT OUT: no test data in %s\n", path.c_str());
  else
    std::fprintf(stderr, "test data: %zu files in %s\n", files.size(), path.c_str());
  return files;
}

}  // namespace raytree::test
