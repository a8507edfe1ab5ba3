#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "isotherm/spectral/resistance/effective_resistance.hpp"
#include "spectral/distributed/ranks.hpp"

namespace isotherm::spectral {
namespace {

using namespace isotherm_test;

/// Brackets hold what elimination without subtraction gives, whose error is proven.
void check_resistances(const WeightedGraph& graph, const std::vector<VertexPair>& pairs,
                       bool converges) {
  const auto exact = effective_resistances(graph, pairs);
  const auto mine = share(std::span<const VertexPair>(pairs));
  const auto found = distributed::effective_resistances(distribute(graph), mine);
  EXPECT_TRUE(found.proven);
  EXPECT_TRUE(found.unconverged == 0 || !converges) << found.unconverged;
  for (std::size_t k = 0; k < mine.size(); ++k) {
    const double value = exact.values[share_begin(pairs) + k];
    if (std::isinf(value)) {
      EXPECT_EQ(found.values[k].lower, value);
      continue;
    }
    EXPECT_LE(found.values[k].lower, value * (1.0 + exact.bound));
    EXPECT_GE(found.values[k].upper, value * (1.0 - exact.bound));
  }
}

TEST(DistributedResistance, BracketsHoldTheExactValue) {
  Random random(21);
  for (const auto& shape : joined_shapes(random)) {
    for (const double decades : {0.0, 8.0}) {
      const auto graph = decades > 0.0 ? spread_weights(shape, decades, random) : shape;
      std::vector<VertexPair> pairs = {{3, 3}, {0, graph.vertex_count() - 1}};
      for (int k = 0; k < 15; ++k) {
        pairs.push_back({random_vertex(random, graph.vertex_count()),
                         random_vertex(random, graph.vertex_count())});
      }
      check_resistances(graph, pairs, decades == 0.0);
    }
  }
}

TEST(DistributedResistance, ProjectionsStayWithinTheErrorTheyState) {
  Random random(22);
  const auto graph = disjoint_union(random_geometric(60, 0.3, random), loopy_path(40, 10, random));
  const auto exact = edge_resistances(graph);
  const auto mine = distribute(graph);
  const auto found = distributed::project_resistances(mine, {.error = 0.4, .seed = 3});
  const auto edges = mine.edges();
  EXPECT_EQ(found.values.size(), edges.size());
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const double value = exact.values[static_cast<std::size_t>(edges[k].number)];
    if (edges[k].from == edges[k].to) {
      EXPECT_EQ(found.values[k], 0.0);
    } else {
      EXPECT_NEAR(found.values[k], value, 0.4 * value);
    }
  }
}

}  // namespace
}  // namespace isotherm::spectral
