#include "prune/consensus/objective/near_density.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam::detail {
namespace {

using isotherm_test::random_loop_graph;
using isotherm_test::random_tangent;

template <class Pose>
class NearDensityOf : public testing::Test {};
using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(NearDensityOf, Poses);

// Of few poses all pairs are looked at. In other units of length what loops measure is as rare
// among near poses, and its density in the space of poses scales with the units.
TYPED_TEST(NearDensityOf, HoldsLoopsAgainstADensity) {
  using Pose = TypeParam;
  Random random(9);
  const auto made = random_loop_graph<Pose>(random, 60, 30, 1.0);
  auto larger = made.graph;
  constexpr double kUnits = 1000.0;
  typename Pose::Tangent units = Pose::Tangent::Ones();
  units.template head<Pose::kDim>().setConstant(kUnits);
  const auto convert = [&units](Pose& T) { T = Pose::exp(units.cwiseProduct(T.log())); };
  std::ranges::for_each(larger.poses, convert);
  const typename Pose::Tangent smaller = units.cwiseInverse();
  for (auto& constraint : larger.constraints) {
    convert(constraint.T_from_to);
    constraint.information =
        smaller.asDiagonal() * constraint.information.eval() * smaller.asDiagonal();
  }
  const auto reduced = reduce(made.graph, edge_roles(made.graph));
  const auto in_other_units = reduce(larger, edge_roles(larger));
  const NearDensity<Pose> near(reduced);
  const NearDensity<Pose> scaled(in_other_units);
  const auto mean = near.log_mean({reduced.poses});
  const auto scaled_mean = scaled.log_mean({in_other_units.poses});
  for (std::size_t c = 0; c < kProposalClasses; ++c) {
    EXPECT_NEAR(scaled_mean[c], mean[c] - Pose::kDim * std::log(kUnits), 1e-6);
  }
  const std::vector<Index> loops = {0, 7, 29};
  EXPECT_NEAR(scaled.log_mean_around(in_other_units, loops, 20),
              near.log_mean_around(reduced, loops, 20) - Pose::kDim * std::log(kUnits), 1e-6);
}

template <class Pose>
ReducedGraph<Pose> graph_with_loops(std::uint64_t seed) {
  Random random(seed);
  const auto made = random_loop_graph<Pose>(random, 200, 30, 1.0);
  return reduce(made.graph, edge_roles(made.graph));
}

// However many maps there are, each pair is looked at once, and weighs as much on each.
TYPED_TEST(NearDensityOf, CountsNearPairsOverMaps) {
  using Pose = TypeParam;
  const auto reduced = graph_with_loops<Pose>(12);
  const NearDensity<Pose> near(reduced);
  std::vector<Pose> point = reduced.poses;
  for (Pose& pose : point) pose = Pose();
  const auto one = near.log_mean({reduced.poses});
  const auto same = near.log_mean({reduced.poses, reduced.poses, reduced.poses});
  const auto shrunk = near.log_mean({point});
  const auto mixed = near.log_mean({reduced.poses, point});
  for (std::size_t c = 0; c < kProposalClasses; ++c) {
    EXPECT_NEAR(same[c], one[c], 1e-12);
    EXPECT_GE(mixed[c], std::min(one[c], shrunk[c]) - 0.2);
    EXPECT_LE(mixed[c], std::max(one[c], shrunk[c]) + 0.2);
  }
}

// A loop of a graph that shrinks to a point is near everything.
TYPED_TEST(NearDensityOf, FindsPairsNearerOnASmallerMap) {
  using Pose = TypeParam;
  const auto reduced = graph_with_loops<Pose>(9);
  const NearDensity<Pose> near(reduced);
  std::vector<Pose> scattered = reduced.poses;
  for (std::size_t v = 0; v < scattered.size(); ++v) {
    typename Pose::Tangent away = Pose::Tangent::Zero();
    away[0] = 1000.0 * static_cast<double>(v);
    scattered[v] = Pose::exp(away) * scattered[v];
  }
  const auto as_is = near.log_mean({reduced.poses});
  const auto far = near.log_mean({scattered});
  const std::size_t longest = proposal_class(reduced, 0);
  EXPECT_GT(as_is[longest], far[longest]);
}

// By what the loops measure: none is near around one that joins poses far from each other. Of no
// loops as little is known as of a class without pairs.
TYPED_TEST(NearDensityOf, KnowsHowManyAreNearAroundLoops) {
  using Pose = TypeParam;
  const auto reduced = graph_with_loops<Pose>(12);
  const NearDensity<Pose> near(reduced);
  const double nothing = near.log_mean({reduced.poses})[0];
  auto far = reduced;
  typename Pose::Tangent away = Pose::Tangent::Zero();
  away[0] = 1e6;
  far.loops[7].T_a_b = far.loops[7].T_a_b * Pose::exp(away);
  const double none = near.log_mean_around(far, {7}, 20);
  EXPECT_LT(none, nothing - 4.0);
  EXPECT_GT(near.log_mean_around(reduced, {7}, 20), none + 1.0);
  EXPECT_EQ(near.log_mean_around(reduced, {}, 20), nothing);
}

// A loop that measured z says little of a pair that the map has far from what loops measure, and as
// much from either end.
TYPED_TEST(NearDensityOf, FallsWithTheDistanceOfThePair) {
  using Pose = TypeParam;
  const auto reduced = graph_with_loops<Pose>(12);
  const NearDensity<Pose> near(reduced);
  const Pose z;
  typename Pose::Tangent away = Pose::Tangent::Zero();
  EXPECT_EQ(near.log_nearer(z, away, true), 0.0);
  double last = 0.0;
  for (const double metres : {100.0, 1e3, 1e4}) {
    away[0] = metres;
    const double now = near.log_nearer(z, away, true);
    EXPECT_LT(now, last);
    if (last < 0.0) {  // as Student's t does
      EXPECT_NEAR(now - last, -(kTailDof + Pose::kDof) * std::numbers::ln10, 0.5);
    }
    last = now;
  }
  // A wild measurement of a pair that is near is as likely as its own tails say, and no likelier.
  for (const double metres : {1e3, 1e4}) {
    away[0] = metres;
    const Pose wild = Pose::exp(away);
    const auto decade = near.log_nearer(Pose::exp(10.0 * away), -10.0 * away, true, 1.0) -
                        near.log_nearer(wild, -away, true, 1.0);
    EXPECT_NEAR(decade, (1.0 + Pose::kDof) * std::numbers::ln10, 0.5);
  }
  Random random(4);
  const Pose measured = Pose::exp(random_tangent<Pose>(random, 1.0));
  const Pose h = Pose::exp(random_tangent<Pose>(random, 1.0));
  const auto left = (measured.inverse() * h).log();
  const auto other_way = (measured * h.inverse()).log();
  EXPECT_NEAR(near.log_nearer(measured.inverse(), other_way, false),
              near.log_nearer(measured, left, true), 1e-9);
}

}  // namespace
}  // namespace isotherm::slam::detail
