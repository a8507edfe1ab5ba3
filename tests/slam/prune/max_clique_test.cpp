#include "prune/pcm/max_clique.hpp"

#include <bit>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"

namespace isotherm::slam::detail {
namespace {

BitGraph random_graph(Random& random, Index n, double density) {
  BitGraph graph(n);
  for (Index a = 0; a < n; ++a) {
    for (Index b = 0; b < a; ++b) {
      if (random.uniform() < density) graph.connect(a, b);
    }
  }
  return graph;
}

bool is_clique(const BitGraph& graph, const std::vector<Index>& members) {
  for (const Index a : members) {
    for (const Index b : members) {
      if (a != b && !graph.connected(a, b)) return false;
    }
  }
  return true;
}

// By trying every subset.
int largest_size(const BitGraph& graph) {
  int largest = 0;
  for (unsigned subset = 0; subset < 1u << graph.vertex_count(); ++subset) {
    std::vector<Index> members;
    for (Index v = 0; v < graph.vertex_count(); ++v) {
      if ((subset >> v & 1u) != 0) members.push_back(v);
    }
    if (std::popcount(subset) > largest && is_clique(graph, members)) {
      largest = std::popcount(subset);
    }
  }
  return largest;
}

TEST(MaxClique, AsLargeAsBruteForceFinds) {
  Random random(61);
  for (int trial = 0; trial < 30; ++trial) {
    const auto graph = random_graph(random, 12, 0.2 + 0.025 * trial);
    const auto clique = max_clique(graph, 1000000);
    EXPECT_TRUE(clique.proven);
    EXPECT_TRUE(is_clique(graph, clique.members));
    EXPECT_EQ(static_cast<int>(clique.members.size()), largest_size(graph));
  }
}

TEST(MaxClique, WithoutBudgetACliqueThatNothingCanJoin) {
  Random random(62);
  const auto graph = random_graph(random, 150, 0.6);
  const auto clique = max_clique(graph, 0);
  EXPECT_FALSE(clique.proven);
  EXPECT_TRUE(is_clique(graph, clique.members));
  for (Index v = 0; v < 150; ++v) {
    auto more = clique.members;
    if (std::find(more.begin(), more.end(), v) != more.end()) continue;
    more.push_back(v);
    EXPECT_FALSE(is_clique(graph, more));
  }
  EXPECT_LE(clique.members.size(), max_clique(graph, 1000000).members.size());
}

TEST(MaxClique, EmptyAndEdgeless) {
  EXPECT_TRUE(max_clique(BitGraph(0), 10).members.empty());
  EXPECT_EQ(max_clique(BitGraph(5), 100).members.size(), 1u);
}

}  // namespace
}  // namespace isotherm::slam::detail
