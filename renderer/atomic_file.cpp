// Files that appear whole or not at all: written and synced without a name, so that not even kill -9 leaves anything,
// then given their name; where the file system knows no nameless files, a temporary file beside the target that is
// renamed. What is not a regular file (devices, pipes, descriptors under /dev/fd) is written in place.
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "geometry/error.h"
#include "renderer/image_file.h"

namespace raytree {
namespace {

constexpr int kLinkLimit = 40;                // as the kernel's own
constexpr int kPipeWaitMilliseconds = 10000;  // for somebody to read from a named pipe

[[noreturn]] void fail(const std::string& path, const std::string& what, int code) {
  throw Error(ErrorKind::failure, {path == "-" ? "standard output" : path, 0, ""},
              what + ": " + std::string(std::strerror(code)));
}

// --- Temporary files under way, for a signal handler: fixed slots, no lock, no allocation. ---

constexpr int kSlotCount = 16;
struct Slot {
  std::atomic<int> state{0};  // 0 free, 1 being filled or emptied, 2 names a file
  char path[PATH_MAX];
};
static_assert(std::atomic<int>::is_always_lock_free);
Slot slots[kSlotCount];

// Names a temporary file to remove_unfinished_file() for as long as it lives; deletes it unless it was kept.
class TemporaryName {
 public:
  explicit TemporaryName(const std::string& path) : path_(path) {
    if (path.size() >= sizeof slots[0].path) return;
    for (Slot& slot : slots) {
      int free = 0;
      if (!slot.state.compare_exchange_strong(free, 1)) continue;
      std::memcpy(slot.path, path.c_str(), path.size() + 1);
      slot.state = 2;
      slot_ = &slot;
      return;
    }
  }
  TemporaryName(const TemporaryName&) = delete;
  TemporaryName& operator=(const TemporaryName&) = delete;
  ~TemporaryName() {
    if (created_) ::unlink(path_.c_str());
    if (slot_ != nullptr) slot_->state = 0;
  }
  void created() { created_ = true; }
  void kept() { created_ = false; }

 private:
  std::string path_;
  Slot* slot_ = nullptr;
  bool created_ = false;
};

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  int number() const { return number_; }
  /// 0, or the error that a late write met.
  int close() {
    const int result = ::close(std::exchange(number_, -1));
    return result == 0 ? 0 : errno;
  }

 private:
  int number_;
};

// SIGPIPE and SIGXFSZ kill by default; here they must become EPIPE and EFBIG. Both are sent to the writing thread, so
// blocking them there and taking back what the write raised disturbs nobody else.
class WriteSignalsBlocked {
 public:
  WriteSignalsBlocked() {
    sigemptyset(&ours_);
    sigaddset(&ours_, SIGPIPE);
    sigaddset(&ours_, SIGXFSZ);
    sigset_t pending;
    sigemptyset(&pending);
    sigpending(&pending);
    for (const int signal : {SIGPIPE, SIGXFSZ})
      if (sigismember(&pending, signal) == 1) sigdelset(&ours_, signal);  // somebody else's, stays pending
    pthread_sigmask(SIG_BLOCK, &ours_, &before_);
  }
  WriteSignalsBlocked(const WriteSignalsBlocked&) = delete;
  WriteSignalsBlocked& operator=(const WriteSignalsBlocked&) = delete;
  ~WriteSignalsBlocked() {
    const timespec now{0, 0};
    while (sigtimedwait(&ours_, nullptr, &now) > 0) {
    }
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

 private:
  sigset_t ours_, before_;
};

// 0, or errno.
int write_all(int descriptor, const void* bytes, std::size_t size) {
  const WriteSignalsBlocked blocked;
  const char* at = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t written = ::write(descriptor, at, std::min<std::size_t>(size, std::size_t{1} << 30));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    if (written == 0) return ENOSPC;
    at += written;
    size -= static_cast<std::size_t>(written);
  }
  return 0;
}

void write_to_descriptor(const std::string& path, int descriptor, const void* bytes, std::size_t size) {
  if (const int code = write_all(descriptor, bytes, size)) fail(path, "cannot write", code);
}

// The descriptor that a path such as /dev/fd/3, /proc/self/fd/3 or /dev/stdout names.
std::optional<int> named_descriptor(const std::string& path) {
  if (path == "/dev/stdout") return STDOUT_FILENO;
  if (path == "/dev/stderr") return STDERR_FILENO;
  for (const std::string& prefix :
       {std::string("/dev/fd/"), std::string("/proc/self/fd/"), "/proc/" + std::to_string(::getpid()) + "/fd/"}) {
    if (path.compare(0, prefix.size(), prefix) != 0) continue;
    int number = 0;
    const char* end = path.data() + path.size();
    const auto [stop, problem] = std::from_chars(path.data() + prefix.size(), end, number);
    if (problem == std::errc() && stop == end && number >= 0) return number;
  }
  return std::nullopt;
}

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  return slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
}

// What a chain of symbolic links ends at; the end need not exist. Stops at names of descriptors.
std::string link_target(const std::string& path) {
  std::string target = path;
  for (int i = 0; i < kLinkLimit; ++i) {
    if (named_descriptor(target)) return target;
    char text[PATH_MAX];
    const ssize_t size = ::readlink(target.c_str(), text, sizeof text);
    if (size < 0) return target;  // not a link, or not there
    const std::string next(text, static_cast<std::size_t>(size));
    target = !next.empty() && next[0] == '/' ? next : folder_of(target) + "/" + next;
  }
  fail(path, "cannot write", ELOOP);
}

