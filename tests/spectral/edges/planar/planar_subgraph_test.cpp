#include "edges/planar/planar_subgraph.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#include <gtest/gtest.h>

#include "edges/planar/planarity.hpp"
#include "isotherm/base/error.hpp"
#include "spectral/graphs.hpp"

namespace isotherm::spectral::detail {
namespace {

using namespace isotherm_test;

/// By trying all sets of edges.
double greatest_worth(const WeightedGraph& graph, const std::vector<double>& worth) {
  const auto count = static_cast<unsigned>(graph.edge_count());
  double greatest = 0.0;
  for (unsigned set = 0; set < 1U << count; ++set) {
    std::vector<bool> chosen;
    double sum = 0.0;
    for (unsigned e = 0; e < count; ++e) {
      chosen.push_back((set >> e & 1U) != 0);
      if (chosen.back()) sum += worth[e];
    }
    if (sum > greatest && is_planar(graph, chosen)) greatest = sum;
  }
  return greatest;
}

/// Whether the edges can be drawn, and none can be added.
bool is_maximal(const WeightedGraph& graph, std::vector<bool> chosen) {
  if (!is_planar(graph, chosen)) return false;
  for (std::size_t e = 0; e < chosen.size(); ++e) {
    if (chosen[e]) continue;
    chosen[e] = true;
    if (is_planar(graph, chosen)) return false;
    chosen[e] = false;
  }
  return true;
}

WeightedGraph with_shortcuts(const WeightedGraph& graph, int count, Random& random) {
  std::vector<WeightedEdge> edges(graph.edges().begin(), graph.edges().end());
  while (count > 0) {
    const WeightedEdge edge = {random_vertex(random, graph.vertex_count()),
                               random_vertex(random, graph.vertex_count()), 1.0};
    if (edge.from == edge.to) continue;
    edges.push_back(edge);
    --count;
  }
  return {graph.vertex_count(), std::move(edges)};
}

TEST(PlanarSubgraph, ComesNearTheGreatestOfSmallGraphs) {
  Random random(63);
  double found = 0.0, greatest = 0.0;
  for (int k = 0; k < 25; ++k) {
    auto graph = with_shortcuts(ring_graph(6), 6, random);
    std::vector<double> worth, suspicion;
    for (Index e = 0; e < graph.edge_count(); ++e) {
      worth.push_back(random.uniform(1.0, 3.0));
      suspicion.push_back(random.uniform());
    }
    const auto plane = find_planar_subgraph(graph, worth, suspicion, {.most_left_out = 1.0});
    EXPECT_TRUE(is_maximal(graph, plane.chosen));
    double sum = 0.0;
    for (std::size_t e = 0; e < worth.size(); ++e) sum += plane.chosen[e] ? worth[e] : 0.0;
    EXPECT_DOUBLE_EQ(plane.worth, sum);
    const double best = greatest_worth(graph, worth);
    EXPECT_LE(plane.worth, best + 1e-12);
    found += plane.worth;
    greatest += best;
  }
  EXPECT_GT(found, 0.97 * greatest);
}

TEST(PlanarSubgraph, KeepsAGridAndNotItsShortcuts) {
  Random random(64);
  const auto grid = grid_graph(15, 15);
  const auto graph = with_shortcuts(grid, 25, random);
  std::vector<double> suspicion;  // which errs
  for (Index e = 0; e < graph.edge_count(); ++e) {
    suspicion.push_back(random.uniform() + (e < grid.edge_count() ? 0.0 : 0.5));
  }
  const auto plane = find_planar_subgraph(graph, equal_worth(graph), suspicion);
  ASSERT_EQ(plane.chosen.size(), graph.edges().size());
  EXPECT_TRUE(is_maximal(graph, plane.chosen));
  const auto kept =
      std::count(plane.chosen.begin(), plane.chosen.begin() + grid.edge_count(), true);
  EXPECT_GE(kept, grid.edge_count() - 4);
  EXPECT_EQ(plane.chosen, find_planar_subgraph(graph, equal_worth(graph), suspicion).chosen);
}

TEST(PlanarSubgraph, ChoosesByWorthThenBySuspicion) {
  const auto complete = complete_graph(5);  // any edge may go
  auto worth = equal_worth(complete);
  worth[9] = 2.0;  // the one that is left out first
  EXPECT_FALSE(
      find_planar_subgraph(complete, worth, equal_worth(complete), {.rounds = 0}).chosen[9]);
  const auto by_worth = find_planar_subgraph(complete, worth, equal_worth(complete));
  EXPECT_DOUBLE_EQ(by_worth.worth, 10.0);
  EXPECT_TRUE(by_worth.chosen[9]);
  auto suspicion = equal_worth(complete);
  suspicion[4] = 5.0;
  EXPECT_FALSE(find_planar_subgraph(complete, equal_worth(complete), suspicion).chosen[4]);
}

TEST(PlanarSubgraph, HasThreeEdgesAVertexAtMost) {
  EXPECT_TRUE(has_few_enough_edges(WeightedGraph()));
  EXPECT_TRUE(has_few_enough_edges(grid_graph(10, 10)));
  EXPECT_TRUE(has_few_enough_edges(complete_graph(8)));   // 0.8 of 28 are less than 24
  EXPECT_FALSE(has_few_enough_edges(complete_graph(9)));  // 0.8 of 36 are more than 27
  EXPECT_TRUE(has_few_enough_edges(complete_graph(9), {.most_left_out = 0.25}));
}

TEST(PlanarSubgraph, ForcesNothingInThatIsWorthLittle) {
  const auto complete = complete_graph(5);
  auto worth = equal_worth(complete);
  worth[9] = 2.0;
  const PlanarSubgraphOptions options = {.least_forced = 3.0};
  const auto kept = find_planar_subgraph(complete, worth, equal_worth(complete), options);
  EXPECT_TRUE(is_maximal(complete, kept.chosen));
  EXPECT_FALSE(kept.chosen[9]);  // the last in order, which found no room
}

TEST(PlanarSubgraph, GivesUpOnWhatIsNotNearlyPlanar) {
  const auto dense = complete_graph(30);
  EXPECT_TRUE(find_planar_subgraph(dense, equal_worth(dense), equal_worth(dense)).chosen.empty());
  Random random(65);
  const auto sparse = with_shortcuts(ring_graph(200), 200, random);  // few enough edges
  EXPECT_TRUE(
      find_planar_subgraph(sparse, equal_worth(sparse), equal_worth(sparse)).chosen.empty());
  const auto grid = with_shortcuts(grid_graph(20, 20), 20, random);
  EXPECT_TRUE(find_planar_subgraph(grid, equal_worth(grid), equal_worth(grid), {.budget = 1e4})
                  .chosen.empty());
}

TEST(PlanarSubgraph, TakesDegenerateGraphsAndIsCancelled) {
  EXPECT_TRUE(find_planar_subgraph(WeightedGraph(), {}, {}).chosen.empty());
  const WeightedGraph loops(3, {{0, 0, 1.0}, {0, 1, 1.0}, {1, 0, 1.0}});
  const auto plane = find_planar_subgraph(loops, equal_worth(loops), equal_worth(loops));
  EXPECT_EQ(plane.chosen, (std::vector<bool>{false, true, true}));
  Random random(66);
  const auto grid = with_shortcuts(grid_graph(10, 10), 5, random);
  EXPECT_THROW(find_planar_subgraph(grid, equal_worth(grid), equal_worth(grid),
                                    {.progress = [](const Progress&) { return false; }}),
               Cancelled);
}

}  // namespace
}  // namespace isotherm::spectral::detail
