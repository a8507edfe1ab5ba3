#include "localize/start/anchor_frame.hpp"

#include <vector>

#include "isotherm/base/random.hpp"
#include "isotherm/geometry/points/point_alignment.hpp"

namespace isotherm::network::detail {
namespace {

// The isometry with the least sum of squared distances, each no more than the square of
// `tolerance`, of those that fit all points or samples of d + 1 and what agrees with them.
geometry::PointAlignment align_robustly(const Eigen::MatrixXd& from, const Eigen::MatrixXd& to,
                                        double tolerance) {
  constexpr int kMostTrials = 200;
  auto best = geometry::align_points(from, to);
  const auto misses = [&](const geometry::PointAlignment& alignment) {
    return (alignment.apply(from) - to).colwise().norm().eval();
  };
  const auto cost = [&](const geometry::PointAlignment& alignment) {
    return misses(alignment).cwiseAbs2().cwiseMin(tolerance * tolerance).sum();
  };
  double least = cost(best);
  Random random(1);
  for (int trial = 0; trial < kMostTrials; ++trial) {
    std::vector<Eigen::Index> sample;
    for (Eigen::Index k = 0; k <= from.rows(); ++k) {
      sample.push_back(static_cast<Eigen::Index>(random.index(from.cols())));
    }
    auto alignment = geometry::align_points(from(Eigen::all, sample), to(Eigen::all, sample));
    std::vector<Eigen::Index> near;
    const auto off = misses(alignment);
    for (Eigen::Index k = 0; k < from.cols(); ++k) {
      if (off[k] < tolerance) near.push_back(k);
    }
    if (static_cast<Eigen::Index>(near.size()) <= from.rows()) continue;
    alignment = geometry::align_points(from(Eigen::all, near), to(Eigen::all, near));
    const double reached = cost(alignment);
    if (reached >= least) continue;
    least = reached;
    best = alignment;
  }
  return best;
}

}  // namespace

bool align_to_anchors(const RangeProblem& problem, const Placement& anchors, Placement& part) {
  std::vector<Index> shared;
  for (Index v = 0; v < problem.nodes; ++v) {
    if (problem.is_anchor[v] && part.placed[v]) shared.push_back(v);
  }
  if (!span_space(problem, anchors, shared)) return false;
  const auto alignment =
      align_robustly(part.positions(Eigen::all, shared), anchors.positions(Eigen::all, shared),
                     problem.typical_distance);
  part.positions = alignment.apply(part.positions);
  return true;
}

}  // namespace isotherm::network::detail
