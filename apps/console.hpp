#pragma once

#include <string_view>

#include "command.hpp"
#include "isotherm/base/progress.hpp"

/// Everything the command says to a person. It goes to stderr: stdout carries
/// data only. What cannot be written there, because it is closed or full, is dropped:
/// no result is lost for a message.
namespace isotherm::apps {

/// Writes text as it is. Safe in a signal handler.
void put(std::string_view text) noexcept;

/// Prints "isotherm: ...", also with --quiet.
void complain(std::string_view problem);

/// Prints a line unless --quiet was given.
void say(const CommonFlags& flags, std::string_view line);

/// Prints "warning: ..." unless --quiet was given.
void warn(const CommonFlags& flags, std::string_view line);

/// Prints a line only with --verbose.
void detail_line(const CommonFlags& flags, std::string_view line);

/// A callback that draws one progress line on a terminal, stays silent
/// elsewhere, and asks the computation to stop when interrupted() says so.
ProgressCallback progress_line(const CommonFlags& flags);

}  // namespace isotherm::apps
