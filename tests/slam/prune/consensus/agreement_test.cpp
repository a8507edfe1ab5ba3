#include "prune/consensus/pairs/agreement.hpp"

#include <gtest/gtest.h>

namespace isotherm::slam::detail {
namespace {

constexpr double kGate = 20.0;

TEST(Agreement, WithoutDataIsTheGateAndOneInFive) {
  const auto agreement = learn_agreement({}, {}, kGate);
  EXPECT_EQ(agreement.most_chi2, kGate);
  EXPECT_DOUBLE_EQ(agreement.alike_fraction, 0.2);
}

TEST(Agreement, FalsePairsAreCountedWithinTheLimit) {
  EXPECT_DOUBLE_EQ(learn_agreement({}, {1.0, 20.0, 21.0, 1e9, 50.0}, kGate).alike_fraction, 0.3);
}

TEST(Agreement, TrueLoopsThatAgreeWellAskTheSameOfOthers) {
  std::vector<double> accepted(1000, 0.5);
  for (int k = 0; k < 40; ++k) accepted[k] = 19.0;  // false ones that were accepted
  const auto agreement = learn_agreement(accepted, {1.0, 3.0, 19.0, 100.0, 200.0}, kGate);
  EXPECT_DOUBLE_EQ(agreement.most_chi2, 2.0);
  EXPECT_DOUBLE_EQ(agreement.alike_fraction, 0.2) << "of five one agrees as well";
}

TEST(Agreement, TheLimitIsNeverBeyondTheGateNorLearntFromAFew) {
  EXPECT_EQ(learn_agreement(std::vector<double>(1000, 15.0), {}, kGate).most_chi2, kGate);
  EXPECT_EQ(learn_agreement(std::vector<double>(50, 0.5), {}, kGate).most_chi2, kGate);
}

}  // namespace
}  // namespace isotherm::slam::detail
