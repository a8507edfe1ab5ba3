#include "isotherm/slam/prune/loop_evidence.hpp"

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/simulate/corrupt.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam {
namespace {

using isotherm_test::random_loop_graph;

template <class Pose>
class LoopEvidence : public testing::Test {};
using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(LoopEvidence, Poses);

TYPED_TEST(LoopEvidence, IsHighestOfTheTrueLoops) {
  using Pose = TypeParam;
  Random random(71);
  const auto made = random_loop_graph<Pose>(random, 80, 30, 1.0);
  const auto bad = corrupt(made.graph, made.truth, {.fraction = 0.5});
  const auto roles = edge_roles(bad.graph);
  std::vector<Index> correct;
  std::vector<Index> incorrect;
  for (const auto& row : bad.labels) {
    (row.label == Label::correct ? correct : incorrect).push_back(static_cast<Index>(row.edge));
  }
  const double of_true = loop_evidence(bad.graph, roles, correct);
  EXPECT_NEAR(of_true, consensus(bad.graph, roles).log_evidence, 1.0);
  EXPECT_GT(of_true, loop_evidence(bad.graph, roles, {}) + 10.0);
  EXPECT_GT(of_true, loop_evidence(bad.graph, roles, incorrect) + 10.0);
  EXPECT_GT(of_true, loop_evidence(bad.graph, roles, roles.candidates) + 10.0);
  correct.pop_back();
  EXPECT_GT(of_true, loop_evidence(bad.graph, roles, correct));
}

// Sixty false loops of a straight way that state the same transform, as injected groups do: taken
// for off by tens of metres they all fit, which is no reason to believe them.
TEST(LoopEvidence, OfCopiesThatFitAnywhereIsLessThanOfNone) {
  for (const std::uint64_t seed : {75, 76, 77}) {
    Random random(seed);
    auto graph = random_loop_graph<Pose2>(random, 260, 0, 1.0).graph;
    for (Index v = 0; v < 259; ++v) {
      auto& step = graph.constraints[v];
      step.from = v;
      step.to = v + 1;
      step.information = Pose2::Tangent(400.0, 400.0, 1e4).asDiagonal();
      step.T_from_to = Pose2(1.0, 0.0, 0.0) *
                       Pose2::exp(isotherm_test::random_error<Pose2>(random, step.information));
    }
    for (Index v = 0; v < 60; ++v) {
      graph.constraints.push_back(
          {v, v + 150, Pose2(0.5, 0.3, 0.2), Pose2::Tangent(400.0, 400.0, 131.0).asDiagonal()});
    }
    const auto roles = edge_roles(graph);
    ASSERT_EQ(roles.candidates.size(), 60U);
    EXPECT_LT(loop_evidence(graph, roles, roles.candidates), loop_evidence(graph, roles, {}));
  }
}

TEST(LoopEvidence, LeavesOutRepeatsAndSelfEdges) {
  Random random(72);
  auto graph = random_loop_graph<Pose2>(random, 40, 10, 1.0).graph;
  const auto before = edge_roles(graph);
  const double once = loop_evidence(graph, before, before.candidates);
  graph.constraints.push_back(graph.constraints[before.candidates.front()]);
  graph.constraints.push_back({3, 3, Pose2(), Pose2::Matrix::Identity()});
  const auto roles = edge_roles(graph);
  EXPECT_DOUBLE_EQ(loop_evidence(graph, roles, roles.candidates), once);
}

TEST(LoopEvidence, OfOdometryAloneIsZeroWithoutCandidates) {
  Random random(73);
  const auto graph = random_loop_graph<Pose2>(random, 5, 0, 1.0).graph;
  EXPECT_EQ(loop_evidence(graph, edge_roles(graph), {}), 0.0);
}

TEST(LoopEvidence, NamesAnEdgeThatIsNoCandidate) {
  Random random(74);
  const auto graph = random_loop_graph<Pose2>(random, 20, 5, 1.0).graph;
  EXPECT_THROW(loop_evidence(graph, edge_roles(graph), {0}), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::slam
