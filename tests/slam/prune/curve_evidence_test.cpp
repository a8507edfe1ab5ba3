#include "isotherm/slam/prune/curve_evidence.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/evaluate/evaluate_loops.hpp"
#include "isotherm/slam/evaluate/ground_truth.hpp"
#include "isotherm/slam/graph/trajectory.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/slam/prune/prune.hpp"
#include "isotherm_test/data.hpp"

namespace isotherm::slam {
namespace {

using ::testing::Each;
using ::testing::Field;

template <class Pose>
PoseGraph<Pose> graph_along(const std::vector<Pose>& poses) {
  PoseGraph<Pose> graph;
  graph.poses = poses;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    graph.ids.push_back(k);
    if (k == 0) continue;
    Constraint<Pose> step;
    step.from = static_cast<Index>(k - 1);
    step.to = static_cast<Index>(k);
    step.T_from_to = poses[k - 1].inverse() * poses[k];
    graph.constraints.push_back(step);
  }
  return graph;
}

// Two laps of a bending circuit of about 340 m, a vertex every degree.
std::vector<Pose2> two_laps() {
  const auto at = [](double t) {
    const double radius = 50.0 + 9.0 * std::sin(3.0 * t) + 6.0 * std::cos(2.0 * t);
    return Eigen::Vector2d(radius * std::cos(t), radius * std::sin(t));
  };
  std::vector<Pose2> poses;
  for (int k = 0; k < 720; ++k) {
    const double t = k * std::numbers::pi / 180.0;
    const Eigen::Vector2d tangent = at(t + 1e-4) - at(t - 1e-4);
    poses.emplace_back(at(t), std::atan2(tangent.y(), tangent.x()));
  }
  return poses;
}

template <class Pose>
void add_loop(PoseGraph<Pose>& graph, Index from, Index to, const Pose& T_from_to) {
  Constraint<Pose> loop;
  loop.from = from;
  loop.to = to;
  loop.T_from_to = T_from_to;
  graph.constraints.push_back(loop);
}

// Correct loops first, then as many that claim two different places to be one.
template <class Pose>
PoseGraph<Pose> with_loops(const std::vector<Pose>& poses) {
  auto graph = graph_along(poses);
  for (const Index v : {70, 120, 190, 250, 300}) {
    add_loop(graph, v, v + 360, poses[v].inverse() * poses[v + 360]);
  }
  for (const Index v : {70, 120, 190, 250, 300}) add_loop(graph, v, v + 300, Pose());
  return graph;
}

std::vector<double> scores(const std::vector<CurveEvidence>& evidence) {
  std::vector<double> found;
  for (const auto& e : evidence) found.push_back(e.score);
  return found;
}

void expect_first_half_below_second(const std::vector<CurveEvidence>& evidence) {
  const std::size_t half = evidence.size() / 2;
  for (std::size_t a = 0; a < half; ++a) {
    EXPECT_TRUE(evidence[a].compared);
    for (std::size_t b = half; b < evidence.size(); ++b) {
      EXPECT_LT(evidence[a].score, evidence[b].score) << a << " " << b;
    }
  }
}

std::vector<CurveEvidenceOptions> all_comparisons() {
  std::vector<CurveEvidenceOptions> all(5);
  all[0].comparison = CurveComparison::lap_line;
  all[0].lap_line = {.interval = 1.0, .window = 40};
  all[1].windows = {30.0};
  all[2].windows = {20.0, 40.0};
  all[2].shared_path = SharedPath::left_out;
  all[3].windows = {30.0};
  all[3].rarity = true;
  all[3].places = 60;
  all[4].windows = {30.0};
  all[4].shared_path = SharedPath::any_half;
  return all;
}

TEST(CurveEvidence, LoopsBetweenVisitsOfOnePlaceScoreLow) {
  const auto graph = with_loops(two_laps());
  for (const auto& options : all_comparisons()) {
    const auto evidence = curve_evidence(graph, edge_roles(graph), options);
    ASSERT_EQ(evidence.size(), 10U);
    expect_first_half_below_second(evidence);
    for (int k = 0; k < 5; ++k) EXPECT_LT(evidence[k].disparity, 0.3);  // half a step at most
  }
}

TEST(CurveEvidence, InSpace) {
  std::vector<Pose3> poses;
  const Eigen::Quaterniond tilt = Eigen::Quaterniond(0.9, 0.2, -0.3, 0.1).normalized();
  for (const auto& pose : two_laps()) {
    const double climb = 5.0 * std::sin(0.05 * pose.translation().x());
    const Pose3 lifted = lift(pose);
    poses.push_back(Pose3(Eigen::Vector3d(3, 2, 1), tilt) *
                    Pose3(lifted.translation() + Eigen::Vector3d(0, 0, climb), lifted.rotation()));
  }
  const auto graph = with_loops(poses);
  for (const auto& options : all_comparisons()) {
    expect_first_half_below_second(curve_evidence(graph, edge_roles(graph), options));
  }
}

TEST(CurveEvidence, TravelBackOnTheSameRoadMatches) {
  // Out along half a lap, and back on it.
  auto poses = two_laps();
  poses.resize(300);
  for (int k = 299; k >= 0; --k) {
    poses.emplace_back(poses[k].translation(), poses[k].angle() + std::numbers::pi);
  }
  auto graph = graph_along(poses);
  for (const Index v : {80, 130, 170}) add_loop(graph, v, 599 - v, Pose2(0, 0, std::numbers::pi));
  for (const Index v : {80, 130, 170}) add_loop(graph, v, 560 - v, Pose2(0, 0, std::numbers::pi));
  for (auto options : all_comparisons()) {
    if (options.rarity) continue;  // a path that lies on itself twice has no rare place
    expect_first_half_below_second(curve_evidence(graph, edge_roles(graph), options));
  }
}

TEST(CurveEvidence, ALoopThatShiftsAStraightPathAlongItselfDoesNotPass) {
  // Straight for 200 m with a bend at its end; the loop says that 20 m were none.
  std::vector<Pose2> poses;
  for (int k = 0; k < 200; ++k) poses.emplace_back(k, 0.0, 0.0);
  for (int k = 1; k < 60; ++k) poses.emplace_back(199.0, k, std::numbers::pi / 2.0);
  auto graph = graph_along(poses);
  add_loop(graph, 150, 170, Pose2());
  CurveEvidenceOptions options{.windows = {60.0}};
  const auto roles = edge_roles(graph);
  EXPECT_GT(curve_evidence(graph, roles, options)[0].disparity, 1.0);
  options.shared_path = SharedPath::any_half;
  EXPECT_LT(curve_evidence(graph, roles, options)[0].disparity, 1e-9);
}

TEST(CurveEvidence, PathsThatAreTooShortTellNothing) {
  std::vector<Pose2> poses;
  for (int k = 0; k < 5; ++k) poses.emplace_back(k, 0.0, 0.0);
  auto graph = graph_along(poses);
  add_loop(graph, 0, 4, Pose2());
  for (const auto& options : all_comparisons()) {
    const auto evidence = curve_evidence(graph, edge_roles(graph), options);
    EXPECT_EQ(evidence[0].score, 0.5);
    EXPECT_FALSE(evidence[0].compared);
  }
}

TEST(CurveEvidence, ChainsWithoutLengthOrOdometryTellNothing) {
  auto still = graph_along(std::vector<Pose2>(4));
  add_loop(still, 0, 3, Pose2(1.0, 0.0, 0.0));
  PoseGraph<Pose2> loose;
  loose.ids = {0, 5, std::uint64_t{1} << 60};
  add_loop(loose, 0, 2, Pose2());
  for (const auto& options : all_comparisons()) {
    EXPECT_THAT(curve_evidence(still, edge_roles(still), options),
                Each(Field(&CurveEvidence::compared, false)));
    EXPECT_THAT(curve_evidence(loose, edge_roles(loose), options),
                Each(Field(&CurveEvidence::compared, false)));
    EXPECT_TRUE(curve_evidence(PoseGraph<Pose3>(), EdgeRoles(), options).empty());
  }
}

TEST(CurveEvidence, LoopsBetweenTwoChainsAreCompared) {
  const auto poses = two_laps();
  auto graph = with_loops(poses);
  const auto whole = curve_evidence(graph, edge_roles(graph), {.windows = {30.0}});
  // Another robot from the second lap on: its odometry starts anew.
  for (std::size_t v = 360; v < graph.ids.size(); ++v) graph.ids[v] |= std::uint64_t{1} << 56;
  graph.constraints.erase(graph.constraints.begin() + 359);
  const auto split = curve_evidence(graph, edge_roles(graph), {.windows = {30.0}});
  expect_first_half_below_second(split);
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(split[k].disparity, whole[k].disparity, 0.3);
}

TEST(CurveEvidence, ManyThreadsGiveTheSame) {
  const auto graph = with_loops(two_laps());
  for (const auto& options : all_comparisons()) {
    EXPECT_EQ(scores(curve_evidence(graph, edge_roles(graph), options, {.threads = 1})),
              scores(curve_evidence(graph, edge_roles(graph), options, {.threads = 3})));
  }
}

TEST(CurveEvidence, RejectsOptionsOutOfRange) {
  const auto graph = with_loops(two_laps());
  const auto reject = [&](const CurveEvidenceOptions& options) {
    EXPECT_THROW(curve_evidence(graph, edge_roles(graph), options), InvalidArgument);
  };
  reject({.lap_line = {.window = 1}});
  reject({.windows = {}});
  reject({.windows = {10.0, -1.0}});
  reject({.windows = {10.0}, .step = 11.0});
  reject({.step = 0.0});
  reject({.cap = std::nan("")});
  reject({.places = 0});
  reject({.chance = 1.0});
}

TEST(PruneByCurves, PrunesTheLoopsBetweenDifferentPlaces) {
  const auto graph = with_loops(two_laps());
  const auto result = prune(graph, edge_roles(graph), CurvePruneOptions{});
  ASSERT_EQ(result.verdicts.size(), 10U);
  for (int k = 0; k < 10; ++k) {
    EXPECT_EQ(result.verdicts[k].verdict,
              k < 5 ? spectral::Verdict::keep : spectral::Verdict::prune);
    EXPECT_EQ(result.verdicts[k].stage, "common-frame");
  }
  EXPECT_TRUE(result.warnings.empty());
}

// The same file in millimetres. Lengths that were given for metres are not the same then.
TEST(PruneByCurves, TheUnitOfTheFilePlaysNoPart) {
  const auto in_metres = with_loops(two_laps());
  auto in_millimetres = in_metres;
  for (auto& edge : in_millimetres.constraints) {
    const Pose2& step = edge.T_from_to;
    edge.T_from_to = Pose2(1000.0 * step.translation(), step.angle());
  }
  const auto same = [&](const CurveEvidenceOptions& metres,
                        const CurveEvidenceOptions& millimetres) {
    const auto expected = prune(in_metres, CurvePruneOptions{metres}).verdicts;
    const auto found = prune(in_millimetres, CurvePruneOptions{millimetres}).verdicts;
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_EQ(found[k].verdict, expected[k].verdict);
      EXPECT_NEAR(found[k].score, expected[k].score, 1e-9);
    }
  };
  same({.comparison = CurveComparison::lap_line}, {.comparison = CurveComparison::lap_line});
  CurveEvidenceOptions scaled;
  for (double& window : scaled.windows) window *= 1000.0;
  scaled.step *= 1000.0;
  scaled.cap *= 1000.0;
  same({}, scaled);
}

