#include <gtest/gtest.h>

#include "graph/bridges.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/spectral/edges/multiscale_heat.hpp"
#include "spectral/distributed/ranks.hpp"

namespace isotherm::spectral {
namespace {

using namespace isotherm_test;

TEST(DistributedEdges, BridgesAreThoseOfOneMachine) {
  Random random(31);
  auto graphs = shapes(random);
  graphs.push_back(path_graph(30));
  graphs.push_back(ring_graph(30));
  graphs.push_back(star_graph(12));
  graphs.push_back(WeightedGraph(3, {{0, 1, 1}, {1, 0, 1}, {1, 2, 1}, {2, 2, 1}}));
  // Two rings that one bridge joins, with tails.
  auto rings = disjoint_union(disjoint_union(ring_graph(15), ring_graph(15)), path_graph(6));
  std::vector<WeightedEdge> edges(rings.edges().begin(), rings.edges().end());
  edges.push_back({3, 20, 1.0});
  edges.push_back({7, 30, 1.0});
  graphs.emplace_back(rings.vertex_count(), edges);
  for (int round = 0; round < 20; ++round) graphs.push_back(loopy_path(30, 4, random));
  for (const auto& ordered : graphs) {
    const auto graph = relabel(ordered, random_permutation(ordered.vertex_count(), random));
    const auto exact = detail::find_bridges(graph);
    const auto mine = distribute(graph);
    const auto found = distributed::find_bridges(mine);
    const auto numbered = mine.edges();
    ASSERT_EQ(found.size(), numbered.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_EQ(found[k], exact[static_cast<std::size_t>(numbered[k].number)]);
    }
  }
}

TEST(DistributedEdges, FilteredGraphsKeepTheirVertices) {
  Random random(32);
  const auto graph = distribute(loopy_path(60, 10, random));
  const auto edges = graph.edges();
  std::vector<bool> keep;
  for (const auto& edge : edges) keep.push_back(edge.number % 3 != 0);
  const auto left = graph.filtered(keep);
  EXPECT_EQ(left.vertex_count(), 60);
  EXPECT_EQ(left.edge_count(), graph.edge_count() - (graph.edge_count() + 2) / 3);
  std::size_t next = 0;
  for (const auto& edge : left.edges()) {
    while (!keep[next]) ++next;
    EXPECT_EQ(edge.from, edges[next].from);
    EXPECT_EQ(edge.to, edges[next++].to);
  }
  keep.push_back(true);
  EXPECT_THROW(graph.filtered(keep), InvalidArgument);
}

void expect_decisions_of_one_machine(const MultiscaleHeatOptions& options) {
  Random random(33);
  const auto path = path_graph(200);
  std::vector<WeightedEdge> edges(path.edges().begin(), path.edges().end());
  std::vector<Index> candidates;
  for (int k = 0; k < 40; ++k) {
    const Index from = random_vertex(random, 180);
    const Index to = k % 5 == 0 ? random_vertex(random, 200) : from + 5 + k % 7;
    candidates.push_back(static_cast<Index>(edges.size()));
    edges.push_back({from, to, 1.0});
  }
  const WeightedGraph graph(200, edges);
  const auto exact = multiscale_heat(graph, candidates, options);
  const auto mine = distribute(graph);
  const auto numbered = mine.edges();
  std::vector<bool> candidate;
  for (const auto& edge : numbered) candidate.push_back(edge.number >= candidates.front());
  const auto found = distributed::multiscale_heat(mine, candidate, options);
  ASSERT_EQ(found.rounds.size(), exact.rounds.size());
  for (std::size_t s = 0; s < exact.rounds.size(); ++s) {
    EXPECT_NEAR(found.rounds[s].threshold, exact.rounds[s].threshold, 1e-8);
    EXPECT_NEAR(found.rounds[s].separation, exact.rounds[s].separation, 1e-6);
    EXPECT_EQ(found.rounds[s].candidates, exact.rounds[s].candidates);
    EXPECT_EQ(found.rounds[s].pruned, exact.rounds[s].pruned);
  }
  for (std::size_t k = 0; k < numbered.size(); ++k) {
    if (!candidate[k]) continue;
    const auto& other =
        exact.verdicts[static_cast<std::size_t>(numbered[k].number - candidates.front())];
    EXPECT_EQ(found.verdicts[k].pruned, other.pruned);
    EXPECT_NEAR(found.verdicts[k].score, other.score, 1e-6 * other.score);
    EXPECT_EQ(found.verdicts[k].stage, other.stage);
  }
}

TEST(DistributedEdges, Algorithm1DecidesAsOnOneMachine) {
  for (const auto rule : {ThresholdRule::mean_sigma, ThresholdRule::otsu}) {
    SCOPED_TRACE(enum_name(rule));
    expect_decisions_of_one_machine(
        {.scales = {100, 10, 1}, .threshold = rule, .min_separation = 0.0, .tolerance = 1e-9});
  }
}

}  // namespace
}  // namespace isotherm::spectral
