#include "localize/start/path_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include <Eigen/Eigenvalues>

#include "localize/constants.hpp"
#include "localize/problem/absence.hpp"
#include "localize/problem/point_grid.hpp"
#include "localize/refine/refine.hpp"

namespace isotherm::network::detail {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

// Lengths of the shortest paths from a node (Dijkstra).
Eigen::VectorXd path_lengths(const RangeProblem& problem, const std::vector<bool>& trusted,
                             Index start) {
  Eigen::VectorXd length = Eigen::VectorXd::Constant(problem.nodes, kFar);
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  length[start] = 0.0;
  queue.emplace(0.0, start);
  while (!queue.empty()) {
    const auto [reached, node] = queue.top();
    queue.pop();
    if (reached > length[node]) continue;
    for (const auto& [vertex, edge] : problem.pair_graph.neighbours(node)) {
      const double longer = reached + problem.pairs[edge].distance;
      if (!trusted[edge] || longer >= length[vertex]) continue;
      length[vertex] = longer;
      queue.emplace(longer, vertex);
    }
  }
  return length;
}

// The nodes of the largest part, ascending.
std::vector<Index> largest_part(const RangeProblem& problem, const std::vector<bool>& trusted) {
  std::vector<spectral::WeightedEdge> edges;
  for (std::size_t p = 0; p < problem.pairs.size(); ++p) {
    if (trusted[p]) edges.push_back({problem.pairs[p].from, problem.pairs[p].to, 1.0});
  }
  const auto components =
      spectral::connected_components(spectral::WeightedGraph(problem.nodes, edges));
  std::vector<Index> size(components.count, 0);
  for (const auto label : components.label) ++size[label];
  const auto largest = std::max_element(size.begin(), size.end()) - size.begin();
  std::vector<Index> nodes;
  for (Index v = 0; v < problem.nodes; ++v) {
    if (components.label[v] == largest) nodes.push_back(v);
  }
  return nodes;
}

// Squared path lengths from pilots, each the node farthest from those before, to the nodes.
struct Pilots {
  std::vector<Index> which;  // places among the nodes
  Eigen::MatrixXd squared;   // nodes x pilots
};

Pilots choose_pilots(const RangeProblem& problem, const std::vector<bool>& trusted,
                     const std::vector<Index>& nodes) {
  constexpr Eigen::Index kMost = 200;
  const auto n = static_cast<Eigen::Index>(nodes.size());
  const auto count = std::min(kMost, n);
  Pilots pilots;
  pilots.squared.resize(n, count);
  Eigen::VectorXd nearest = Eigen::VectorXd::Constant(n, kFar);
  Eigen::Index next = 0;
  for (Eigen::Index k = 0; k < count; ++k) {
    pilots.which.push_back(static_cast<Index>(next));
    const Eigen::VectorXd length = path_lengths(problem, trusted, nodes[next])(nodes);
    pilots.squared.col(k) = length.cwiseAbs2();
    nearest = nearest.cwiseMin(length);
    nearest.maxCoeff(&next);
  }
  return pilots;
}

// Eigenpairs of the inner products of points about their centre, from their squared distances: the
// points' coordinates are the last eigenvectors times the roots of their values (W. Torgerson,
// "Multidimensional scaling", 1952).
Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> classical_scaling(const Eigen::MatrixXd& squared,
                                                                 const Eigen::RowVectorXd& means) {
  Eigen::MatrixXd inner = squared.rowwise() - means;
  inner.colwise() -= means.transpose();
  inner.array() += means.mean();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(-0.5 * inner);
}

// Classical scaling of the pilots; the others by their distances from these.
Eigen::MatrixXd scale(const Pilots& pilots, int d) {
  const Eigen::MatrixXd among = pilots.squared(pilots.which, Eigen::all);
  const Eigen::RowVectorXd means = among.colwise().mean();
  const auto eigen = classical_scaling(among, means);
  const auto n = among.rows();
  Eigen::MatrixXd positions = Eigen::MatrixXd::Zero(d, pilots.squared.rows());
  for (Eigen::Index i = 0; i < std::min<Eigen::Index>(d, n); ++i) {
    const double value = eigen.eigenvalues()[n - 1 - i];
    if (!(value > 0.0)) continue;
    const Eigen::VectorXd axis = eigen.eigenvectors().col(n - 1 - i) / std::sqrt(value);
    positions.row(i) = 0.5 * ((-pilots.squared).rowwise() + means) * axis;
  }
  return positions;
}

// Makes the distances of the pairs theirs in the median.
void match_size(const MapTask& task, Placement& placement) {
  std::vector<double> ratios;
  task.visit_pairs(placement, [&](const RangePair& pair) {
    const double length = distance_of(placement, pair.from, pair.to);
    if (length > 0.0) ratios.push_back(pair.distance / length);
  });
  if (!ratios.empty()) placement.positions *= lower_median(std::move(ratios));
}

// The map as a body of springs.
class Unfolding {
 public:
  Unfolding(const MapTask& task, Errors errors, Placement& placement)
      : task_(task),
        problem_(task.problem),
        errors_(errors),
        placement_(placement),
        sigma_(task.problem.typical_sigma) {}

