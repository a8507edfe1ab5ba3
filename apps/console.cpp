#include "console.hpp"

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "interruption.hpp"

namespace isotherm::apps {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// "8 s", "3 min", "2 h".
std::string duration_in_words(double seconds) {
  if (seconds < 100.0) return fmt::format("{:.0f} s", seconds);
  if (seconds < 6000.0) return fmt::format("{:.0f} min", seconds / 60.0);
  return fmt::format("{:.0f} h", seconds / 3600.0);
}

// Redraws at most ten times a second and erases itself when a stage is done, or when a line
// is said.
class ProgressLine {
 public:
  void draw(const Progress& progress) {
    start_stage(progress);
    const bool finished = progress.total > 0 && progress.done >= progress.total;
    const auto now = Clock::now();
    if (!finished && now - last_draw_ < std::chrono::milliseconds(100)) return;
    last_draw_ = now;
    if (finished) {
      erase();
      return;
    }
    put(fmt::format("\r\033[K{}: {}", stage_, amount(progress)));
    drawn_ = true;
  }

  void erase() noexcept {
    if (!drawn_) return;
    put("\r\033[K");
    drawn_ = false;
  }

 private:
  // Work that starts anew under the same name is another pass, not a step back.
  void start_stage(const Progress& progress) {
    const bool again = progress.stage == stage_name_ && progress.done < done_;
    if (progress.stage != stage_name_ || again) {
      pass_ = again ? pass_ + 1 : 1;
      stage_name_ = progress.stage;
      stage_ = pass_ == 1 ? stage_name_ : fmt::format("{}, pass {}", stage_name_, pass_);
      stage_start_ = Clock::now();
    }
    done_ = progress.done;
  }

  std::string amount(const Progress& progress) const {
    const std::string elapsed = duration_in_words(seconds_since(start_));
    if (progress.total == 0) return fmt::format("{}, {}", progress.done, elapsed);
    const double share = static_cast<double>(progress.done) / static_cast<double>(progress.total);
    const double so_far = seconds_since(stage_start_);
    constexpr double kTelling = 0.02;  // of the stage, before which nothing is foretold
    // How many passes are still to come is not known.
    const std::string left =
        pass_ == 1 && share > kTelling && so_far > 1.0
            ? fmt::format(", about {} left", duration_in_words(so_far * (1.0 - share) / share))
            : "";
    return fmt::format("{:3.0f} %, {}{}", 100.0 * share, elapsed, left);
  }

  bool drawn_ = false;
  std::string stage_name_;
  std::string stage_;
  int pass_ = 1;
  std::uint64_t done_ = 0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point stage_start_ = start_;
  Clock::time_point last_draw_{};
};

// There is one terminal.
ProgressLine& the_progress_line() {
  static ProgressLine line;
  return line;
}

void put_line(std::string_view text) {
  the_progress_line().erase();
  put(fmt::format("{}\n", text));
}

}  // namespace

void put(std::string_view text) noexcept {
  while (!text.empty()) {
    const auto written = ::write(STDERR_FILENO, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

void complain(std::string_view problem) { put_line(fmt::format("isotherm: {}", problem)); }

void say(const CommonFlags& flags, std::string_view line) {
  if (!flags.quiet) put_line(line);
}

void warn(const CommonFlags& flags, std::string_view line) {
  if (!flags.quiet) put_line(fmt::format("warning: {}", line));
}

void detail_line(const CommonFlags& flags, std::string_view line) {
  if (flags.verbose) say(flags, line);
}

ProgressCallback progress_line(const CommonFlags& flags) {
  const bool visible = !flags.quiet && !flags.no_progress && isatty(STDERR_FILENO) != 0;
  return [visible](const Progress& progress) {
    if (visible) the_progress_line().draw(progress);
    return !interrupted();
  };
}

}  // namespace isotherm::apps
