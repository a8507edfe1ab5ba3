#include "localize/problem/small_network.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Cholesky>

#include "isotherm/spectral/sparse/damped_step.hpp"
#include "localize/problem/absence.hpp"
#include "localize/problem/classical_scaling.hpp"
#include "localize/problem/geman_mcclure.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {
namespace {

// Median deviation of normal noise.
constexpr double kMedianOfNormal = 0.6745;

Eigen::MatrixXd shortest_paths(const SmallNetwork& network) {
  const auto n = network.positions.cols();
  Eigen::MatrixXd length = Eigen::MatrixXd::Constant(n, n, std::numeric_limits<double>::infinity());
  length.diagonal().setZero();
  for (const auto& range : network.ranges) {
    const double shorter = std::min(length(range.from, range.to), range.distance);
    length(range.from, range.to) = length(range.to, range.from) = shorter;
  }
  for (Eigen::Index via = 0; via < n; ++via) {
    for (Eigen::Index to = 0; to < n; ++to) {
      const double rest = length(via, to);
      length.col(to) = length.col(to).cwiseMin((length.col(via).array() + rest).matrix());
    }
  }
  return length;
}

double median_deviation(const SmallNetwork& network) {
  std::vector<double> deviations;
  for (const auto& range : network.ranges)
    deviations.push_back(std::abs(deviation(network, range)));
  return lower_median(std::move(deviations));
}

// The ranges as a damped least-squares problem in the free nodes.
class DenseSystem {
 public:
  DenseSystem(SmallNetwork& network, double width) : network_(network), kernel_{width} {}

  void set_width(double width) { kernel_.width = width; }

  bool linearise() {
    const auto d = network_.positions.rows();
    const auto unknowns = d * free_nodes();
    matrix_.setZero(unknowns, unknowns);
    gradient_.setZero(unknowns);
    for (const auto& range : network_.ranges) add_range(range);
    return matrix_.diagonal().sum() > 0.0;
  }

  std::optional<double> move(double damping) {
    Eigen::MatrixXd damped = matrix_;
    damped.diagonal().array() += damping * matrix_.diagonal().mean();
    const Eigen::VectorXd step = damped.ldlt().solve(-gradient_);
    before_ = network_.positions;
    network_.positions.rightCols(free_nodes()) +=
        step.reshaped(network_.positions.rows(), free_nodes());
    return -step.dot(gradient_);
  }

  void take_back() { network_.positions = before_; }

  double cost() const {
    double sum = 0.0;
    for (const auto& range : network_.ranges) {
      sum += kernel_.loss(std::pow(deviation(network_, range), 2));
    }
    return sum;
  }

 private:
  Eigen::Index free_nodes() const { return network_.positions.cols() - network_.fixed; }

  void add_range(const SmallRange& range) {
    const auto d = network_.positions.rows();
    const Point arm = network_.positions.col(range.from) - network_.positions.col(range.to);
    const double length = arm.norm();
    if (length == 0.0) return;
    const Point slope = arm / (length * range.sigma);
    const double residual = (length - range.distance) / range.sigma;
    const double weight = kernel_.weight(residual * residual);
    const Block block = weight * slope * slope.transpose();
    const Eigen::Index ends[] = {d * (range.from - network_.fixed),
                                 d * (range.to - network_.fixed)};
    for (int a = 0; a < 2; ++a) {
      if (ends[a] < 0) continue;
      gradient_.segment(ends[a], d) += (a == 0 ? weight : -weight) * residual * slope;
      for (int b = 0; b < 2; ++b) {
        if (ends[b] >= 0) matrix_.block(ends[a], ends[b], d, d) += (a == b ? 1.0 : -1.0) * block;
      }
    }
  }

  SmallNetwork& network_;
  GemanMcClure kernel_;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd gradient_;
  Eigen::MatrixXd before_;
};

}  // namespace

double deviation(const SmallNetwork& network, const SmallRange& range) {
  const double length =
      (network.positions.col(range.from) - network.positions.col(range.to)).norm();
  return (length - range.distance) / range.sigma;
}

bool place_by_scaling(SmallNetwork& network) {
  const auto d = network.positions.rows();
  const auto n = network.positions.cols();
  const Eigen::MatrixXd length = shortest_paths(network);
  if (!length.allFinite()) return false;
  const auto eigen = classical_scaling(length.cwiseAbs2());
  for (Eigen::Index i = 0; i < d; ++i) {
    const double value = i < n ? std::max(0.0, eigen.eigenvalues()[n - 1 - i]) : 0.0;
    network.positions.row(i).setZero();
    if (i < n) {
      network.positions.row(i) = std::sqrt(value) * eigen.eigenvectors().col(n - 1 - i).transpose();
    }
  }
  return true;
}

void fit_robustly(SmallNetwork& network, double width, int max_iterations) {
  constexpr int kStepsPerWidth = 3;
  constexpr double kStill = 1e-10;  // relative decrease
  constexpr double kDamping = 1e-3;
  double damping = kDamping;
  double current = std::max(width, 2.0 * median_deviation(network) / kMedianOfNormal);
  DenseSystem system(network, current);
  double cost = system.cost();
  for (int k = 0; k < max_iterations; ++k) {
    const double before = cost;
    const bool moved = spectral::damped_step(system, damping, cost);
    const bool still = !moved || before - cost <= kStill * before;
    if (still && current <= width) return;
    if (still || (k + 1) % kStepsPerWidth == 0) {
      const double spread = 2.0 * median_deviation(network) / kMedianOfNormal;
      current = std::max(width, std::min(0.5 * current, spread));
      system.set_width(current);
      cost = system.cost();
      damping = std::min(damping, kDamping);
    }
  }
}

double place_cost(const SmallNetwork& network, const Limits& limits) {
  double cost = 0.0;
  for (const auto& range : network.ranges) {
    const double r = deviation(network, range);
    cost += std::min(r * r, limits(r));
  }
  if (network.absence == nullptr) return cost;
  const Point place = network.positions.rightCols(1);
  for (Eigen::Index k = 0; k < network.strangers.cols(); ++k) {
    cost += network.absence->cost((network.strangers.col(k) - place).norm());
  }
  return cost;
}

}  // namespace isotherm::network::detail
