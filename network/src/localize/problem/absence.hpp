#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// What it means that two nodes have no range: how likely that is at each distance, as
/// learned from maps. Where most nodes near each other have one, a place beside nodes without
/// is an unlikely one. Where half of them have none absence says nothing, and neither does it
/// without a map to learn from.
class Absence {
 public:
  Absence() = default;

  /// From the pairs of placed nodes; those between anchors, and those that have a range
  /// which is not trusted, do not count. O(nodes * degree).
  static Absence learn(const RangeProblem& problem, const std::vector<bool>& trusted,
                       const Placement& placement);

  /// Twice the log of how much less likely than not it is to have no range at this distance; at
  /// least 0.
  double cost(double distance) const;

  /// Its derivative; at most 0.
  double slope(double distance) const;

  /// How far apart the distances are between which it changes.
  double resolution() const { return bin_; }

  /// Distance from which on absence costs nothing: up to there most nodes have a range. 0 if
  /// it never costs anything.
  double reach() const { return reach_; }

 private:
  class Counts;
  std::pair<double, double> at(double distance) const;  // cost and slope
  double bin_ = 0.0;                                    // width
  std::vector<double> costs_;                           // at the middle of each bin
  double reach_ = 0.0;
};

}  // namespace isotherm::network::detail
