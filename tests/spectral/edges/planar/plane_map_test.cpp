#include "edges/planar/plane_map.hpp"

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "spectral/graphs.hpp"

namespace isotherm::spectral::detail {
namespace {

using namespace isotherm_test;

constexpr int kMany = 1000;

/// Crossings in a grid, whose drawing is the usual one: straight through the cells, or around.
int grid_crossings(Index width, Index height, Index from, Index to) {
  const auto border = [&](Index v) {
    const Index x = v % width, y = v / width;
    return std::min({x, width - 1 - x, y, height - 1 - y});
  };
  const auto between = [](Index a, Index b) { return std::max<Index>(0, std::abs(a - b) - 1); };
  const Index straight = between(from % width, to % width) + between(from / width, to / width);
  return static_cast<int>(std::min(straight, border(from) + border(to)));
}

TEST(PlaneMap, CountsWhatACurveThroughAGridCrosses) {
  const Index width = 9, height = 7;
  const auto grid = grid_graph(width, height);
  PlaneMap map(grid, all_edges(grid));
  EXPECT_EQ(map.face_count(), (width - 1) * (height - 1) + 1);
  for (Index from = 0; from < grid.vertex_count(); ++from) {
    for (Index to = 0; to < grid.vertex_count(); ++to) {
      const int expected = grid_crossings(width, height, from, to);
      ASSERT_EQ(map.crossings(from, to, kMany), expected) << from << " " << to;
      ASSERT_EQ(map.crossings(from, to, 1), std::min(expected, 2)) << from << " " << to;
      ASSERT_EQ(map.crossed_edges(from, to).size(), static_cast<std::size_t>(expected));
    }
  }
}

TEST(PlaneMap, MakesRoomByTakingOutWhatIsCrossed) {
  Random random(62);
  const auto grid = grid_graph(12, 12);
  PlaneMap map(grid, all_edges(grid));
  for (int k = 0; k < 50; ++k) {
    const Index from = random_vertex(random, 144), to = random_vertex(random, 144);
    if (from == to) continue;
    std::vector<WeightedEdge> edges(grid.edges().begin(), grid.edges().end());
    edges.push_back({from, to, 1.0});
    std::vector<bool> chosen(edges.size(), true);
    const auto crossed = map.crossed_edges(from, to);
    const WeightedGraph with_edge(144, edges);
    EXPECT_EQ(is_planar(with_edge, chosen), crossed.empty());
    for (const Index edge : crossed) chosen[edge] = false;
    EXPECT_TRUE(is_planar(with_edge, chosen));
  }
}

TEST(PlaneMap, FacesAreRings) {
  const auto grid = grid_graph(3, 2);
  const PlaneMap map(grid, all_edges(grid));
  // The middle edge is between the two squares.
  const Index middle = 3;
  ASSERT_EQ(grid.edge(middle).from, 1);
  ASSERT_EQ(grid.edge(middle).to, 4);
  EXPECT_EQ(map.face_beside(2 * middle).size(), 4U);
  EXPECT_EQ(map.face_beside(2 * middle + 1).size(), 4U);
}

TEST(PlaneMap, NothingIsBetweenWhatHangsApart) {
  const auto grid = grid_graph(6, 6);
  const auto both = disjoint_union(grid, grid);
  PlaneMap map(both, all_edges(both));
  EXPECT_EQ(map.crossings(14, 36 + 14, kMany), 0);
  auto chosen = all_edges(grid);
  for (const auto& near : grid.neighbours(14)) chosen[near.edge] = false;
  PlaneMap lonely(grid, chosen);  // vertex 14 has no edge any more
  EXPECT_EQ(lonely.crossings(14, 0, kMany), 0);
  EXPECT_TRUE(lonely.crossed_edges(14, 0).empty());
}

TEST(PlaneMap, RefusesWhatIsNotPlanar) {
  const auto complete = complete_graph(5);
  EXPECT_THROW(PlaneMap(complete, all_edges(complete)), InvalidArgument);
  EXPECT_EQ(PlaneMap(WeightedGraph(), {}).face_count(), 0);
}

}  // namespace
}  // namespace isotherm::spectral::detail
