#include "app/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "app/messages.h"

namespace raytree::app {
namespace {

constexpr auto kRedrawInterval = std::chrono::milliseconds(100);
constexpr int kPlainSteps = 20;

bool stderr_redraws() {
  const char* terminal = std::getenv("TERM");
  return isatty(STDERR_FILENO) && terminal && std::strcmp(terminal, "dumb") != 0;
}

int terminal_columns() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

std::string progress_text(const RenderProgress& done, double seconds) {
  const double share =
      done.tiles_total ? static_cast<double>(done.tiles_done) / static_cast<double>(done.tiles_total) : 1;
  std::string text = fmt::format("{:3.0f} %", std::floor(share * 100));
  if (seconds > 0) text += fmt::format("  {:.2f} Mrays/s", static_cast<double>(done.rays) / seconds * 1e-6);
  if (share > 0 && share < 1) text += "  ETA " + readable_seconds(seconds * (1 - share) / share);
  return text;
}

Progress::Progress(ProgressMode mode) : mode_(mode) {
  if (mode_ == ProgressMode::automatic) mode_ = stderr_redraws() ? ProgressMode::bar : ProgressMode::plain;
}

Progress::~Progress() { clear(); }

void Progress::phase(const std::string& text) {
  const std::lock_guard lock(mutex_);
  if (mode_ == ProgressMode::bar) draw(text);
}

void Progress::begin_tracing() {
  const std::lock_guard lock(mutex_);
  begin_ = last_drawn_ = Clock::now();
  last_step_ = 0;
  if (mode_ == ProgressMode::bar) draw("tracing");
}

void Progress::update(const RenderProgress& done) {
  if (mode_ == ProgressMode::none) return;
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - begin_).count();
  if (mode_ == ProgressMode::plain) {
    const int step =
        done.tiles_total ? static_cast<int>(done.tiles_done * kPlainSteps / done.tiles_total) : kPlainSteps;
    if (step <= last_step_) return;
    last_step_ = step;
    print_message("tracing " + progress_text(done, seconds));
    return;
  }
  if (now - last_drawn_ < kRedrawInterval) return;
  last_drawn_ = now;
  const std::string text = progress_text(done, seconds);
  const int columns = terminal_columns();
  const int width = std::clamp(columns - static_cast<int>(text.size()) - 14, 0, 40);
  std::string bar;
  if (width >= 8) {
    const auto filled =
        done.tiles_total
            ? static_cast<std::size_t>(done.tiles_done * static_cast<std::uint64_t>(width) / done.tiles_total)
            : 0;
    bar = "[" + std::string(filled, '#') + std::string(static_cast<std::size_t>(width) - filled, '.') + "] ";
  }
  draw("tracing " + bar + text);
}

void Progress::draw(const std::string& line) {
  // A line longer than the terminal would wrap and could not be taken back.
  const std::string whole = "\r" + line.substr(0, static_cast<std::size_t>(terminal_columns() - 1)) + "\x1b[K";
  drawn_ = true;
  std::fwrite(whole.data(), 1, whole.size(), stderr);
  std::fflush(stderr);
}

void Progress::clear() {
  const std::lock_guard lock(mutex_);
  if (!drawn_) return;
  std::fputs("\r\x1b[K", stderr);
  std::fflush(stderr);
  drawn_ = false;
}

void Progress::abandon() noexcept {
  if (drawn_) [[maybe_unused]]
    const auto written = write(STDERR_FILENO, "\n", 1);
}

}  // namespace raytree::app
