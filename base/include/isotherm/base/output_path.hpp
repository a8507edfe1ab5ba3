#pragma once

#include <string>

namespace isotherm {

/// The file that writing to `path` makes or replaces: links followed, no "." or "..", so
/// that two names of one file are the same. "-" is itself.
std::string output_target(const std::string& path);

/// Whether `path` is a symbolic link that leads back to itself, so that there is no such file.
bool is_endless_link(const std::string& path);

/// For a look ahead, before hours of work: nothing is created.
/// @throws FileError if OutputFile could not write to `path` as things stand.
void require_writable(const std::string& path);

}  // namespace isotherm
