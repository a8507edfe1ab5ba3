#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "localize/fold/fold_axes.hpp"
#include "localize/fold/open_folds.hpp"
#include "localize/fold/part_move.hpp"
#include "network/localize/networks.hpp"
#include "network/localize/range_problems.hpp"

namespace isotherm::network::detail {
namespace {

/// That of ranges of which a tenth may have any length up to two, and none is too long.
const Evidence kNoAbsence = {{.share = {0.9, 0.0, 0.1}, .longest = 2.0}, {}};
const std::vector<Index> kAbove = {8, 9, 10, 11, 12};

/// Five nodes below and five above three on the x axis, the last of which stands off it by
/// `bend`.
Eigen::MatrixXd hinged_points(double bend = 0.0) {
  Eigen::MatrixXd points(2, 13);
  points << 0.2, 1.0, 1.8, 0.6, 1.4, 0, 1, 2, 0.3, 1.1, 1.7, 0.8, 1.5,  //
      -0.6, -0.7, -0.6, -1.3, -1.3, 0, 0, bend, 0.7, 0.6, 0.8, 1.4, 1.5;
  return points;
}

/// All ranges but those between what is above and what is below, and some of these.
RangeNetwork hinged_network(double bend, const std::vector<std::pair<int, int>>& across) {
  std::vector<std::pair<int, int>> pairs = across;
  for (const auto& [a, b] : all_pairs({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12})) {
    if (a >= 5 || b <= 7) pairs.emplace_back(a, b);
  }
  auto network = exact_network(hinged_points(bend), pairs);
  for (auto& range : network.ranges) range.variance = 0.0025;
  return network;
}

/// A network with its true places.
struct Map {
  explicit Map(const RangeNetwork& network, double bend = 0.0)
      : problem(make_problem(network)),
        trusted(problem.pairs.size(), true),
        placement{hinged_points(bend), std::vector<bool>(13, true)} {}

  MapTask task() const { return {problem, trusted, kGate, options}; }

  std::vector<Fold> folds() const {
    return find_folds(task(), kNoAbsence, placement, std::vector<bool>(problem.nodes, true));
  }

  static const Fold* fold_of(const std::vector<Fold>& folds, const std::vector<Index>& part) {
    const auto found = std::find_if(folds.begin(), folds.end(),
                                    [&](const Fold& fold) { return fold.part == part; });
    return found == folds.end() ? nullptr : &*found;
  }

  MoveOutcome try_it(const Fold& fold) const {
    const Crowd crowd(problem, placement, kNoAbsence.absence);
    return try_move(task(), kNoAbsence, crowd, placement, fold.move(placement));
  }

  LocalizeOptions options = {.threads = 1};
  RangeProblem problem;
  std::vector<bool> trusted;
  Placement placement;
};

TEST(Folds, APartTurnsOnNodesInALine) {
  const Map map(hinged_network(0.0, {}));
  const auto folds = map.folds();
  const auto* fold = Map::fold_of(folds, kAbove);
  ASSERT_NE(fold, nullptr);
  EXPECT_NEAR(fold->cost, 0.0, 1e-9);
  EXPECT_TRUE(fold->mirrored(Eigen::Vector2d(3, 4)).isApprox(Eigen::Vector2d(3, -4)));
  const auto outcome = map.try_it(*fold);
  EXPECT_NEAR(outcome.extra, 0.0, 1e-6);
  ASSERT_EQ(outcome.moved, kAbove);
  Eigen::MatrixXd mirrored = hinged_points().rightCols(5);
  mirrored.row(1) *= -1.0;
  EXPECT_LT((outcome.positions - mirrored).norm(), 1e-6);
}

TEST(Folds, GivingWayCostsLessThanStayingRigid) {
  const double bend = 0.1;  // two standard deviations
  const Map map(hinged_network(bend, {}), bend);
  const auto folds = map.folds();
  const auto* fold = Map::fold_of(folds, kAbove);
  ASSERT_NE(fold, nullptr);
  const double extra = map.try_it(*fold).extra;
  EXPECT_GT(extra, 0.0);
  EXPECT_LT(extra, 0.5 * fold->cost);
}

TEST(Folds, OneRangeAcrossDoesNotJoinWhatIsOnBothSides) {
  const Map map(hinged_network(0.0, {{0, 8}}));
  const auto folds = map.folds();
  const auto* fold = Map::fold_of(folds, kAbove);
  ASSERT_NE(fold, nullptr);
  EXPECT_NEAR(fold->cost, kNoAbsence.cost_of(0.05).anything, 1e-9);
}

TEST(Folds, AnchorsDoNotTurn) {
  auto network = hinged_network(0.0, {});
  network.landmarks = {11};
  network.positions.col(11) = hinged_points().col(11);
  const Map map(network);
  for (const auto& fold : map.folds()) {
    EXPECT_FALSE(std::binary_search(fold.part.begin(), fold.part.end(), 11));
  }
}

// It stands six deviations off the line of the two others, so that the part's ranges to it break.
TEST(Folds, AnAnchorBesideTheHingeDoesNotHoldAPart) {
  const double bend = 0.3;
  auto network = hinged_network(bend, {});
  network.landmarks = {7};
  network.positions.col(7) = hinged_points(bend).col(7);
  const Map map(network, bend);
  const auto folds = map.folds();
  const auto* fold = Map::fold_of(folds, kAbove);
  ASSERT_NE(fold, nullptr);
  EXPECT_NEAR(std::abs(fold->normal.y()), 1.0, 1e-9);
  EXPECT_NEAR(fold->cost, 5.0 * kNoAbsence.cost_of(0.05).anything, 1e-3);
}

TEST(Folds, NoneInSpaceOrOfNothing) {
  Map map(hinged_network(0.0, {}));
  map.placement.placed.assign(13, false);
  EXPECT_TRUE(map.folds().empty());
  const Eigen::MatrixXd corners = Eigen::MatrixXd::Identity(3, 3);
  const auto problem = make_problem(exact_network(corners, all_pairs({0, 1, 2})));
  const Placement placement{corners, std::vector<bool>(3, true)};
  EXPECT_TRUE(
      find_folds({problem, {true, true, true}, kGate, {}}, {}, placement, {true, true, true})
          .empty());
}

TEST(OpenFolds, MirrorsWhatFitsBetterThatWay) {
  Map map(hinged_network(0.0, {{0, 8}, {1, 9}, {2, 10}}));
  map.placement.positions.row(1).tail(5) *= -1.0;
  EXPECT_TRUE(open_folds(map.task(), map.placement));
  double misfit = 0.0;
  for (const auto& pair : map.problem.pairs) misfit += squared_deviation(map.placement, pair);
  EXPECT_LT(misfit, 1e-3);
  EXPECT_FALSE(open_folds(map.task(), map.placement));
}

}  // namespace
}  // namespace isotherm::network::detail
