#include <string>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/graph/repeats.hpp"
#include "matrices/decompositions.hpp"
#include "optimize/minimize.hpp"

namespace isotherm::slam::detail {
namespace {

[[noreturn]] void fail(std::size_t constraint, std::uint64_t line, const std::string& problem) {
  std::string place = "constraint " + std::to_string(constraint);
  if (line > 0) place += " (line " + std::to_string(line) + ")";
  throw InvalidArgument("graph", place + " " + problem);
}

template <class Pose>
bool is_finite(const Pose& pose) {
  return pose.translation().allFinite() && pose.rotation_matrix().allFinite();
}

// Sets negative eigenvalues to zero; true if there were any beyond rounding.
template <class Matrix>
bool make_semidefinite(Matrix& information) {
  if (Eigen::LLT<Matrix>(information).info() == Eigen::Success) return false;
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(information);
  const auto& values = eigen.eigenvalues();
  if (values[0] >= -1e-12 * values.cwiseAbs().maxCoeff()) return false;
  information =
      eigen.eigenvectors() * values.cwiseMax(0.0).asDiagonal() * eigen.eigenvectors().transpose();
  return true;
}

}  // namespace

template <class Pose>
PreparedGraph<Pose> prepare(const PoseGraph<Pose>& graph) {
  PreparedGraph<Pose> prepared{graph, 0, 0};
  const auto in_range = [&](Index vertex) { return vertex >= 0 && vertex < graph.vertex_count(); };
  for (const Index vertex : graph.fixed) {
    if (!in_range(vertex)) throw InvalidArgument("graph", "a fixed vertex does not exist");
  }
  for (const Pose& pose : graph.poses) {
    if (!is_finite(pose)) throw InvalidArgument("graph", "a pose is not finite");
  }
  for (std::size_t k = 0; k < graph.constraints.size(); ++k) {
    auto& constraint = prepared.graph.constraints[k];
    if (!in_range(constraint.from) || !in_range(constraint.to)) {
      fail(k, constraint.line, "names a vertex that does not exist");
    }
    if (!is_finite(constraint.T_from_to) || !constraint.information.allFinite()) {
      fail(k, constraint.line, "has an entry that is not finite");
    }
    if (make_semidefinite(constraint.information)) ++prepared.projected_information;
  }
  const auto repeats = exact_repeats(graph);
  for (const auto& repeat : repeats) prepared.graph.constraints[repeat.edge].information.setZero();
  prepared.repeats = static_cast<Index>(repeats.size());
  return prepared;
}

template PreparedGraph<Pose2> prepare(const PoseGraph<Pose2>&);
template PreparedGraph<Pose3> prepare(const PoseGraph<Pose3>&);

}  // namespace isotherm::slam::detail
