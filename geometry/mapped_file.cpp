// Mapping and reading of whole files through POSIX calls.
#include "geometry/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "geometry/error.h"

namespace raytree {
namespace {

struct Descriptor {
  int number = -1;
  explicit Descriptor(int n) : number(n) {}
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
};

[[noreturn]] void throw_cannot(const std::string& what, const std::string& path, int error) {
  throw Error(ErrorKind::bad_input, {path, 0, {}}, "cannot " + what + ": " + std::generic_category().message(error));
}

}  // namespace

MappedFile::MappedFile(const std::string& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.number < 0) throw_cannot("open", path, errno);
  struct stat status {};
  if (::fstat(file.number, &status) != 0) throw_cannot("read", path, errno);
  if (S_ISDIR(status.st_mode)) throw_cannot("read", path, EISDIR);
  if (S_ISREG(status.st_mode) && status.st_size > 0) {
    const auto size = static_cast<std::size_t>(status.st_size);
    void* const mapping = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.number, 0);
    if (mapping != MAP_FAILED) {
      ::madvise(mapping, size, MADV_WILLNEED);
      mapping_ = mapping;
      bytes_ = {static_cast<const char*>(mapping), size};
      return;
    }
  }
  constexpr std::size_t kStep = std::size_t(1) << 20;
  std::size_t size = 0;
  for (;;) {
    if (read_.size() < size + kStep) read_.resize(size + size / 2 + kStep);
    const ssize_t count = ::read(file.number, read_.data() + size, read_.size() - size);
    if (count < 0) {
      if (errno == EINTR) continue;
      throw_cannot("read", path, errno);
    }
    if (count == 0) break;
    size += static_cast<std::size_t>(count);
  }
  bytes_ = {read_.data(), size};
}

MappedFile::~MappedFile() {
  if (mapping_) ::munmap(mapping_, bytes_.size());
}

}  // namespace raytree
