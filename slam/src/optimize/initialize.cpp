#include "isotherm/slam/optimize/initialize.hpp"

#include <queue>

#include <Eigen/Geometry>

#include "graph/gauge.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/slam/optimize/robust_kernel.hpp"
#include "isotherm/spectral/sparse/block_cholesky.hpp"
#include "matrices/nearest_rotation.hpp"
#include "optimize/robust_minimize.hpp"

namespace isotherm::slam {
namespace {

struct Step {
  Index constraint;
  Index vertex;  // where it leads
};

using Adjacency = std::vector<std::vector<Step>>;

template <class Pose>
Adjacency adjacency(const PoseGraph<Pose>& graph) {
  Adjacency steps(graph.ids.size());
  for (Index k = 0; k < graph.constraint_count(); ++k) {
    const auto& constraint = graph.constraints[k];
    if (constraint.information.isZero(0.0)) continue;
    steps[constraint.from].push_back({k, constraint.to});
    steps[constraint.to].push_back({k, constraint.from});
  }
  return steps;
}

template <class Pose>
Pose follow(const Constraint<Pose>& constraint, Index vertex, const Pose& T_world_vertex) {
  return constraint.from == vertex ? T_world_vertex * constraint.T_from_to
                                   : T_world_vertex * constraint.T_from_to.inverse();
}

// Breadth first from the held vertices, of which every component has one.
// Preferred constraints are exhausted before another one is followed.
template <class Pose>
std::vector<Pose> follow_tree(const PoseGraph<Pose>& graph, const std::vector<bool>& preferred) {
  const Adjacency steps = adjacency(graph);
  std::vector<Pose> poses = graph.poses;
  poses.resize(graph.ids.size());
  std::vector<bool> reached(graph.ids.size(), false);
  std::queue<Index> queue;
  std::queue<Index> postponed;
  for (const Index held : detail::fix_gauge(graph).held) {
    reached[held] = true;
    queue.push(held);
  }
  while (!queue.empty() || !postponed.empty()) {
    const bool preferred_only = !queue.empty();
    auto& source = preferred_only ? queue : postponed;
    const Index vertex = source.front();
    source.pop();
    bool skipped = false;
    for (const Step& step : steps[vertex]) {
      if (reached[step.vertex]) continue;
      if (preferred_only && !preferred[step.constraint]) {
        skipped = true;
        continue;
      }
      reached[step.vertex] = true;
      poses[step.vertex] = follow(graph.constraints[step.constraint], vertex, poses[vertex]);
      queue.push(step.vertex);
    }
    if (skipped) postponed.push(vertex);
  }
  return poses;
}

template <class Pose>
using Rotation = Eigen::Matrix<double, Pose::kDim, Pose::kDim>;

Pose2 make_pose(const Eigen::Vector2d& translation, const Eigen::Matrix2d& rotation) {
  return {translation, std::atan2(rotation(1, 0), rotation(0, 0))};
}

Pose3 make_pose(const Eigen::Vector3d& translation, const Eigen::Matrix3d& rotation) {
  return {translation, Eigen::Quaterniond(rotation).normalized()};
}

// A linear least-squares problem over one small vector a vertex, with several
// right-hand sides: sum of weight * |x_to - A x_from - b|^2 over constraints.
class VertexSystem {
 public:
  VertexSystem(int block_size, int columns, const detail::Gauge& gauge,
               std::span<const std::pair<Index, Index>> ends)
      : gauge_(gauge),
        ends_(ends.begin(), ends.end()),
        matrix_(block_size, gauge.variable_count, variables(gauge, ends)),
        rhs_(Eigen::MatrixXd::Zero(matrix_.size(), columns)) {}

  void add(std::size_t which, double weight, const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
           const std::vector<Eigen::MatrixXd>& held) {
    const auto [from, to] = ends_[which];
    const Index f = gauge_.variable[from];
    const Index t = gauge_.variable[to];
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(a.rows(), a.cols());
    Eigen::MatrixXd target = b;
    if (f < 0) target += a * held[from];
    if (t < 0) target -= held[to];
    if (t >= 0) {
      matrix_.add_diagonal(t, weight * identity);
      rows(t) += weight * target;
    }
    if (f >= 0) {
      matrix_.add_diagonal(f, weight * (a.transpose() * a));
      rows(f) -= weight * (a.transpose() * target);
    }
    if (f >= 0 && t >= 0) matrix_.add_pair(pair_++, -weight * a.transpose());
  }

  // The solution; held vertices keep their values.
  std::vector<Eigen::MatrixXd> solve(std::vector<Eigen::MatrixXd> held) {
    if (!matrix_.factorise()) {
      throw NumericalError("chordal initialisation", "the linear system is singular");
    }
    rhs_ = matrix_.solve(rhs_);
    for (std::size_t v = 0; v < held.size(); ++v) {
      if (gauge_.variable[v] >= 0) held[v] = rows(gauge_.variable[v]);
    }
    return held;
  }

 private:
  static std::vector<std::pair<Index, Index>> variables(
      const detail::Gauge& gauge, std::span<const std::pair<Index, Index>> ends) {
    std::vector<std::pair<Index, Index>> pairs;
    for (const auto& [from, to] : ends) {
      if (gauge.variable[from] < 0 || gauge.variable[to] < 0) continue;
      pairs.emplace_back(gauge.variable[from], gauge.variable[to]);
    }
    return pairs;
  }

