#include "isotherm/slam/simulate/densify.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/graph/odometry.hpp"
#include "isotherm/slam/simulate/simulate.hpp"

namespace isotherm::slam {
namespace {

// Without noise every loop, and so every copy, is what the true poses say.
TEST(Densify, CopiesAgreeWithTheTruthWhereThereIsNoNoise) {
  const auto city = simulate_city({.poses = 200, .measurements = {.loops = 12}, .seed = 4});
  auto exact = city.graph;
  for (auto& constraint : exact.constraints) {
    constraint.T_from_to = city.truth[constraint.from].inverse() * city.truth[constraint.to];
  }
  const auto roles = edge_roles(exact);
  const auto dense = densify(exact, roles, {.copies = 3});
  const auto loops = static_cast<Index>(roles.candidates.size());
  const Index added = dense.constraint_count() - exact.constraint_count();
  EXPECT_GT(added, 3 * loops);
  EXPECT_LE(added, 6 * loops);
  for (Index k = exact.constraint_count(); k < dense.constraint_count(); ++k) {
    const auto& copy = dense.constraints[k];
    EXPECT_LT(residual(copy, city.truth[copy.from], city.truth[copy.to]).norm(), 1e-9);
    EXPECT_EQ(copy.information, exact.constraints[roles.candidates[0]].information);
  }
}

TEST(Densify, MakesNoCopyWhereOneIsOrOdometryEnds) {
  PoseGraph<Pose2> graph;
  for (VertexId id = 0; id < 8; ++id) graph.ids.push_back(id);
  for (Index v = 0; v + 1 < 8; ++v) {
    if (v != 3) graph.constraints.push_back({v, v + 1, Pose2(1.0, 0.0, 0.0)});
  }
  graph.constraints.push_back({0, 6, Pose2(0.0, 1.0, 0.0)});
  graph.constraints.push_back({7, 1, Pose2(0.0, 1.0, 0.0)});
  const auto dense = densify(graph, edge_roles(graph), {.copies = 2});
  // Of (0, 6): (1, 7) is there already, all others are off the ends. Of (7, 1): (5, 0) is
  // off the start, (6, 0) there already.
  EXPECT_EQ(dense.constraint_count(), graph.constraint_count());
  graph.constraints.pop_back();
  const auto more = densify(graph, edge_roles(graph), {.copies = 2});
  ASSERT_EQ(more.constraint_count(), graph.constraint_count() + 1);
  EXPECT_EQ(more.constraints.back().from, 1);
  EXPECT_EQ(more.constraints.back().to, 7);
  EXPECT_NEAR(more.constraints.back().T_from_to.translation().y(), 1.0, 1e-12);
  EXPECT_THROW(densify(graph, edge_roles(graph), {.copies = 0}), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::slam
