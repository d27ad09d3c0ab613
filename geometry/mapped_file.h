// A file's bytes, mapped into memory where the system can (regular files), read into memory otherwise (pipes).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace raytree {

/// Read-only. The mapping lives as long as the object; a file that another program shortens meanwhile is lost (SIGBUS).
class MappedFile {
 public:
  /// Throws Error (bad_input) naming the file when it cannot be opened or read.
  explicit MappedFile(const std::string& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::string_view bytes() const { return bytes_; }
  bool is_mapped() const { return mapping_ != nullptr; }

 private:
  std::string_view bytes_;
  void* mapping_ = nullptr;
  std::vector<char> read_;
};

}  // namespace raytree
