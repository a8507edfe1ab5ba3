#include "isotherm/slam/prune/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/evaluate/evaluate_loops.hpp"
#include "isotherm/slam/prune/prune.hpp"
#include "isotherm/slam/simulate/corrupt.hpp"
#include "isotherm/slam/simulate/simulate.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam {
namespace {

using isotherm_test::random_loop_graph;
using spectral::Verdict;

template <class Pose>
class EvidenceOf : public testing::Test {};
using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(EvidenceOf, Poses);

TYPED_TEST(EvidenceOf, KeepsACleanGraphWhateverTheFileSaysOfItsAccuracy) {
  using Pose = TypeParam;
  Random random(31);
  const auto made = random_loop_graph<Pose>(random, 80, 40, 1.0);
  const auto roles = edge_roles(made.graph);
  for (const double odometry : {0.01, 1.0, 100.0}) {
    for (const double loops : {0.01, 1.0, 100.0}) {
      auto graph = made.graph;
      for (const Index k : roles.odometry) graph.constraints[k].information *= odometry;
      for (const Index k : roles.candidates) graph.constraints[k].information *= loops;
      const auto result = judge_by_evidence(graph, roles);
      EXPECT_EQ(count(result.verdicts, Verdict::prune), 0) << odometry << ' ' << loops;
      EXPECT_GE(count(result.verdicts, Verdict::keep), 38) << odometry << ' ' << loops;
      EXPECT_TRUE(result.settled);
    }
  }
}

TYPED_TEST(EvidenceOf, FindsFalseLoopsAndSaysHowSureItIs) {
  using Pose = TypeParam;
  Random random(32);
  const auto made = random_loop_graph<Pose>(random, 80, 30, 1.0);
  for (const auto type : {NoiseType::random, NoiseType::random_grouped}) {
    const auto bad = corrupt(made.graph, made.truth,
                             {.style = NoiseStyle::paper, .type = type, .count = 60, .seed = 3});
    const auto result = judge_by_evidence(bad.graph, edge_roles(bad.graph));
    const auto metrics = evaluate_loops(result.verdicts, bad.labels);
    EXPECT_GE(metrics.precision(), 0.98);
    EXPECT_EQ(metrics.recall(), 1.0);
    for (std::size_t k = 0; k < result.verdicts.size(); ++k) {
      const auto& verdict = result.verdicts[k];
      const double probability = result.details[k].probability;
      EXPECT_EQ(verdict.verdict == Verdict::prune, verdict.score > verdict.threshold);
      EXPECT_EQ(verdict.verdict == Verdict::prune, probability < 0.01);
      EXPECT_TRUE(std::isfinite(verdict.score)) << "however sure it is";
    }
  }
}

TEST(Evidence, LearnsHowAccurateLoopsAre) {
  Random random(33);
  auto made = random_loop_graph<Pose2>(random, 300, 200, 1.0);
  const auto roles = edge_roles(made.graph);
  for (const Index k : roles.candidates) made.graph.constraints[k].information *= 4.0;
  const auto result = judge_by_evidence(made.graph, roles);
  EXPECT_NEAR(result.loop_scale, 4.0, 1.0);
  EXPECT_NEAR(result.odometry_scale, 1.0, 0.3);
}

// As files do that state all by the same number.
TYPED_TEST(EvidenceOf, LearnsRotationAgainstTranslation) {
  using Pose = TypeParam;
  Random random(36);
  auto made = random_loop_graph<Pose>(random, 200, 150, 1.0);
  const auto stated = made.graph;
  typename Pose::Tangent root = Pose::Tangent::Ones();
  root.template tail<Pose::kDof - Pose::kDim>().setConstant(10.0);
  for (auto& constraint : made.graph.constraints) {
    constraint.information = root.asDiagonal() * constraint.information * root.asDiagonal();
  }
  const auto roles = edge_roles(made.graph);
  const auto as_stated = judge_by_evidence(stated, roles);
  const auto result = judge_by_evidence(made.graph, roles);
  EXPECT_NEAR(std::log(result.rotation_scale / as_stated.rotation_scale), std::log(100.0), 1.0);
  EXPECT_EQ(count(result.verdicts, Verdict::prune), 0);
}

// A robot that drives on a floor, in a file of poses in space: of three coordinates there is
// nothing to learn but that they have no error.
TEST(Evidence, KeepsTheLoopsOfAFloorInSpace) {
  const auto city = simulate_city({.poses = 400, .measurements = {.loops = 120}, .seed = 6});
  PoseGraph<Pose3> lifted;
  lifted.ids = city.graph.ids;
  const auto lift = [](const Pose2& T) {
    return Pose3(Eigen::Vector3d(T.x(), T.y(), 0.0),
                 Eigen::Quaterniond(Eigen::AngleAxisd(T.theta(), Eigen::Vector3d::UnitZ())));
  };
  for (const auto& pose : city.graph.initial) lifted.initial.push_back(lift(pose));
  for (const auto& constraint : city.graph.constraints) {
    lifted.constraints.push_back({constraint.from, constraint.to, lift(constraint.T_from_to),
                                  100.0 * Pose3::Matrix::Identity()});
  }
  const auto result = judge_by_evidence(lifted, edge_roles(lifted));
  EXPECT_EQ(count(result.verdicts, Verdict::keep), 120);
}

// Whether odometry or they are wrong nobody knows.
TEST(Evidence, PrunesNoneOfAFewLoops) {
  Random random(37);
  auto made = random_loop_graph<Pose2>(random, 200, 4, 1.0);
  for (const Index k : edge_roles(made.graph).odometry) {
    made.graph.constraints[k].T_from_to =
        made.graph.constraints[k].T_from_to * Pose2(0.0, 0.0, 0.05);
  }
  const auto result = judge_by_evidence(made.graph, edge_roles(made.graph));
  EXPECT_EQ(count(result.verdicts, Verdict::prune), 0);
}

TEST(Evidence, GivesTheSameResultWhateverTheOrderOfTheFile) {
  const auto city = simulate_city({.poses = 400, .measurements = {.loops = 120}, .seed = 5});
  const auto bad = corrupt(city.graph, city.truth, {.count = 100, .seed = 5});
  const auto verdicts = judge_by_evidence(bad.graph, edge_roles(bad.graph)).verdicts;
  auto reversed = bad.graph;
  std::ranges::reverse(reversed.constraints);
  const auto other = judge_by_evidence(reversed, edge_roles(reversed)).verdicts;
  ASSERT_EQ(other.size(), verdicts.size());
  for (std::size_t k = 0; k < verdicts.size(); ++k) {
    EXPECT_EQ(verdicts[k].verdict, other[other.size() - 1 - k].verdict);
  }
}

TEST(Evidence, DecidesNothingWhereThereIsNothingToDecide) {
  Random random(34);
  const auto made = random_loop_graph<Pose2>(random, 10, 0, 1.0);
  EXPECT_TRUE(judge_by_evidence(made.graph, edge_roles(made.graph)).verdicts.empty());
  EXPECT_TRUE(judge_by_evidence(PoseGraph<Pose2>(), EdgeRoles()).verdicts.empty());
}

TEST(Evidence, TakesTheFileAtItsWordIfToldTo) {
  Random random(35);
  const auto made = random_loop_graph<Pose2>(random, 60, 30, 1.0);
  const auto result = judge_by_evidence(made.graph, edge_roles(made.graph), {.calibrate = false});
  EXPECT_EQ(result.odometry_scale, 1.0);
  EXPECT_EQ(result.loop_scale, 1.0);
  EXPECT_EQ(count(result.verdicts, Verdict::keep), 30);
}

TEST(Evidence, ComesThroughTheDoorByName) {
  const auto city = simulate_city({.poses = 300, .measurements = {.loops = 80}, .seed = 6});
  const auto result = prune(city.graph, prune_method("evidence"));
  EXPECT_EQ(result.method, "evidence");
  EXPECT_EQ(count(result.verdicts, Verdict::prune), 0);
}

TEST(Evidence, RefusesWhatIsOutOfRange) {
  EXPECT_THROW((EvidenceOptions{.significance = 0.5}.validate()), InvalidArgument);
  EXPECT_THROW((EvidenceOptions{.significance = 0.0}.validate()), InvalidArgument);
  EXPECT_THROW((EvidenceOptions{.window = 0}.validate()), InvalidArgument);
  EXPECT_THROW((EvidenceOptions{.max_rounds = 0}.validate()), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::slam