// A named pipe without a reader would block for ever: waits for one a while, then says so.
int open_in_place(const std::string& path, bool pipe) {
  for (int waited = 0;; waited += 20) {
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | (pipe ? O_NONBLOCK : 0));
    if (descriptor >= 0) {
      if (pipe) ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
      return descriptor;
    }
    if (!(pipe && errno == ENXIO && waited < kPipeWaitMilliseconds)) return -1;
    const timespec pause{0, 20'000'000};
    ::nanosleep(&pause, nullptr);
  }
}

std::atomic<unsigned> temporary_counter{0};

/// What is to be written, and where.
struct Whole {
  const std::string& path;      // as the caller named it, for messages
  const std::string& target;    // what links lead to
  const struct stat* existing;  // null: there is no file yet
  const void* bytes;
  std::size_t size;
};

void fill(const Descriptor& file, const Whole& whole) {
  // Keeping the mode is a courtesy: file systems without modes refuse it.
  if (whole.existing != nullptr && ::fchmod(file.number(), whole.existing->st_mode & 07777) != 0) errno = 0;
  if (const int code = write_all(file.number(), whole.bytes, whole.size)) fail(whole.path, "cannot write", code);
  if (::fsync(file.number()) != 0) fail(whole.path, "cannot write to the disk", errno);
}

std::string temporary_name(const std::string& folder) {
  return (folder == "/" ? "" : folder) + "/.raytree-" + std::to_string(::getpid()) + "-" +
         std::to_string(temporary_counter++) + ".part";
}

constexpr int kNameAttempts = 1000;  // names may be left by a process of the same number that was killed

/// Moves a finished file from its temporary name to its own.
void put_in_place(TemporaryName& name, const std::string& temporary, const Whole& whole) {
  if (::rename(temporary.c_str(), whole.target.c_str()) != 0)
    fail(whole.path, "cannot put the finished file in place", errno);
  name.kept();
}

/// Gives the nameless file its name. False: the system gives it none (no /proc, no links); nothing is left then.
bool name_nameless(const Descriptor& file, const std::string& folder, const Whole& whole) {
  const std::string source = "/proc/self/fd/" + std::to_string(file.number());
  const auto link_to = [&](const std::string& name) {
    return ::linkat(AT_FDCWD, source.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
  };
  if (whole.existing == nullptr && link_to(whole.target)) return true;
  // A link replaces nothing, only a rename does: the finished file passes through a temporary name.
  for (int attempt = 0; attempt < kNameAttempts; ++attempt) {
    const std::string temporary = temporary_name(folder);
    TemporaryName name(temporary);
    if (!link_to(temporary)) {
      if (errno == EEXIST) continue;
      return false;
    }
    name.created();
    put_in_place(name, temporary, whole);
    return true;
  }
  return false;
}

/// False where the file system knows no nameless files.
bool write_nameless(const std::string& folder, const Whole& whole) {
  const Descriptor file(::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666));
  if (file.number() < 0) return false;
  fill(file, whole);
  return name_nameless(file, folder, whole);
}

void write_beside_and_rename(const std::string& folder, const Whole& whole) {
  for (int attempt = 0;; ++attempt) {
    const std::string temporary = temporary_name(folder);
    TemporaryName name(temporary);
    Descriptor file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666));
    if (file.number() < 0) {
      if (errno == EEXIST && attempt < kNameAttempts) continue;
      fail(whole.path, "cannot create a file in folder " + folder, errno);
    }
    name.created();
    fill(file, whole);
    if (const int code = file.close()) fail(whole.path, "cannot write", code);
    put_in_place(name, temporary, whole);
    return;
  }
}

void write_whole(const Whole& whole) {
  // A new file would replace one that its owner protected.
  if (whole.existing != nullptr && ::access(whole.target.c_str(), W_OK) != 0) fail(whole.path, "cannot write", errno);
  const std::string folder = folder_of(whole.target);
  if (!write_nameless(folder, whole)) write_beside_and_rename(folder, whole);
  // Makes the new name outlast a power cut; the file itself is whole already, so a refusal is no failure.
  const Descriptor directory(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.number() >= 0 && ::fsync(directory.number()) != 0) errno = 0;
}

}  // namespace

void write_file_atomically(const std::string& path, const void* bytes, std::size_t size) {
  if (path == "-") return write_to_descriptor(path, STDOUT_FILENO, bytes, size);
  if (path.empty()) fail("(no name)", "cannot write", ENOENT);
  const std::string target = link_target(path);
  if (const std::optional<int> descriptor = named_descriptor(target))
    return write_to_descriptor(path, *descriptor, bytes, size);

  struct stat status {};
  const bool exists = ::stat(target.c_str(), &status) == 0;
  if (!exists && errno != ENOENT) fail(path, "cannot write", errno);
  if (exists && S_ISDIR(status.st_mode)) fail(path, "cannot write", EISDIR);
  if (exists && !S_ISREG(status.st_mode)) {
    Descriptor file(open_in_place(target, S_ISFIFO(status.st_mode)));
    if (file.number() < 0) fail(path, "cannot open", errno);
    write_to_descriptor(path, file.number(), bytes, size);
    if (const int code = file.close()) fail(path, "cannot write", code);
    return;
  }
  write_whole({path, target, exists ? &status : nullptr, bytes, size});
}

void remove_unfinished_file() noexcept {
  const int before = errno;
  for (Slot& slot : slots)
    if (slot.state.load() == 2) ::unlink(slot.path);
  errno = before;
}

}  // namespace raytree
