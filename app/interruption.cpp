#include "app/interruption.h"

#include <pthread.h>
#include <unistd.h>

#include <csignal>
#include <ctime>

#include "app/exit_status.h"
#include "renderer/atomic_file.h"

namespace raytree::app {
namespace {

bool is_ignored(int number) {
  struct sigaction action {};
  return sigaction(number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

sigset_t interruptions() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  if (!is_ignored(SIGHUP)) sigaddset(&set, SIGHUP);
  return set;
}

}  // namespace

Interruption::Interruption(std::function<void()> before_exit) : before_exit_(std::move(before_exit)) {
  const sigset_t set = interruptions();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  // A shell starts the background jobs of a script with SIGINT ignored; one that is sent all the same is meant.
  std::signal(SIGINT, SIG_DFL);
  thread_ = std::thread([this] { listen(); });
}

Interruption::~Interruption() {
  finished_ = true;
  pthread_kill(thread_.native_handle(), SIGTERM);  // wakes the listener, which finds that it is done
  thread_.join();
}

void Interruption::listen() {
  const sigset_t set = interruptions();
  int number = 0;
  while (sigwait(&set, &number) != 0) {
  }
  if (finished_) return;
  signal_ = number;
  stop_ = true;
  // The work may end by itself now; a second signal, or the end of the grace time, does not wait for it.
  timespec grace{};
  grace.tv_nsec = static_cast<long>(kGraceSeconds * 1e9);
  sigtimedwait(&set, nullptr, &grace);
  if (finished_) return;
  remove_unfinished_file();
  if (before_exit_) before_exit_();
  _exit(kSignalBase + number);
}

}  // namespace raytree::app
