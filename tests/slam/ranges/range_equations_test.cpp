#include "ranges/range_equations.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "ranges/known_world.hpp"
#include "slam/ranges/range_graphs.hpp"

namespace isotherm::slam::detail {
namespace {

using isotherm_test::simulated_ranges;

// A small world, all in one body, near its truth.
template <class Pose>
struct Case {
  KnownWorld<Pose> world;
  RangeProblem<Pose> problem;
  RangeEstimate<Pose> at;

  explicit Case(bool calibrated)
      : world(know_world(simulated_ranges<Pose>({.poses = 8, .beacons = 2, .ranges = 30}), {})) {
    const auto n = world.graph.names.size();
    Bodies bodies{std::vector<Index>(n, 0), std::vector<bool>(n, true)};
    problem = problem_of(world, bodies);
    problem.calibrated = calibrated;
    at.poses = world.graph.positions;
    Random random(3);
    for (std::size_t v = 1; v < n; ++v) {
      at.poses[v] = at.poses[v] * Pose::exp(isotherm_test::noise_of<Pose>(random, 0.01));
    }
    at.model.longest = world.longest;
    at.model.share = {0.98, 0.01, 0.01};
    at.model.excess = 3.0;
    at.model.odometry = 2.0;
    if (!calibrated) at.model.offset = 0.02;
    if (!calibrated) at.model.log_stretch = 0.003;
  }

  Eigen::Index unknowns() const {
    return Eigen::Index{problem.gauge.variable_count} * Pose::kDof + (problem.calibrated ? 0 : 2);
  }

  RangeEstimate<Pose> moved(const Eigen::VectorXd& step) const {
    auto result = at;
    for (std::size_t v = 0; v < at.poses.size(); ++v) {
      const Index variable = problem.gauge.variable[v];
      if (variable < 0) continue;
      typename Pose::Tangent xi =
          step.template segment<Pose::kDof>(Eigen::Index{variable} * Pose::kDof);
      // The system keeps points from turning; the cost does not know of it.
      if (problem.is_point[v]) xi.template tail<Pose::kDof - Pose::kDim>().setZero();
      result.poses[v] = at.poses[v] * Pose::exp(xi);
    }
    if (!problem.calibrated) {
      result.model.offset += step[step.size() - 2];
      result.model.log_stretch += step[step.size() - 1];
    }
    return result;
  }
};

// The Gauss-Newton system by finite differences of residuals, dense.
template <class Pose>
struct DenseSystem {
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;

