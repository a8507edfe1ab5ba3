#pragma once

#include <string>
#include <string_view>

#include "io/graph_draft.hpp"

namespace isotherm::slam::detail {

/// Whether this is the beginning of a JRL file: of an object in JSON, as no other format's is.
bool is_jrl(std::string_view text);

/// Reads a JRL file: the measurements between poses of all its robots in order of time, the poses
/// of its initialization, its ground truth, and which measurements it calls outliers.
/// @throws ParseError
FileDraft read_jrl(const std::string& path, std::string_view text, const ReadOptions& options);

/// The same of all that is left of `text`.
FileDraft read_jrl(TextReader& text, const ReadOptions& options);

}  // namespace isotherm::slam::detail
