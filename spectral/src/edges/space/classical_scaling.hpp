#pragma once

#include <span>

#include <Eigen/Core>

#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::spectral::detail {

/// Fewest steps between any two vertices along edges whose trust is not 0, a chain counted by its
/// length. Where there is no way, the longest of all and one more. O(n (n + m)).
/// @param lengths whole numbers
Eigen::MatrixXd steps_between(const WeightedGraph& graph, std::span<const double> lengths,
                              std::span<const double> trust);

/// Places, a column each, whose distances are nearest to those given (Torgerson 1952): eigenvectors
/// of the largest eigenvalues of the centred matrix of squares, of which negative ones count as 0,
/// the largest first, so that the first rows are the places in fewer dimensions.
/// @param distances symmetric; at least `dimension` + 3 rows
Eigen::MatrixXd classical_scaling(const Eigen::MatrixXd& distances, Eigen::Index dimension);

}  // namespace isotherm::spectral::detail
