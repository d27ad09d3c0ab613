// Files that appear whole or not at all: written and synced without a name, so that not even kill -9 leaves anything,
// then given their name; where the file system knows no nameless files, a temporary file beside the target that is
// renamed.
#include "renderer/atomic_file.h"

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
#include <vector>

#include "geometry/error.h"

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
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
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

// All of the bytes by one(at, size left); 0, or errno.
template <class One>
int write_all(const void* bytes, std::size_t size, One&& one) {
  const WriteSignalsBlocked blocked;
  const char* at = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t written = one(at, std::min<std::size_t>(size, std::size_t{1} << 30));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    if (written == 0) return ENOSPC;
    at += written;
    size -= static_cast<std::size_t>(written);
  }
  return 0;
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

std::string temporary_name(const std::string& folder) {
  return (folder == "/" ? "" : folder) + "/.raytree-" + std::to_string(::getpid()) + "-" +
         std::to_string(temporary_counter++) + ".part";
}

constexpr int kNameAttempts = 1000;  // names may be left by a process of the same number that was killed

}  // namespace

struct AtomicFile::State {
  explicit State(std::string as_named) : path(std::move(as_named)) {}

  std::string path;    // as the caller named it, for messages
  std::string target;  // what links lead to
  std::optional<struct stat> existing;
  std::string folder;
  std::string temporary;              // name of the file so far; empty: it has none
  std::optional<TemporaryName> name;  // of `temporary`
  std::optional<Descriptor> file;
  bool in_place = false;   // a device, a pipe or a descriptor: takes bytes in their order only
  std::vector<char> kept;  // what is to go to a file in place

