#include "interruption.hpp"

#include <atomic>
#include <csignal>
#include <string_view>

#include <fcntl.h>
#include <unistd.h>

#include "command.hpp"
#include "console.hpp"
#include "isotherm/base/output_group.hpp"

namespace isotherm::apps {
namespace {

constexpr unsigned kGraceSeconds = 1;

std::atomic<bool> asked_to_stop{false};
std::atomic_flag said = ATOMIC_FLAG_INIT;
static_assert(std::atomic<bool>::is_always_lock_free, "is used in signal handlers");

// Files that are being named, or have been, are complete, and so is the run: it ends by itself.
void end_now(int) {
  if (outputs_in_place()) return;
  say_interrupted();
  abandon_outputs();
  ::_exit(kInterrupted);
}

void on_interrupt(int signal) {
  if (asked_to_stop.exchange(true)) {
    end_now(signal);
  } else {
    ::alarm(kGraceSeconds);
  }
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  ::sigaction(signal, &action, nullptr);
}

// As `nohup` asks for.
bool is_ignored(int signal) {
  struct sigaction action = {};
  return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void settle_streams() {
  // In the direction that the stream is not for: using it fails, as it did when it was closed.
  constexpr int kModes[] = {O_WRONLY, O_RDONLY, O_RDONLY};
  for (int descriptor = 0; descriptor <= STDERR_FILENO; ++descriptor) {
    if (::fcntl(descriptor, F_GETFD) < 0) ::open("/dev/null", kModes[descriptor]);
  }
  handle(SIGPIPE, SIG_IGN);
  handle(SIGXFSZ, SIG_IGN);
}

void stop_cleanly_on_interrupt() {
  handle(SIGALRM, end_now);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    if (!is_ignored(signal)) handle(signal, on_interrupt);
  }
}

bool interrupted() noexcept { return asked_to_stop; }

void leave_interruption_unsaid() noexcept { said.test_and_set(); }

void say_interrupted() noexcept {
  if (!said.test_and_set()) put("isotherm: interrupted; nothing was written\n");
}

}  // namespace isotherm::apps
