#include "console.hpp"

#include <cerrno>
#include <chrono>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "interruption.hpp"

namespace isotherm::apps {
namespace {

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
    put(fmt::format("\r\033[K{}: {}", progress.stage, amount));
    drawn_ = true;
  }

 private:
  void erase() {
    if (!drawn_) return;
    put("\r\033[K");
    drawn_ = false;
  }

  bool visible_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_draw_{};
};

}  // namespace

void put(std::string_view text) noexcept {
  while (!text.empty()) {
    const auto written = ::write(STDERR_FILENO, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

void complain(std::string_view problem) { put(fmt::format("isotherm: {}\n", problem)); }

void say(const CommonFlags& flags, std::string_view line) {
  if (!flags.quiet) put(fmt::format("{}\n", line));
}

void warn(const CommonFlags& flags, std::string_view line) {
  if (!flags.quiet) put(fmt::format("warning: {}\n", line));
}

void detail_line(const CommonFlags& flags, std::string_view line) {
  if (flags.verbose) say(flags, line);
}

ProgressCallback progress_line(const CommonFlags& flags) {
  const bool visible = !flags.quiet && !flags.no_progress && isatty(STDERR_FILENO) != 0;
  const auto line = std::make_shared<ProgressLine>(visible);
  return [line](const Progress& progress) {
    line->draw(progress);
    return !interrupted();
  };
}

}  // namespace isotherm::apps
