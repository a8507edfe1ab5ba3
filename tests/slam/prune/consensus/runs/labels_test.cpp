#include "prune/consensus/runs/labels.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"
#include "prune/consensus/climb/assessment.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam::detail {
namespace {

using isotherm_test::random_loop_graph;

// By the chain rule what is known of the next one follows from those before, in any order.
TEST(Labels, AreAsLikelyAsOneByOne) {
  Random random(5);
  LabelCounts labels;
  double sum = labels.log_evidence();
  EXPECT_EQ(sum, 0.0) << "nothing is certain";
  bool before = false;
  for (int k = 0; k < 200; ++k) {
    const bool is_true = random.uniform(0.0, 1.0) < (k < 100 ? 0.9 : 0.2);
    if (random.index(4) == 0) {
      const auto alone = random.index(2) == 0 ? LabelCounts::kFirst : LabelCounts::kCopy;
      sum += labels.log_share(alone, is_true);
      labels.add(alone, is_true);
    } else {
      sum += labels.log_next(before, is_true);
      labels.add_next(before, is_true);
    }
    before = is_true;
    EXPECT_NEAR(labels.log_evidence(), sum, 1e-9);
  }
}

TEST(Labels, AreEitherTrueOrFalse) {
  LabelCounts labels;
  labels.add(LabelCounts::kFirst, 0.3);
  labels.add_next(0.3, 0.8);
  EXPECT_NEAR(std::exp(labels.log_share(LabelCounts::kFirst, true)) +
                  std::exp(labels.log_share(LabelCounts::kFirst, false)),
              1.0, 1e-12);
  for (const bool before : {false, true}) {
    EXPECT_NEAR(std::exp(labels.log_next(before, true)) + std::exp(labels.log_next(before, false)),
                1.0, 1e-12);
  }
  EXPECT_NEAR(std::exp(labels.log_next(true, true)), (1.0 + 0.24) / 2.3, 1e-12)
      << "of .3 that follow a true one .24 are true";
}

template <class Pose>
class LabelsOf : public testing::Test {};
using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(LabelsOf, Poses);

// Those of a run together, as one after the other.
TYPED_TEST(LabelsOf, ChangeTheOddsOfTheirRuns) {
  using Pose = TypeParam;
  constexpr Index kLoops = 60;
  Random random(4);
  const auto graph = random_loop_graph<Pose>(random, 40, kLoops, 1.0).graph;
  const Objective<Pose> objective(graph, edge_roles(graph), 20);
  const Assessment<Pose> assessment(objective);
  const auto& runs = objective.runs();
  Explanation<Pose> now{.accepted = std::vector<bool>(kLoops)};
  for (Index k = 0; k < kLoops; ++k) now.accepted[k] = random.index(2) == 0;
  now.labels = runs.labels(now.accepted);
  std::size_t led = 0;
  for (Index k = 0; k < kLoops; ++k) {
    const Index leader = runs.leader(k);
    if (leader == Runs<Pose>::kNone) continue;
    ++led;
    std::vector<Index> both = {std::min(k, leader), std::max(k, leader)};
    const double together = assessment.log_prior_odds(now, both);
    auto others = now;
    others.accepted[k] = false;
    const double first = assessment.log_prior_odds(others, std::vector{leader});
    others.accepted[leader] = true;
    EXPECT_NEAR(together, first + assessment.log_prior_odds(others, std::vector{k}), 1e-9) << k;
  }
  EXPECT_GT(led, 20u);
}

}  // namespace
}  // namespace isotherm::slam::detail
