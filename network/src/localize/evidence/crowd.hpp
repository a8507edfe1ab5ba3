#pragma once

#include <vector>

#include "localize/evidence/star.hpp"
#include "localize/problem/absence.hpp"
#include "localize/problem/point_grid.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// Placed nodes by their place, to see beside whom a node would stand.
class Crowd {
 public:
  /// All placed nodes. The arguments must outlive it.
  Crowd(const RangeProblem& problem, const Placement& placement, const Absence& absence);

  /// Gives the star of a node its strangers: those of the crowd in `among` that have no range
  /// to the node, as far as its neighbours let it come near them.
  void add_strangers(Star& star, Index node, const std::vector<bool>& among) const;

  /// What it costs that a node is at this place without ranges to those of the crowd in
  /// `among`.
  double absence_cost(Index node, const Point& place, const std::vector<bool>& among) const;

 private:
  const RangeProblem& problem_;
  const Absence& absence_;
  PointGrid grid_;
};

/// What it costs that the placed nodes have no other ranges between them. O(nodes * degree^2).
double absence_cost(const RangeProblem& problem, const Absence& absence,
                    const Placement& placement);

}  // namespace isotherm::network::detail
