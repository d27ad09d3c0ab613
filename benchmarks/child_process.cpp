#include "benchmarks/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "geometry/error.h"

extern char** environ;

namespace raytree::benchmarks {
namespace {

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

struct FileActions {
  posix_spawn_file_actions_t actions;
  FileActions() { posix_spawn_file_actions_init(&actions); }
  ~FileActions() { posix_spawn_file_actions_destroy(&actions); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
};

}  // namespace

ChildResult run_child(const std::vector<std::string>& words, const std::filesystem::path& scratch) {
  // One name a launching process, so that a launcher of its own may use the same folder.
  const std::string mark = std::to_string(getpid());
  const std::filesystem::path output = scratch / ("stdout-" + mark), errors = scratch / ("stderr-" + mark);
  FileActions files;
  posix_spawn_file_actions_addopen(&files.actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files.actions, 1, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&files.actions, 2, errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);

  ChildResult result;
  pid_t child = 0;
  result.start_clock = steady_seconds();
  if (const int code = posix_spawnp(&child, arguments[0], &files.actions, nullptr, arguments.data(), environ);
      code != 0)
    throw Error(ErrorKind::failure, {words[0], 0, ""}, std::string("cannot be started: ") + std::strerror(code));
  int status = 0;
  rusage usage{};
  while (wait4(child, &status, 0, &usage) == -1)
    if (errno != EINTR) throw Error(ErrorKind::failure, {words[0], 0, ""}, std::strerror(errno));
  result.wall_seconds = steady_seconds() - result.start_clock;
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.peak_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
  result.output = text_of(output);
  result.errors = text_of(errors);
  std::error_code ignored;
  std::filesystem::remove(output, ignored);
  std::filesystem::remove(errors, ignored);
  return result;
}

std::string launch_apart(const std::vector<std::string>& words) {
  if (words.size() < 2) throw Error(ErrorKind::bad_input, {}, "a scratch folder and a program must follow");
  const ChildResult result = run_child({words.begin() + 1, words.end()}, words[0]);
  return nlohmann::json{
      {"status", result.status},         {"start_clock", result.start_clock}, {"wall_seconds", result.wall_seconds},
      {"peak_bytes", result.peak_bytes}, {"output", result.output},           {"errors", result.errors}}
      .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

ChildResult run_child_apart(const std::string& launcher, const std::vector<std::string>& words,
                            const std::filesystem::path& scratch) {
  std::vector<std::string> all = {launcher, kLaunchFlag, scratch.string()};
  all.insert(all.end(), words.begin(), words.end());
  const ChildResult outer = run_child(all, scratch);
  require_success(outer, launcher);
  const nlohmann::json json = nlohmann::json::parse(outer.output);
  ChildResult result;
  result.status = json.at("status");
  result.start_clock = json.at("start_clock");
  result.wall_seconds = json.at("wall_seconds");
  result.peak_bytes = json.at("peak_bytes");
  result.output = json.at("output");
  result.errors = json.at("errors");
  return result;
}

void require_success(const ChildResult& result, const std::string& what) {
  if (result.status == 0) return;
  constexpr std::size_t kShown = 400;
  const std::string& text = result.errors;
  throw Error(ErrorKind::failure, {},
              what + " ended with status " + std::to_string(result.status) + ": " +
                  (text.size() > kShown ? "..." + text.substr(text.size() - kShown) : text));
}

}  // namespace raytree::benchmarks
