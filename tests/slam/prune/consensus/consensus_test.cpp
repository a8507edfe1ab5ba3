#include "isotherm/slam/prune/consensus.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "graph/reversed.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/statistics.hpp"
#include "isotherm/slam/evaluate/evaluate_loops.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/slam/optimize/optimize.hpp"
#include "isotherm/slam/prune/prune.hpp"
#include "isotherm/slam/simulate/corrupt.hpp"
#include "isotherm/slam/simulate/simulate.hpp"
#include "isotherm_test/data.hpp"
#include "slam/loop_graph.hpp"
#include "slam/prune/consensus/all_accepted.hpp"

namespace isotherm::slam {
namespace {

using isotherm_test::random_error;
using isotherm_test::random_loop_graph;
using isotherm_test::random_tangent;
using spectral::Verdict;

/// What consensus makes of simulated loops with false ones among them.
template <class Pose>
LoopMetrics metrics_of(const Simulation<Pose>& made, const CorruptOptions& options) {
  const auto bad = corrupt(made.graph, made.truth, options);
  return evaluate_loops(consensus(bad.graph, edge_roles(bad.graph)).verdicts, bad.labels);
}

template <class Pose>
class ConsensusOf : public testing::Test {};
using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(ConsensusOf, Poses);

TYPED_TEST(ConsensusOf, KeepsACleanGraphAsItIs) {
  using Pose = TypeParam;
  Random random(31);
  const auto made = random_loop_graph<Pose>(random, 80, 40, 1.0);
  const auto result = consensus(made.graph, edge_roles(made.graph));
  EXPECT_EQ(count(result.verdicts, Verdict::keep), 40);
  EXPECT_TRUE(result.settled);
  EXPECT_LT(result.odometry_scale, 1.5);
  EXPECT_LT(result.loop_scale, 1.5);
}

TYPED_TEST(ConsensusOf, KeepsACleanGraphWhateverTheFileSaysOfItsAccuracy) {
  using Pose = TypeParam;
  Random random(31);
  const auto made = random_loop_graph<Pose>(random, 80, 40, 1.0);
  const auto roles = edge_roles(made.graph);
  for (const double odometry : {0.01, 1.0, 100.0}) {
    for (const double loops : {0.01, 1.0, 100.0}) {
      auto graph = made.graph;
      for (const Index k : roles.odometry) graph.constraints[k].information *= odometry;
      for (const Index k : roles.candidates) graph.constraints[k].information *= loops;
      const auto result = consensus(graph, roles);
      EXPECT_EQ(count(result.verdicts, Verdict::prune), 0) << odometry << ' ' << loops;
      EXPECT_GE(count(result.verdicts, Verdict::keep), 38) << odometry << ' ' << loops;
      EXPECT_TRUE(result.settled);
    }
  }
}

TEST(Consensus, LearnsHowAccurateLoopsAre) {
  Random random(33);
  auto made = random_loop_graph<Pose2>(random, 300, 200, 1.0);
  const auto roles = edge_roles(made.graph);
  double chi2 = 0.0;  // of all loops at the truth
  for (const Index k : roles.candidates) {
    auto& loop = made.graph.constraints[k];
    loop.information *= 4.0;
    const Pose2 truth = made.truth[loop.from].inverse() * made.truth[loop.to];
    const Pose2::Tangent error = (loop.T_from_to.inverse() * truth).log();
    chi2 += error.dot(loop.information * error);
  }
  const double drawn = chi2 / (Pose2::kDof * static_cast<double>(roles.candidates.size()));
  const auto result = consensus(made.graph, roles);
  EXPECT_NEAR(result.loop_scale / drawn, 1.0, 0.25) << drawn;
  EXPECT_NEAR(result.odometry_scale, 1.0, 0.3);
}

// As files do that state all by the same number.
// As a sensor has it: errors in translation tell nothing of those in rotation.
template <class Pose>
PoseGraph<Pose> graph_with_independent_rotation(Random& random) {
  constexpr int kTurns = Pose::kDof - Pose::kDim;
  auto graph = random_loop_graph<Pose>(random, 200, 150, 0.0).graph;
  for (auto& constraint : graph.constraints) {
    auto& information = constraint.information;
    information.template topRightCorner<Pose::kDim, kTurns>().setZero();
    information.template bottomLeftCorner<kTurns, Pose::kDim>().setZero();
    const auto error = random_error<Pose>(random, information);
    constraint.T_from_to = constraint.T_from_to * Pose::exp(error);
  }
  return graph;
}

TYPED_TEST(ConsensusOf, LearnsRotationAgainstTranslation) {
  using Pose = TypeParam;
  Random random(36);
  const auto stated = graph_with_independent_rotation<Pose>(random);
  auto graph = stated;
  typename Pose::Tangent root = Pose::Tangent::Ones();
  root.template tail<Pose::kDof - Pose::kDim>().setConstant(10.0);
  for (auto& constraint : graph.constraints) {
    constraint.information = root.asDiagonal() * constraint.information * root.asDiagonal();
  }
  const auto roles = edge_roles(graph);
  const auto as_stated = consensus(stated, roles);
  const auto result = consensus(graph, roles);
  EXPECT_NEAR(std::log(result.rotation_scale / as_stated.rotation_scale), std::log(100.0), 1.0);
  EXPECT_EQ(count(result.verdicts, Verdict::prune), 0);
}

// Which end of an edge tells of it is a matter of the file.
TYPED_TEST(ConsensusOf, DecidesTheSameOfReversedEdges) {
  using Pose = TypeParam;
  Random random(37);
  auto graph = graph_with_independent_rotation<Pose>(random);
  const auto roles = edge_roles(graph);
  for (std::size_t k = 0; k < roles.candidates.size(); k += 3) {
    graph.constraints[roles.candidates[k]].T_from_to = Pose::exp(random_tangent<Pose>(random, 3.0));
  }
  typename Pose::Tangent root = Pose::Tangent::Ones();
  root.template tail<Pose::kDof - Pose::kDim>().setConstant(10.0);
  auto turned = graph;
  for (std::size_t k = 0; k < graph.constraints.size(); ++k) {
    auto& information = graph.constraints[k].information;
    information = root.asDiagonal() * information * root.asDiagonal();
    turned.constraints[k] =
        k % 2 == 0 ? graph.constraints[k] : detail::reversed(graph.constraints[k]);
  }
  const auto evidence = [&roles](const auto& told) {
    const detail::Objective<Pose> objective(told, roles, 20);
    return isotherm_test::AllAccepted<Pose>(objective, {2.0, 0.5}, {}).evidence();
  };
  EXPECT_NEAR(evidence(graph), evidence(turned), 1e-9 * std::abs(evidence(graph)));
  for (const bool calibrate : {false, true}) {
    const auto result = consensus(graph, roles, {.calibrate = calibrate});
    const auto other = consensus(turned, roles, {.calibrate = calibrate});
    // As stated all rotations are off by ten times: true loops are wrong measurements, too.
    if (calibrate) {
      EXPECT_GT(count(result.verdicts, Verdict::prune), 40);
    }
    for (std::size_t k = 0; k < result.verdicts.size(); ++k) {
      EXPECT_EQ(result.verdicts[k].verdict, other.verdicts[k].verdict);
      EXPECT_NEAR(result.verdicts[k].score, other.verdicts[k].score,
                  1e-3 * (1.0 + std::abs(result.verdicts[k].score)));
    }
    EXPECT_NEAR(result.log_evidence, other.log_evidence, 1e-3);
  }
}

// A robot that drives on a floor, in a file of poses in space: of three coordinates there is
// nothing to learn but that they have no error.
TEST(Consensus, KeepsTheLoopsOfAFloorInSpace) {
  const auto city = simulate_city({.poses = 400, .measurements = {.loops = 120}, .seed = 6});
  PoseGraph<Pose3> lifted;
  lifted.ids = city.graph.ids;
  const auto lift = [](const Pose2& T) {
    return Pose3(Eigen::Vector3d(T.translation().x(), T.translation().y(), 0.0),
                 Eigen::Quaterniond(Eigen::AngleAxisd(T.angle(), Eigen::Vector3d::UnitZ())));
  };
  for (const auto& pose : city.graph.poses) lifted.poses.push_back(lift(pose));
  for (const auto& constraint : city.graph.constraints) {
    lifted.constraints.push_back({constraint.from, constraint.to, lift(constraint.T_from_to),
                                  100.0 * Pose3::Matrix::Identity()});
  }
  const auto result = consensus(lifted, edge_roles(lifted));
  EXPECT_EQ(count(result.verdicts, Verdict::keep), 120);
}

// Whether odometry or they are wrong nobody knows.
TEST(Consensus, PrunesNoneOfAFewLoops) {
  Random random(37);
  auto made = random_loop_graph<Pose2>(random, 200, 4, 1.0);
  for (const Index k : edge_roles(made.graph).odometry) {
    made.graph.constraints[k].T_from_to =
        made.graph.constraints[k].T_from_to * Pose2(0.0, 0.0, 0.05);
  }
  const auto result = consensus(made.graph, edge_roles(made.graph));
  EXPECT_EQ(count(result.verdicts, Verdict::prune), 0);
}

// Nothing says how accurate odometry is against which they are held.
TEST(Consensus, PrunesNoneWhereNoneIsFoundTrue) {
  auto city = simulate_city({.poses = 300, .measurements = {.loops = 40}, .seed = 5});
  const EdgeRoles roles = edge_roles(city.graph);
  Random random(5);
  for (const Index k : roles.candidates) {
    city.graph.constraints[k].T_from_to =
        Pose2(random.normal(0.0, 20.0), random.normal(0.0, 20.0), random.normal());
  }
  const auto result = consensus(city.graph, roles);
  EXPECT_EQ(count(result.verdicts, Verdict::prune), 0);
  EXPECT_EQ(count(result.verdicts, Verdict::ambiguous), 40);
}

TEST(Consensus, GivesTheSameResultWhateverTheOrderOfTheFile) {
  const auto city = simulate_city({.poses = 400, .measurements = {.loops = 120}, .seed = 5});
  const auto bad = corrupt(city.graph, city.truth, {.count = 100, .seed = 5});
  const auto verdicts = consensus(bad.graph, edge_roles(bad.graph)).verdicts;
  auto reversed = bad.graph;
  std::ranges::reverse(reversed.constraints);
  const auto other = consensus(reversed, edge_roles(reversed)).verdicts;
  ASSERT_EQ(other.size(), verdicts.size());
  for (std::size_t k = 0; k < verdicts.size(); ++k) {
    EXPECT_EQ(verdicts[k].verdict, other[other.size() - 1 - k].verdict);
  }
}

TEST(Consensus, DecidesNothingWhereThereIsNothingToDecide) {
  Random random(34);
  const auto made = random_loop_graph<Pose2>(random, 10, 0, 1.0);
  EXPECT_TRUE(consensus(made.graph, edge_roles(made.graph)).verdicts.empty());
  EXPECT_TRUE(consensus(PoseGraph<Pose2>(), EdgeRoles()).verdicts.empty());
}

TEST(Consensus, TakesTheFileAtItsWordIfToldTo) {
  Random random(35);
  const auto made = random_loop_graph<Pose2>(random, 60, 30, 1.0);
  const auto result = consensus(made.graph, edge_roles(made.graph), {.calibrate = false});
  EXPECT_EQ(result.odometry_scale, 1.0);
  EXPECT_EQ(result.loop_scale, 1.0);
  EXPECT_EQ(count(result.verdicts, Verdict::keep), 30);
}

TYPED_TEST(ConsensusOf, FindsFalseLoops) {
  using Pose = TypeParam;
  Random random(32);
  const auto made = random_loop_graph<Pose>(random, 80, 30, 1.0);
  for (const auto type : {NoiseType::random, NoiseType::random_grouped}) {
    const auto bad = corrupt(made.graph, made.truth,
                             {.style = NoiseStyle::paper, .type = type, .count = 60, .seed = 3});
    const auto result = consensus(bad.graph, edge_roles(bad.graph));
    const auto metrics = evaluate_loops(result.verdicts, bad.labels);
    EXPECT_EQ(metrics.precision(), 1.0);
    EXPECT_EQ(metrics.recall(), 1.0);
    for (std::size_t k = 0; k < result.verdicts.size(); ++k) {
      const auto& verdict = result.verdicts[k];
      const double probability = result.details[k].probability;
      EXPECT_EQ(verdict.verdict == Verdict::prune, verdict.score > verdict.threshold);
      EXPECT_EQ(verdict.verdict == Verdict::prune, probability < 0.01);
      EXPECT_EQ(verdict.probability, probability);
      EXPECT_TRUE(std::isfinite(verdict.score)) << "however sure it is";
      EXPECT_EQ(verdict.verdict == Verdict::prune, !result.details[k].conflicts.empty());
      EXPECT_LE(result.details[k].conflicts.size(), 3u);
      for (const Index other : result.details[k].conflicts) {
        EXPECT_EQ(result.verdicts.at(other).verdict, Verdict::keep);
      }
    }
  }
}

// Two robots that share no odometry: only loops that confirm each other can join
// them, and a false one among them must not.
TYPED_TEST(ConsensusOf, JoinsRobotsByLoopsThatConfirmEachOther) {
  using Pose = TypeParam;
  Random random(33);
  auto made = random_loop_graph<Pose>(random, 60, 0, 0.1);
  made.graph.constraints.erase(made.graph.constraints.begin() + 29);
  for (Index v = 0; v < 60; ++v) made.graph.ids[v] = (v < 30 ? 'a' : 'b') * (1ull << 56) + v;
  for (Index k = 3; k < 27; k += 3) {
    Constraint<Pose> loop{k, k + 30, made.truth[k].inverse() * made.truth[k + 30]};
    loop.information = 1e4 * Pose::Matrix::Identity();
    made.graph.constraints.push_back(loop);
  }
  typename Pose::Tangent xi = Pose::Tangent::Zero();
  xi[1] = 20.0;
  auto& wrong = made.graph.constraints.back();
  wrong.T_from_to = wrong.T_from_to * Pose::exp(xi);

  const auto result = consensus(made.graph, edge_roles(made.graph));
  EXPECT_EQ(count(result.verdicts, Verdict::keep), 7);
  EXPECT_EQ(result.verdicts.back().verdict, Verdict::prune);
}

TYPED_TEST(ConsensusOf, OneLoopBetweenTwoRobotsIsNeitherProvenNorRefuted) {
  using Pose = TypeParam;
  Random random(34);
  auto made = random_loop_graph<Pose>(random, 20, 0, 0.1);
  made.graph.constraints.erase(made.graph.constraints.begin() + 9);
  made.graph.constraints.push_back({2, 15, Pose(), Pose::Matrix::Identity()});
  const auto result = consensus(made.graph, edge_roles(made.graph));
  EXPECT_EQ(result.verdicts.front().verdict, Verdict::ambiguous);
}

TYPED_TEST(ConsensusOf, LearnsThatInformationIsOverconfident) {
  using Pose = TypeParam;
  Random random(35);
  auto made = random_loop_graph<Pose>(random, 100, 150, 1.0);
  for (const Index k : edge_roles(made.graph).candidates) {
    made.graph.constraints[k].information *= 4.0;  // half the true deviations
  }
  const auto result = consensus(made.graph, edge_roles(made.graph), {.significance = 1e-6});
  EXPECT_NEAR(result.loop_scale, 4.0, 1.0) << result.share_of_worse << " L " << result.log_evidence;
  EXPECT_LT(result.odometry_scale, 1.5);
  EXPECT_GE(count(result.verdicts, Verdict::keep), 148);
}

// Twenty deviations in a step of fifty: all others would have to err seven times as much.
TYPED_TEST(ConsensusOf, FindsWhereOdometrySlips) {
  using Pose = TypeParam;
  Random random(11);
  auto graph = random_loop_graph<Pose>(random, 150, 80, 1.0).graph;
  std::vector<VertexId> slipped;
  for (Index k = 20; k < 140; k += 50) {
    auto& step = graph.constraints[k];
    ASSERT_EQ(std::abs(step.to - step.from), 1);
    isotherm_test::slip(step, 20.0);
    slipped.push_back(graph.ids[std::min(step.from, step.to)]);
  }
  const auto result = consensus(graph, edge_roles(graph), {}, {.threads = 1});
  EXPECT_EQ(count(result.verdicts, spectral::Verdict::keep), 80);
  std::vector<VertexId> found;
  for (const auto& slip : result.odometry_slips) {
    found.push_back(slip.from);
    EXPECT_EQ(slip.to, slip.from + 1);
    EXPECT_GE(slip.factor, 9.99);
  }
  EXPECT_EQ(found, slipped);
  EXPECT_LT(result.odometry_scale, 2.0);
}

// A matcher fails in one step, which tells that the robot jumped ten metres. The robot did not: it
// moved about as far as in any step, or as it tells.
TEST(Consensus, NamesTheStepThatJumps) {
  constexpr Index kJumps = 150;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    auto city = simulate_city({.poses = 300, .measurements = {.loops = 60}, .seed = seed}).graph;
    auto& step = city.constraints[kJumps];
    ASSERT_EQ(step.to, kJumps + 1);
    step.T_from_to = step.T_from_to * Pose2(8.0, -6.0, 0.0);
    const auto result = consensus(city, edge_roles(city), {}, {.threads = 1});
    EXPECT_EQ(count(result.verdicts, Verdict::keep), 60) << seed;
    ASSERT_EQ(result.odometry_slips.size(), 1U) << seed;
    EXPECT_EQ(result.odometry_slips.front().from, city.ids[kJumps]) << seed;
    EXPECT_LT(result.odometry_scale, 3.0) << seed;
  }
}

constexpr Index kSlipped = 100;

/// A chain one edge of which is off by forty deviations, with true loops over fifteen edges; of
/// those over that one so many.
template <class Pose>
PoseGraph<Pose> slipped_chain(int over_it) {
  Random random(14);
  auto [graph, truth] = random_loop_graph<Pose>(random, 200, 0, 1.0);
  for (Index v = 0; v < 184; v += 3) {
    auto loop = graph.constraints[v];
    const auto error = isotherm_test::random_error<Pose>(random, loop.information, 1.0);
    loop.from = v;
    loop.to = v + 15;
    loop.T_from_to = truth[v].between(truth[v + 15]) * Pose::exp(error);
    const bool over = loop.from <= kSlipped && kSlipped < loop.to;
    if (!over || over_it-- > 0) graph.constraints.push_back(loop);
  }
  isotherm_test::slip(graph.constraints[kSlipped], 40.0);
  return graph;
}

// Nothing else tells that it slipped: neither is beyond doubt.
TYPED_TEST(ConsensusOf, DoubtsALoopThatASlipWouldExplain) {
  using Pose = TypeParam;
  const auto graph = slipped_chain<Pose>(1);
  const auto result = consensus(graph, edge_roles(graph), {}, {.threads = 1});
  for (const auto& verdict : result.verdicts) {
    const auto& loop = graph.constraints[verdict.edge];
    const auto [first, last] = std::minmax(loop.from, loop.to);
    if (first > kSlipped || last <= kSlipped) continue;
    EXPECT_GT(verdict.probability, 1e-4);
    EXPECT_LT(verdict.probability, 1.0 - 1e-4);
  }
}

// Each of the five loops over it is refuted by itself. Together they say that it slipped.
TYPED_TEST(ConsensusOf, BelievesLoopsThatTogetherTellASlip) {
  using Pose = TypeParam;
  const auto graph = slipped_chain<Pose>(5);
  const auto result = consensus(graph, edge_roles(graph), {}, {.threads = 1});
  EXPECT_EQ(count(result.verdicts, Verdict::prune), 0);
  ASSERT_EQ(result.odometry_slips.size(), 1U);
  const auto from = graph.find(result.odometry_slips.front().from);
  EXPECT_EQ(*from / 3, kSlipped / 3);  // no loop ends between
}

TYPED_TEST(ConsensusOf, OdometryThatErrsAsStatedDoesNotSlip) {
  using Pose = TypeParam;
  for (const std::uint64_t seed : {1, 2, 3}) {
    Random random(seed);
    const auto graph = random_loop_graph<Pose>(random, 150, 80, 1.0).graph;
    const auto result = consensus(graph, edge_roles(graph), {}, {.threads = 1});
    EXPECT_TRUE(result.odometry_slips.empty()) << seed;
  }
}

// Every loop that is kept fits the least-squares solution of what is kept, found by
// another solver: nothing accepted early is left unchecked once loops are dropped or
// the scales change.
TYPED_TEST(ConsensusOf, WhatIsKeptFitsItsOptimum) {
  using Pose = TypeParam;
  Random random(41);
  auto made = random_loop_graph<Pose>(random, 120, 60, 1.0);
  const auto bad =
      corrupt(made.graph, made.truth, {.type = NoiseType::random_grouped, .count = 120, .seed = 7});
  const auto result = consensus(bad.graph, edge_roles(bad.graph));
  auto kept = bad.graph;
  std::vector<bool> pruned(kept.constraints.size(), false);
  for (const auto& verdict : result.verdicts)
    pruned[verdict.edge] = verdict.verdict != Verdict::keep;
  kept.constraints.clear();
  for (std::size_t k = 0; k < pruned.size(); ++k) {
    if (!pruned[k]) kept.constraints.push_back(bad.graph.constraints[k]);
  }
  const auto optimum = optimize(kept);
  for (std::size_t k = 0; k < kept.constraints.size(); ++k) {
    EXPECT_LE(optimum.chi2[static_cast<Eigen::Index>(k)],
              4.0 * chi_squared_quantile(0.9999, Pose::kDof))
        << k;
  }
}

// Not met: all seven loops are accepted at once, and the scales learnt from them then explain them.
//
// Odometry with one bad step, of which it says that it is bad: a false loop across it
// that repeats the mistake fits best at first, and two true ones are turned away by it.
TEST(Consensus, DISABLED_TwoTrueLoopsOutweighAFalseBridge) {
  using Pose = Pose2;
  using Tangent = Pose::Tangent;
  Random random(43);
  auto graph = isotherm_test::random_chain<Pose>(random, 40);
  std::vector<Pose> truth(40);
  for (Index v = 0; v + 1 < 40; ++v) {
    Tangent xi = Tangent::Zero();
    xi[0] = 1.0;
    xi[Pose::kDof - 1] = 0.1;
    truth[v + 1] = truth[v] * Pose::exp(xi);
    graph.constraints[v] = {v, v + 1, Pose::exp(xi), 1e6 * Pose::Matrix::Identity()};
  }
  auto& bad = graph.constraints[19];
  Tangent wrong = Tangent::Zero();
  wrong[0] = 6.0;
  bad.T_from_to = bad.T_from_to * Pose::exp(wrong);
  bad.information.diagonal().head<Pose::kDim>().setConstant(1.0 / 16.0);
  const auto add = [&](Index from, Index to, const Pose& T) {
    graph.constraints.push_back({from, to, T, 1e4 * Pose::Matrix::Identity()});
  };
  const auto measured = [&](Index from, Index to) { return truth[from].inverse() * truth[to]; };
  for (const auto& [from, to] : {std::pair{0, 10}, {3, 15}, {22, 33}, {25, 39}, {2, 38}, {8, 30}}) {
    add(from, to, measured(from, to));
  }
  const Pose moved = truth[20] * Pose::exp(wrong) * truth[20].inverse();
  add(5, 35, truth[5].inverse() * moved * truth[35]);
  const auto result = consensus(graph, edge_roles(graph));
  EXPECT_EQ(count(result.verdicts, Verdict::keep), 6);
  EXPECT_EQ(result.verdicts.back().verdict, Verdict::prune);
}

// Odometry that is certain of little, and false loops that outnumber the true ones by nine.
TEST(Consensus, FindsTheFewTrueLoopsOfASmallCity) {
  const auto city = simulate_city(
      {.poses = 150, .measurements = {.loops = 60, .odometry_turn_sigma = 0.02}, .seed = 2});
  const auto bad = corrupt(city.graph, city.truth, {.fraction = 0.9, .seed = 2});
  const auto result = consensus(bad.graph, edge_roles(bad.graph));
  const auto metrics = evaluate_loops(result.verdicts, bad.labels);
  EXPECT_EQ(metrics.precision(), 1.0);
  EXPECT_GE(metrics.recall(), 0.995);
}

/// A grid so coarse that odometry predicts next to no loop.
Simulation<Pose3> coarse_grid(std::int64_t poses, std::uint64_t seed) {
  return simulate_grid3d({.poses = poses,
                          .measurements = {.loops = poses / 2,
                                           .odometry_sigma = 0.1,
                                           .odometry_turn_sigma = 0.2,
                                           .loop_sigma = 0.1,
                                           .loop_turn_sigma = 0.2},
                          .seed = seed});
}

// With odometry 25 times as uncertain as stated a map shrunk to a point would explain all
// the loops, nine in ten of which are false.
TEST(Consensus, AMapThatProvesNothingIsNoExplanation) {
  const auto metrics =
      metrics_of(coarse_grid(60, 2), {.type = NoiseType::local, .fraction = 0.9, .seed = 2});
  EXPECT_GE(metrics.precision(), 0.9);
  EXPECT_GE(metrics.recall(), 0.9);
}

// A third of the deviation of one step: of a thousand that is more than chance.
TEST(Consensus, TellsByHowMuchOdometryTurnsTooLittle) {
  Random random(5);
  auto graph = random_loop_graph<Pose2>(random, 1000, 60, 1.0).graph;
  const auto roles = edge_roles(graph);
  isotherm_test::turn_less<Pose2>(graph, roles.odometry, Eigen::Matrix<double, 1, 1>(3e-3));
  const auto result = consensus(graph, roles, {}, {.threads = 1});
  EXPECT_EQ(count(result.verdicts, Verdict::keep), 60);
  ASSERT_EQ(result.odometry_bias.size(), 1U);
  EXPECT_NEAR(result.odometry_bias.front(), 3e-3, 1e-3);
  EXPECT_LT(result.odometry_scale, 1.5);
}

// Held to the gate of all, one in eight of the false loops would pass, and one in thirteen.
TEST(Consensus, LoopsAmongFalseOnesMustFitBetter) {
  using Case = std::pair<NoiseType, std::uint64_t>;
  for (const auto& [type, seed] : {Case(NoiseType::local, 6), Case(NoiseType::random_grouped, 3)}) {
    const auto metrics =
        metrics_of(coarse_grid(40, seed), {.type = type, .fraction = 0.9, .seed = seed});
    EXPECT_GE(metrics.precision(), 0.99);
    EXPECT_GE(metrics.recall(), 0.97);
  }
}

// A file may claim far less of its edges than they deserve.
TEST(Consensus, LearnsThatAFileIsUnderconfident) {
  auto city = simulate_city({.poses = 800, .measurements = {.loops = 300}, .seed = 3});
  for (auto& constraint : city.graph.constraints) constraint.information *= 1e-3;
  const auto bad = corrupt(city.graph, city.truth, {.fraction = 0.5, .seed = 3});
  const auto result = consensus(bad.graph, edge_roles(bad.graph));
  const auto metrics = evaluate_loops(result.verdicts, bad.labels);
  EXPECT_LT(result.odometry_scale, 0.1);
  EXPECT_NEAR(std::log(result.loop_scale / 1e-3), 0.0, 0.3) << "no further than they deserve";
  EXPECT_GE(metrics.precision(), 0.99);
  EXPECT_GE(metrics.recall(), 0.99);
}

// Loops between near poses that odometry ties far better, and that are wrong by three
// times what they claim, are no measure of odometry, nor do the loops that hold the map suffer.
TEST(Consensus, SloppyLoopsBetweenNearPosesDoNoHarm) {
  Random random(12);
  auto city = simulate_city({.poses = 800, .measurements = {.loops = 150}, .seed = 5});
  for (int k = 0; k < 300; ++k) {
    Constraint<Pose2> near;
    near.from = static_cast<Index>(random.index(790));
    near.to = near.from + 2 + static_cast<Index>(random.index(6));
    const Pose2::Tangent sigma(0.3, 0.3, 0.1);
    near.information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
    const Pose2::Tangent error = 3.0 * sigma.cwiseProduct(random_tangent<Pose2>(random, 1.0));
    near.T_from_to = city.truth[near.from].inverse() * city.truth[near.to] * Pose2::exp(error);
    city.graph.constraints.push_back(near);
  }
  const auto result = consensus(city.graph, edge_roles(city.graph));
  EXPECT_LT(result.odometry_scale, 1.5);
  for (std::size_t k = 0; k < 150; ++k) EXPECT_EQ(result.verdicts[k].verdict, Verdict::keep);
}

// A front end may copy a loop along odometry; the copies close perfect cycles with it,
// which say nothing of how accurate odometry is.
TEST(Consensus, CopiedLoopsDoNotVouchForOdometry) {
  auto city =
      simulate_city({.poses = 600, .measurements = {.loops = 60, .drift = 10.0}, .seed = 6});
  auto& constraints = city.graph.constraints;
  const auto roles = edge_roles(city.graph);
  std::vector<Pose2> step(600);
  for (const Index k : roles.odometry) step[constraints[k].from] = constraints[k].T_from_to;
  for (const Index k : roles.candidates) {
    auto copy = constraints[k];
    for (int n = 0; n < 4 && std::max(copy.from, copy.to) + 1 < 600; ++n) {
      copy.T_from_to = step[copy.from++].inverse() * copy.T_from_to * step[copy.to++];
      if (std::abs(copy.to - copy.from) > 1) constraints.push_back(copy);
    }
  }
  const auto result = consensus(city.graph, edge_roles(city.graph));
  EXPECT_EQ(count(result.verdicts, Verdict::keep),
            static_cast<std::int64_t>(result.verdicts.size()));
}

// All errors are a thirtieth of what the file states: true loops end well inside the gate,
// and false ones between near poses begin there.
TEST(Consensus, FalseLoopsThatCrowdAroundTheGateDoNotPass) {
  auto city = simulate_city({.poses = 2000, .measurements = {.loops = 600}, .seed = 4});
  for (auto& constraint : city.graph.constraints) constraint.information *= 1e-3;
  const auto metrics = metrics_of(city, {.type = NoiseType::local, .fraction = 0.5, .seed = 4});
  EXPECT_GE(metrics.precision(), 0.995);
  EXPECT_GE(metrics.recall(), 0.995);
}

// Odometry in pieces of ten poses, with edges that skip a pose where a step is missing.
Corrupted<Pose2> city_in_pieces_of_ten() {
  auto city = simulate_city({.poses = 600, .measurements = {.loops = 200}, .seed = 4});
  auto& constraints = city.graph.constraints;
  const auto step = constraints.front();
  std::erase_if(constraints, [](const auto& c) { return c.to == c.from + 1 && c.to % 10 == 0; });
  const auto add = [&](Index from, Index to) {
    auto skip = step;
    skip.from = from;
    skip.to = to;
    skip.T_from_to = city.truth[from].inverse() * city.truth[to];
    constraints.push_back(skip);
  };
  for (Index v = 10; v + 1 < 600; v += 10) {
    add(v - 2, v);
    add(v - 1, v + 1);
    add(v - 1, v + 1);
  }
  for (Index v = 1; v + 2 < 600; ++v) add(v, v + 2);
  return corrupt(city.graph, city.truth, {.fraction = 0.3, .seed = 4});
}

// The same with a single edge over each gap, which no other confirms.
Corrupted<Pose2> city_in_pieces_of_twenty() {
  auto city = simulate_city({.poses = 600, .measurements = {.loops = 200}, .seed = 8});
  auto& constraints = city.graph.constraints;
  const auto step = constraints.front();
  std::erase_if(constraints, [](const auto& c) { return c.to == c.from + 1 && c.to % 20 == 0; });
  for (Index v = 1; v + 2 < 600; ++v) {
    if (v % 20 == 18) continue;
    auto skip = step;
    skip.from = v;
    skip.to = v + 2;
    skip.T_from_to = city.truth[v].inverse() * city.truth[v + 2];
    constraints.push_back(skip);
  }
  return corrupt(city.graph, city.truth, {.fraction = 0.5, .seed = 8});
}

TEST(Consensus, JoinsBrokenOdometryByEdgesPastOnePose) {
  for (const auto& bad : {city_in_pieces_of_ten(), city_in_pieces_of_twenty()}) {
    const auto verdicts = consensus(bad.graph, edge_roles(bad.graph)).verdicts;
    const auto metrics = evaluate_loops(verdicts, bad.labels);
    EXPECT_GE(metrics.precision(), 0.99);
    EXPECT_GE(metrics.recall(), 0.99);
    EXPECT_LE(count(verdicts, Verdict::ambiguous), 1);
  }
}

// Not met: in each city one loop stays ambiguous.
TEST(Consensus, DISABLED_LeavesNoDoubtWhereOdometryIsBroken) {
  for (const auto& bad : {city_in_pieces_of_ten(), city_in_pieces_of_twenty()}) {
    const auto result = consensus(bad.graph, edge_roles(bad.graph));
    EXPECT_EQ(count(result.verdicts, Verdict::ambiguous), 0);
  }
}

// One step of odometry is missing, and false loops come in groups that agree as true ones
// do: what joins the two parts is decided by the loops elsewhere that it lets be proven.
TEST(Consensus, JoinsPartsByWhatLoopsElsewhereConfirm) {
  auto city = simulate_city({.poses = 1200, .measurements = {.loops = 400}, .seed = 9});
  std::erase_if(city.graph.constraints, [](const auto& c) { return c.from == 599 && c.to == 600; });
  const CorruptOptions hardly_clustered = {
      .type = NoiseType::random_grouped, .fraction = 0.5, .seed = 9};
  const CorruptOptions large_groups = {
      .type = NoiseType::random_grouped, .fraction = 0.7, .group_size = 20, .seed = 10};
  for (const auto& [options, window] : {std::pair(hardly_clustered, 3), {large_groups, 20}}) {
    const auto bad = corrupt(city.graph, city.truth, options);
    const auto result = consensus(bad.graph, edge_roles(bad.graph), {.window = window});
    const auto metrics = evaluate_loops(result.verdicts, bad.labels);
    EXPECT_EQ(metrics.precision(), 1.0);
    EXPECT_EQ(metrics.recall(), 1.0);
    EXPECT_EQ(count(result.verdicts, Verdict::ambiguous), 0);
  }
}

TYPED_TEST(ConsensusOf, DegenerateGraphs) {
  using Pose = TypeParam;
  PoseGraph<Pose> graph;
  EXPECT_TRUE(consensus(graph, edge_roles(graph)).verdicts.empty());

  Random random(36);
  graph = isotherm_test::random_chain<Pose>(random, 10);
  EXPECT_TRUE(consensus(graph, edge_roles(graph)).verdicts.empty()) << "no candidate";

  // A loop from a pose to itself, one that claims nothing, a repeated step.
  graph.constraints.push_back({4, 4, Pose(), Pose::Matrix::Identity()});
  graph.constraints.push_back({1, 8, Pose(), Pose::Matrix::Zero()});
  graph.constraints.push_back(graph.constraints.front());
  const auto result = consensus(graph, edge_roles(graph));
  ASSERT_EQ(result.verdicts.size(), 3u);
  EXPECT_EQ(count(result.verdicts, Verdict::prune), 0);

  graph.constraints.back().information(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(consensus(graph, edge_roles(graph)), NumericalError);
}

TYPED_TEST(ConsensusOf, ProgressIsReportedAndCanCancel) {
  using Pose = TypeParam;
  Random random(37);
  const auto made = random_loop_graph<Pose>(random, 60, 30, 1.0);
  const auto roles = edge_roles(made.graph);
  int calls = 0;
  const auto count = [&calls](const Progress& progress) {
    EXPECT_LE(progress.done, progress.total);
    ++calls;
    return true;
  };
  const auto result = consensus(made.graph, roles, {}, {.progress = count});
  EXPECT_GE(calls, 2 * static_cast<int>(result.moves.size()));
  const auto stop = [](const Progress&) { return false; };
  EXPECT_THROW(consensus(made.graph, roles, {}, {.progress = stop}), Cancelled);
}

TEST(Consensus, SurvivesDriftAndGroupsInACity) {
  const auto city = simulate_city({.poses = 1500, .measurements = {.drift = 20.0}, .seed = 1});
  for (const std::int64_t size : {5, 20}) {
    const auto metrics = metrics_of(
        city, {.type = NoiseType::random_grouped, .fraction = 0.5, .group_size = size, .seed = 1});
    EXPECT_GE(metrics.precision(), 0.99);
    EXPECT_GE(metrics.recall(), 0.99);
  }
}

TYPED_TEST(ConsensusOf, WithoutInformationPruneFallsBackOnHeat) {
  using Pose = TypeParam;
  Random random(38);
  auto made = random_loop_graph<Pose>(random, 30, 10, 0.0);
  for (auto& constraint : made.graph.constraints) constraint.information.setZero();
  const auto result = prune(made.graph, edge_roles(made.graph));
  EXPECT_EQ(result.method, "heat");
  EXPECT_THAT(result.warnings, testing::Contains(testing::HasSubstr("heat distances")));
}

TEST(Consensus, WarnsOfInformationThatSaysNothing) {
  Random random(39);
  const auto made = random_loop_graph<Pose2>(random, 120, 80, 1.0);
  const auto warnings_at = [&](double factor) {
    auto graph = made.graph;
    for (const Index k : edge_roles(graph).odometry) graph.constraints[k].information *= factor;
    return prune(graph).warnings;
  };
  EXPECT_TRUE(warnings_at(1.0).empty());
  EXPECT_TRUE(warnings_at(1e-3).empty()) << "a factor of thirty in the errors may happen";
  EXPECT_THAT(warnings_at(1e-6),
              testing::ElementsAre(testing::HasSubstr("information of odometry says nothing")));
}

TEST(Consensus, DeviationsOfThePriorAreFactorsOfTenInTheErrors) {
  EXPECT_EQ(prior_deviations(1.0), 0.0);
  EXPECT_NEAR(prior_deviations(100.0), 1.0, 1e-12);
  EXPECT_NEAR(prior_deviations(1e-4), 2.0, 1e-12);
}

TEST(Consensus, OptionsAreChecked) {
  const PoseGraph<Pose2> graph;
  const EdgeRoles roles;
  EXPECT_THROW(consensus(graph, roles, {.significance = 0.0}), InvalidArgument);
  EXPECT_THROW(consensus(graph, roles, {.significance = 0.5}), InvalidArgument);
  EXPECT_THROW(consensus(graph, roles, {.window = 0}), InvalidArgument);
  EXPECT_THROW(consensus(graph, roles, {.max_rounds = 0}), InvalidArgument);
}

// The sums of distances are those of the files: nothing true is lost on clean data, and at
// most one in twenty is left open.
TEST(Consensus, KeepsRealCleanGraphs) {
  for (const std::string name : {"posegraph2d/MIT/MIT", "posegraph2d/CSAIL/CSAIL",
                                 "posegraph2d/intel/intel", "paper/kitti/kitti_09"}) {
    ISOTHERM_REAL_DATA_OR_SKIP(path, name + ".g2o");
    const auto file = read_pose_graph(path.string());
    const auto& graph = std::get<PoseGraph<Pose2>>(file.graph);
    const auto result = consensus(graph, edge_roles(graph));
    EXPECT_EQ(count(result.verdicts, Verdict::prune), 0) << name;
    EXPECT_LE(20 * count(result.verdicts, Verdict::ambiguous),
              static_cast<std::int64_t>(result.verdicts.size()))
        << name;
  }
}

TEST(Consensus, FindsGroupedFalseLoopsOfRingCity) {
  ISOTHERM_REAL_DATA_OR_SKIP(path, "outliers/ringCity_randomgrouped_100.g2o.gz");
  ISOTHERM_REAL_DATA_OR_SKIP(labels, "outliers/ringCity_randomgrouped_100.labels.csv");
  const auto file = read_pose_graph(path.string());
  const auto& graph = std::get<PoseGraph<Pose2>>(file.graph);
  const auto result = consensus(graph, edge_roles(graph));
  const auto metrics = evaluate_loops(result.verdicts, read_labels(labels.string()));
  EXPECT_EQ(metrics.precision(), 1.0);
  EXPECT_EQ(metrics.recall(), 1.0);
}

// Where turns of a spiral are a little off, each loop between them speaks against the map: of 60
// that are true 12 were left undecided, one by one.
TEST(Consensus, KeepsTogetherWhatIsUndecidedAlone) {
  const auto sphere = simulate_sphere({.poses = 500,
                                       .measurements = {.loops = 60,
                                                        .odometry_sigma = 0.1,
                                                        .odometry_turn_sigma = 0.02,
                                                        .loop_sigma = 0.1,
                                                        .loop_turn_sigma = 0.02},
                                       .seed = 2});
  const auto result = consensus(sphere.graph, edge_roles(sphere.graph));
  EXPECT_EQ(count(result.verdicts, Verdict::prune), 0);
  EXPECT_GE(count(result.verdicts, Verdict::keep), 52);
}

// A robot drives twice around a block, with loops where it comes by again and more where it looks
// to a detector as if it had not moved: each of these says, a little differently, that it is where
// it was 20 m before. Odometry that is bad enough, or loops that are, would explain all of them.
TEST(Consensus, PlacesThatLookAlikeAlongTheWayAreNotOne) {
  Random random(5);
  constexpr int kLap = 600;
  constexpr double kStep = 0.5;
  const Pose2::Tangent step_sigma(0.02, 0.02, 0.005);
  const Pose2::Tangent loop_sigma(0.3, 0.3, 0.05);
  const auto noise = [&random](const Pose2::Tangent& sigma) {
    return Pose2::exp(sigma.cwiseProduct(random_tangent<Pose2>(random, 1.0)));
  };
  const auto information = [](const Pose2::Tangent& sigma) {
    return Pose2::Matrix(sigma.cwiseAbs2().cwiseInverse().asDiagonal());
  };
  PoseGraph<Pose2> graph;
  std::vector<Pose2> truth = {Pose2()};
  std::vector<EdgeLabel> labels;
  for (Index v = 0; v < 2 * kLap; ++v) {
    const bool corner = v % (kLap / 4) == kLap / 4 - 1;
    const Pose2 step(kStep * random.uniform(0.8, 1.2), 0.0, corner ? 0.5 * std::numbers::pi : 0.0);
    truth.push_back(truth.back() * step);
    graph.constraints.push_back({v, v + 1, step * noise(step_sigma), information(step_sigma)});
  }
  const auto add = [&](Index from, Index to, const Pose2& measured, Label label) {
    labels.push_back(
        {graph.constraint_count(), static_cast<VertexId>(from), static_cast<VertexId>(to), label});
    graph.constraints.push_back({from, to, measured, information(loop_sigma)});
  };
  for (Index v = 60; v < 2 * kLap; v += 10) {
    const Index along = v % (kLap / 4);  // this side of the block
    if (v >= kLap && along < 90) {
      const Pose2 h = truth[v - kLap].inverse() * truth[v];
      add(v - kLap, v, h * noise(loop_sigma), Label::correct);
    }
    if (along >= 40) add(v - 40, v, noise(1.5 * loop_sigma), Label::incorrect);
  }
  graph.poses = truth;
  graph.ids.resize(truth.size());
  std::iota(graph.ids.begin(), graph.ids.end(), 0);
  const auto metrics = evaluate_loops(consensus(graph, edge_roles(graph)).verdicts, labels);
  EXPECT_EQ(metrics.fp, 0);
  EXPECT_EQ(metrics.fn, 0);
}

// Copies of one false measurement hold each other up, where a gyroscope drifts: two groups of ten
// were thought true, of 53 nats less than the labels.
TEST(Consensus, DropsRunsOfCopies) {
  ISOTHERM_REAL_DATA_OR_SKIP(path, "paper/b25b/B25b_0.600.g2o");
  auto graph = std::get<PoseGraph<Pose2>>(read_pose_graph(path.string()).graph);
  for (const Index k : edge_roles(graph).odometry) {
    auto& step = graph.constraints[k];
    step.T_from_to = Pose2(step.T_from_to.translation().x(), step.T_from_to.translation().y(),
                           step.T_from_to.angle() + (step.from < step.to ? 1e-3 : -1e-3));
  }
  const auto bad = corrupt(graph, optimize(graph).poses,
                           {.type = NoiseType::random_grouped, .fraction = 0.5, .seed = 1});
  const auto result = consensus(bad.graph, edge_roles(bad.graph));
  const auto metrics = evaluate_loops(result.verdicts, bad.labels);
  EXPECT_EQ(metrics.precision(), 1.0);
  EXPECT_GE(metrics.recall(), 0.97);
}

}  // namespace
}  // namespace isotherm::slam