  void open() {
    if (path == "-") return take_place(duplicate(STDOUT_FILENO));
    if (path.empty()) fail("(no name)", "cannot write", ENOENT);
    target = link_target(path);
    if (const std::optional<int> descriptor = named_descriptor(target)) return take_place(duplicate(*descriptor));
    struct stat status {};
    if (::stat(target.c_str(), &status) == 0)
      existing = status;
    else if (errno != ENOENT)
      fail(path, "cannot write", errno);
    if (existing && S_ISDIR(existing->st_mode)) fail(path, "cannot write", EISDIR);
    if (existing && !S_ISREG(existing->st_mode))
      return take_place(open_in_place(target, S_ISFIFO(existing->st_mode)), "cannot open");
    // A new file would replace one that its owner protected.
    if (existing && ::access(target.c_str(), W_OK) != 0) fail(path, "cannot write", errno);
    folder = folder_of(target);
    file.emplace(::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666));
    if (file->number() < 0) return open_beside();  // the file system knows no nameless files
    keep_mode();
  }

  /// A courtesy: file systems without modes refuse it.
  void keep_mode() const {
    if (existing && ::fchmod(file->number(), existing->st_mode & 07777) != 0) errno = 0;
  }

  static int duplicate(int descriptor) { return ::fcntl(descriptor, F_DUPFD_CLOEXEC, 0); }

  void take_place(int descriptor, const char* problem = "cannot write") {
    if (descriptor < 0) fail(path, problem, errno);
    file.emplace(descriptor);
    in_place = true;
  }

  void open_beside() {
    for (int attempt = 0;; ++attempt) {
      temporary = temporary_name(folder);
      name.emplace(temporary);
      file.emplace(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666));
      if (file->number() >= 0) break;
      if (errno != EEXIST || attempt >= kNameAttempts) fail(path, "cannot create a file in folder " + folder, errno);
    }
    name->created();
    keep_mode();
  }

  bool has_name() const { return name.has_value(); }

  /// Makes the new name outlast a power cut; the file itself is whole already, so a refusal is no failure.
  void sync_folder() const {
    const Descriptor directory(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (directory.number() >= 0 && ::fsync(directory.number()) != 0) errno = 0;
  }

  void write_in_place(const void* bytes, std::size_t size) {
    const auto one = [&](const char* at, std::size_t left) { return ::write(file->number(), at, left); };
    if (const int code = write_all(bytes, size, one)) fail(path, "cannot write", code);
  }

  /// Moves the finished file from its temporary name to its own.
  void put_in_place() {
    if (::rename(temporary.c_str(), target.c_str()) != 0) fail(path, "cannot put the finished file in place", errno);
    name->kept();
  }

  /// Gives the nameless file its name. False: the system gives it none (no /proc, no links).
  bool name_nameless() {
    const std::string source = "/proc/self/fd/" + std::to_string(file->number());
    const auto link_to = [&](const std::string& link) {
      return ::linkat(AT_FDCWD, source.c_str(), AT_FDCWD, link.c_str(), AT_SYMLINK_FOLLOW) == 0;
    };
    if (!existing && link_to(target)) return true;
    // A link replaces nothing, only a rename does: the finished file passes through a temporary name.
    for (int attempt = 0; attempt < kNameAttempts; ++attempt) {
      temporary = temporary_name(folder);
      name.emplace(temporary);
      if (!link_to(temporary)) {
        if (errno == EEXIST) continue;
        return false;
      }
      name->created();
      put_in_place();
      return true;
    }
    return false;
  }

  /// What a file without a name holds, in one that has one.
  void copy_beside() {
    const Descriptor nameless = std::move(*file);
    open_beside();
    std::vector<char> piece(std::size_t{1} << 20);
    for (std::uint64_t offset = 0;;) {
      const ssize_t count = ::pread(nameless.number(), piece.data(), piece.size(), static_cast<off_t>(offset));
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) fail(path, "cannot write", errno);
      if (count == 0) return;
      write_at(offset, piece.data(), static_cast<std::size_t>(count));
      offset += static_cast<std::uint64_t>(count);
    }
  }

  void write_at(std::uint64_t offset, const void* bytes, std::size_t size) {
    const auto one = [&](const char* at, std::size_t left) {
      const std::size_t done = static_cast<std::size_t>(at - static_cast<const char*>(bytes));
      return ::pwrite(file->number(), at, left, static_cast<off_t>(offset + done));
    };
    if (const int code = write_all(bytes, size, one)) fail(path, "cannot write", code);
  }

  void sync() {
    if (::fsync(file->number()) != 0) fail(path, "cannot write to the disk", errno);
  }

  void close() {
    if (const int code = file->close()) fail(path, "cannot write", code);
  }
};

AtomicFile::AtomicFile(const std::string& path) : state_(std::make_unique<State>(path)) { state_->open(); }

AtomicFile::~AtomicFile() = default;

void AtomicFile::write(std::uint64_t offset, const void* bytes, std::size_t size) {
  if (!state_->in_place) return state_->write_at(offset, bytes, size);
  std::vector<char>& kept = state_->kept;
  if (kept.size() < offset + size) kept.resize(offset + size);
  if (size > 0) std::memcpy(kept.data() + offset, bytes, size);
}

void AtomicFile::commit() {
  State& state = *state_;
  if (state.in_place) {
    state.write_in_place(state.kept.data(), state.kept.size());
    return state.close();
  }
  if (!state.has_name()) {
    state.sync();
    if (state.name_nameless()) return state.sync_folder();
    state.copy_beside();
  }
  state.sync();
  state.close();
  state.put_in_place();
  state.sync_folder();
}

void AtomicFile::commit_whole(const void* bytes, std::size_t size) {
  if (!state_->in_place) {
    state_->write_at(0, bytes, size);
    return commit();
  }
  state_->write_in_place(bytes, size);
  state_->close();
}

void write_file_atomically(const std::string& path, const void* bytes, std::size_t size) {
  AtomicFile(path).commit_whole(bytes, size);
}

void remove_unfinished_file() noexcept {
  const int before = errno;
  for (Slot& slot : slots)
    if (slot.state.load() == 2) ::unlink(slot.path);
  errno = before;
}

}  // namespace raytree
