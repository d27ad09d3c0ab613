// Files appear whole or not at all, whatever the disk, the place and the system do.
#include "renderer/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "geometry/error.h"
#include "tests/temporary_folder.h"

namespace raytree {
namespace {

using namespace test;
namespace fs = std::filesystem;

/// A folder of its own for each test.
class AtomicFileTest : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path(name); }

  TemporaryFolder folder_;
};

void write_text(const std::string& path, const std::string& text) {
  write_file_atomically(path, text.data(), text.size());
}

// The message of the failure that writing meets, or "" when it succeeds.
std::string write_error(const std::string& path, const std::string& text) {
  try {
    write_text(path, text);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::failure);
    return error.what();
  }
  return "";
}

TEST_F(AtomicFileTest, WritesAndReplaces) {
  write_text(path("a"), "first");
  EXPECT_EQ(file_text(path("a")), "first");
  fs::permissions(path("a"), fs::perms(0640));
  write_text(path("a"), "second");
  EXPECT_EQ(file_text(path("a")), "second");
  EXPECT_EQ(fs::status(path("a")).permissions(), fs::perms(0640));
  const mode_t mask = umask(027);
  write_text(path("b"), "");
  umask(mask);
  EXPECT_EQ(fs::file_size(path("b")), 0u);
  EXPECT_EQ(fs::status(path("b")).permissions(), fs::perms(0640));
  const std::string longest(255, 'x');  // a name that leaves no room for a suffix
  write_text(path(longest), "long");
  EXPECT_EQ(file_text(path(longest)), "long");
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"a", "b", longest}));
}

TEST_F(AtomicFileTest, PiecesStandOnlyOnceCommitted) {
  write_text(path("a"), "old");
  {
    AtomicFile file(path("a")), fresh(path("b"));
    file.write(0, "abcdef", 6);
    fresh.write(3, "z", 1);
    EXPECT_EQ(file_text(path("a")), "old");
    EXPECT_FALSE(fs::exists(path("b")));
  }
  EXPECT_EQ(file_text(path("a")), "old");
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"a"});
  AtomicFile file(path("a"));
  file.write(0, "abcdef", 6);
  file.write(6, "gh", 2);
  file.write(1, "BC", 2);
  file.commit();
  EXPECT_EQ(file_text(path("a")), "aBCdefgh");

  // What takes bytes in order only gets them when all are there.
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  AtomicFile in_place("/dev/fd/" + std::to_string(ends[1]));
  in_place.write(0, "....tail", 8);
  in_place.write(0, "head", 4);
  in_place.commit();
  close(ends[1]);
  char text[16] = {};
  EXPECT_EQ(read(ends[0], text, sizeof text), 8);
  EXPECT_STREQ(text, "headtail");
  close(ends[0]);
}

TEST_F(AtomicFileTest, LinksAreFollowed) {
  fs::create_directory(folder_.folder() / "deep");
  write_text(path("deep/target"), "old");
  fs::create_symlink("deep/target", folder_.folder() / "link");
  fs::create_symlink("link", folder_.folder() / "link2");
  write_text(path("link2"), "new");
  EXPECT_TRUE(fs::is_symlink(folder_.folder() / "link") && fs::is_symlink(folder_.folder() / "link2"));
  EXPECT_EQ(file_text(path("deep/target")), "new");
  fs::create_symlink("deep/later", folder_.folder() / "dangling");
  write_text(path("dangling"), "made");
  EXPECT_EQ(file_text(path("deep/later")), "made");
  fs::create_symlink("loop", folder_.folder() / "loop");
  EXPECT_TRUE(contains(write_error(path("loop"), "x"), path("loop")));
}

TEST_F(AtomicFileTest, BadTargetsAreErrorsThatSayWhy) {
  fs::create_directory(folder_.folder() / "folder");
  write_text(path("file"), "kept");
  const std::string inside = write_error(path("file/inside"), "x");
  EXPECT_TRUE(contains(inside, "Not a directory") && contains(inside, path("file/inside"))) << inside;
  const std::string missing = write_error(path("absent/a.png"), "x");
  EXPECT_TRUE(contains(missing, "No such file or directory") && contains(missing, path("absent/a.png"))) << missing;
  const std::string directory = write_error(path("folder"), "x");
  EXPECT_TRUE(contains(directory, "Is a directory")) << directory;
  EXPECT_TRUE(contains(write_error("", "x"), "No such file"));
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"file", "folder"}));
  EXPECT_EQ(file_text(path("file")), "kept");
}

TEST_F(AtomicFileTest, ProtectedPlacesAreErrors) {
  // The superuser may write anywhere, so a child without that right does it.
  write_text(path("file"), "kept");
  fs::create_directory(folder_.folder() / "locked");
  write_text(path("locked/old"), "kept");
  fs::permissions(folder_.folder(), fs::perms(0755));
  fs::permissions(folder_.folder() / "file", fs::perms(0444));
  fs::permissions(folder_.folder() / "locked", fs::perms(0555));
  const pid_t child = fork();
  if (child == 0) {
    if (geteuid() == 0 && (setgid(65534) != 0 || setuid(65534) != 0)) _exit(3);
    const bool denied = contains(write_error(path("file"), "x"), "Permission denied") &&
                        contains(write_error(path("locked/old"), "x"), "Permission denied") &&
                        contains(write_error(path("locked/new"), "x"), "Permission denied");
    _exit(denied ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  EXPECT_EQ(file_text(path("file")), "kept");
  EXPECT_EQ(file_text(path("locked/old")), "kept");
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"file", "locked"}));
  fs::permissions(folder_.folder() / "locked", fs::perms(0755));
}