  Eigen::Block<Eigen::MatrixXd> rows(Index variable) {
    const Eigen::Index size = matrix_.block_size();
    return rhs_.block(variable * size, 0, size, rhs_.cols());
  }

  const detail::Gauge& gauge_;
  std::vector<std::pair<Index, Index>> ends_;
  spectral::BlockCholesky matrix_;
  Eigen::MatrixXd rhs_;
  std::size_t pair_ = 0;
};

// Mean information of the translation or rotation part, kept away from zero so
// that every joined vertex is determined.
template <class Pose>
double mean_information(const Constraint<Pose>& constraint, int first, int count) {
  const double mean = constraint.information.diagonal().segment(first, count).mean();
  return std::max(mean, 1e-9 * constraint.information.diagonal().maxCoeff());
}

template <class Pose>
std::vector<Pose> chordal_poses(const PoseGraph<Pose>& graph, std::vector<Pose> poses) {
  constexpr int kDim = Pose::kDim;
  const detail::Gauge gauge = detail::fix_gauge(graph);
  std::vector<Index> used;
  std::vector<std::pair<Index, Index>> ends;
  for (Index k = 0; k < graph.constraint_count(); ++k) {
    const auto& constraint = graph.constraints[k];
    if (constraint.from == constraint.to || !(constraint.information.diagonal().maxCoeff() > 0.0)) {
      continue;
    }
    used.push_back(k);
    ends.emplace_back(constraint.from, constraint.to);
  }

  // R_to = R_from Z is linear in the transposes: R_to' = Z' R_from'.
  VertexSystem rotations(kDim, kDim, gauge, ends);
  std::vector<Eigen::MatrixXd> values;
  for (const Pose& pose : poses) values.emplace_back(pose.rotation_matrix().transpose());
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(kDim, kDim);
  for (std::size_t i = 0; i < used.size(); ++i) {
    const auto& constraint = graph.constraints[used[i]];
    rotations.add(i, mean_information(constraint, kDim, Pose::kDof - kDim),
                  constraint.T_from_to.rotation_matrix().transpose(), zero, values);
  }
  values = rotations.solve(std::move(values));
  std::vector<Rotation<Pose>> rotation;
  for (const auto& value : values) {
    rotation.push_back(detail::nearest_rotation(value.transpose()).rotation);
  }

  VertexSystem translations(1, kDim, gauge, ends);
  std::vector<Eigen::MatrixXd> places;
  for (const Pose& pose : poses) places.emplace_back(pose.translation().transpose());
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(1, 1);
  for (std::size_t i = 0; i < used.size(); ++i) {
    const auto& constraint = graph.constraints[used[i]];
    const Eigen::MatrixXd step =
        (rotation[constraint.from] * constraint.T_from_to.translation()).transpose();
    translations.add(i, mean_information(constraint, 0, kDim), one, step, places);
  }
  places = translations.solve(std::move(places));
  for (std::size_t v = 0; v < poses.size(); ++v) {
    if (gauge.variable[v] < 0) continue;
    poses[v] = make_pose(typename Pose::Translation(places[v].transpose()), rotation[v]);
  }
  return poses;
}

}  // namespace

template <class Pose>
std::vector<Pose> initial_poses(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                Initialization method) {
  if (!graph.poses.empty() && graph.poses.size() != graph.ids.size()) {
    throw InvalidArgument("poses", "must have one entry a vertex, or none");
  }
  const bool any_step =
      method == Initialization::spanning_tree || method == Initialization::automatic;
  std::vector<bool> preferred(graph.constraints.size(), any_step);
  for (const Index k : roles.odometry) preferred[k] = true;
  switch (method) {
    case Initialization::file:
      if (graph.poses.empty() && !graph.ids.empty()) {
        throw InvalidArgument("initialization", "the graph has no poses of its own to start from");
      }
      return graph.poses;
    case Initialization::chordal:
      return chordal_poses(graph, follow_tree(graph, preferred));
    case Initialization::switchable:
      return detail::switchable_poses(graph, roles,
                                      default_kernel_width(RobustKernel::sc, Pose::kDof));
    case Initialization::automatic:
    case Initialization::odometry:
    case Initialization::spanning_tree:
      break;
  }
  return follow_tree(graph, preferred);
}

template <class Pose>
std::vector<Pose> detail::switchable_poses(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                           double width, const ProgressCallback& progress) {
  std::vector<bool> robust(graph.constraints.size(), false);
  for (const Index k : roles.candidates) robust[k] = true;
  const auto odometry = initial_poses(graph, roles, Initialization::odometry);
  auto poses = odometry;
  detail::NormalEquations<Pose> equations(graph);
  Eigen::VectorXd weights;
  detail::MinimizeOptions options;
  options.progress = progress;
  const auto summary =
      detail::minimize_switchable(equations, robust, width, options, poses, weights);
  return summary.status == OptimizeStatus::diverged ? odometry : poses;
}

template std::vector<Pose2> initial_poses(const PoseGraph<Pose2>&, const EdgeRoles&,
                                          Initialization);
template std::vector<Pose3> initial_poses(const PoseGraph<Pose3>&, const EdgeRoles&,
                                          Initialization);
template std::vector<Pose2> detail::switchable_poses(const PoseGraph<Pose2>&, const EdgeRoles&,
                                                     double, const ProgressCallback&);
template std::vector<Pose3> detail::switchable_poses(const PoseGraph<Pose3>&, const EdgeRoles&,
                                                     double, const ProgressCallback&);

}  // namespace isotherm::slam
