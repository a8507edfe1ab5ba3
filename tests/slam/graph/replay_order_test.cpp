#include "isotherm/slam/graph/replay_order.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam {
namespace {

TEST(ReplayOrder, HasEveryEdgeAfterTheStepsThatLeadToIt) {
  Random random(1);
  auto graph = isotherm_test::random_loop_graph<Pose2>(random, 30, 20, 1.0).graph;
  for (std::size_t k = graph.constraints.size(); k > 1; --k) {
    std::swap(graph.constraints[k - 1], graph.constraints[random.index(k)]);
  }
  const auto sorted = in_replay_order(graph);
  ASSERT_EQ(sorted.constraints.size(), graph.constraints.size());
  Index known = 0;  // the last vertex that a step leads to
  for (const auto& edge : sorted.constraints) {
    const auto [first, last] = std::minmax(edge.from, edge.to);
    if (last == known + 1 && first == known) known = last;
    EXPECT_LE(last, known);
  }
  EXPECT_EQ(known, 29);
}

TEST(ReplayOrder, LeavesAnEmptyGraphEmpty) {
  EXPECT_TRUE(in_replay_order(PoseGraph<Pose3>()).constraints.empty());
}

}  // namespace
}  // namespace isotherm::slam
