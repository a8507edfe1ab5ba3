#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "isotherm/base/options.hpp"
#include "isotherm/base/range.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam {

/// What ground truth says about a candidate.
enum class Label {
  correct,
  incorrect,
  ignore,  ///< no ground truth, or too close to call; counts nowhere
};

constexpr std::array<EnumName<Label>, 3> enum_names(Label) {
  return {
      {{Label::correct, "correct"}, {Label::incorrect, "incorrect"}, {Label::ignore, "ignore"}}};
}

/// One row of a label file.
struct EdgeLabel {
  std::int64_t edge = 0;  ///< 0-based position among the edge lines of the graph file
  std::uint64_t from = 0;
  std::uint64_t to = 0;
  Label label = Label::ignore;
};

/// When a measured relative pose counts as wrong.
struct LabelOptions {
  double max_translation_error = 2.0;  ///< metres, > 0
  double max_rotation_error = 0.5;     ///< radians, > 0
  /// Metres either side of max_translation_error that are too close to call; >= 0.
  double ignore_band = 0.0;

  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, LabelOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("max_translation_error", options.max_translation_error,
        "metres by which a correct loop may miss the ground truth", left_open(0, 1e9));
  visit("max_rotation_error", options.max_rotation_error,
        "radians by which a correct loop may miss the ground truth", left_open(0, 1e9));
  visit("ignore_band", options.ignore_band,
        "metres either side of max-translation-error that are too close to call", closed(0, 1e9));
}

/// Labels every candidate by the ground truth of its ends: incorrect iff the
/// measured relative pose is off by more than an allowed error, ignore if an end
/// has no ground truth or the translation is off by about the allowed error. `truth` has one entry
/// a vertex. One label a candidate.
/// @throws InvalidArgument if `truth` has another size than the graph.
template <class Pose>
std::vector<EdgeLabel> label_candidates(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                        const std::vector<std::optional<Pose>>& truth,
                                        const LabelOptions& options = {});

/// How many of `labels` equal `label`.
std::int64_t count(const std::vector<EdgeLabel>& labels, Label label);

/// Writes `edge,from,to,label` rows; "-" is stdout. @throws FileError
void write_labels(const std::string& path, const std::vector<EdgeLabel>& labels);

/// @throws FileError, ParseError
std::vector<EdgeLabel> read_labels(const std::string& path);

}  // namespace isotherm::slam
