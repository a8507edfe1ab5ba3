#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "isotherm/base/progress.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"

namespace isotherm::spectral::detail {

/// By how many vertices each pair reaches past: the vertices nearer to one end than the other end
/// is, counted from the end that has fewer of them; 0 for equal ends. `positions` is dimension x
/// vertices. O(pairs sqrt n) in the plane.
/// @throws Cancelled
std::vector<double> pair_ranks(const Eigen::MatrixXd& positions,
                               const std::vector<VertexPair>& pairs, int threads,
                               const ProgressCallback& progress);

}  // namespace isotherm::spectral::detail
