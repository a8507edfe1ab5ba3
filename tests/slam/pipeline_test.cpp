#include "isotherm/slam/pipeline.hpp"

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
  const auto result = prune_and_optimize(corrupted.graph, {.prune = {.method = PruneMethod::chi2}});

  EXPECT_EQ(result.optimized.status, OptimizeStatus::converged);
  EXPECT_EQ(result.pruned.poses.size(), 600u);
  EXPECT_EQ(result.pruned.constraint_count(),
            corrupted.graph.constraint_count() -
                count(result.decisions.verdicts, spectral::Verdict::prune));
  EXPECT_LT(worst_error(result.optimized.poses, city.truth), 0.5);
  EXPECT_GT(worst_error(optimize(corrupted.graph).poses, city.truth), 5.0);
}

TEST(Pipeline, EmptyGraph) {
  const auto result = prune_and_optimize(PoseGraph<Pose3>());
  EXPECT_TRUE(result.decisions.verdicts.empty());
  EXPECT_TRUE(result.optimized.poses.empty());
}

}  // namespace
}  // namespace isotherm::slam
