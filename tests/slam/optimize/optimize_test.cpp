#include "isotherm/slam/optimize/optimize.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm_test/data.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam {
namespace {

using isotherm_test::random_loop_graph;
using isotherm_test::random_tangent;
using isotherm_test::worst_difference;
using testing::ElementsAre;
using testing::IsEmpty;

template <class Pose>
double chi2_of(const PoseGraph<Pose>& graph, const std::vector<Pose>& poses) {
  double sum = 0.0;
  for (const auto& constraint : graph.constraints) {
    const auto r = residual(constraint, poses[constraint.from], poses[constraint.to]);
    sum += r.dot(constraint.information * r);
  }
  return sum;
}

// Derivative of chi-squared by each pose but those held, by central differences.
template <class Pose>
double largest_slope(const PoseGraph<Pose>& graph, std::vector<Pose> poses,
                     const std::vector<Index>& held) {
  double largest = 0.0;
  const double h = 1e-6;
  for (Index v = 0; v < graph.vertex_count(); ++v) {
    if (std::find(held.begin(), held.end(), v) != held.end()) continue;
    const Pose centre = poses[v];
    for (int k = 0; k < Pose::kDof; ++k) {
      typename Pose::Tangent step = Pose::Tangent::Zero();
      step[k] = h;
      poses[v] = centre * Pose::exp(step);
      const double above = chi2_of(graph, poses);
      poses[v] = centre * Pose::exp(-step);
      largest = std::max(largest, std::abs(above - chi2_of(graph, poses)) / (2 * h));
    }
    poses[v] = centre;
  }
  return largest;
}

template <class Pose>
class Optimize : public testing::Test {
 protected:
  Random random{31};
};

using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(Optimize, Poses);

constexpr OptimizeAlgorithm kAlgorithms[] = {OptimizeAlgorithm::gauss_newton,
                                             OptimizeAlgorithm::levenberg_marquardt};

TYPED_TEST(Optimize, RecoversTheTruthWithoutNoise) {
  using Pose = TypeParam;
  const auto [graph, truth] = random_loop_graph<Pose>(this->random, 50, 30, 0.0);
  for (const auto algorithm : kAlgorithms) {
    const auto result = optimize(graph, {.algorithm = algorithm});
    EXPECT_EQ(result.status, OptimizeStatus::converged);
    EXPECT_LT(worst_difference(result.poses, truth), 1e-9);
    EXPECT_LT(result.final_cost, 1e-12);
  }
}

TYPED_TEST(Optimize, EndsWhereChiSquaredIsFlatWithFullInformation) {
  using Pose = TypeParam;
  const auto [graph, truth] = random_loop_graph<Pose>(this->random, 40, 60, 1.0);
  for (const auto algorithm : kAlgorithms) {
    for (const auto start :
         {Initialization::odometry, Initialization::spanning_tree, Initialization::chordal}) {
      const auto result = optimize(
          graph, {.initialization = start, .algorithm = algorithm, .cost_tolerance = 1e-14});
      EXPECT_EQ(result.status, OptimizeStatus::converged);
      EXPECT_NEAR(result.final_cost, chi2_of(graph, result.poses), 1e-9 * result.final_cost);
      EXPECT_NEAR(result.chi2.sum(), result.final_cost, 1e-9 * result.final_cost);
      // The slope is compared with what a pose error of 1e-6 would give.
      EXPECT_LT(largest_slope(graph, result.poses, result.held), 0.1);
      EXPECT_LT(result.final_cost, result.initial_cost);
      // Residual degrees of freedom: 60 loops, each as many as a pose has.
      EXPECT_NEAR(result.final_cost, 60 * Pose::kDof, 6 * std::sqrt(2.0 * 60 * Pose::kDof));
    }
  }
}

TYPED_TEST(Optimize, StartsWhereLeastSquaresCostsLeast) {
  using Pose = TypeParam;
  const auto [graph, truth] = random_loop_graph<Pose>(this->random, 60, 40, 1.0);
  auto wrong = graph;
  for (Index k = 59; k < 89; ++k) {  // most loops
    wrong.constraints[k].T_from_to = Pose::exp(random_tangent<Pose>(this->random, 2.0));
  }
  for (const auto& tried : {graph, wrong}) {
    const auto cost_from = [&tried](Initialization start) {
      return optimize(tried, {.initialization = start, .max_iterations = 0}).initial_cost;
    };
    EXPECT_EQ(
        cost_from(Initialization::automatic),
        std::min(cost_from(Initialization::spanning_tree), cost_from(Initialization::chordal)));
  }
}

TYPED_TEST(Optimize, GaugeIsHeldOncePerComponentAndAtFixedVertices) {
  using Pose = TypeParam;
  auto [graph, truth] = random_loop_graph<Pose>(this->random, 20, 0, 1.0);
  graph.constraints.erase(graph.constraints.begin() + 9);
  graph.poses = truth;
  auto result = optimize(graph);
  EXPECT_EQ(result.components, 2);
  EXPECT_THAT(result.held, ElementsAre(0, 10));
  EXPECT_EQ(worst_difference<Pose>({result.poses[0], result.poses[10]}, {truth[0], truth[10]}),
            0.0);

  graph.fixed = {3, 12, 17};
  result = optimize(graph);
  EXPECT_THAT(result.held, ElementsAre(3, 12, 17));
  for (const Index v : result.held) {
    EXPECT_EQ((result.poses[v].inverse() * truth[v]).log().norm(), 0.0);
  }
  EXPECT_EQ(result.status, OptimizeStatus::converged);
  EXPECT_LT(largest_slope(graph, result.poses, result.held), 0.1);
}

TYPED_TEST(Optimize, ACutGraphIsOptimisedPieceByPiece) {
  using Pose = TypeParam;
  const auto whole = random_loop_graph<Pose>(this->random, 15, 10, 1.0);
  PoseGraph<Pose> twice = whole.graph;
  for (Index v = 0; v < 15; ++v) twice.ids.push_back(static_cast<VertexId>(100 + v));
  for (auto constraint : whole.graph.constraints) {
    constraint.from += 15;
    constraint.to += 15;
    twice.constraints.push_back(constraint);
  }
  const auto one = optimize(whole.graph, {.cost_tolerance = 1e-12});
  const auto both = optimize(twice, {.cost_tolerance = 1e-12});
  EXPECT_EQ(both.components, 2);
  EXPECT_NEAR(both.final_cost, 2 * one.final_cost, 1e-9 * one.final_cost);
  const std::vector<Pose> second(both.poses.begin() + 15, both.poses.end());
  EXPECT_LT(worst_difference(second, one.poses), 1e-7);
}

TYPED_TEST(Optimize, EmptyAndSinglePose) {
  using Pose = TypeParam;
  for (const auto algorithm : kAlgorithms) {
    const auto empty = optimize(PoseGraph<Pose>(), {.algorithm = algorithm});
    EXPECT_EQ(empty.status, OptimizeStatus::converged);
    EXPECT_THAT(empty.poses, IsEmpty());
    EXPECT_EQ(empty.components, 0);

    PoseGraph<Pose> single;
    single.ids = {7};
    single.poses = {Pose::exp(random_tangent<Pose>(this->random, 1.0))};
    const auto result = optimize(single, {.algorithm = algorithm});
    EXPECT_EQ(result.status, OptimizeStatus::converged);
    EXPECT_EQ(worst_difference(result.poses, single.poses), 0.0);
    EXPECT_THAT(result.held, ElementsAre(0));
  }
}

TYPED_TEST(Optimize, WithoutLoopsOdometryIsTheOptimum) {
  using Pose = TypeParam;
  const auto [graph, truth] = random_loop_graph<Pose>(this->random, 30, 0, 1.0);
  const auto result = optimize(graph);
  EXPECT_EQ(result.status, OptimizeStatus::converged);
  EXPECT_LT(result.final_cost, 1e-15);
  const auto chained = initial_poses(graph, edge_roles(graph), Initialization::odometry);
  EXPECT_LT(worst_difference(result.poses, chained), 1e-9);
}

TYPED_TEST(Optimize, ALoopToItselfCountsAndMovesNothing) {
  using Pose = TypeParam;
  auto [graph, truth] = random_loop_graph<Pose>(this->random, 10, 5, 1.0);
  const auto without = optimize(graph);
  Constraint<Pose> self;
  self.from = self.to = 4;
  self.T_from_to = Pose::exp(random_tangent<Pose>(this->random, 0.3));
  graph.constraints.push_back(self);
  const auto with = optimize(graph);
  EXPECT_NEAR(with.chi2[graph.constraint_count() - 1], self.T_from_to.inverse().log().squaredNorm(),
              1e-12);
  EXPECT_NEAR(with.final_cost - without.final_cost, with.chi2[graph.constraint_count() - 1], 1e-6);
  EXPECT_LT(worst_difference(with.poses, without.poses), 1e-5);
}

TYPED_TEST(Optimize, ARepeatedConstraintCountsOnce) {
  auto graph = random_loop_graph<TypeParam>(this->random, 30, 8, 1.0).graph;
  const auto once = optimize(graph);
  for (Index k = 5; k < 33; ++k) graph.constraints.push_back(graph.constraints[k]);
  const auto twice = optimize(graph);
  EXPECT_EQ(twice.repeats, 28);
  EXPECT_NEAR(twice.final_cost, once.final_cost, 1e-9 * once.final_cost);
  EXPECT_LT(worst_difference(once.poses, twice.poses), 1e-6);
}

TYPED_TEST(Optimize, ZeroInformationJoinsAndMovesNothing) {
  using Pose = TypeParam;
  auto [graph, truth] = random_loop_graph<Pose>(this->random, 10, 5, 1.0);
  const auto before = optimize(graph, {.cost_tolerance = 1e-12});
  Constraint<Pose> empty = graph.constraints.back();
  empty.T_from_to = Pose();
  empty.information.setZero();
  graph.constraints.push_back(empty);
  graph.ids.push_back(10);  // joined by nothing but zero information
  empty.to = 10;
  graph.constraints.push_back(empty);
  for (const auto algorithm : kAlgorithms) {
    const auto after = optimize(graph, {.algorithm = algorithm, .cost_tolerance = 1e-12});
    EXPECT_EQ(after.components, 2);
    EXPECT_EQ(after.projected_information, 0);
    EXPECT_EQ((after.poses[10].log()).norm(), 0.0);
    const std::vector<Pose> joined(after.poses.begin(), after.poses.end() - 1);
    EXPECT_LT(worst_difference(before.poses, joined), 1e-7);
    EXPECT_EQ(after.chi2[graph.constraint_count() - 1], 0.0);
  }
  for (auto& constraint : graph.constraints) constraint.information.setZero();
  const auto nothing = optimize(graph);
  EXPECT_EQ(nothing.status, OptimizeStatus::converged);
  EXPECT_EQ(nothing.components, 11);
  EXPECT_EQ(nothing.final_cost, 0.0);
}

TYPED_TEST(Optimize, UnmeasuredDirectionsStayWhereTheyStarted) {
  using Pose = TypeParam;
  auto [graph, truth] = random_loop_graph<Pose>(this->random, 8, 0, 1.0);
  // The last step measures rotation only.
  auto& last = graph.constraints.back();
  last.information.setZero();
  last.information.bottomRightCorner(Pose::kDof - Pose::kDim, Pose::kDof - Pose::kDim)
      .setIdentity();
  for (const auto algorithm : kAlgorithms) {
    const auto result = optimize(graph, {.algorithm = algorithm});
    EXPECT_EQ(result.status, OptimizeStatus::converged);
    EXPECT_EQ(result.components, 1);
    for (const Pose& pose : result.poses) EXPECT_TRUE(pose.translation().allFinite());
    EXPECT_LT(result.final_cost, 1e-12);
  }
}

TYPED_TEST(Optimize, NegativeEigenvaluesCountAsZeroAndAreReported) {
  using Pose = TypeParam;
  auto [graph, truth] = random_loop_graph<Pose>(this->random, 10, 5, 1.0);
  const auto before = optimize(graph, {.cost_tolerance = 1e-12});
  Constraint<Pose> negative = graph.constraints.back();
  negative.T_from_to = Pose();
  negative.information = -Pose::Matrix::Identity();
  graph.constraints.push_back(negative);
  const auto after = optimize(graph, {.cost_tolerance = 1e-12});
  EXPECT_EQ(after.projected_information, 1);
  EXPECT_EQ(after.chi2[graph.constraint_count() - 1], 0.0);
  EXPECT_LT(worst_difference(before.poses, after.poses), 1e-7);
}

TYPED_TEST(Optimize, DcsWithGaussNewtonLeavesOutFalseLoops) {
  using Pose = TypeParam;
  auto [graph, truth] = random_loop_graph<Pose>(this->random, 60, 40, 0.1, 1e6);
  const auto clean = optimize(graph);
  for (int l = 0; l < 10; ++l) {
    Constraint<Pose> wrong = graph.constraints[59 + l];
    wrong.T_from_to = wrong.T_from_to * Pose::exp(random_tangent<Pose>(this->random, 2.0));
    graph.constraints.push_back(wrong);
  }
  const auto result = optimize(graph, {.kernel = RobustKernel::dcs,
                                       .initialization = Initialization::odometry,
                                       .algorithm = OptimizeAlgorithm::gauss_newton});
  EXPECT_EQ(result.status, OptimizeStatus::converged);
  EXPECT_LT(worst_difference(result.poses, clean.poses), 1e-3);
  for (Index k = 0; k < graph.constraint_count(); ++k) {
    if (k < 99) {
      EXPECT_GT(result.weight[k], 0.5) << k;
    } else {
      EXPECT_LT(result.weight[k], 0.01) << k;
    }
  }
}

TYPED_TEST(Optimize, KernelsAreForLoopsUnlessAskedOtherwise) {
  using Pose = TypeParam;
  const auto [graph, truth] = random_loop_graph<Pose>(this->random, 20, 20, 30.0);
  OptimizeOptions options{.kernel = RobustKernel::cauchy};
  const auto roles = edge_roles(graph);
  const auto loops_only = optimize(graph, options);
  for (const Index k : roles.odometry) EXPECT_EQ(loops_only.weight[k], 1.0);
  EXPECT_LE(loops_only.final_cost, loops_only.initial_cost);
  options.kernel_on_odometry = true;
  const auto all = optimize(graph, options);
  double smallest = 1.0;
  for (const Index k : roles.odometry) smallest = std::min(smallest, all.weight[k]);
  EXPECT_LT(smallest, 1.0);
}

TYPED_TEST(Optimize, TheStartAloneAndTheIterationLimit) {
  using Pose = TypeParam;
  const auto [graph, truth] = random_loop_graph<Pose>(this->random, 30, 30, 1.0);
  const auto start = optimize(graph, {.max_iterations = 0});
  EXPECT_EQ(start.iterations, 0);
  EXPECT_EQ(start.initial_cost, start.final_cost);
  EXPECT_EQ(start.status, OptimizeStatus::iteration_limit);
  for (const auto algorithm : kAlgorithms) {
    const auto one = optimize(graph, {.algorithm = algorithm, .max_iterations = 1});
    EXPECT_EQ(one.iterations, 1);
    EXPECT_LE(one.final_cost, one.initial_cost);
  }
}

TYPED_TEST(Optimize, SameInputSameBytes) {
  using Pose = TypeParam;
  const auto [graph, truth] = random_loop_graph<Pose>(this->random, 60, 40, 1.0);
  const auto first = optimize(graph);
  const auto second = optimize(graph);
  EXPECT_EQ(first.final_cost, second.final_cost);
  EXPECT_EQ(first.chi2, second.chi2);
}

TYPED_TEST(Optimize, CanBeCancelled) {
  using Pose = TypeParam;
  const auto [graph, truth] = random_loop_graph<Pose>(this->random, 10, 10, 1.0);
  const auto stop = [](const Progress& progress) { return progress.done < 1; };
  EXPECT_THROW(optimize(graph, {}, {.progress = stop}), Cancelled);
}

TYPED_TEST(Optimize, DefaultToleranceIsThatOfTheOptimum) {
  using Pose = TypeParam;
  for (int k = 0; k < 10; ++k) {
    // Few loops on a long chain: much of what is left lies where hardly anything is measured.
    const auto [graph, truth] = random_loop_graph<Pose>(this->random, 400, 1 + 3 * k, 1.0);
    const auto optimum = optimize(graph, {.cost_tolerance = 1e-13});
    for (const auto start : {Initialization::automatic, Initialization::odometry}) {
      const auto found = optimize(graph, {.initialization = start});
      if (found.final_cost > 1.1 * optimum.final_cost) continue;  // another minimum
      EXPECT_EQ(found.status, OptimizeStatus::converged);
      EXPECT_LE(found.final_cost, (1.0 + 2e-6) * optimum.final_cost) << k;
    }
  }
}

TEST(OptimizeRealData, Ais2klinikEndsAtItsOptimum) {
  ISOTHERM_REAL_DATA_OR_SKIP(path, "posegraph2d/ais2klinik/ais2klinik.g2o");
  const auto graph = read_pose_graph(path.string()).graph;
  const auto found = optimize(graph);
  const auto optimum = optimize(graph, {.cost_tolerance = 1e-12});
  EXPECT_EQ(found.status, OptimizeStatus::converged);
  EXPECT_LE(found.final_cost, (1.0 + 1e-6) * optimum.final_cost);
}

TYPED_TEST(Optimize, RejectsWhatItCannotRead) {
  using Pose = TypeParam;
  const auto made = random_loop_graph<Pose>(this->random, 5, 2, 1.0);
  auto graph = made.graph;
  graph.constraints[1].to = 5;
  EXPECT_THROW(optimize(graph), InvalidArgument);
  graph = made.graph;
  graph.constraints[1].information(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(optimize(graph), InvalidArgument);
  graph = made.graph;
  graph.fixed = {-1};
  EXPECT_THROW(optimize(graph), InvalidArgument);
  EXPECT_THROW(optimize(made.graph, {.kernel_width = -1.0}), InvalidArgument);
  EXPECT_THROW(optimize(made.graph, {.max_iterations = -1}), InvalidArgument);
  EXPECT_THROW(optimize(made.graph, {.cost_tolerance = std::nan("")}), InvalidArgument);
  EXPECT_THROW(optimize(made.graph, {.initialization = Initialization::file}), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::slam
