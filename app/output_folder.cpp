#include "app/output_folder.h"

#include <filesystem>

#include "app/render_options.h"
#include "geometry/error.h"

namespace raytree::app {

std::string output_folder(const std::string& name, std::initializer_list<const char*> files) {
  namespace fs = std::filesystem;
  std::string folder = name;
  while (folder.size() > 1 && folder.back() == '/') folder.pop_back();
  std::error_code code;
  if (fs::is_directory(folder, code)) {
    for (const char* file : files) check_writable((fs::path(folder) / file).string());
  } else if (fs::exists(folder, code)) {
    throw Error(ErrorKind::bad_input, {folder, 0, ""}, "is a file; -o names a folder");
  }
  return folder;
}

}  // namespace raytree::app
