#pragma once

#include <vector>

#include <Eigen/Core>

namespace isotherm::spectral::detail {

/// What is measured of edges, each without itself, and of pairs that no edge joins; a row each.
struct PairFeatures {
  Eigen::MatrixXd edges;
  Eigen::MatrixXd pairs;
};

/// Edges as a mixture of true ones and false ones, which are like the pairs:
///
///   f(x) = (1 - c) f_true(x) + c f_pairs(x),   log (f_pairs / f_true) = linear in x.
///
/// The linear function is that of a logistic regression of pairs against edges, each weighted by
/// the probability that it is a true one. That and c are found in turn, as both make the edges more
/// likely (Dempster, Laird and Rubin 1977). If the model holds, no score tells true edges from
/// false ones better (Neyman and Pearson 1933). Features that say the same share, and those that
/// say nothing get no weight.
struct EdgeOdds {
  std::vector<double> scores;  ///< log (f_pairs / f_true) of each edge
  std::vector<double> truth;   ///< probability that an edge is a true one
  double false_count = 0.0;    ///< expected number of false ones
  /// sum of log f(x) / f_pairs(x) over the edges, less what the coefficients' prior takes: how much
  /// better than pairs the mixture explains them, in nats.
  double log_evidence = 0.0;
};

/// @param truth the probabilities to start from
EdgeOdds edge_odds(const PairFeatures& features, std::vector<double> truth);

}  // namespace isotherm::spectral::detail
