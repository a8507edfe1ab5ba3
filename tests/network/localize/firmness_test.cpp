#include "localize/firm/firmness.hpp"

#include <gtest/gtest.h>

#include "network/localize/networks.hpp"
#include "network/localize/range_problems.hpp"

namespace isotherm::network::detail {
namespace {

/// Whether node 8 is firm at its place between eight anchors, of which it has ranges to `here`, if
/// it has `elsewhere` more to nodes without a place.
bool is_firm(int here, int elsewhere) {
  Eigen::MatrixXd truth(2, 9 + elsewhere);
  truth.leftCols(9) << 0.0, 1.0, 0.1, 0.9, 0.5, 0.4, 0.0, 1.0, 0.6,  //
      0.0, 0.1, 1.0, 0.9, 0.0, 1.0, 0.5, 0.6, 0.4;
  for (int k = 0; k < elsewhere; ++k) truth.col(9 + k) << 1.0 + 0.1 * k, 0.2 * k;
  auto pairs = all_pairs({0, 1, 2, 3, 4, 5, 6, 7});
  for (int k = 0; k < here; ++k) pairs.emplace_back(k, 8);
  for (int k = 0; k < elsewhere; ++k) pairs.emplace_back(9 + k, 8);
  const auto problem = make_problem(exact_network(truth, pairs, {0, 1, 2, 3, 4, 5, 6, 7}));
  Placement placement{truth, std::vector<bool>(truth.cols(), false)};
  for (int v = 0; v < 9; ++v) placement.placed[v] = true;
  const std::vector<bool> trusted(problem.pairs.size(), true);
  return firm_nodes(problem, trusted, kGate, {}, placement)[8];
}

TEST(FirmNodes, DPlusOneRangesDoIfMostAreHere) {
  EXPECT_FALSE(is_firm(2, 0));
  EXPECT_TRUE(is_firm(3, 0));
  EXPECT_TRUE(is_firm(3, 3));
}

TEST(FirmNodes, WhereMostLeadElsewhereOneMoreHasToAgree) {
  EXPECT_FALSE(is_firm(3, 4));
  EXPECT_TRUE(is_firm(4, 5));
}

}  // namespace
}  // namespace isotherm::network::detail
