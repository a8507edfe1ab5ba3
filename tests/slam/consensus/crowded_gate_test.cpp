#include "consensus/crowded_gate.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"
#include "isotherm/base/statistics.hpp"
#include "slam/consensus/chi_squared_sample.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr int kDof = 6;
const double kGate = chi_squared_quantile(1.0 - 1e-4, kDof);

std::vector<double> true_loops(Random& random, int count, double scale) {
  return isotherm_test::chi_squared_sample(random, count, kDof, scale);
}

void add_false_loops(Random& random, int count, double least, std::vector<double>& chi2) {
  for (int k = 0; k < count; ++k) chi2.push_back(random.uniform(least, 10.0 * kGate));
}

TEST(CrowdedGate, StaysWhereNoFalseLoopsCrowd) {
  Random random(71);
  for (const double scale : {1e-4, 1.0}) {
    auto chi2 = true_loops(random, 3000, scale);
    EXPECT_EQ(crowded_gate(chi2, kGate), kGate) << "none at all";
    for (int k = 0; k < 3000; ++k) chi2.push_back(random.uniform(100.0, 1e4) * kGate);
    EXPECT_EQ(crowded_gate(chi2, kGate), kGate) << "all far off";
  }
  EXPECT_EQ(crowded_gate({}, kGate), kGate);
  EXPECT_EQ(crowded_gate({0.0, 0.0, 1.0, kGate + 1.0}, kGate), kGate) << "too few to tell";
}

TEST(CrowdedGate, PartsAccurateLoopsFromFalseOnesInsideTheGate) {
  Random random(72);
  auto chi2 = true_loops(random, 3000, 0.02);
  add_false_loops(random, 3000, 0.3 * kGate, chi2);
  const double gate = crowded_gate(chi2, kGate);
  EXPECT_LT(gate, 0.3 * kGate);
  EXPECT_GT(gate, 0.02 * kGate) << "all true ones are inside";
}

TEST(CrowdedGate, StaysWhereTrueLoopsReachIt) {
  Random random(73);
  auto chi2 = true_loops(random, 3000, 2.0);
  add_false_loops(random, 300, 0.0, chi2);
  EXPECT_EQ(crowded_gate(chi2, kGate), kGate);
}

}  // namespace
}  // namespace isotherm::slam::detail
