#pragma once

#include <string>

namespace isotherm {

/// The file that writing to `path` makes or replaces: links followed, no "." or "..", so
/// that two names of one file are the same. "-" is itself.
std::string output_target(const std::string& path);

/// For a look ahead, before hours of work: nothing is created.
/// @throws FileError if OutputFile could not write to `path` as things stand.
void require_writable(const std::string& path);

}  // namespace isotherm
