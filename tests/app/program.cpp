#include "tests/app/program.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace raytree::test {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kLongest = 120;  // seconds; a program that hangs must not hang the tests

double since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// A pseudo-terminal, as [reading end, the program's end].
void open_terminal(int columns, int (&ends)[2]) {
  winsize size{};
  size.ws_row = 24;
  size.ws_col = static_cast<unsigned short>(columns);
  if (openpty(&ends[0], &ends[1], nullptr, nullptr, &size) != 0) throw std::runtime_error("openpty");
  for (const int end : ends) fcntl(end, F_SETFD, FD_CLOEXEC);
}

}  // namespace

ProgramResult run_program(const std::vector<std::string>& arguments, const ProgramOptions& options) {
  int out[2], err[2];
  if (pipe2(out, O_CLOEXEC) != 0) throw std::runtime_error("pipe");
  if (options.terminal_columns > 0)
    open_terminal(options.terminal_columns, err);
  else if (pipe2(err, O_CLOEXEC) != 0)
    throw std::runtime_error("pipe");
  std::vector<const char*> words = {RAYTREE_PROGRAM};
  for (const std::string& argument : arguments) words.push_back(argument.c_str());
  words.push_back(nullptr);
  const Clock::time_point begin = Clock::now();
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork");
  if (child == 0) {
    dup2(out[1], STDOUT_FILENO);
    dup2(err[1], STDERR_FILENO);
    const int empty = open("/dev/null", O_RDONLY);
    dup2(empty, STDIN_FILENO);
    if (options.close_stdout) close(STDOUT_FILENO);
    if (options.signal) std::signal(options.signal, SIG_DFL);  // as under nohup
    for (const std::string& variable : options.environment) putenv(const_cast<char*>(variable.c_str()));
    if (!options.input_folder.empty() && chdir(options.input_folder.c_str()) != 0) _exit(126);
    execv(RAYTREE_PROGRAM, const_cast<char* const*>(words.data()));
    _exit(127);
  }
  close(out[1]);
  close(err[1]);
  ProgramResult result;
  pollfd streams[2] = {{out[0], POLLIN, 0}, {err[0], POLLIN, 0}};
  std::string* const texts[2] = {&result.out, &result.err};
  bool signalled = false;
  Clock::time_point signal_time = begin;
  int open_streams = 2;
  while (open_streams > 0) {
    poll(streams, 2, 5);
    const bool due =
        options.signal_on.empty() ? since(begin) >= options.signal_after : contains(result.err, options.signal_on);
    if (options.signal && !signalled && due) {
      kill(child, options.signal);
      signalled = true;
      signal_time = Clock::now();
    }
    if (since(begin) > kLongest) kill(child, SIGKILL);
    for (int i = 0; i < 2; ++i) {
      if (streams[i].fd < 0 || !(streams[i].revents & (POLLIN | POLLHUP))) continue;
      char block[65536];
      const ssize_t size = read(streams[i].fd, block, sizeof block);
      if (size > 0) {
        texts[i]->append(block, static_cast<std::size_t>(size));
      } else if (size == 0 || errno != EINTR) {
        close(streams[i].fd);
        streams[i].fd = -1;
        --open_streams;
      }
    }
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  result.peak_memory_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
  result.seconds = since(begin);
  result.seconds_after_signal = signalled ? since(signal_time) : 0;
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

void expect_bad_input(const std::vector<std::string>& arguments, const std::vector<std::string>& parts) {
  const ProgramResult result = run_program(arguments);
  std::string line;
  for (const std::string& argument : arguments) line += argument + " ";
  EXPECT_EQ(result.status, 2) << line << "\n" << result.err;
  EXPECT_EQ(result.out, "") << line;
  EXPECT_EQ(result.err.rfind("raytree: error: ", 0), 0u) << line << "\n" << result.err;
  for (const std::string& part : parts) EXPECT_TRUE(contains(result.err, part)) << line << "\n" << result.err;
}

void write_text(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

}  // namespace raytree::test
