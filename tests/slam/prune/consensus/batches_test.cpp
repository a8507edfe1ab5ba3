#include "prune/consensus/pairs/batches.hpp"

#include <gtest/gtest.h>

namespace isotherm::slam::detail {
namespace {

using Loops = std::vector<Index>;

const Agreement kRarelyAlike{.most_chi2 = 25.0, .alike_fraction = 1e-9};

TEST(MostCertainThird, IsTakenInTheOrderOfCertainty) {
  const std::vector<double> log_odds = {1.0, 5.0, 3.0, 4.0, 2.0, 6.0};
  EXPECT_EQ(most_certain_third({0, 1, 2, 3, 4, 5}, log_odds, 0.0), (Loops{5, 1}));
  EXPECT_EQ(most_certain_third({0, 4}, log_odds, 0.0), (Loops{4})) << "at least one";
  EXPECT_TRUE(most_certain_third({}, log_odds, 0.0).empty());
}

TEST(MostCertainThird, AndWithItWhatIsBeyondDoubt) {
  const std::vector<double> log_odds = {20.0, 30.0, 25.0, 5.0};
  EXPECT_EQ(most_certain_third({0, 1, 2, 3}, log_odds, 1e-6), (Loops{1, 2, 0}));
}

TEST(AgreeingGroups, AreThoseOfTheEligible) {
  const MutualSupport support{
      .agreeing = {{3, 1, 8.0}, {4, 5, 1.0}}, .contradicting = {{0, 3}}, .copied = {{1, 2, 7.0}}};
  EXPECT_EQ(agreeing_groups(support, {0, 1, 2, 3, 5}, 6),
            (std::vector<Loops>{{0}, {1, 2, 3}, {5}}));
  EXPECT_EQ(agreeing_groups(support, {2, 3}, 6), (std::vector<Loops>{{2}, {3}}))
      << "the one between them is not eligible";
  EXPECT_TRUE(agreeing_groups(support, {}, 6).empty());
}

TEST(StrongestClusters, AgreementAddsUp) {
  // Three loops that agree, and one that is by itself.
  const MutualSupport support{
      .agreeing = {{0, 1, 8.0}, {1, 2, 7.0}}, .contradicting = {{0, 3}}, .copied = {}};
  const std::vector<double> log_odds = {1.0, 2.0, 1.0, 3.0};
  const Loops all = {0, 1, 2, 3};
  EXPECT_EQ(strongest_clusters(support, all, log_odds, kRarelyAlike, 10.0), (Loops{0, 1, 2}));
  EXPECT_TRUE(strongest_clusters(support, all, log_odds, {25.0, 0.5}, 10.0).empty())
      << "false loops often agree here, so that agreement proves little";
  EXPECT_TRUE(strongest_clusters(support, {0, 2, 3}, log_odds, kRarelyAlike, 10.0).empty())
      << "the one between them is not eligible";
}

TEST(StrongestClusters, ACopyAddsNothing) {
  // Two groups of copies, between which every pair agrees, are two measurements that do.
  MutualSupport support{.agreeing = {{0, 2, 8.0}, {0, 3, 8.0}, {1, 2, 8.0}, {1, 3, 8.0}},
                        .contradicting = {},
                        .copied = {{0, 1, 8.0}, {2, 3, 8.0}}};
  const Loops all = {0, 1, 2, 3};
  const std::vector<double> log_odds(4, 1.0);
  EXPECT_EQ(strongest_clusters(support, all, log_odds, kRarelyAlike, 9.0), all);
  EXPECT_TRUE(strongest_clusters(support, all, log_odds, kRarelyAlike, 9.1).empty());
}

TEST(StrongestClusters, ThoseThatAgreeWorseThanTrueOnesDoAddNothing) {
  const MutualSupport support{
      .agreeing = {{0, 1, 9.0, 0.5}, {2, 3, 8.0, 3.0}}, .contradicting = {}, .copied = {}};
  const Agreement close{.most_chi2 = 2.0, .alike_fraction = 1e-9};
  EXPECT_EQ(strongest_clusters(support, {0, 1, 2, 3}, std::vector<double>(4, 2.0), close, 10.0),
            (Loops{0, 1}));
}

TEST(StrongestClusters, WeakOnesWaitForTheStrongest) {
  const MutualSupport support{
      .agreeing = {{0, 1, 40.0}, {2, 3, 9.0}}, .contradicting = {}, .copied = {}};
  const std::vector<double> log_odds = {2.0, 2.0, 2.0, 2.0};
  EXPECT_EQ(strongest_clusters(support, {0, 1, 2, 3}, log_odds, {25.0, 1e-30}, 10.0),
            (Loops{0, 1}));
}

}  // namespace
}  // namespace isotherm::slam::detail
