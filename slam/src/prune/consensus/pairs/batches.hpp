#pragma once

#include <cstddef>
#include <vector>

#include "prune/consensus/pairs/agreement.hpp"
#include "prune/consensus/pairs/mutual_support.hpp"

namespace isotherm::slam::detail {

/// Which of `passing` loops to accept together. Every accepted loop sharpens the
/// prediction of the others, so that only the most certain third is taken; and with it
/// those that are beyond doubt already, as long as the expected number of false ones
/// stays below `expected_false`. `log_odds` has one entry a loop of the graph.
std::vector<Index> most_certain_third(std::vector<Index> passing,
                                      const std::vector<double>& log_odds, double expected_false);

/// The `eligible` loops in groups of those that agree, each group and all groups in order
/// of their first loop. `loop_count` is that of the graph.
std::vector<std::vector<Index>> agreeing_groups(const MutualSupport& support,
                                                const std::vector<Index>& eligible,
                                                std::size_t loop_count);

/// Groups tried at most where each is accepted on trial, at the cost of an estimate.
inline constexpr std::size_t kMostTrials = 30;

/// Puts the largest groups first; those of one size keep their order.
void largest_first(std::vector<std::vector<Index>>& groups);

/// The strongest groups of loops that confirm each other, among the `eligible` ones.
///
/// A group's score is what the graph says about its best member, plus what agreement
/// adds: at most the odds against a false loop agreeing with its false neighbour, as
/// `agreement` says, and nothing if true ones agree better, or by repeating a measurement.
/// Groups below `required_odds` are left, and those well below the strongest, which are
/// better judged afterwards.
std::vector<Index> strongest_clusters(const MutualSupport& support,
                                      const std::vector<Index>& eligible,
                                      const std::vector<double>& log_odds,
                                      const Agreement& agreement, double required_odds);

}  // namespace isotherm::slam::detail
