#include "prune/consensus/climb/groups.hpp"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "prune/consensus/constants.hpp"
#include "prune/consensus/log_odds.hpp"

namespace isotherm::slam::detail {
namespace {

Group group_of(std::vector<Index> loops, double gain, std::pair<Index, Index> parts = {0, 0}) {
  return {.loops = std::move(loops), .gain = gain, .parts = parts};
}

TEST(MostCertain, AreNoMoreThanAreLikelyAllTrue) {
  std::vector<Group> groups;
  for (Index k = 0; k < 8; ++k) groups.push_back(group_of({k}, 0.5 * (1.0 + k)));
  double expected_false = 0.0;
  std::vector<Index> expected;
  for (Index k = 7; k >= 0; --k) {
    expected_false += probability_of(-0.5 * (1.0 + k));
    if (expected_false <= kMostExpectedFalse) expected.push_back(k);
  }
  ASSERT_LT(expected.size(), 8u);
  const Group all = most_certain(groups, 100);
  EXPECT_EQ(all.loops, expected);
  EXPECT_TRUE(most_certain({}, 100).loops.empty());
}

TEST(MostCertain, AreNotManyMoreThanThoseInForce) {
  std::vector<Group> groups;
  for (Index k = 0; k < 100; ++k) groups.push_back(group_of({3 * k, 3 * k + 1, 3 * k + 2}, 50.0));
  EXPECT_EQ(most_certain(groups, 3).loops.size(), 3 * kBatchGrowth);
  EXPECT_EQ(most_certain({group_of({0, 1, 2}, 50.0)}, 0).loops.size(), 3u) << "the first at least";
}

// Whatever each says of where a part is, one of them puts it there.
TEST(MostCertain, JoinPartsOnce) {
  const Group all = most_certain({group_of({0}, 50.0, {0, 1}), group_of({1}, 60.0, {1, 2}),
                                  group_of({2}, 40.0, {0, 2}), group_of({3}, 30.0, {2, 2})},
                                 10);
  EXPECT_EQ(all.loops, (std::vector<Index>{1, 0, 3}));
  EXPECT_NEAR(all.gain, 140.0, 1e-12);
}

}  // namespace
}  // namespace isotherm::slam::detail
