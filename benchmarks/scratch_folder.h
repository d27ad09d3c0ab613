// A folder for files in passing.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "geometry/error.h"

namespace raytree::benchmarks {

/// Goes with all that is in it when it ends.
class ScratchFolder {
 public:
  /// Throws Error (failure).
  ScratchFolder() {
    // mkdtemp() puts a name of its own in place of the Xs.
    std::string name = (std::filesystem::temp_directory_path() / "raytree-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw Error(ErrorKind::failure, {name, 0, ""}, "no folder for files in passing");
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace raytree::benchmarks
