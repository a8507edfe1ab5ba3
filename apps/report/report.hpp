#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "isotherm/base/options.hpp"
#include "option_flags.hpp"

/// The document that explains a run: what the page in viewer/ draws, and what
/// `--report FILE.json` saves (schema isotherm.report/1, docs/report.md).
namespace isotherm::apps {

/// What kind of graph was judged; the page words itself accordingly.
enum class ReportKind {
  pose_graph,  ///< poses, odometry and loop closures
  graph,       ///< vertices and weighted edges
  network,     ///< sensor nodes and ranges
};

constexpr std::array<EnumName<ReportKind>, 3> enum_names(ReportKind) {
  return {{{ReportKind::pose_graph, "pose_graph"},
           {ReportKind::graph, "graph"},
           {ReportKind::network, "network"}}};
}

/// Coordinates at which the graph can be drawn.
struct ReportLayout {
  std::string key;    ///< "before", "after"
  std::string label;  ///< e.g. "After: optimised without the pruned loops"
  /// nodes x dimension, row-major, relative to `origin`; NaN where not known.
  std::vector<float> positions;
  std::vector<double> origin;  ///< added to every position; keeps large coordinates exact
  /// True positions, moved onto the layout by the best rigid motion; NaN where there is
  /// none. Empty if no truth was given.
  std::vector<float> truth;
  std::vector<float> errors;  ///< distance of each node from its true position, or empty
};

/// One number for each candidate, shown in the table and for the chosen edge.
struct ReportColumn {
  std::string key;
  std::string label;
  std::string unit;  ///< or empty
  std::string help;  ///< what the number is, in one sentence
  std::vector<float> values;
  bool charted = false;  ///< drawn over all candidates, on a logarithmic axis
};

/// A decision for each candidate, column by column in order of the input.
struct ReportCandidates {
  std::vector<std::uint32_t> edge;  ///< 0-based position among the edges of the input
  std::vector<std::int32_t> from;   ///< positions of nodes
  std::vector<std::int32_t> to;
  std::vector<std::uint32_t> line;    ///< line of the input file; 0 if there is none
  std::vector<std::uint8_t> verdict;  ///< 0 keep, 1 prune, 2 ambiguous
  std::vector<float> score;
  std::vector<float> threshold;
  std::vector<std::uint32_t> stage;  ///< position in `stages`
  std::vector<std::string> stages;
  std::vector<ReportColumn> columns;
  /// Candidates (positions in these columns) that contradict candidate k:
  /// conflicts[conflict_offsets[k]] to conflicts[conflict_offsets[k + 1] - 1]. Empty if
  /// the method does not tell.
  std::vector<std::uint32_t> conflict_offsets;
  std::vector<std::uint32_t> conflicts;

  std::size_t size() const noexcept { return edge.size(); }
};

/// Squared heat distances of some candidates at some scales.
struct ReportHeat {
  std::vector<double> scales;             ///< times t of exp(-tL)
  std::vector<std::uint32_t> candidates;  ///< positions among the candidates, ascending
  std::vector<float> distances;           ///< candidates x scales, row-major
  /// Threshold a scale, where heat decided; infinity where nothing was split.
  std::vector<double> thresholds;
  std::string note;  ///< what graph this is about, and what was left out
};

/// The smallest eigenvalues of the graph's Laplacian.
struct ReportSpectrum {
  std::vector<double> values;  ///< ascending
  std::int64_t null_count = 0;
  std::vector<double> scales;  ///< times t at which exp(-lambda t) is drawn
  std::string note;
};

/// What happened round by round, or scale by scale.
struct ReportRounds {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

/// What things are called.
struct ReportNouns {
  std::string node, nodes;  ///< "pose", "poses"
  std::string edge, edges;  ///< "loop", "loops"
  std::string trusted;      ///< "odometry"; empty if every edge is a candidate
};

/// A heading and what there is to say under it.
struct ReportParagraph {
  std::string heading;
  std::string text;
};

struct Report {
  ReportKind kind = ReportKind::pose_graph;
  std::string title;  ///< name of the input file
  int dimension = 2;  ///< of the layouts
  std::string unit;   ///< of the layouts; empty for abstract coordinates
  ReportNouns nouns;
  std::vector<ReportParagraph> summary;
  std::vector<std::string> warnings;
  Json options;
  std::vector<std::string> notes;  ///< what was left out or thinned, if anything

  std::vector<std::uint64_t> node_ids;  ///< or `node_names`; one a node
  std::vector<std::string> node_names;
  std::vector<std::int32_t> landmarks;   ///< nodes that do not move
  std::vector<std::string> robot_names;  ///< empty unless there are several robots
  std::vector<std::int32_t> robots;      ///< of each node, a position in `robot_names`
  std::vector<ReportColumn> node_columns;
  std::vector<float> path;            ///< metres travelled at each node, or empty
  std::vector<std::int32_t> trusted;  ///< pairs of node positions, from and to in turn
  std::vector<ReportLayout> layouts;  ///< at least one
  ReportCandidates candidates;
  ReportHeat heat;          ///< no scales: not computed, see its note
  ReportSpectrum spectrum;  ///< no values: not computed, see its note
  ReportRounds rounds;
  std::string truth_note;  ///< why there are no errors, or how they were aligned
};

}  // namespace isotherm::apps
