#include "localize/firm/firmness.hpp"

#include <gtest/gtest.h>

#include "network/localize/networks.hpp"
#include "network/localize/range_problems.hpp"

namespace isotherm::network::detail {
namespace {

/// Eight anchors and two nodes among them, of which each has ranges to so many of the anchors and
/// to the other one: whether these are firm.
std::vector<bool> firm_of(int of_first, int of_second) {
  Eigen::MatrixXd truth(2, 10);
  truth << 0.0, 1.0, 0.1, 0.9, 0.5, 0.4, 0.0, 1.0, 0.6, 0.3,  //
      0.0, 0.1, 1.0, 0.9, 0.0, 1.0, 0.5, 0.6, 0.4, 0.7;
  auto pairs = all_pairs({0, 1, 2, 3, 4, 5, 6, 7});
  for (int k = 0; k < of_first; ++k) pairs.emplace_back(k, 8);
  for (int k = 0; k < of_second; ++k) pairs.emplace_back(7 - k, 9);
  pairs.emplace_back(8, 9);
  const auto problem = make_problem(exact_network(truth, pairs, {0, 1, 2, 3, 4, 5, 6, 7}));
  const Placement placement{truth, std::vector<bool>(10, true)};
  const auto firm = firm_nodes({problem, all_of(problem), kGate, {}}, placement);
  return {firm[8], firm[9]};
}

TEST(FirmNodes, HaveRangesEnough) {
  EXPECT_EQ(firm_of(4, 4), (std::vector<bool>{true, true}));
  EXPECT_EQ(firm_of(4, 1), (std::vector<bool>{true, false}));
}

TEST(FirmNodes, AreNotHeldByWhatHasTwoPlaces) {
  // The first has three ranges, but one of them leads to a node with two.
  EXPECT_EQ(firm_of(2, 1), (std::vector<bool>{false, false}));
}

TEST(FirmNodes, OfNothingAreNone) {
  const auto none = make_problem(exact_network(Eigen::MatrixXd(2, 0), {}));
  EXPECT_TRUE(firm_nodes({none, {}, kGate, {}}, {Eigen::MatrixXd(2, 0), {}}).empty());
}

}  // namespace
}  // namespace isotherm::network::detail
