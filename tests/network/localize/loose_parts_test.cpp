#include "localize/fold/loose_parts.hpp"

#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "localize/fold/open_folds.hpp"
#include "network/localize/networks.hpp"
#include "network/localize/range_problems.hpp"

namespace isotherm::network::detail {
namespace {

/// That of ranges of which a tenth may have any length up to four, and none is too long.
const Evidence kFewFalse = {{.share = {0.9, 0.0, 0.1}, .longest = 4.0}, {}};
const std::vector<Index> kIsland = {6, 7, 8, 9, 10};
constexpr double kIslandSigma = 0.02;

/// Six nodes around an island of five.
Eigen::MatrixXd island_places() {
  Eigen::MatrixXd points(2, 11);
  points << 0.0, 2.0, 2.1, 0.1, -0.4, 1.1, 0.7, 1.4, 1.2, 0.8, 1.0,  //
      0.0, 0.1, 1.9, 2.0, 0.9, -0.3, 0.6, 0.7, 1.3, 1.4, 0.9;
  return points;
}

/// All ranges but those between the island and the others, and these.
RangeNetwork island(const std::vector<std::pair<int, int>>& across) {
  auto pairs = across;
  for (const auto& [a, b] : all_pairs({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10})) {
    if (b <= 5 || a >= 6) pairs.emplace_back(a, b);
  }
  auto network = exact_network(island_places(), pairs);
  for (auto& range : network.ranges) range.variance = kIslandSigma * kIslandSigma;
  return network;
}

const std::vector<std::pair<int, int>> kFive = {{0, 6}, {1, 7}, {2, 8}, {3, 9}, {4, 6}};

struct IslandMap {
  explicit IslandMap(const RangeNetwork& network)
      : problem(make_problem(network)), placement{island_places(), std::vector<bool>(11, true)} {}

  /// The island turned, in its mirror image if `mirrored`, and shifted away.
  IslandMap& adrift(bool mirrored) {
    for (const Index v : kIsland) {
      Eigen::Vector2d place = placement.positions.col(v);
      if (mirrored) place.x() *= -1.0;
      placement.positions.col(v) = Eigen::Rotation2Dd(2.0) * place + Eigen::Vector2d(-3.0, 1.0);
    }
    return *this;
  }

  std::vector<PartMove> moves() const {
    return loose_parts({problem, all_of(problem), kGate, {.threads = 1}}, kFewFalse, placement);
  }

  double off() const { return (placement.positions - island_places()).colwise().norm().maxCoeff(); }

  RangeProblem problem;
  Placement placement;
};

TEST(LooseParts, FitWhereTheirTiesMeet) {
  for (const bool mirrored : {false, true}) {
    const auto moves = IslandMap(island(kFive)).adrift(mirrored).moves();
    ASSERT_EQ(moves.size(), 2u);  // turned, and in its mirror image
    const auto& move = moves[mirrored ? 1 : 0];
    EXPECT_EQ(move.part, kIsland);
    EXPECT_LT((move.positions - island_places().rightCols(5)).colwise().norm().maxCoeff(), 0.05);
  }
}

TEST(LooseParts, AreBroughtHome) {
  for (const bool mirrored : {false, true}) {
    IslandMap map(island(kFive));
    map.adrift(mirrored);
    EXPECT_TRUE(
        open_folds({map.problem, all_of(map.problem), kGate, {.threads = 1}}, map.placement));
    EXPECT_LT(map.off(), 1e-3);
  }
}

TEST(LooseParts, NoneWhereEverythingFits) { EXPECT_TRUE(IslandMap(island(kFive)).moves().empty()); }

// Three ties can always be met.
TEST(LooseParts, AreHeldByMoreThanTheirMotions) {
  EXPECT_TRUE(IslandMap(island({{0, 6}, {1, 7}, {2, 8}})).adrift(false).moves().empty());
}

TEST(LooseParts, AnchorsDoNotTurn) {
  auto network = island(kFive);
  network.landmarks = {10};
  network.positions.col(10) = island_places().col(10);
  for (const auto& move : IslandMap(network).adrift(false).moves()) EXPECT_NE(move.part, kIsland);
}

TEST(LooseParts, NoneInSpaceOrOfNothing) {
  const Eigen::MatrixXd corners = Eigen::MatrixXd::Identity(3, 3);
  const auto problem = make_problem(exact_network(corners, all_pairs({0, 1, 2})));
  const Placement together{Eigen::MatrixXd::Zero(3, 3), std::vector<bool>(3, true)};
  EXPECT_TRUE(loose_parts({problem, all_of(problem), kGate, {}}, kFewFalse, together).empty());
  IslandMap map(island(kFive));
  map.placement.placed.assign(11, false);
  EXPECT_TRUE(map.moves().empty());
}

}  // namespace
}  // namespace isotherm::network::detail
