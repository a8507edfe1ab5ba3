// What loops say about each other, and against "anywhere on the map".
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "prune/consensus/estimate/map_volume.hpp"
#include "prune/consensus/pairs/mutual_support.hpp"
#include "prune/consensus/pairs/near_pairs.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam::detail {
namespace {

std::vector<Pose2> square_map(double side) {
  return {Pose2(0.0, 0.0, 0.0), Pose2(side, 0.0, 1.0), Pose2(side, side, 2.0)};
}

// For a prediction much sharper than the map, the evidence is the log ratio of its
// normal density to the uniform one.
TEST(MapVolume, SharpPredictionsAreComparedWithTheUniformDensity) {
  const MapVolume<Pose2> map(square_map(50.0));
  const double volume = 100.0 * 100.0 * 2.0 * std::numbers::pi;
  const Pose2::Matrix spread = Pose2::Tangent(0.01, 0.04, 0.0001).asDiagonal();
  const Pose2::Tangent r(0.1, -0.1, 0.02);
  const double chi2 = 0.01 / 0.01 + 0.01 / 0.04 + 4.0;
  const double density =
      std::exp(-0.5 * chi2) / std::sqrt(std::pow(2.0 * std::numbers::pi, 3) * spread.determinant());
  const auto evidence = weigh(r, spread, map);
  EXPECT_NEAR(evidence.chi2, chi2, 1e-12);
  EXPECT_NEAR(evidence.log_ratio, std::log(density * volume), 1e-3);
}

TEST(MapVolume, PredictionsWiderThanTheMapSayNothing) {
  const MapVolume<Pose3> map({Pose3(), Pose3({10.0, 5.0, 0.0}, Eigen::Quaterniond::Identity())});
  const Pose3::Matrix spread = 1e12 * Pose3::Matrix::Identity();
  EXPECT_NEAR(weigh<Pose3>(Pose3::Tangent::Ones(), spread, map).log_ratio, 0.0, 1e-6);
}

TEST(MapVolume, MapsWithoutExtentAreAllowed) {
  for (const auto& poses : {std::vector<Pose2>{}, std::vector<Pose2>(3)}) {
    EXPECT_TRUE((MapVolume<Pose2>(poses).variance().array() > 0.0).all());
  }
}

template <class Pose>
class MutualSupportOf : public testing::Test {
 protected:
  // Two passes of the same path, each loop joining corresponding poses; every
  // second one is stated backwards.
  static PoseGraph<Pose> two_passes(Random& random) {
    auto graph = isotherm_test::random_chain<Pose>(random, 40, 1e4);
    const auto roles = edge_roles(graph);
    const auto poses = odometry_poses(graph, roles);
    for (Index k = 2; k < 14; k += 3) {
      Constraint<Pose> loop{k, k + 20, poses[k].inverse() * poses[k + 20]};
      loop.information = 1e4 * Pose::Matrix::Identity();
      if (k % 2 == 0) {
        std::swap(loop.from, loop.to);
        loop.T_from_to = loop.T_from_to.inverse();
      }
      graph.constraints.push_back(loop);
    }
    return graph;
  }
};
using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(MutualSupportOf, Poses);

TYPED_TEST(MutualSupportOf, NeighboursAgreeWhicheverWayTheyAreStated) {
  using Pose = TypeParam;
  Random random(21);
  const auto graph = this->two_passes(random);
  const auto reduced = reduce(graph, edge_roles(graph));
  const MapVolume<Pose> map(reduced.poses);
  const auto support = mutual_support(reduced, near_pairs(reduced, 20), map, {}, 25.0);
  EXPECT_EQ(support.agreeing.size(), 6u) << "every pair of the four";
  EXPECT_TRUE(support.contradicting.empty());
  for (std::size_t k = 0; k + 1 < support.agreeing.size(); ++k) {
    EXPECT_GE(support.agreeing[k].gain, support.agreeing[k + 1].gain);
  }
}

TYPED_TEST(MutualSupportOf, ALoopThatRepeatsAMeasurementIsACopy) {
  using Pose = TypeParam;
  Random random(23);
  auto graph = this->two_passes(random);
  auto copy = graph.constraints[graph.constraints.size() - 1];
  graph.constraints.push_back(copy);
  std::swap(copy.from, copy.to);
  graph.constraints.push_back(copy);
  const auto reduced = reduce(graph, edge_roles(graph));
  const MapVolume<Pose> map(reduced.poses);
  const auto support = mutual_support(reduced, near_pairs(reduced, 20), map, {}, 25.0);
  ASSERT_EQ(support.copied.size(), 1u) << "the other one is wrong way round";
  EXPECT_EQ(support.copied[0].first, 3);
  EXPECT_EQ(support.copied[0].second, 4);
  EXPECT_EQ(support.agreeing.size(), 9u) << "each of both with three, and those";
}

TYPED_TEST(MutualSupportOf, AFalseNeighbourContradictsAndADistantOneIsNotCompared) {
  using Pose = TypeParam;
  Random random(22);
  auto graph = this->two_passes(random);
  auto& wrong = graph.constraints.back();
  typename Pose::Tangent xi = Pose::Tangent::Zero();
  xi[0] = 50.0;
  wrong.T_from_to = wrong.T_from_to * Pose::exp(xi);
  const auto reduced = reduce(graph, edge_roles(graph));
  const MapVolume<Pose> map(reduced.poses);
  const auto support = mutual_support(reduced, near_pairs(reduced, 20), map, {}, 25.0);
  EXPECT_EQ(support.agreeing.size(), 3u);
  EXPECT_EQ(support.contradicting.size(), 3u);
  const auto close = mutual_support(reduced, near_pairs(reduced, 3), map, {}, 25.0);
  EXPECT_EQ(close.agreeing.size() + close.contradicting.size(), 3u) << "only direct neighbours";
}

}  // namespace
}  // namespace isotherm::slam::detail
