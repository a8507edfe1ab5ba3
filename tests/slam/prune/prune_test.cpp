#include "isotherm/slam/prune/prune.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/base/statistics.hpp"
#include "isotherm/slam/evaluate/evaluate_loops.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/slam/prune/odometry_chi2.hpp"
#include "isotherm/slam/simulate/corrupt.hpp"
#include "isotherm/slam/simulate/simulate.hpp"
#include "isotherm_test/data.hpp"

namespace isotherm::slam {
namespace {

using spectral::Verdict;

TEST(Prune, Chi2GateIsTheQuantile) {
  const auto city = simulate_city({.poses = 500, .measurements = {.loops = 300}, .seed = 1});
  const auto roles = edge_roles(city.graph);
  const auto result = prune(city.graph, roles, Chi2PruneOptions{.significance = 0.05});
  const auto checks = odometry_chi2(city.graph, roles);
  for (std::size_t c = 0; c < checks.size(); ++c) {
    EXPECT_EQ(result.verdicts[c].score, checks[c].chi2);
    EXPECT_EQ(result.verdicts[c].threshold, chi_squared_quantile(0.95, 3));
    EXPECT_EQ(result.verdicts[c].edge, roles.candidates[c]);
  }
  EXPECT_TRUE(result.warnings.empty());
}

TEST(Prune, LoopsBetweenPartsAreKeptWithAWarning) {
  PoseGraph<Pose2> graph;
  graph.ids = {0, 1, 2, 3};
  graph.constraints = {{0, 1, Pose2(1, 0, 0)}, {2, 3, Pose2(1, 0, 0)}, {0, 3, Pose2(9, 9, 1)}};
  const auto result = prune(graph, Chi2PruneOptions{});
  ASSERT_EQ(result.verdicts.size(), 1u);
  EXPECT_EQ(result.verdicts[0].verdict, Verdict::keep);
  EXPECT_EQ(result.verdicts[0].stage, "no-odometry-path");
  EXPECT_EQ(result.warnings.size(), 1u);
}

TEST(Prune, SelfEdgesAreSetAsideByEveryMethod) {
  PoseGraph<Pose2> graph;
  graph.ids = {0, 1, 2, 3, 4};
  for (Index v = 0; v < 4; ++v) graph.constraints.push_back({v, v + 1, Pose2(1, 0, 0)});
  graph.constraints.push_back({2, 2, Pose2(5, 0, 0)});
  graph.constraints.push_back({0, 3, Pose2(3, 0, 0)});
  graph.constraints.push_back({0, 0, Pose2(0, 0, 0)});
  for (const auto& method : prune_methods()) {
    const auto name = method_name(method);
    const auto result = prune(graph, method);
    ASSERT_EQ(result.verdicts.size(), 3u) << name;
    for (const Index k : {0, 2}) {
      EXPECT_EQ(result.verdicts[k].edge, 4 + k) << name;
      EXPECT_EQ(result.verdicts[k].verdict, Verdict::ambiguous) << name;
      EXPECT_EQ(result.verdicts[k].stage, "self-edge") << name;
      EXPECT_TRUE(std::isnan(result.verdicts[k].probability)) << name;
    }
    EXPECT_EQ(result.verdicts[1].edge, 5) << name;
    EXPECT_NE(result.verdicts[1].verdict, Verdict::prune) << name << ": one loop proves little";
    EXPECT_NE(result.warnings.back().find("2 edges join a vertex with itself"), std::string::npos);
  }
}

TEST(Prune, ARepeatIsNoEvidenceAndHasTheVerdictOfItsOriginal) {
  auto city = simulate_city({.poses = 300, .measurements = {.loops = 60}, .seed = 3}).graph;
  for (auto& constraint : city.constraints) constraint.line = 0;
  const auto roles = edge_roles(city);
  auto repeated = city;
  for (const Index k : roles.candidates) repeated.constraints.push_back(city.constraints[k]);
  repeated.constraints.push_back(city.constraints[roles.odometry.front()]);
  for (const auto& method : prune_methods()) {
    const auto name = method_name(method);
    const auto once = prune(city, method).verdicts;
    const auto result = prune(repeated, method);
    ASSERT_EQ(result.verdicts.size(), 2 * once.size() + 1) << name;
    EXPECT_EQ(result.verdicts.back().verdict, Verdict::keep) << name << ": repeats odometry";
    EXPECT_EQ(result.verdicts.back().stage, "repeat") << name;
    for (std::size_t k = 0; k < once.size(); ++k) {
      const auto& copy = result.verdicts[once.size() + k];
      EXPECT_EQ(result.verdicts[k].verdict, once[k].verdict) << name;
      EXPECT_EQ(result.verdicts[k].score, once[k].score) << name;
      EXPECT_EQ(copy.verdict, once[k].verdict) << name;
      EXPECT_EQ(copy.score, once[k].score) << name;
      EXPECT_EQ(copy.stage, "repeat") << name;
      const bool stated = name == "consensus";
      EXPECT_EQ(std::isnan(copy.probability), !stated) << name;
      EXPECT_TRUE(!stated || copy.probability == once[k].probability) << name;
    }
    EXPECT_NE(result.warnings.back().find("61 edges repeat another one"), std::string::npos);
  }
}

TEST(Prune, LoopsBetweenChainsThatMeetEachInOneVertex) {
  for (const Index length : {1, 2, 2001}) {
    PoseGraph<Pose2> graph;
    for (Index v = 0; v < length; ++v) {
      graph.ids.push_back(static_cast<VertexId>(v));
      if (v > 0) graph.constraints.push_back({v - 1, v, Pose2(1, 0, 0)});
    }
    // Another robot, of one pose: all loops touch it, so that no pose is left to move.
    graph.ids.push_back(VertexId{1} << 60);
    for (int copies = 0; copies < 3; ++copies) {
      graph.constraints.push_back({0, length, Pose2(1, 2, 0.5)});
    }
    graph.constraints.push_back({0, 0, Pose2(1, 0, 0)});
    const auto result = prune(graph);
    EXPECT_EQ(result.verdicts.size(), 4u);
  }
}

TEST(Prune, Chi2SeparatesTheRealLoopsOfBicocca) {
  ISOTHERM_REAL_DATA_OR_SKIP(folder, "paper/b25b");
  const auto file = read_pose_graph((folder / "B25b_0.000.g2o").string());
  const auto result = prune(file, Chi2PruneOptions{});
  EXPECT_EQ(result.verdicts.size(), 446u);
  EXPECT_EQ(count(result.verdicts, Verdict::prune), 211);
}

TEST(ApplyVerdicts, LeavesOutPrunedAndByDefaultAmbiguous) {
  PoseGraph<Pose2> graph;
  graph.ids = {0, 1, 2};
  graph.constraints = {{0, 1}, {1, 2}, {0, 2}, {2, 0}, {0, 2}};
  spectral::EdgeVerdicts verdicts(3);
  verdicts[0].edge = 2;
  verdicts[0].verdict = Verdict::prune;
  verdicts[1].edge = 3;
  verdicts[1].verdict = Verdict::ambiguous;
  verdicts[2].edge = 4;
  EXPECT_EQ(apply_verdicts(graph, verdicts).constraint_count(), 3);
  EXPECT_EQ(apply_verdicts(graph, verdicts, true).constraint_count(), 4);
  verdicts[0].edge = 5;
  EXPECT_THROW(apply_verdicts(graph, verdicts), InvalidArgument);
}

TEST(PruneMethods, AreKnownByName) {
  const auto methods = prune_methods();
  ASSERT_EQ(methods.size(), std::variant_size_v<PruneOptions>);
  for (std::size_t k = 0; k < methods.size(); ++k) {
    EXPECT_EQ(methods[k].index(), k);
    EXPECT_EQ(prune_method(method_name(methods[k])).index(), k) << "a name of its own";
    EXPECT_FALSE(method_title(methods[k]).empty());
  }
  EXPECT_EQ(method_name({}), "consensus") << "the default";
  EXPECT_THROW(prune_method("magic"), InvalidArgument);
}

TEST(PruneMethods, OptionsOutOfRange) {
  const PoseGraph<Pose2> graph;
  for (const double significance : {1.0, 1.5, 0.0, -0.1}) {
    EXPECT_THROW(prune(graph, Chi2PruneOptions{.significance = significance}), InvalidArgument);
  }
  EXPECT_THROW(prune(graph, DcsOptions{.kernel_width = -1.0}), InvalidArgument);
}

// The same decisions, whether a graph's roles are given or found, its dimension known or not.
TEST(PruneMethods, GraphsOfAnyDimensionWithTheirOwnRoles) {
  const auto city = simulate_city({.poses = 200, .measurements = {.loops = 80}, .seed = 3});
  const auto bad = corrupt(city.graph, city.truth, {.count = 40, .seed = 3});
  const auto scores = [](const PruneResult& result) {
    std::vector<double> all;
    for (const auto& verdict : result.verdicts) all.push_back(verdict.score);
    return all;
  };
  for (const auto& method : prune_methods()) {
    const auto given = prune(bad.graph, edge_roles(bad.graph), method);
    EXPECT_EQ(given.method, method_name(method));
    EXPECT_EQ(given.verdicts.size(), 120u);
    EXPECT_EQ(scores(prune(bad.graph, method)), scores(given)) << method_name(method);
    EXPECT_EQ(scores(prune(AnyPoseGraph(bad.graph), method)), scores(given));
  }
}

TEST(PruneMethods, SameVerdictsForAnyNumberOfThreads) {
  const auto city = simulate_city({.poses = 400, .measurements = {.loops = 150}, .seed = 5});
  const auto bad = corrupt(city.graph, city.truth, {.count = 150, .seed = 5});
  for (const char* method : {"consensus", "heat", "lap-line"}) {
    const auto one = prune(bad.graph, prune_method(method), {.threads = 1});
    const auto three = prune(bad.graph, prune_method(method), {.threads = 3});
    for (std::size_t k = 0; k < one.verdicts.size(); ++k) {
      EXPECT_EQ(one.verdicts[k].verdict, three.verdicts[k].verdict);
      EXPECT_EQ(one.verdicts[k].score, three.verdicts[k].score);
    }
  }
  EXPECT_THROW(prune(bad.graph, HeatPruneOptions{}, {.threads = -1}), InvalidArgument);
}

// Every real graph of the list loads and prunes.
class RealGraphs : public testing::TestWithParam<std::string> {};

TEST_P(RealGraphs, LoadAndPrune) {
  ISOTHERM_REAL_DATA_OR_SKIP(path, GetParam());
  const auto file = read_pose_graph(path.string());
  const auto candidates =
      std::visit([](const auto& graph) { return edge_roles(graph).candidates.size(); }, file.graph);
  EXPECT_EQ(prune(file, HeatPruneOptions{.tolerance = 1e-4}).verdicts.size(), candidates);
  EXPECT_EQ(prune(file, Chi2PruneOptions{}).verdicts.size(), candidates);
}

INSTANTIATE_TEST_SUITE_P(Files, RealGraphs,
                         testing::Values("posegraph2d/intel/intel.g2o",
                                         "posegraph2d/CSAIL/CSAIL.g2o", "paper/kitti/kitti_00.g2o",
                                         "paper/kitti/kitti_06.g2o", "paper/b25b/B25b_0.300.g2o",
                                         "posegraph3d/sphere2500/sphere2500.g2o",
                                         "posegraph3d/parking-garage/parking-garage.g2o"));

}  // namespace
}  // namespace isotherm::slam
