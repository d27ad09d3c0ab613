// A file system that really fills up: a small tmpfs in a mount namespace of the test's own.
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <functional>

#include "renderer/image_file.h"
#include "tests/app/program.h"

namespace raytree::test {
namespace {

constexpr int kNotPermitted = 77;

/// Runs `check` in a process that sees an empty tmpfs at `folder`; nobody else sees it, and it goes with the process.
/// Returns that process's exit status: 0 when nothing failed, kNotPermitted where mounting is not allowed.
int with_small_file_system(const std::string& folder, const std::string& options, const std::function<void()>& check) {
  const pid_t child = fork();
  if (child == 0) {
    if (unshare(CLONE_NEWNS) != 0 || mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        mount("raytree_test", folder.c_str(), "tmpfs", 0, options.c_str()) != 0) {
      std::fprintf(stderr, "mounting a tmpfs: %s\n", std::strerror(errno));
      _exit(kNotPermitted);
    }
    check();
    std::fflush(nullptr);
    _exit(testing::Test::HasFailure() ? 1 : 0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void expect_failure(const ProgramResult& result, const std::string& path, const std::string& reason) {
  EXPECT_EQ(result.status, 1) << result.err;
  EXPECT_NE(result.err.find("raytree: error: " + path + ": "), std::string::npos) << result.err;
  EXPECT_NE(result.err.find(reason), std::string::npos) << result.err;
}

#define EXPECT_HELD(status)                                                                          \
  if (const int held = (status); held == kNotPermitted)                                              \
    GTEST_SKIP() << "SKIPPED: this process may not mount; run as root to see what a full disk does"; \
  else                                                                                               \
    EXPECT_EQ(held, 0) << "see the failures above"

std::vector<std::string> render_into(const std::vector<std::string>& files) {
  std::vector<std::string> words = {"render", "spheres-1980", "--size", "200x150"};
  for (const std::string& file : files) words.insert(words.end(), {"-o", file});
  return words;
}

TEST(FullDisk, ANewFileIsWholeOrNotThere) {
  TemporaryFolder folder;
  EXPECT_HELD(with_small_file_system(folder.path(""), "size=16k", [&] {
    const std::string path = folder.path("a.exr");
    expect_failure(run_program(render_into({path})), path, "No space left on device");
    EXPECT_TRUE(folder.names().empty()) << folder.names().front();
  }));
}

TEST(FullDisk, AnExistingFileStaysAsItWas) {
  TemporaryFolder folder;
  EXPECT_HELD(with_small_file_system(folder.path(""), "size=16k", [&] {
    const std::string path = folder.path("a.exr");
    write_text(path, "kept");
    expect_failure(run_program(render_into({path})), path, "No space left on device");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.exr"});
    EXPECT_EQ(file_text(path), "kept");
  }));
}

TEST(FullDisk, FilesWrittenBeforeItFilledStayWhole) {
  TemporaryFolder folder;
  EXPECT_HELD(with_small_file_system(folder.path(""), "size=128k", [&] {
    const std::string small = folder.path("a.jpg"), large = folder.path("a.exr"), later = folder.path("later.jpg");
    std::vector<std::string> words = render_into({small, large, later});
    words.insert(words.end(), {"--channels", "all"});
    expect_failure(run_program(words), large, "No space left on device");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.jpg"});
    EXPECT_EQ(read_image_file(small).width, 200);
  }));
}

TEST(FullDisk, NoRoomForANameIsToldToo) {
  TemporaryFolder folder;
  // The folder itself is the only inode.
  EXPECT_HELD(with_small_file_system(folder.path(""), "size=1m,nr_inodes=1", [&] {
    const std::string path = folder.path("a.png");
    expect_failure(run_program(render_into({path})), path, "No space left on device");
    EXPECT_TRUE(folder.names().empty());
  }));
}

TEST(FullDisk, StatisticsAreWholeOrNotThere) {
  TemporaryFolder folder;
  EXPECT_HELD(with_small_file_system(folder.path(""), "size=4k", [&] {
    write_text(folder.path("filler"), std::string(4096, 'x'));
    const std::string path = folder.path("s.json");
    expect_failure(
        run_program({"render", "spheres-1980", "--size", "20x15", "-o", "-", "--format", "png", "--stats", path}), path,
        "No space left on device");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"filler"});
  }));
}

}  // namespace
}  // namespace raytree::test
