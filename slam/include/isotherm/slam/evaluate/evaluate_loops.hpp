#pragma once

#include <cstdint>
#include <vector>

#include "isotherm/slam/evaluate/labels.hpp"
#include "isotherm/spectral/edges/edge_verdicts.hpp"

namespace isotherm::slam {

/// Quality of pruning. A positive is a pruned edge: tp counts incorrect edges
/// pruned, fp correct edges pruned.
struct LoopMetrics {
  std::int64_t tp = 0;
  std::int64_t fp = 0;
  std::int64_t fn = 0;         ///< incorrect edges not pruned (kept or ambiguous)
  std::int64_t tn = 0;         ///< correct edges not pruned (kept or ambiguous)
  std::int64_t ambiguous = 0;  ///< how many of fn + tn are ambiguous
  std::int64_t ignored = 0;    ///< edges labelled ignore; in none of the above

  /// tp / (tp + fp); 1 if nothing was pruned.
  double precision() const;
  /// tp / (tp + fn); 1 if nothing is incorrect.
  double recall() const;
  /// Harmonic mean of precision and recall; 0 if both are 0.
  double f1() const;
  /// Probability that an incorrect edge has a higher score than a correct one,
  /// ties counting half; NaN unless both kinds occur.
  double auc = 0.0;
};

/// Compares verdicts with labels of the same edges.
/// @throws InvalidArgument if an edge of `verdicts` has no label, an edge of
///   `labels` has no verdict, an edge occurs twice, the ends differ, or a score is NaN.
LoopMetrics evaluate_loops(const spectral::EdgeVerdicts& verdicts,
                           const std::vector<EdgeLabel>& labels);

}  // namespace isotherm::slam