  explicit DenseSystem(const Case<Pose>& c) {
    const Eigen::Index n = c.unknowns();
    hessian = Eigen::MatrixXd::Zero(n, n);
    gradient = Eigen::VectorXd::Zero(n);
    const double h = 1e-5;  // rounding and truncation weigh about the same
    const auto at_step = [&](Eigen::Index i, double size) {
      Eigen::VectorXd step = Eigen::VectorXd::Zero(n);
      step[i] = size;
      return c.moved(step);
    };
    std::vector<RangeEstimate<Pose>> up;
    std::vector<RangeEstimate<Pose>> down;
    for (Eigen::Index i = 0; i < n; ++i) {
      up.push_back(at_step(i, h));
      down.push_back(at_step(i, -h));
    }
    for (const auto& step : c.problem.steps.constraints) {
      Eigen::MatrixXd jacobian(Pose::kDof, n);
      const auto error = [&](const RangeEstimate<Pose>& e) {
        return residual(step, e.poses[step.from], e.poses[step.to]);
      };
      for (Eigen::Index i = 0; i < n; ++i)
        jacobian.col(i) = (error(up[i]) - error(down[i])) / (2 * h);
      const Eigen::MatrixXd omega = step.information / c.at.model.odometry;
      hessian += jacobian.transpose() * omega * jacobian;
      gradient += jacobian.transpose() * omega * error(c.at);
    }
    for (const auto& term : c.problem.terms) {
      Eigen::VectorXd row(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        row[i] = (range_error(term, up[i]) - range_error(term, down[i])) / (2 * h);
      }
      const auto loss = range_loss(c.at.model, range_error(term, c.at), term.sigma * term.sigma);
      hessian += loss.curvature * row * row.transpose();
      gradient += loss.slope * row;
    }
    for (std::size_t v = 0; v < c.problem.is_point.size(); ++v) {
      const Index variable = c.problem.gauge.variable[v];
      if (!c.problem.is_point[v] || variable < 0) continue;
      for (int i = Pose::kDim; i < Pose::kDof; ++i) {
        hessian(Eigen::Index{variable} * Pose::kDof + i, Eigen::Index{variable} * Pose::kDof + i) =
            1.0;
      }
    }
    if (c.problem.calibrated) return;
    const double offset = 1.0 / std::pow(c.problem.longest, 2);
    const double stretch = 1.0 / std::pow(std::log(10.0), 2);
    hessian(n - 2, n - 2) += offset;
    hessian(n - 1, n - 1) += stretch;
    gradient[n - 2] += offset * c.at.model.offset;
    gradient[n - 1] += stretch * c.at.model.log_stretch;
  }
};

template <class Pose>
void expect_the_dense_system(bool calibrated) {
  const Case<Pose> c(calibrated);
  const DenseSystem<Pose> dense(c);
  RangeEquations<Pose> equations(c.problem, spectral::FactorForm::supernodal);
  equations.linearise(c.at);
  auto found = c.at;
  const auto promised = equations.move(0.0, equations.damping_scale(), found);
  ASSERT_TRUE(promised);
  const Eigen::VectorXd step = dense.hessian.ldlt().solve(-dense.gradient);
  const auto expected = c.moved(step);
  const double tolerance = 1e-6 * (1.0 + step.norm());
  for (std::size_t v = 0; v < found.poses.size(); ++v) {
    EXPECT_LT((found.poses[v].inverse() * expected.poses[v]).log().norm(), tolerance) << v;
  }
  EXPECT_NEAR(found.model.offset, expected.model.offset, tolerance);
  EXPECT_NEAR(found.model.log_stretch, expected.model.log_stretch, 1e-7);
  EXPECT_NEAR(*promised, -0.5 * step.dot(dense.gradient), 1e-6 * (1.0 + *promised));
  const auto log_determinant = equations.log_determinant();
  ASSERT_TRUE(log_determinant);
  EXPECT_NEAR(*log_determinant, std::log(dense.hessian.determinant()), 1e-5);
}

TEST(RangeEquations, AStepIsThatOfTheDenseSystem) {
  for (const bool calibrated : {true, false}) {
    expect_the_dense_system<Pose2>(calibrated);
    expect_the_dense_system<Pose3>(calibrated);
  }
}

template <class Pose>
void expect_dense_covariances() {
  const Case<Pose> c(true);
  const DenseSystem<Pose> dense(c);
  RangeEquations<Pose> equations(c.problem, spectral::FactorForm::supernodal);
  equations.linearise(c.at);
  ASSERT_TRUE(equations.log_determinant());
  const auto variances = equations.prediction_variances(c.at);
  const Eigen::MatrixXd inverse = dense.hessian.inverse();
  double fitted = 0.0;
  for (std::size_t k = 0; k < variances.size(); ++k) {
    Eigen::VectorXd row(c.unknowns());
    const double h = 1e-6;
    for (Eigen::Index i = 0; i < row.size(); ++i) {
      Eigen::VectorXd step = Eigen::VectorXd::Zero(row.size());
      step[i] = h;
      row[i] = (range_error(c.problem.terms[k], c.moved(step)) -
                range_error(c.problem.terms[k], c.moved(-step))) /
               (2 * h);
    }
    EXPECT_NEAR(variances[k], row.dot(inverse * row), 1e-8);
    fitted += equations.curvatures()[k] * variances[k];
  }
  EXPECT_NEAR(equations.fitted(variances), fitted, 1e-9);
  // The traces of both parts sum to the number of unknowns.
  const double points = 2.0 * (Pose::kDof - Pose::kDim);
  const double measured = Pose::kDof * static_cast<double>(c.problem.steps.constraints.size());
  EXPECT_NEAR(equations.steps_redundancy(fitted),
              measured - (static_cast<double>(c.unknowns()) - points - fitted), 1e-9);
}

TEST(RangeEquations, PredictionsAreAsUncertainAsTheDenseInverseSays) {
  expect_dense_covariances<Pose2>();
  expect_dense_covariances<Pose3>();
}

TEST(RangeEquations, NodesAtOnePlaceDoNotDivideByZero) {
  Case<Pose2> c(true);
  for (auto& pose : c.at.poses) pose = Pose2();
  RangeEquations<Pose2> equations(c.problem);
  equations.linearise(c.at);
  auto found = c.at;
  EXPECT_TRUE(equations.move(1e-3, equations.damping_scale(), found));
  for (const auto& pose : found.poses) EXPECT_TRUE(pose.translation().allFinite());
}

}  // namespace
}  // namespace isotherm::slam::detail