TEST(PruneByCurves, SaysWhereItKnowsNothing) {
  std::vector<Pose2> poses;
  for (int k = 0; k < 5; ++k) poses.emplace_back(k, 0.0, 0.0);
  auto graph = graph_along(poses);
  add_loop(graph, 0, 4, Pose2());
  const auto result = prune(graph, edge_roles(graph), CurvePruneOptions{});
  EXPECT_EQ(result.verdicts[0].verdict, spectral::Verdict::keep);
  EXPECT_EQ(result.verdicts[0].stage, "short-path");
  EXPECT_EQ(result.warnings.size(), 1U);
  EXPECT_THROW(prune(graph, edge_roles(graph), CurvePruneOptions{.curve_threshold = 2.0}),
               InvalidArgument);
}

TEST(CurveEvidence, TellsTrueFromFalseLoopsOfBicocca) {
  ISOTHERM_REAL_DATA_OR_SKIP(file, "paper/b25b/B25b_0.000.g2o");
  ISOTHERM_REAL_DATA_OR_SKIP(truth, "paper/b25b/Bicocca_2009-02-25b-GT-extended.csv");
  ISOTHERM_REAL_DATA_OR_SKIP(stamps, "paper/b25b/B25b_timestamps.txt");
  const auto graph = as<Pose2>(read_pose_graph(file.string()));
  const auto roles = edge_roles(graph);
  const auto labels =
      label_candidates(graph, roles, read_ground_truth(graph, {truth.string(), stamps.string()}));
  const auto auc = [&](const CurveEvidenceOptions& curve) {
    return evaluate_loops(prune(graph, roles, CurvePruneOptions{curve}).verdicts, labels).auc;
  };
  EXPECT_GT(auc({}), 0.8);
  const double faithful = auc({.comparison = CurveComparison::lap_line});
  EXPECT_GT(faithful, 0.4);  // 2.7 m of corridor tell nothing
  EXPECT_LT(faithful, 0.6);
}

}  // namespace
}  // namespace isotherm::slam
