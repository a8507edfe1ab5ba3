#include "isotherm/slam/graph/repeats.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam {
namespace {

using isotherm_test::random_loop_graph;
using Pairs = std::vector<std::pair<Index, Index>>;

template <class Pose>
Pairs repeats_in(const PoseGraph<Pose>& graph) {
  Pairs pairs;
  for (const auto& repeat : exact_repeats(graph)) pairs.emplace_back(repeat.edge, repeat.original);
  return pairs;
}

template <class Pose>
class ExactRepeats : public testing::Test {};

using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(ExactRepeats, Poses);

TYPED_TEST(ExactRepeats, AreEqualToTheLastDigit) {
  Random random(1);
  auto graph = random_loop_graph<TypeParam>(random, 8, 6, 1.0).graph;
  EXPECT_EQ(repeats_in(graph), Pairs{});
  const auto count = graph.constraint_count();
  graph.constraints.push_back(graph.constraints[2]);  // odometry
  graph.constraints.push_back(graph.constraints[9]);
  graph.constraints.push_back(graph.constraints[9]);
  auto nearly = graph.constraints[9];
  nearly.information(0, 0) = std::nextafter(nearly.information(0, 0), 1e9);
  graph.constraints.push_back(nearly);
  graph.constraints.back().line = 77;
  EXPECT_EQ(repeats_in(graph), (Pairs{{count, 2}, {count + 1, 9}, {count + 2, 9}}));
}

TEST(ExactRepeatsReversed, CountWhereInvertingLeavesNoRounding) {
  PoseGraph<Pose2> graph;
  graph.ids = {0, 1, 2};
  Constraint<Pose2> along{0, 2, Pose2(2, 0, 0),
                          Pose2::Matrix(Eigen::Vector3d(4, 0, 1).asDiagonal())};
  Constraint<Pose2> back{2, 0, Pose2(-2, 0, 0), along.information};
  graph.constraints = {back, along, along};
  EXPECT_EQ(repeats_in(graph), (Pairs{{1, 0}, {2, 0}}));
  graph.constraints[0].T_from_to = Pose2(2, 0, 0);
  EXPECT_EQ(repeats_in(graph), (Pairs{{2, 1}})) << "the inverse is another measurement";
  // Seen from the other end, information across is information on the turn, too.
  graph.constraints[0] = back;
  for (auto& edge : graph.constraints) edge.information = Pose2::Matrix::Identity();
  EXPECT_EQ(repeats_in(graph), (Pairs{{2, 1}}));
}

TEST(ExactRepeatsDegenerate, SelfEdgesAndNanAreLeftAlone) {
  PoseGraph<Pose2> graph;
  EXPECT_EQ(repeats_in(graph), Pairs{});
  graph.ids = {0, 1};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  graph.constraints = {{0, 0, Pose2(1, 0, 0)},
                       {0, 0, Pose2(1, 0, 0)},
                       {0, 1, Pose2(nan, 0, 0)},
                       {0, 1, Pose2(0.0, 0, 0)},
                       {0, 1, Pose2(-0.0, 0, 0)}};
  EXPECT_EQ(repeats_in(graph), (Pairs{{4, 3}}));
}

}  // namespace
}  // namespace isotherm::slam
