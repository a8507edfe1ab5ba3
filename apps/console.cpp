#include "console.hpp"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

namespace isotherm::apps {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void on_interrupt(int) {
  // A second Ctrl-C ends the process at once, should a step take too long.
  std::signal(SIGINT, SIG_DFL);
  interrupted = 1;
}

// Redraws at most ten times a second and erases itself when a stage is done.
class ProgressLine {
 public:
  explicit ProgressLine(bool visible) : visible_(visible) {}
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() { erase(); }

  void draw(const Progress& progress) {
    if (!visible_) return;
    const bool finished = progress.total > 0 && progress.done >= progress.total;
    const auto now = std::chrono::steady_clock::now();
    if (!finished && now - last_draw_ < std::chrono::milliseconds(100)) return;
    last_draw_ = now;
    if (finished) {
      erase();
      return;
    }
    const std::string amount =
        progress.total > 0 ? fmt::format("{:3.0f} %", 100.0 * static_cast<double>(progress.done) /
                                                          static_cast<double>(progress.total))
                           : fmt::format("{}", progress.done);
    fmt::print(stderr, "\r\033[K{}: {}", progress.stage, amount);
    std::fflush(stderr);
    drawn_ = true;
  }

 private:
  void erase() {
    if (!drawn_) return;
    fmt::print(stderr, "\r\033[K");
    std::fflush(stderr);
    drawn_ = false;
  }

  bool visible_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_draw_{};
};

}  // namespace

void say(const CommonFlags& flags, std::string_view line) {
  if (!flags.quiet) fmt::print(stderr, "{}\n", line);
}

void warn(const CommonFlags& flags, std::string_view line) {
  if (!flags.quiet) fmt::print(stderr, "warning: {}\n", line);
}

void detail_line(const CommonFlags& flags, std::string_view line) {
  if (flags.verbose) say(flags, line);
}

ProgressCallback progress_line(const CommonFlags& flags) {
  const bool visible = !flags.quiet && !flags.no_progress && isatty(STDERR_FILENO) != 0;
  const auto line = std::make_shared<ProgressLine>(visible);
  return [line](const Progress& progress) {
    line->draw(progress);
    return interrupted == 0;
  };
}

void stop_cleanly_on_interrupt() { std::signal(SIGINT, on_interrupt); }

}  // namespace isotherm::apps
