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
  Placement truth{simulated.truth, std::vector<bool>(problem.nodes, true)};
  refine_robustly(problem, trusted, kGate, {}, truth);
  const auto found =
      search_map(problem, anchors_only(simulated.network, problem), trusted, kGate, {});
  const double best = worth(problem, trusted, truth);
  EXPECT_GE(worth(problem, trusted, found), best - 0.01 * std::abs(best));
}

TEST(SearchMap, IsWorthAsMuchAsTheTruth) {
  expect_no_less_than_the_truth({.nodes = 150, .degree = 14.0, .noise = 0.02, .seed = 4});
  expect_no_less_than_the_truth(
      {.nodes = 150, .degree = 14.0, .noise = 0.02, .false_fraction = 0.2, .seed = 4});
  expect_no_less_than_the_truth(
      {.nodes = 150, .degree = 14.0, .noise = 0.02, .biased_fraction = 0.2, .seed = 4});
}

TEST(SearchMap, OfNothingIsNothing) {
  const auto network = exact_network(Eigen::MatrixXd(2, 0), {});
  const auto none = make_problem(network);
  EXPECT_EQ(placed_count(search_map(none, anchors_only(network, none), {}, kGate, {})), 0);
}

}  // namespace
}  // namespace isotherm::network::detail
