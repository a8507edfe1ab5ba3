#pragma once

#include <vector>

#include "isotherm/network/localize/localize.hpp"
#include "isotherm/network/localize/range_mixture.hpp"
#include "localize/problem/range_problem.hpp"
#include "localize/refine/refine.hpp"

namespace isotherm::network::detail {

/// What all ranges between placed nodes weigh, each by how likely it is of a kind that weighs.
struct WeighedRanges {
  RangeMixture model;
  bool too_long = true;             ///< whether ranges can be
  std::vector<bool> weighs;         ///< one a range: more than nothing
  std::vector<double> information;  ///< one a range, 1 / m^2
  RefineOutcome outcome;
  double evidence = 0.0;  ///< log, by Laplace's approximation, up to a constant
};

/// Moves the placed nodes to where the ranges are likeliest, each being correct, too long or
/// anything, and others absent. Whether any are too long is what has more evidence. @throws
/// Cancelled, NumericalError
WeighedRanges weigh_ranges(const RangeProblem& problem, const Absence& absence,
                           const LocalizeOptions& options, Placement& placement);

/// The same from what was found before, with kinds of range that are the same.
WeighedRanges weigh_ranges_again(const RangeProblem& problem, const Absence& absence,
                                 const LocalizeOptions& options, const WeighedRanges& before,
                                 Placement& placement);

/// What each range is, given all others: one a range, without probabilities where nothing checks
/// it.
struct JudgedRange {
  bool checked = false;
  bool fits = false;     ///< likelier correct than not where its ends are
  RangeLoss loss;        ///< where the others predict it
  RangeMoments moments;  ///< with it
  double fitted = 0.0;   ///< of its degree of freedom, what the estimate has used up
};

std::vector<JudgedRange> judge_ranges(const RangeProblem& problem, const WeighedRanges& weighed,
                                      const Placement& placement);

}  // namespace isotherm::network::detail
