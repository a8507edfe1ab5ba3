#include "isotherm/slam/pipeline.hpp"

#include <algorithm>
#include <optional>

#include <gtest/gtest.h>

#include "isotherm/slam/simulate/corrupt.hpp"
#include "isotherm/slam/simulate/simulate.hpp"

namespace isotherm::slam {
namespace {

double worst_error(const std::vector<Pose2>& poses, const std::vector<Pose2>& truth) {
  double worst = 0.0;
  for (std::size_t v = 0; v < truth.size(); ++v) {
    worst = std::max(worst, (poses[v].translation() - truth[v].translation()).norm());
  }
  return worst;
}

TEST(Pipeline, RecoversTheMapThatFalseLoopsRuin) {
  const auto city = simulate_city({.poses = 600, .measurements = {.loops = 300}, .seed = 5});
  const auto corrupted = corrupt(city.graph, city.truth, {.count = 150, .seed = 5});
  const auto result = prune_and_optimize(corrupted.graph, {.prune = Chi2PruneOptions{}});

  ASSERT_TRUE(result.optimized);
  EXPECT_EQ(result.optimized->status, OptimizeStatus::converged);
  EXPECT_EQ(result.pruned.poses.size(), 600u);
  EXPECT_EQ(result.pruned.constraint_count(),
            corrupted.graph.constraint_count() -
                count(result.decisions.verdicts, spectral::Verdict::prune));
  EXPECT_LT(worst_error(result.pruned.poses, city.truth), 0.5);
  EXPECT_GT(worst_error(optimize(corrupted.graph).poses, city.truth), 5.0);
}

// Trusting every third loop gives roles that edge_roles() would not find, neither before nor
// after pruning: the kernel must spare exactly the trusted ones.
TEST(Pipeline, KeepsTheRolesItWasGiven) {
  const auto city = simulate_city({.poses = 300, .measurements = {.loops = 150}, .seed = 6});
  auto bad = corrupt(city.graph, city.truth, {.count = 80, .seed = 6}).graph;
  const auto found = edge_roles(bad);
  EdgeRoles trusting{found.odometry, {}};
  for (std::size_t c = 0; c < found.candidates.size(); ++c) {
    const bool trusted = c < 150 && c % 3 == 0;
    (trusted ? trusting.odometry : trusting.candidates).push_back(found.candidates[c]);
    bad.constraints[found.candidates[c]].line = trusted ? 1 : 2;
  }
  std::ranges::sort(trusting.odometry);
  const OptimizeOptions robust{.kernel = RobustKernel::dcs};
  const auto result =
      prune_and_optimize(bad, trusting, {.prune = Chi2PruneOptions{}, .optimize = robust});

  const auto decisions = prune(bad, trusting, Chi2PruneOptions{});
  const auto pruned = apply_verdicts(bad, decisions.verdicts);
  EdgeRoles left;
  for (Index k = 0; k < pruned.constraint_count(); ++k) {
    (pruned.constraints[k].line == 2 ? left.candidates : left.odometry).push_back(k);
  }
  const auto optimized = optimize(pruned, left, robust);
  EXPECT_EQ(result.optimized->final_cost, optimized.final_cost);
  EXPECT_EQ(worst_error(result.pruned.poses, optimized.poses), 0.0);
}

TEST(Pipeline, PrunesWithoutOptimisingIfAsked) {
  const auto city = simulate_city({.poses = 100, .measurements = {.loops = 40}, .seed = 5});
  const auto result =
      prune_and_optimize(city.graph, {.prune = Chi2PruneOptions{}, .optimize = std::nullopt});
  EXPECT_FALSE(result.optimized);
  EXPECT_EQ(result.pruned.poses.size(), city.graph.poses.size());
  EXPECT_EQ(worst_error(result.pruned.poses, city.graph.poses), 0.0);
}

TEST(Pipeline, GraphsOfAnyDimension) {
  const auto sphere = simulate_sphere({.poses = 400, .seed = 2});
  const PipelineOptions options{.prune = Chi2PruneOptions{}};
  const auto typed = prune_and_optimize(sphere.graph, options);
  const auto any = prune_and_optimize(AnyPoseGraph(sphere.graph), options);
  const auto& pruned = as<Pose3>(any.pruned);
  EXPECT_EQ(any.roles.candidates, typed.roles.candidates);
  EXPECT_EQ(any.optimized->final_cost, typed.optimized->final_cost);
  ASSERT_EQ(pruned.poses.size(), typed.pruned.poses.size());
  EXPECT_EQ(pruned.poses.back().translation(), typed.pruned.poses.back().translation());
}

TEST(Pipeline, EmptyGraph) {
  const auto result = prune_and_optimize(PoseGraph<Pose3>());
  EXPECT_TRUE(result.decisions.verdicts.empty());
  EXPECT_TRUE(result.pruned.poses.empty());
}

}  // namespace
}  // namespace isotherm::slam
