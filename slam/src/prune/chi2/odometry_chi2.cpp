#include "isotherm/slam/prune/odometry_chi2.hpp"

#include <Eigen/Cholesky>

#include "isotherm/slam/graph/information.hpp"
#include "isotherm/slam/graph/odometry.hpp"

namespace isotherm::slam {
namespace {

template <class Pose>
double chi2_against(const UncertainPose<Pose>& predicted, const Constraint<Pose>& measured) {
  using Matrix = typename Pose::Matrix;
  const typename Pose::Tangent r = measured.T_from_to.between(predicted.T).log();
  const Matrix j = Pose::right_jacobian_inverse(r);
  const Matrix s = covariance_from_information<Pose::kDof>(measured.information) +
                   j * predicted.covariance * j.transpose();
  return r.dot(Eigen::LDLT<Matrix>(s).solve(r));
}

}  // namespace

template <class Pose>
std::vector<OdometryChi2> odometry_chi2(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  const OdometryChain<Pose> odometry(graph, roles);
  std::vector<OdometryChi2> results;
  results.reserve(roles.candidates.size());
  for (const Index k : roles.candidates) {
    const auto& constraint = graph.constraints[k];
    if (odometry.chain(constraint.from) != odometry.chain(constraint.to)) {
      results.push_back({0.0, false});
      continue;
    }
    const auto predicted = odometry.relative(constraint.from, constraint.to);
    results.push_back({chi2_against(predicted, constraint), true});
  }
  return results;
}

template std::vector<OdometryChi2> odometry_chi2(const PoseGraph<Pose2>&, const EdgeRoles&);
template std::vector<OdometryChi2> odometry_chi2(const PoseGraph<Pose3>&, const EdgeRoles&);

}  // namespace isotherm::slam
