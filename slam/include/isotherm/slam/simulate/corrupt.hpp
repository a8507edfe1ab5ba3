#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include "isotherm/base/options.hpp"
#include "isotherm/base/range.hpp"
#include "isotherm/slam/evaluate/labels.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam {

/// Whose false loop closures are imitated.
enum class NoiseStyle {
  /// N. Suenderhauf's Vertigo: transforms near the identity, one a group.
  vertigo,
  /// The files of S. Datta et al.: every edge has a wild transform of its own.
  paper,
};

/// Which vertices false loop closures join.
enum class NoiseType {
  random,
  local,
  random_grouped,
  local_grouped,
  all_random,  ///< groups of random size anywhere
};

/// What false loop closures claim about their own accuracy.
enum class NoiseInformation {
  first,   ///< as the first candidate of the graph
  median,  ///< the entry-wise median of the candidates' diagonals
  paper,   ///< the candidates' mean times a number in [-1, 3]: often not a valid matrix
};

constexpr std::array<EnumName<NoiseStyle>, 2> enum_names(NoiseStyle) {
  return {{{NoiseStyle::vertigo, "vertigo"}, {NoiseStyle::paper, "paper"}}};
}

constexpr std::array<EnumName<NoiseType>, 5> enum_names(NoiseType) {
  return {{{NoiseType::random, "random"},
           {NoiseType::local, "local"},
           {NoiseType::random_grouped, "random-grouped"},
           {NoiseType::local_grouped, "local-grouped"},
           {NoiseType::all_random, "all-random"}}};
}

constexpr std::array<EnumName<NoiseInformation>, 3> enum_names(NoiseInformation) {
  return {{{NoiseInformation::first, "first"},
           {NoiseInformation::median, "median"},
           {NoiseInformation::paper, "paper"}}};
}

/// How a graph is corrupted. Exactly one of count, ratio and fraction is set.
struct CorruptOptions {
  NoiseStyle style = NoiseStyle::vertigo;
  NoiseType type = NoiseType::random;
  std::int64_t count = -1;      ///< false loops to add; -1: not set
  double ratio = -1.0;          ///< false loops per candidate of the graph; < 0: not set
  double fraction = -1.0;       ///< share of false loops afterwards, in [0, 1); < 0: not set
  std::int64_t group_size = 0;  ///< edges a group; 0: 10 (vertigo) or 5 (paper)
  NoiseInformation information = NoiseInformation::first;
  bool shuffle = true;  ///< mix false loops among the others instead of appending them
  std::uint64_t seed = 0;

  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, CorruptOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("style", options.style,
        "whose false loops to imitate: those of Vertigo's generator (Suenderhauf, 2012), or "
        "of the heat-kernel paper (Datta et al., 2016)");
  visit("type", options.type, "which vertices they join");
  visit("count", options.count, "how many to add", closed(-1, 1e7));
  visit("ratio", options.ratio, "how many to add per loop of the input", closed(-1, 1000));
  visit("fraction", options.fraction, "their share among all loops afterwards, below 1",
        closed(-1, 0.999));
  visit("group_size", options.group_size, "loops per group; 0: 10 (vertigo) or 5 (paper)",
        closed(0, 1e7));
  visit("information", options.information, "what they claim about their accuracy");
  visit("shuffle", options.shuffle, "mix them among the other loops instead of appending them");
}

template <class Pose>
struct Corrupted {
  PoseGraph<Pose> graph;
  std::vector<EdgeLabel> labels;  ///< one a candidate of `graph`, in order
};

/// Adds false loop closures to a graph whose candidates are taken as correct.
///
/// `truth` gives a pose a vertex (ground truth, or the optimum of the clean
/// graph): an injected constraint whose chi-squared there lies inside the 99.9 %
/// quantile is consistent and labelled `ignore`, others `incorrect`. Odometry
/// keeps its place and order; no false loop joins neighbours or a vertex with
/// itself. Deterministic in the options. O(constraints).
/// @throws InvalidArgument for options out of range, fewer than three vertices,
///   or a graph without candidates to copy information from.
template <class Pose>
Corrupted<Pose> corrupt(const PoseGraph<Pose>& graph, const std::vector<Pose>& truth,
                        const CorruptOptions& options);

}  // namespace isotherm::slam