  // From a loss that is wide beside the errors of the map down to that of a range.
  void run() {
    constexpr double kNarrowest = 0.02;  // typical ranges; the rest is for the refinement
    const double narrow =
        std::max(std::sqrt(task_.gate), kNarrowest * problem_.typical_distance / sigma_);
    wide_ = std::max(narrow, kRoughMap * problem_.typical_distance / sigma_);
    for (double width = wide_; width > narrow; width *= 0.5) fit(width);
    fit(narrow);
  }

 private:
  void fit(double width) {
    constexpr int kRounds = 3;
    constexpr int kIterations = 5;
    for (int round = 0; round < kRounds; ++round) {
      reach_ = Absence::learn(problem_, task_.trusted, placement_).reach();
      auto springs = ranges(width);
      add_repulsion(springs);
      refine(problem_, springs, placement_,
             {.max_iterations = kIterations, .progress = task_.options.progress});
    }
  }

  // All with the usual deviation: those stated of false ranges mislead, and a few very short
  // ones would rule a map that is still rough.
  std::vector<Spring> ranges(double width) const {
    const double apart = errors_ == Errors::too_long ? wide_ : width;
    std::vector<Spring> springs;
    task_.visit_pairs(placement_, [&](const RangePair& pair) {
      springs.push_back({pair.from, pair.to, pair.distance, sigma_, apart, width});
    });
    return springs;
  }

  void add_repulsion(std::vector<Spring>& springs) const {
    if (!(reach_ > 0.0)) return;
    for (const auto& [a, b] : near_nodes(placement_, reach_)) {
      if (!has_range(problem_, a, b))
        springs.push_back({a, b, reach_, kRepulsion * reach_, 0.0, kRepulsionWidth});
    }
  }

  const MapTask& task_;
  const RangeProblem& problem_;
  Errors errors_;
  double reach_ = 0.0;
  Placement& placement_;
  double sigma_;
  double wide_ = 0.0;
};

}  // namespace

Placement map_by_paths(const MapTask& task, Errors errors) {
  const RangeProblem& problem = task.problem;
  const auto nodes = largest_part(problem, task.trusted);
  if (static_cast<int>(nodes.size()) <= problem.dimension) {
    return place_nodes(problem, {}, Eigen::MatrixXd(problem.dimension, 0));
  }
  const auto pilots = choose_pilots(problem, task.trusted, nodes);
  auto placement = place_nodes(problem, nodes, scale(pilots, problem.dimension));
  match_size(task, placement);
  unfold(task, errors, placement);
  return placement;
}

void unfold(const MapTask& task, Errors errors, Placement& placement) {
  Unfolding(task, errors, placement).run();
}

}  // namespace isotherm::network::detail
