#pragma once

#include <vector>

#include <Eigen/Core>

namespace isotherm::network::detail {

class Absence;

/// A point or direction in the plane or in space, and a d x d block: no memory of
/// their own to fetch.
using Point = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 3, 1>;
using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;

/// A range within a small network.
struct SmallRange {
  int from = 0;
  int to = 0;
  double distance = 0.0;
  double sigma = 1.0;
};

/// A few nodes, of which the first `fixed` stay where they are.
struct SmallNetwork {
  Eigen::MatrixXd positions;  ///< dimension x nodes
  int fixed = 0;
  std::vector<SmallRange> ranges;
  Eigen::MatrixXd strangers = {};    ///< places of nodes that the last node has no range to
  const Absence* absence = nullptr;  ///< what that costs; null: nothing
};

/// Most that a range can cost, in chi-squared: one that does not fit.
struct Limits {
  double apart = 0.0;  ///< its ends are farther from each other than the range
  double close = 0.0;  ///< they are closer

  double operator()(double residual) const { return residual > 0.0 ? apart : close; }
  double least() const { return apart < close ? apart : close; }
};

/// (distance between the ends - range) / sigma.
double deviation(const SmallNetwork& network, const SmallRange& range);

/// Shortest-path distances between all nodes (Floyd and Warshall; infinite where
/// there is no path), then classical multidimensional scaling: the positions of
/// best-fitting inner products (W. Torgerson 1952; "MDS-MAP" of Y. Shang et al.
/// 2003). O(nodes^3). False if the network is not connected.
bool place_by_scaling(SmallNetwork& network);

/// Moves the free nodes to a minimum of the sum of Geman and McClure's
/// r^2 / (1 + r^2 / width^2), r being the deviations, by reweighted Gauss-Newton
/// steps with damping. The width starts where half of the ranges are well inside and
/// shrinks to `width`. Dense: O(iterations * (dimension * free nodes)^3).
void fit_robustly(SmallNetwork& network, double width, int max_iterations);

/// Sum over the ranges of min(r^2, limit), and of what it costs that the last node has none
/// to the strangers.
double place_cost(const SmallNetwork& network, const Limits& limits);

}  // namespace isotherm::network::detail
