#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "isotherm/slam/evaluate/labels.hpp"
#include "isotherm/spectral/edges/edge_verdicts.hpp"

namespace isotherm::slam {

/// A verdict that a loop was given, or changed to, while a graph came in.
struct TimedVerdict {
  std::int64_t edge = 0;
  spectral::Verdict verdict = spectral::Verdict::ambiguous;
  std::int64_t at = 0;     ///< number of the edge that brought it; that of all edges at the end
  std::int64_t poses = 0;  ///< how many had come by then
  std::optional<double> probability;  ///< of the loop being true, where that was told
};

/// As if there were no third verdict, for comparison with methods that have none: a loop whose
/// probability is known is kept where it is likelier true than false, and else pruned.
std::vector<TimedVerdict> decided_at_even_odds(std::vector<TimedVerdict> verdicts);

/// How the loops that had come stood from one edge on. A positive is a loop that is kept.
struct OnlineStep {
  std::int64_t at = 0;
  std::int64_t poses = 0;
  std::int64_t kept_true = 0;
  std::int64_t kept_false = 0;
  std::int64_t missed = 0;  ///< true loops that are not kept

  /// The share of kept loops that are true; 1 where none is kept.
  double precision() const;
  /// The share of true loops that are kept; 1 where none has come.
  double recall() const;
};

struct OnlineMetrics {
  std::vector<OnlineStep> steps;  ///< one an edge that changed a verdict, in order
  double mean_precision = 1.0;    ///< over all edges from the first loop to the last edge
  double mean_recall = 1.0;
  std::int64_t right = 0;      ///< true loops kept and false ones pruned, at the end
  std::int64_t wrong = 0;      ///< the other way round
  std::int64_t undecided = 0;  ///< ambiguous at the end
  std::int64_t ignored = 0;    ///< loops labelled ignore, or not at all; in none of the above
  /// Of loops that end right, poses from the first verdict to the last change; ascending.
  std::vector<std::int64_t> delays;
};

/// Compares verdicts through time, in order of `at`, with labels of the same edges. `edges` is how
/// many there are.
/// @throws InvalidArgument if verdicts are out of order, or a label occurs twice
OnlineMetrics evaluate_online(const std::vector<TimedVerdict>& verdicts,
                              const std::vector<EdgeLabel>& labels, std::int64_t edges);

}  // namespace isotherm::slam
