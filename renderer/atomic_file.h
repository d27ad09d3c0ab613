// Files that appear whole or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace raytree {

/// A file in the making: it stands at its path when commit() returns, and not before; without commit() nothing is left
/// of it. Written into a file without a name (O_TMPFILE; where that is not to be had, a temporary file beside the
/// target), synced, then named; links are followed and the mode of an existing file is kept. "-" is standard output;
/// devices, pipes and /dev/fd/N are written in place, by commit(). An existing file stays as it was when anything
/// fails. All throw Error (failure) with the path and the system's reason.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Bytes [offset, offset + size) of the file. What was written there before is replaced.
  void write(std::uint64_t offset, const void* bytes, std::size_t size);

  /// Once, last.
  void commit();

  /// Instead of both: the file consists of these bytes.
  void commit_whole(const void* bytes, std::size_t size);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A whole AtomicFile of these bytes.
void write_file_atomically(const std::string& path, const void* bytes, std::size_t size);

/// Removes the temporary files of writes under way, if any. Async-signal-safe: for the handler of an interruption.
void remove_unfinished_file() noexcept;

}  // namespace raytree
