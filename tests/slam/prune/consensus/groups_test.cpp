#include "prune/consensus/climb/groups.hpp"

#include <gtest/gtest.h>

#include "prune/consensus/objective/log_prior.hpp"

namespace isotherm::slam::detail {
namespace {

Group group_of(std::vector<Index> loops, double evidence, std::pair<Index, Index> parts = {0, 0}) {
  return {.loops = std::move(loops), .evidence = evidence, .parts = parts};
}

// Of a hundred loops ten are in force, so that one more is false by nine to one. All ninety are
// true as likely as the ten alone are.
TEST(LikeliestTogether, AreManyOfWhichNoneGainsAlone) {
  std::vector<Group> groups;
  for (Index k = 0; k < 90; ++k) groups.push_back(group_of({k}, 0.1));
  const Group many = likeliest_together(groups, 10, 100);
  EXPECT_EQ(many.loops.size(), 90u);
  EXPECT_NEAR(many.evidence, 9.0, 1e-12);
  EXPECT_NEAR(many.gain, 9.0 + log_prior(100, 100) - log_prior(10, 100), 1e-12);
  groups.resize(1);
  EXPECT_TRUE(likeliest_together(groups, 10, 100).loops.empty());
}

// By trying all subsets of groups of several sizes.
TEST(LikeliestTogether, AreTheBestOfAllSubsetsOfLoops) {
  const std::vector<double> evidence = {2.5, -3.0, 1.5, -0.5, -8.0, 0.5};
  std::vector<Group> groups;
  for (std::size_t k = 0; k < evidence.size(); ++k) {
    groups.push_back(group_of({static_cast<Index>(k)}, evidence[k]));
  }
  double best = 0.0;
  for (unsigned subset = 0; subset < 64; ++subset) {
    double gain = -log_prior(1, 8);
    std::size_t size = 0;
    for (std::size_t k = 0; k < 6; ++k) {
      if ((subset >> k) & 1u) gain += evidence[k], ++size;
    }
    best = std::max(best, gain + log_prior(1 + size, 8));
  }
  EXPECT_NEAR(likeliest_together(groups, 1, 8).gain, best, 1e-12);
}

TEST(LikeliestTogether, AreOnlyLoopsThatTheMapPredicts) {
  const Group one = likeliest_together({group_of({3}, 50.0, {0, 1}), group_of({5}, 40.0)}, 0, 2);
  EXPECT_EQ(one.loops, std::vector<Index>{5});
  EXPECT_TRUE(likeliest_together({}, 0, 0).loops.empty());
}

}  // namespace
}  // namespace isotherm::slam::detail
