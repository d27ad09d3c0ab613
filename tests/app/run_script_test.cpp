// What `./run` does about Debian packages that are missing: a copy of the script runs among stand-ins for dpkg-query,
// apt-get and sudo, which note what they are asked.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include "tests/app/program.h"

namespace raytree::test {
namespace {

class RunScript : public testing::Test {
 protected:
  RunScript() {
    namespace fs = std::filesystem;
    // Another user than root must reach it.
    fs::permissions(folder_.folder(), fs::perms(0777));
    for (const char* part : {"tools", "build"}) {
      fs::create_directory(folder_.path(part));
      fs::permissions(folder_.path(part), fs::perms(0777));
    }
    executable("run", file_text(RAYTREE_SOURCE_DIR "/run"));
    // All but g++ and cmake are there, and what apt-get has installed.
    executable("tools/dpkg-query", R"(#!/bin/bash
for word in "$@"; do
  case $word in
    -* | g++ | cmake) ;;
    *) printf '%s installed\n' "$word" ;;
  esac
done
cat )" + folder_.path("installed") + "\n");
    executable("tools/apt-get", "#!/bin/bash\nprintf 'apt-get %s\\n' \"$*\" >>" + folder_.path("calls") +
                                    "\nif [[ \" $* \" == *' install '* ]]; then\n  [[ ! -e " + folder_.path("stale") +
                                    " ]] || exit 100\n  printf '%s installed\\n' g++ cmake >" +
                                    folder_.path("installed") + "\nelse\n  rm -f " + folder_.path("stale") + "\nfi\n");
    write_text(folder_.path("installed"), "");
    write_text(folder_.path("calls"), "");
    for (const char* name : {"installed", "calls"}) fs::permissions(folder_.path(name), fs::perms(0666));
    for (const char* tool : {"bash", "env", "flock", "mkdir", "cat", "rm", "readlink"})
      for (const char* place : {"/usr/bin/", "/bin/"})
        if (fs::exists(std::string(place) + tool) && !fs::exists(folder_.path(std::string("tools/") + tool)))
          fs::create_symlink(std::string(place) + tool, folder_.path(std::string("tools/") + tool));
  }

  void executable(const std::string& name, const std::string& text) {
    write_text(folder_.path(name), text);
    std::filesystem::permissions(folder_.path(name), std::filesystem::perms(0755));
  }
  void add_sudo() {
    executable("tools/sudo", "#!/bin/bash\nprintf 'sudo %s\\n' \"$1\" >>" + folder_.path("calls") +
                                 "\n[[ $1 == -* ]] || exec \"$@\"\n");
  }

  struct Outcome {
    int status;
    std::string err;
  };
  /// `run packages` with these words before it in the environment.
  Outcome packages(const std::string& variables, bool as_root) {
    const std::string err = folder_.path("err");
    std::string command = "env -i PATH='" + folder_.path("tools") + "' " + variables + " /bin/bash '" +
                          folder_.path("run") + "' packages </dev/null >/dev/null 2>'" + err + "'";
    if (!as_root && geteuid() == 0) command = "setpriv --reuid=65534 --regid=65534 --clear-groups " + command;
    const int status = std::system(("cd / && " + command).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, file_text(err)};
  }
  std::string calls() const { return file_text(folder_.path("calls")); }

  TemporaryFolder folder_;
};

TEST_F(RunScript, NamesMissingPackagesWhereItMustNotInstallThem) {
  for (const bool as_root : {false, true}) {
    const Outcome outcome = packages("RAYTREE_NO_INSTALL=1", as_root);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(outcome.err, "run: missing Debian packages, and RAYTREE_NO_INSTALL is set: apt-get install g++ cmake\n");
  }
  EXPECT_EQ(calls(), "");
}

TEST_F(RunScript, FailsWithTheirNamesWhereItIsNeitherRootNorHasSudo) {
  const Outcome outcome = packages("", false);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err,
            "run: missing Debian packages, and neither root nor sudo to install them. As root: apt-get install g++ "
            "cmake\n");
  EXPECT_EQ(calls(), "");
}

TEST_F(RunScript, InstallsThemThroughSudoAndSaysSo) {
  add_sudo();
  const Outcome outcome = packages("", false);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "run: installing Debian packages that building needs (through sudo): g++ cmake\n");
  EXPECT_TRUE(contains(calls(), "sudo env\n")) << calls();
  EXPECT_TRUE(contains(calls(), "install -y --no-install-recommends g++ cmake\n")) << calls();
}

TEST_F(RunScript, FetchesListsWhereTheFirstTryFailsAndAsksNobodyLater) {
  if (geteuid() != 0) add_sudo();
  write_text(folder_.path("stale"), "");
  const Outcome outcome = packages("", true);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "g++ cmake\nrun: fetching Debian's package lists (apt-get update)\n"))
      << outcome.err;
  EXPECT_EQ(count_of(calls(), "apt-get "), 3u) << calls();  // install, update, install
  EXPECT_TRUE(contains(calls(), " update\n")) << calls();
  // The stamp remembers: dpkg-query would say again that something is missing.
  write_text(folder_.path("installed"), "");
  write_text(folder_.path("calls"), "");
  const Outcome later = packages("RAYTREE_NO_INSTALL=1", true);
  EXPECT_EQ(later.status, 0);
  EXPECT_EQ(later.err, "");
  EXPECT_EQ(calls(), "");
}

TEST_F(RunScript, SaysWhatCouldNotBeInstalled) {
  if (geteuid() != 0) add_sudo();
  executable("tools/apt-get", "#!/bin/bash\necho 'E: no network'\nexit 100\n");
  const Outcome outcome = packages("", true);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(contains(outcome.err, "E: no network\nrun: could not install: g++ cmake\n")) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(folder_.path("build/.packages-build")));
}

}  // namespace
}  // namespace raytree::test
