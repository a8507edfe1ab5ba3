#pragma once

#include <span>
#include <vector>

#include "isotherm/spectral/types.hpp"

namespace isotherm::spectral::detail {

/// A list of scores explained as a mixture of true and false ones.
struct TwoGroups {
  std::vector<double> truth;  ///< probability that each score is a true one, in [0, 1]
  double false_count = 0.0;   ///< estimated number of false ones
};

/// Separates `scores` (larger is more suspicious) given scores that are known to be
/// false, `null_scores`, of which the false ones are taken to be a further sample.
///
/// The number of false ones is estimated from the upper tails (Storey 2002); the
/// local false discovery rate (Efron et al. 2001) is a ratio of two densities, of
/// which neither is modelled: it is found by isotonic regression of group on score,
/// and so the probability never rises with the score. Without null scores, all are
/// true. So they are where more than a share `most_false` of them would be false: scores that
/// find no difference between edges and other pairs say nothing. O(q log q) for q scores of both
/// kinds.
TwoGroups separate_groups(std::span<const double> scores, std::span<const double> null_scores,
                          double most_false = 1.0);

/// What scores say of edges of which something else has told how likely each is a true one: the
/// probability as a function of the score that never rises with it and is nearest to what was told
/// (isotonic regression). O(q log q).
TwoGroups calibrate(std::span<const double> scores, std::span<const double> truth);

/// Places of scores, from the largest on.
std::vector<Index> by_suspicion(std::span<const double> scores);

/// Scores above this are to be taken for false ones: those less likely true than `chance`, but no
/// more of them than there are false ones by the estimate, so that one expects to reject as many
/// true ones as one keeps false ones. Infinite if there are none.
double rejection_threshold(std::span<const double> scores, const TwoGroups& groups, double chance);

/// Scores above this, of those less likely true than `chance`, are to be taken for false ones where
/// that gives the highest F to be expected: the harmonic mean of how many of the rejected are false
/// and how many of the false are rejected. Infinite if there are none. Unlike rejection_threshold()
/// for scores of which many are equal.
double threshold_of_best_f(std::span<const double> scores, const TwoGroups& groups, double chance);

}  // namespace isotherm::spectral::detail
