#include "isotherm/slam/graph/usable_odometry.hpp"

#include <cmath>

#include "isotherm/base/error.hpp"
#include "isotherm/base/statistics.hpp"
#include "isotherm/slam/graph/information.hpp"
#include "matrices/decompositions.hpp"

namespace isotherm::slam {
namespace {

constexpr double kFarthest = 1e11;  // from what is typical
constexpr double kRepaired = 1e10;

// Deviations of the information (square roots of the diagonal) that are typical of odometry: the
// median of those that are positive, or 1 where there are none. They make matrices comparable
// in any units.
template <class Pose>
typename Pose::Tangent typical_deviations(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  typename Pose::Tangent typical = Pose::Tangent::Ones();
  for (int d = 0; d < Pose::kDof; ++d) {
    std::vector<double> known;
    for (const Index k : roles.odometry) {
      const double entry = graph.constraints[k].information(d, d);
      if (std::isfinite(entry) && entry > 0.0) known.push_back(std::sqrt(entry));
    }
    if (!known.empty()) typical[d] = median(std::move(known));
  }
  return typical;
}

// Eigenvalues and eigenvectors of the matrix in units of what is typical.
template <class Pose>
Eigen::SelfAdjointEigenSolver<typename Pose::Matrix> relative_eigen(
    const typename Pose::Matrix& information, const typename Pose::Tangent& typical) {
  const typename Pose::Tangent inverse = typical.cwiseInverse();
  const typename Pose::Matrix relative = inverse.asDiagonal() * information * inverse.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<typename Pose::Matrix>(relative);
}

}  // namespace

template <class Pose>
std::vector<Index> unusable_information(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  const auto typical = typical_deviations(graph, roles);
  std::vector<Index> unusable;
  for (const Index k : roles.odometry) {
    const auto& information = graph.constraints[k].information;
    if (information.isZero(0.0)) continue;
    const auto values = relative_eigen<Pose>(information, typical).eigenvalues();
    const bool near = values[0] >= 1.0 / kFarthest && values[Pose::kDof - 1] <= kFarthest;
    if (!near || !is_usable_information<Pose::kDof>(information)) unusable.push_back(k);
  }
  return unusable;
}

template <class Pose>
PoseGraph<Pose> with_usable_information(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                        const std::vector<Index>& unusable) {
  const auto typical = typical_deviations(graph, roles);
  PoseGraph<Pose> repaired = graph;
  for (const Index k : unusable) {
    auto& information = repaired.constraints[k].information;
    if (!information.allFinite()) {
      throw NumericalError("information", "matrix with an entry that is not finite");
    }
    const auto eigen = relative_eigen<Pose>(information, typical);
    const typename Pose::Tangent values =
        eigen.eigenvalues().cwiseMax(1.0 / kRepaired).cwiseMin(kRepaired);
    const typename Pose::Matrix vectors = typical.asDiagonal() * eigen.eigenvectors();
    information = vectors * values.asDiagonal() * vectors.transpose();
    information = (0.5 * (information + information.transpose())).eval();
    if (!is_usable_information<Pose::kDof>(information)) {
      information = usable_information<Pose::kDof>(information);
    }
  }
  return repaired;
}

template <class Pose>
std::string describe_unusable(const PoseGraph<Pose>& graph, const std::vector<Index>& unusable) {
  const auto& first = graph.constraints[unusable.front()];
  std::string text = "odometry edge " + std::to_string(unusable.front()) + ", from vertex " +
                     vertex_name(graph.ids[first.from]) + " to " + vertex_name(graph.ids[first.to]);
  if (unusable.size() > 1) text += ", and " + std::to_string(unusable.size() - 1) + " more";
  return text + ": information matrix too near to a singular one";
}

template std::vector<Index> unusable_information(const PoseGraph<Pose2>&, const EdgeRoles&);
template std::vector<Index> unusable_information(const PoseGraph<Pose3>&, const EdgeRoles&);
template PoseGraph<Pose2> with_usable_information(const PoseGraph<Pose2>&, const EdgeRoles&,
                                                  const std::vector<Index>&);
template PoseGraph<Pose3> with_usable_information(const PoseGraph<Pose3>&, const EdgeRoles&,
                                                  const std::vector<Index>&);
template std::string describe_unusable(const PoseGraph<Pose2>&, const std::vector<Index>&);
template std::string describe_unusable(const PoseGraph<Pose3>&, const std::vector<Index>&);

}  // namespace isotherm::slam
