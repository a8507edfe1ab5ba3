#pragma once

#include <vector>

#include "localize/problem/patch.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// A part of the network in one frame of its own.
struct StitchedPart {
  std::vector<Index> nodes;   ///< ascending
  Eigen::MatrixXd positions;  ///< dimension x nodes
};

/// Brings the patches of neighbours that share d + 1 members or more into common
/// frames, and places their members: rotations and reflections by synchronisation
/// (the smallest eigenvectors of the connection Laplacian; A. Singer, "Angular
/// synchronization by eigenvectors and semidefinite programming", 2011; M.
/// Cucuringu, Y. Lipman, A. Singer, "Sensor network localization by eigenvector
/// synchronization over the Euclidean group", 2012), then positions by least
/// squares, each reweighted so that bad patches lose their say. Parts are ordered
/// by falling size; a node can be in several.
std::vector<StitchedPart> stitch(const RangeProblem& problem, const std::vector<Patch>& patches);

}  // namespace isotherm::network::detail
