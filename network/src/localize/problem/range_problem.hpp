#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "isotherm/network/range_network.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::network::detail {

/// A point or direction in the plane or in space, and a d x d block: no memory of
/// their own to fetch.
using Point = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 3, 1>;
using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;

/// All ranges between the same two nodes, as one.
struct RangePair {
  Index from = 0;
  Index to = 0;
  double distance = 0.0;  ///< median
  double sigma = 0.0;
};

/// Ranges by the two nodes that they are between.
struct PairGroups {
  std::vector<Index> pair_of;                    ///< range -> pair
  std::vector<std::vector<std::size_t>> ranges;  ///< of each pair, by order of first appearance
};

PairGroups group_by_pair(const std::vector<RangeMeasurement>& ranges);

/// A network as the stages of localisation see it.
struct RangeProblem {
  int dimension = 2;
  Index nodes = 0;
  std::vector<RangeMeasurement> ranges;
  std::vector<double> sigmas;          ///< one a range, > 0; provisional where none was given
  std::vector<bool> sigma_given;       ///< one a range
  std::vector<bool> is_anchor;         ///< one a node
  double typical_distance = 0.0;       ///< median of the ranges
  double typical_sigma = 0.0;          ///< median of the standard deviations; NaN without ranges
  std::vector<RangePair> pairs;        ///< by order of first appearance
  spectral::WeightedGraph pair_graph;  ///< edge k is pair k, of weight 1
  std::vector<Index> pair_of;          ///< range -> pair

  bool anchored() const;
};

/// Where nodes are believed to be.
struct Placement {
  Eigen::MatrixXd positions;  ///< dimension x nodes; meaningless where not placed
  std::vector<bool> placed;
};

/// Some nodes at the columns of `positions`, nothing else.
Placement place_nodes(const RangeProblem& problem, const std::vector<Index>& nodes,
                      const Eigen::MatrixXd& positions);

/// How many nodes have a place.
Index placed_count(const Placement& placement);

/// Of the box around the placed nodes, the diagonal; 0 of none.
double extent(const Placement& placement);

/// Whether both have one.
inline bool are_placed(const Placement& placement, Index a, Index b) {
  return placement.placed[a] && placement.placed[b];
}
/// The same of the ends of a range or a pair.
template <class Range>
bool is_placed(const Placement& placement, const Range& range) {
  return are_placed(placement, range.from, range.to);
}

/// Between two points of so many coordinates; the innermost of all loops.
inline double distance_between(const double* a, const double* b, Eigen::Index dimension) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < dimension; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}
inline double distance_between(const Point& a, const Point& b) {
  return distance_between(a.data(), b.data(), a.size());
}

/// Between two placed nodes.
inline double distance_of(const Placement& placement, Index a, Index b) {
  const auto& at = placement.positions;
  return distance_between(at.col(a).data(), at.col(b).data(), at.rows());
}

/// (distance between the places of a pair - its range) / sigma.
double deviation(const Placement& placement, const RangePair& pair);

/// Its square.
double squared_deviation(const Placement& placement, const RangePair& pair);

/// Which nodes are at most so many ranges away from one of `nodes`; only over the `usable` pairs,
/// if these are given.
std::vector<bool> within_steps(const RangeProblem& problem, const std::vector<Index>& nodes,
                               int steps, const std::vector<bool>& usable = {});

/// Whether there is a range between two nodes. O(degree).
bool has_range(const RangeProblem& problem, Index a, Index b);

/// @throws InvalidArgument as `localize` does
void check(const RangeNetwork& network);

/// The network must be valid.
RangeProblem make_problem(const RangeNetwork& network);

/// The anchors where they are, nothing else.
Placement anchors_only(const RangeNetwork& network, const RangeProblem& problem);

/// Whether nodes stand clear of every line (plane, in space), so that nothing on them can
/// be mirrored: by more than the noise of the ranges.
bool span_space(const RangeProblem& problem, const Placement& placement,
                const std::vector<Index>& nodes);

/// Whether the anchors, as far as `placement` has them, span space.
bool anchors_span_space(const RangeProblem& problem, const Placement& placement);

/// The middle one of `values` (the lower of two); NaN if there are none.
double lower_median(std::vector<double> values);

/// That of the values of some numbers.
double median_over(const std::vector<std::size_t>& numbers,
                   const std::function<double(std::size_t)>& value_of);

}  // namespace isotherm::network::detail
