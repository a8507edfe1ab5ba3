#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"
#include "isotherm/base/statistics.hpp"
#include "isotherm/slam/prune/consensus.hpp"
#include "isotherm/slam/simulate/corrupt.hpp"
#include "isotherm/slam/simulate/simulate.hpp"
#include "prune/consensus/calibrate/calibration.hpp"
#include "prune/consensus/calibrate/short_cycles.hpp"
#include "prune/consensus/judge/prior_by_span.hpp"
#include "prune/consensus/pairs/near_pairs.hpp"
#include "slam/prune/consensus/chi_squared_sample.hpp"

namespace isotherm::slam::detail {
namespace {

using isotherm_test::chi_squared_sample;

TEST(CycleScale, IsTheScaleOfASample) {
  Random random(51);
  for (const int dof : {3, 6}) {
    for (const double scale : {1e-4, 1.0, 25.0}) {
      const double found = cycle_scale(chi_squared_sample(random, 4000, dof, scale), dof);
      EXPECT_NEAR(found / scale, 1.0, 0.1) << dof << " " << scale;
    }
  }
}

// False cycles next to the true ones, on a logarithmic scale.
TEST(CycleScale, FalseCyclesMakeItLargerButNotByFar) {
  Random random(52);
  auto sample = chi_squared_sample(random, 1000, 3, 0.1);
  for (int k = 0; k < 500; ++k) sample.push_back(std::exp(random.uniform(-1.0, 7.0)));
  const double found = cycle_scale(sample, 3);
  EXPECT_GE(found, 0.1);
  EXPECT_LE(found, 0.2);
}

TEST(CycleScale, IsThatOfAMinorityFarBelowAllOthers) {
  Random random(54);
  for (const int dof : {3, 6}) {
    auto sample = chi_squared_sample(random, 1000, dof, 1e-3);
    const auto far = chi_squared_sample(random, 30000, dof, 100.0);
    sample.insert(sample.end(), far.begin(), far.end());
    EXPECT_NEAR(cycle_scale(sample, dof) / 1e-3, 1.0, 0.15) << dof;
  }
}

// Too few to be told from chance: the answer is that of all.
TEST(CycleScale, IsNotThatOfAHandfulBelowAllOthers) {
  Random random(55);
  auto sample = chi_squared_sample(random, 30, 3, 1e-3);
  const auto far = chi_squared_sample(random, 3000, 3, 100.0);
  sample.insert(sample.end(), far.begin(), far.end());
  EXPECT_NEAR(cycle_scale(sample, 3) / 100.0, 1.0, 0.15);
}

// Of one crowd without end nothing is left out.
TEST(CycleScale, IsTheLowQuantileOfABroadCrowd) {
  Random random(56);
  std::vector<double> sample;
  for (int k = 0; k < 20000; ++k) sample.push_back(std::exp(random.uniform(-5.0, 5.0)));
  const double expected = std::exp(-3.0) / chi_squared_quantile(0.2, 3);
  EXPECT_NEAR(cycle_scale(sample, 3) / expected, 1.0, 0.1);
}

TEST(CycleScale, LeavesOutCyclesBeyondAllNumbers) {
  Random random(57);
  auto sample = chi_squared_sample(random, 1000, 3, 1.0);
  sample.insert(sample.end(), 50, std::numeric_limits<double>::infinity());
  EXPECT_NEAR(cycle_scale(sample, 3), 1.0, 0.15);
}

TEST(CycleScale, SaysNothingOfAFewCycles) {
  EXPECT_EQ(cycle_scale({}, 3), 1.0);
  EXPECT_EQ(cycle_scale(std::vector<double>(20, 1e-6), 3), 1.0);
}

TEST(CycleScale, SaysNothingOfCopies) {
  EXPECT_EQ(cycle_scale(std::vector<double>(2000, 1e-12), 3), 1.0);
  Random random(53);
  auto sample = chi_squared_sample(random, 1000, 3, 1.0);
  sample.insert(sample.end(), 5000, 1e-12);
  EXPECT_NEAR(cycle_scale(sample, 3), 1.0, 0.2);
}

// Short cycles of loops that share one measurement close nearly as well as if loops were
// without errors.
TEST(Calibration, GroupsThatRepeatOneMeasurementSayNothingOfAccuracy) {
  const auto city =
      simulate_city({.poses = 800,
                     .measurements = {.loops = 100, .loop_sigma = 2.0, .loop_turn_sigma = 0.5},
                     .seed = 7});
  const auto bad = corrupt(city.graph, city.truth,
                           {.type = NoiseType::local_grouped, .fraction = 0.8, .seed = 7});
  const auto graph = reduce(bad.graph, edge_roles(bad.graph));
  const auto pairs = near_pairs(graph, ConsensusOptions().window);
  Calibration<Pose2> calibration(graph, pairs, true);
  calibration.learn_from_cycles(MapVolume<Pose2>(graph.poses));
  EXPECT_EQ(calibration.scale().odometry, 1.0);
}

TEST(Calibration, LeavesRoomForDriftOnlyWhereOdometryIsBetterThanStated) {
  for (const double understated : {1.0, 1e-3}) {
    auto city = simulate_city({.poses = 800, .measurements = {.loops = 300}, .seed = 3});
    for (auto& constraint : city.graph.constraints) constraint.information *= understated;
    const auto graph = reduce(city.graph, edge_roles(city.graph));
    const auto pairs = near_pairs(graph, ConsensusOptions().window);
    Calibration<Pose2> calibration(graph, pairs, true);
    calibration.learn_from_cycles(MapVolume<Pose2>(graph.poses));
    const double sharp = calibration.scale().odometry;
    const bool better = understated < 1.0;
    EXPECT_EQ(calibration.allow_for_drift(), better);
    EXPECT_NEAR(calibration.scale().odometry, better ? 2.0 * sharp : 1.0, 1e-12);

    for (int k = 0; k < 10; ++k) calibration.double_odometry();
    const double widest = calibration.scale().odometry;
    EXPECT_NEAR(widest, better ? 10.0 * sharp : 1024.0, 1e-9) << "no accepted loop may widen more";
  }
}

TEST(Calibration, WidensNothingUnlessItMay) {
  const auto city = simulate_city({.poses = 200, .measurements = {.loops = 50}, .seed = 3});
  const auto graph = reduce(city.graph, edge_roles(city.graph));
  const auto pairs = near_pairs(graph, ConsensusOptions().window);
  Calibration<Pose2> calibration(graph, pairs, false);
  calibration.learn_from_cycles(MapVolume<Pose2>(graph.poses));
  calibration.double_odometry();
  EXPECT_EQ(calibration.scale().odometry, 1.0);
  EXPECT_EQ(calibration.scale().loops, 1.0);
}

TEST(PriorBySpan, IsEvenBeforeAnythingIsDecided) {
  const PriorBySpan prior;
  EXPECT_DOUBLE_EQ(prior.fraction(), 0.5);
  for (const Index span : {0, 1, 1000, 2000000000}) EXPECT_DOUBLE_EQ(prior.log_odds(span), 0.0);
}

TEST(PriorBySpan, TellsShortLoopsFromLongOnes) {
  std::vector<PriorBySpan::Decision> decided;
  for (int k = 0; k < 500; ++k) {
    decided.push_back({.span = 2 + k % 2, .kept = true});
    decided.push_back({.span = 512 + k, .kept = k % 5 == 0});
  }
  const PriorBySpan prior(decided);
  // All: 601 of 1002. Short: 500 of 500, ten more lean on all. Long: 100 of 500, and
  // so no better than all.
  const double all = 601.0 / 1002.0;
  EXPECT_DOUBLE_EQ(prior.fraction(), all);
  EXPECT_NEAR(prior.log_odds(3), std::log((500.0 + 10.0 * all) / (10.0 * (1.0 - all))), 1e-12);
  EXPECT_NEAR(prior.log_odds(600), std::log(all / (1.0 - all)), 1e-12);
  EXPECT_NEAR(prior.log_odds(64), std::log(all / (1.0 - all)), 1e-12) << "none of that span";
}

}  // namespace
}  // namespace isotherm::slam::detail
