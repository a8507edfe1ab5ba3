#pragma once

#include <string>

#include "option_flags.hpp"

namespace isotherm::apps {

/// Deeper nesting than this is an error: no document of ours needs it, and what walks through
/// a document does so by recursion.
inline constexpr int kDeepestJson = 100;

/// The JSON document in a file ("-" is standard input), decompressed.
/// @throws FileError, ParseError naming line, column and token
Json read_json(const std::string& path);

}  // namespace isotherm::apps