TEST_F(AtomicFileTest, FullDevicesAndFileLimitsAreErrors) {
  const std::string full = write_error("/dev/full", "x");
  EXPECT_TRUE(contains(full, "No space left") && contains(full, "/dev/full")) << full;
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  write_text("/dev/null", "x");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));

  // A limit on file size raises SIGXFSZ, which kills unless it is held back.
  write_text(path("a"), "kept");
  const std::string large(100000, 'x');
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_DFL);
    const rlimit limit{4096, 4096};
    setrlimit(RLIMIT_FSIZE, &limit);
    _exit(contains(write_error(path("a"), large), "File too large") ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  EXPECT_EQ(file_text(path("a")), "kept");
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"a"});
}

TEST_F(AtomicFileTest, PipesAndDescriptorsAreWrittenInPlace) {
  const std::string text(200000, 'p');  // more than a pipe holds
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  std::string received;
  std::thread reader([&] { received = file_text(path("pipe")); });
  write_text(path("pipe"), text);
  reader.join();
  EXPECT_TRUE(received == text);
  EXPECT_TRUE(fs::is_fifo(path("pipe")));

  // A redirected output: /dev/fd/N leads to a regular file, which must be written through the descriptor.
  const int file = open(path("out").c_str(), O_RDWR | O_CREAT, 0600);
  ASSERT_EQ(write(file, "head ", 5), 5);
  struct stat before {
  }, after{};
  fstat(file, &before);
  write_text("/dev/fd/" + std::to_string(file), "one ");
  write_text("/proc/self/fd/" + std::to_string(file), "two");
  close(file);
  EXPECT_EQ(file_text(path("out")), "head one two");
  stat(path("out").c_str(), &after);
  EXPECT_EQ(before.st_ino, after.st_ino);

  // A reader that is gone: an error, not SIGPIPE.
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  close(ends[0]);
  EXPECT_TRUE(contains(write_error("/dev/fd/" + std::to_string(ends[1]), text), "Broken pipe"));
  close(ends[1]);
}

TEST_F(AtomicFileTest, StandardOutputIsADash) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDOUT_FILENO);
    close(ends[0]);
    close(ends[1]);
    write_text("-", "by dash ");
    write_text("/dev/stdout", "by name");
    _exit(0);
  }
  close(ends[1]);
  std::string text;
  char buffer[64];
  for (ssize_t n; (n = read(ends[0], buffer, sizeof buffer)) > 0;) text.append(buffer, static_cast<std::size_t>(n));
  close(ends[0]);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(text, "by dash by name");
}

TEST_F(AtomicFileTest, InterruptedAndKilledWritesLeaveWholeFiles) {
  // SIGTERM's handler removes the temporary file; SIGKILL cannot, but the target is old or new, never a part.
  const std::string old_text(1000, 'o'), new_text(1 << 20, 'n');
  for (int i = 0; i < 18; ++i) {
    write_text(path("a"), old_text);
    const int signal_number = i % 3 == 0 ? SIGKILL : SIGTERM;
    const pid_t child = fork();
    if (child == 0) {
      signal(SIGTERM, [](int) {
        remove_unfinished_file();
        _exit(143);
      });
      for (;;) write_text(path("a"), new_text);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(200 + 777 * i));
    kill(child, signal_number);
    waitpid(child, nullptr, 0);
    const std::string now = file_text(path("a"));
    EXPECT_TRUE(now == old_text || now == new_text) << now.size();
    if (signal_number == SIGTERM) {
      EXPECT_EQ(folder_.names(), std::vector<std::string>{"a"});
    } else {
      for (const std::string& name : folder_.names())
        if (name != "a") fs::remove(folder_.folder() / name);
    }
  }
}

TEST_F(AtomicFileTest, KilledWritesOfANewFileLeaveNothingBehind) {
  const int probe = open(folder_.folder().c_str(), O_TMPFILE | O_WRONLY, 0600);
  if (probe < 0)
    GTEST_SKIP() << "no nameless files in " << folder_.folder() << ": a killed write leaves its temporary file";
  close(probe);
  const std::string text(std::size_t(8) << 20, 'n');
  int unfinished = 0;
  for (int i = 0; i < 20; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      write_text(path("b"), text);
      for (;;) pause();
    }
    std::this_thread::sleep_for(std::chrono::microseconds(300 + 700 * i));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    if (fs::exists(path("b"))) {
      EXPECT_EQ(fs::file_size(path("b")), text.size());
      fs::remove(path("b"));
    } else {
      ++unfinished;
    }
    EXPECT_TRUE(folder_.names().empty()) << folder_.names().front();
  }
  EXPECT_GT(unfinished, 0) << "every write was finished before it was killed: nothing was tested";
}

}  // namespace
}  // namespace raytree
