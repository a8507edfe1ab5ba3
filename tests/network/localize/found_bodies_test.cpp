#include "localize/firm/found_bodies.hpp"

#include <numeric>

#include <gtest/gtest.h>

namespace isotherm::network::detail {
namespace {

using Nodes = FoundBodies::Nodes;

Nodes from_to(Index first, Index end) {
  Nodes nodes(end - first);
  std::iota(nodes.begin(), nodes.end(), first);
  return nodes;
}

/// Enters a body with these nodes of its own; what joins it.
Nodes enter(FoundBodies& found, Nodes own, Index all, bool is_enough = true) {
  std::vector<bool> firm(all, false);
  for (const Index v : own) firm[v] = true;
  found.begin_body();
  const auto joined = found.join(own, firm, [&](const Nodes&) { return is_enough; });
  for (const Index v : joined) EXPECT_TRUE(firm[v]);
  own.insert(own.end(), joined.begin(), joined.end());
  found.end_body(own);
  return joined;
}

TEST(FoundBodies, SharingEnoughTheRestJoins) {
  FoundBodies found(40);
  EXPECT_TRUE(enter(found, from_to(0, 20), 40).empty());
  EXPECT_EQ(enter(found, from_to(12, 30), 40), from_to(0, 12));
  EXPECT_TRUE(found.cover(from_to(0, 30)));
  EXPECT_FALSE(found.cover({30}));
  const auto bodies = std::move(found).take();
  ASSERT_EQ(bodies.size(), 1U);
  EXPECT_EQ(bodies.front().size(), 30U);
}

TEST(FoundBodies, SharingFewTheyStayApart) {
  FoundBodies found(40);
  enter(found, from_to(0, 20), 40);
  EXPECT_TRUE(enter(found, from_to(16, 30), 40).empty());
  EXPECT_EQ(std::move(found).take().size(), 2U);
}

TEST(FoundBodies, SharingManyThatDoNotFixTheyStayApart) {
  FoundBodies found(40);
  enter(found, from_to(0, 20), 40);
  EXPECT_TRUE(enter(found, from_to(2, 30), 40, false).empty());
  EXPECT_EQ(std::move(found).take().size(), 2U);
}

TEST(FoundBodies, AreAskedAgainWhenTwiceAsManyAreShared) {
  FoundBodies found(40);
  enter(found, from_to(0, 40), 40);
  std::vector<std::size_t> asked;
  std::vector<bool> firm(40, true);
  found.begin_body();
  found.join(from_to(0, 40), firm, [&](const Nodes& shared) {
    asked.push_back(shared.size());
    return false;
  });
  EXPECT_EQ(asked, (std::vector<std::size_t>{8, 16, 32}));
}

// What joins a body brings others along; nodes of a body that has joined lead to the whole.
TEST(FoundBodies, ThoseThatJoinBringOthers) {
  FoundBodies found(100);
  enter(found, from_to(0, 30), 100);
  enter(found, from_to(30, 60), 100);
  enter(found, from_to(20, 40), 100, false);
  EXPECT_EQ(enter(found, from_to(20, 28), 100).size(), 52U);
  EXPECT_EQ(enter(found, from_to(50, 70), 100).size(), 50U);
  const auto bodies = std::move(found).take();
  ASSERT_EQ(bodies.size(), 1U);
  EXPECT_EQ(bodies.front().size(), 70U);
}

TEST(FoundBodies, WithoutAnyNothingIsCovered) {
  FoundBodies found(2);
  EXPECT_FALSE(found.cover({0}));
  EXPECT_TRUE(std::move(found).take().empty());
}

}  // namespace
}  // namespace isotherm::network::detail
