#include "localize/start/search.hpp"

#include <gtest/gtest.h>

#include "isotherm/network/simulate/simulate_network.hpp"
#include "localize/evidence/evidence.hpp"
#include "localize/refine/robust_refine.hpp"
#include "network/localize/networks.hpp"
#include "network/localize/range_problems.hpp"

namespace isotherm::network::detail {
namespace {

/// What is found, beside the nearest maximum to the truth.
void expect_no_less_than_the_truth(const NetworkOptions& options) {
  const auto simulated = simulate_network(options);
  const auto problem = make_problem(simulated.network);
  const auto trusted = likely_pairs(problem, 0.1, {});
  const LocalizeOptions defaults;
  const MapTask task{problem, trusted, kGate, defaults};
  Placement truth{simulated.truth, std::vector<bool>(problem.nodes, true)};
  refine_robustly(task, truth);
  const auto found = search_map(task, anchors_only(simulated.network, problem));
  const double best = worth(task, truth);
  EXPECT_GE(worth(task, found), best - 0.01 * std::abs(best));
}

TEST(SearchMap, IsWorthAsMuchAsTheTruth) {
  expect_no_less_than_the_truth({.nodes = 150, .degree = 14.0, .noise = 0.02, .seed = 4});
  expect_no_less_than_the_truth(
      {.nodes = 150, .degree = 14.0, .noise = 0.02, .false_fraction = 0.2, .seed = 4});
  expect_no_less_than_the_truth(
      {.nodes = 150, .degree = 14.0, .noise = 0.02, .biased_fraction = 0.2, .seed = 4});
  for (const std::uint64_t seed : {1, 5, 7}) {
    expect_no_less_than_the_truth(
        {.nodes = 200, .degree = 12.0, .noise = 0.01, .false_fraction = 0.3, .seed = seed});
  }
}

// In this network one false range through a node with two of them spans the whole map, which heat
// does not see.
TEST(SearchMap, IsNotMisledByOneFalseRangeFromEndToEnd) {
  const auto simulated = simulate_network(
      {.nodes = 1000, .degree = 12.0, .noise = 0.01, .false_fraction = 0.1, .seed = 1});
  const auto problem = make_problem(simulated.network);
  const auto trusted = likely_pairs(problem, 0.1, {});
  const auto found =
      search_map({problem, trusted, kGate, {}}, anchors_only(simulated.network, problem));
  Index far = 0;
  for (Index v = 0; v < problem.nodes; ++v) {
    const double off = (found.positions.col(v) - simulated.truth.col(v)).norm();
    if (found.placed[v] && off > 0.5 * simulated.radius) ++far;
  }
  EXPECT_LT(far, 10);
}

TEST(SupportedPairs, HaveTwoNeighboursInCommon) {
  // A square with its diagonals, a node that hangs on one corner, and a pair that joins this one to
  // another corner.
  Eigen::MatrixXd points(2, 5);
  points << 0, 1, 1, 0, 3, 0, 0, 1, 1, 3;
  const auto problem = make_problem(
      exact_network(points, {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}, {1, 3}, {2, 4}, {4, 0}}));
  auto pairs = all_of(problem);
  const std::vector<bool> square = {true, true, true, true, true, true, false, false};
  EXPECT_EQ(supported_pairs(problem, pairs), square);
  pairs[5] = false;  // without a diagonal its other one has two common neighbours, no side has
  const std::vector<bool> diagonal = {false, false, false, false, true, false, false, false};
  EXPECT_EQ(supported_pairs(problem, pairs), diagonal);
}

TEST(SearchMap, OfNothingIsNothing) {
  const auto network = exact_network(Eigen::MatrixXd(2, 0), {});
  const auto none = make_problem(network);
  EXPECT_EQ(placed_count(search_map({none, {}, kGate, {}}, anchors_only(network, none))), 0);
}

}  // namespace
}  // namespace isotherm::network::detail
