#pragma once

#include <string_view>

#include "command.hpp"
#include "isotherm/base/progress.hpp"

/// Everything the command says to a person. It goes to stderr: stdout carries
/// data only.
namespace isotherm::apps {

/// Prints a line unless --quiet was given.
void say(const CommonFlags& flags, std::string_view line);

/// Prints "warning: ..." unless --quiet was given.
void warn(const CommonFlags& flags, std::string_view line);

/// Prints a line only with --verbose.
void detail_line(const CommonFlags& flags, std::string_view line);

/// A callback that draws one progress line on a terminal, stays silent
/// elsewhere, and asks the computation to stop after Ctrl-C.
ProgressCallback progress_line(const CommonFlags& flags);

/// Lets Ctrl-C set a flag that progress_line's callback reads, so that a run
/// stops between two steps with nothing half-written.
void stop_cleanly_on_interrupt();

}  // namespace isotherm::apps
