#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "isotherm/base/parallel.hpp"
#include "isotherm/network/localize/localize.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// What a map is sought of, and what every step of the search goes by.
struct MapTask {
  const RangeProblem& problem;
  const std::vector<bool>& trusted;  ///< one a pair
  double gate;                       ///< squared deviation up to which a range fits a map
  const LocalizeOptions& options;

  bool fits(const Placement& placement, const RangePair& pair) const {
    return squared_deviation(placement, pair) <= gate;
  }

  /// Calls visit(pair) for the trusted pairs of placed nodes.
  template <class Visit>
  void visit_pairs(const Placement& placement, const Visit& visit) const {
    for (std::size_t p = 0; p < problem.pairs.size(); ++p) {
      if (trusted[p] && is_placed(placement, problem.pairs[p])) visit(problem.pairs[p]);
    }
  }

  /// Calls visit(neighbour, pair) for those of a node.
  template <class Visit>
  void visit_neighbours(const Placement& placement, Index node, const Visit& visit) const {
    for (const auto& [vertex, edge] : problem.pair_graph.neighbours(node)) {
      if (trusted[edge] && placement.placed[vertex]) visit(vertex, edge);
    }
  }

  /// Calls work(k) for all numbers below `count`, saying what is being done. @throws Cancelled
  void in_parallel(std::size_t count, std::string_view what,
                   const std::function<void(std::int64_t)>& work) const {
    parallel_for(static_cast<std::int64_t>(count), options.threads, options.progress, what, work);
  }
};

}  // namespace isotherm::network::detail
