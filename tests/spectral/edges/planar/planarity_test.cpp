#include "edges/planar/planarity.hpp"

#include <algorithm>

#include <gtest/gtest.h>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boyer_myrvold_planar_test.hpp>

#include "spectral/graphs.hpp"

namespace isotherm::spectral::detail {
namespace {

using namespace isotherm_test;

bool all_planar(const WeightedGraph& graph) { return detail::is_planar(graph, all_edges(graph)); }

/// The method of Boyer and Myrvold, by another library.
bool is_planar_by_boost(const WeightedGraph& graph) {
  boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS> other(graph.vertex_count());
  for (const auto& edge : graph.edges()) boost::add_edge(edge.from, edge.to, other);
  return boost::boyer_myrvold_planarity_test(other);
}

/// Number of faces of a drawing; -1 where it is not a ring of half-edges around each vertex.
Index count_faces(const WeightedGraph& graph, const PlanarEmbedding& drawing) {
  const auto& clockwise = drawing.clockwise;
  const auto source = [&](HalfEdge half) {
    const auto& edge = graph.edge(half / 2);
    return half % 2 == 0 ? edge.from : edge.to;
  };
  std::vector<bool> seen(clockwise.size(), false);
  Index faces = 0;
  for (std::size_t h = 0; h < clockwise.size(); ++h) {
    const auto first = static_cast<HalfEdge>(h);
    if (clockwise[h] == PlanarEmbedding::kNone || seen[h]) continue;
    auto half = first;
    do {
      if (source(clockwise[half]) != source(half)) return -1;
      seen[half] = true;
      half = clockwise[opposite(half)];
    } while (!seen[half]);
    if (half != first) return -1;
    ++faces;
  }
  return faces;
}

/// By Euler's formula, in each component that has edges.
Index expected_faces(const WeightedGraph& graph) {
  Index isolated = 0;
  for (Index v = 0; v < graph.vertex_count(); ++v) isolated += graph.neighbours(v).empty() ? 1 : 0;
  const Index components = connected_components(graph).count - isolated;
  return 2 * components - (graph.vertex_count() - isolated) + graph.edge_count();
}

TEST(Planarity, AgreesWithBoyerAndMyrvold) {
  Random random(61);
  int planar = 0;
  constexpr int kGraphs = 6000;
  for (int k = 0; k < kGraphs; ++k) {
    const auto n = static_cast<Index>(4 + random.index(12));
    std::vector<WeightedEdge> edges;  // parallel ones among them
    for (auto m = random.index(static_cast<std::uint64_t>(3 * n)); m > 0; --m) {
      const WeightedEdge edge = {random_vertex(random, n), random_vertex(random, n), 1.0};
      if (edge.from != edge.to) edges.push_back(edge);
    }
    const WeightedGraph graph(n, edges);
    const auto drawing = embed_in_plane(graph, all_edges(graph));
    ASSERT_EQ(drawing.has_value(), is_planar_by_boost(graph));
    ASSERT_EQ(drawing.has_value(), all_planar(graph));
    if (!drawing) continue;
    ASSERT_EQ(count_faces(graph, *drawing), expected_faces(graph));
    ++planar;
  }
  EXPECT_GT(planar, kGraphs / 4);
  EXPECT_LT(planar, kGraphs * 9 / 10);
}

TEST(Planarity, KnowsTheForbiddenGraphs) {
  EXPECT_TRUE(all_planar(complete_graph(4)));
  EXPECT_FALSE(all_planar(complete_graph(5)));
  std::vector<WeightedEdge> utilities;
  for (Index i = 0; i < 3; ++i) {
    for (Index j = 3; j < 6; ++j) utilities.push_back({i, j, 1.0});
  }
  EXPECT_FALSE(all_planar(WeightedGraph(6, utilities)));
  utilities.pop_back();
  EXPECT_TRUE(all_planar(WeightedGraph(6, utilities)));
}

TEST(Planarity, LeavesOutEdgesAndSelfLoops) {
  const auto complete = complete_graph(5);
  auto chosen = all_edges(complete);
  chosen[3] = false;
  EXPECT_TRUE(detail::is_planar(complete, chosen));
  const auto drawing = embed_in_plane(complete, chosen);
  ASSERT_TRUE(drawing);
  EXPECT_EQ(count_faces(complete, *drawing), 6);
  EXPECT_EQ(drawing->clockwise[6], PlanarEmbedding::kNone);
  EXPECT_EQ(drawing->clockwise[7], PlanarEmbedding::kNone);
  const WeightedGraph loop(2, {{0, 0, 1.0}, {0, 1, 1.0}});
  EXPECT_EQ(embed_in_plane(loop, all_edges(loop))->clockwise[0], PlanarEmbedding::kNone);
}

TEST(Planarity, TakesEmptyLongAndWideGraphs) {
  EXPECT_TRUE(all_planar(WeightedGraph()));
  EXPECT_TRUE(all_planar(WeightedGraph(3, {})));
  const auto path = path_graph(200'000);  // deeper than any call stack
  EXPECT_EQ(count_faces(path, *embed_in_plane(path, all_edges(path))), 1);
  const auto star = star_graph(50'000);
  EXPECT_EQ(count_faces(star, *embed_in_plane(star, all_edges(star))), 1);
  const auto grid = grid_graph(60, 50);
  EXPECT_EQ(count_faces(grid, *embed_in_plane(grid, all_edges(grid))), 59 * 49 + 1);
  const auto apart = disjoint_union(grid, complete_graph(4));
  EXPECT_EQ(count_faces(apart, *embed_in_plane(apart, all_edges(apart))), 59 * 49 + 1 + 4);
}

}  // namespace
}  // namespace isotherm::spectral::detail
