// The folder that -o names for a command that writes several files.
#pragma once

#include <initializer_list>
#include <string>

namespace raytree::app {

/// The folder's name without slashes behind it. Where it exists, each of the files (names within it) must be such that
/// it can be made or replaced. Nothing is left behind. Throws Error naming the folder or the file: bad_input where a
/// file stands in the folder's place or a folder in a file's, failure where the system refuses.
std::string output_folder(const std::string& name, std::initializer_list<const char*> files);

}  // namespace raytree::app
