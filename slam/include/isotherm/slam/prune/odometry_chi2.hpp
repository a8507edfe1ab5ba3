#pragma once

#include <vector>

#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam {

/// How badly one candidate disagrees with odometry alone.
struct OdometryChi2 {
  double chi2 = 0.0;      ///< at the optimum of odometry plus this one constraint
  bool connected = true;  ///< false: no odometry path joins the ends, so chi2 is 0
};

/// Chi-squared of every candidate when it is added, alone, to odometry
/// (S. Datta et al., "SLAM Pose-graph Robustification via Multi-scale
/// Heat-Kernel Analysis", section V-A-2).
///
/// For a chain the optimum has a closed form: r' (Sigma_loop + J Sigma_path J')^-1 r
/// with r the residual under odometry, Sigma_path the covariance propagated along
/// the path and J the derivative of r by the path's end. No solver is run.
/// Under a correct constraint the value follows chi-squared with Pose::kDof
/// degrees of freedom. One entry a candidate, in the order of roles.candidates;
/// O(log n) each. A constraint from a vertex to itself is compared with the
/// identity, known exactly.
template <class Pose>
std::vector<OdometryChi2> odometry_chi2(const PoseGraph<Pose>& graph, const EdgeRoles& roles);

}  // namespace isotherm::slam
