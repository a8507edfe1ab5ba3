#include "edges/space/place_sampler.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "spectral/edges/space/points.hpp"
#include "spectral/edges/space/triple.hpp"

namespace isotherm::spectral::detail {
namespace {

using namespace isotherm_test;

TEST(PlaceSampler, LeavesOutThePairThatIsAskedFor) {
  Random random(5);
  const Places<2> points = 2.5 * points_in_ball(60, 2, random);
  const auto graph = contacts(points, 1.0, 1, random);
  const auto& [from, to, weight] = graph.edges().back();
  ASSERT_GT((points.col(from) - points.col(to)).norm(), 1.5);
  const std::vector<AskedPair> asked = {{{graph.edge(0).from, graph.edge(0).to}, 1.0, true},
                                        {{from, to}, 1.0, true}};
  const ContactGraph model(graph, equal_worth(graph));
  const auto sums = sample_places<2>(model, {0.05, 1e-3}, points, asked, 1);
  EXPECT_GT(sums.near[0] / sums.weight[0], 0.3);
  EXPECT_LT(sums.near[1] / sums.weight[1], 0.01);
  const auto again = sample_places<2>(model, {0.05, 1e-3}, points, asked, 1);
  EXPECT_EQ(sums.near, again.near);
  EXPECT_EQ(sums.weight, again.weight);
}

/// The vertices in any order: `names` are those of the path's ends and middle.
template <int Dimension>
void expect_left_out_of_triple(std::array<Index, 3> names) {
  Triple triple;
  triple.dimension = Dimension;
  const auto [first, middle, last] = names;
  const WeightedGraph path(3, {{first, middle, 1.0}, {middle, last, 1.0}});
  const ContactGraph graph(path, equal_worth(path));
  const std::vector<AskedPair> asked = {{{first, middle}, 1.0, true}, {{first, last}, 1.0, false}};
  std::array<double, 2> near{}, weight{};
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    const auto sums = sample_places<Dimension>(graph, {triple.width, triple.astray, triple.spread},
                                               Places<Dimension>::Zero(Dimension, 3), asked, seed);
    for (const std::size_t k : {0, 1}) {
      near[k] += sums.near[k];
      weight[k] += sums.weight[k];
    }
  }
  auto without_edge = triple, without_gap = triple;
  without_edge.hears_first = false;
  without_gap.hears_open = false;
  EXPECT_NEAR(near[0] / weight[0],
              without_edge.mean([&](const auto& apart) { return triple.rho(apart.first); }), 0.02);
  EXPECT_NEAR(near[1] / weight[1],
              without_gap.mean([&](const auto& apart) { return triple.rho(apart.open); }), 0.02);
}

TEST(PlaceSampler, TellsOfLeftOutPairsWhatAnIntegralDoes) {
  expect_left_out_of_triple<2>({0, 1, 2});
  expect_left_out_of_triple<3>({0, 1, 2});
}

TEST(PlaceSampler, TellsTheSameWhateverTheOrderOfVertices) {
  expect_left_out_of_triple<2>({2, 0, 1});
  expect_left_out_of_triple<3>({1, 2, 0});
}

TEST(PlaceSampler, TakesGraphsOfNextToNothing) {
  const WeightedGraph none, one(1, {}), edge(2, {{0, 1, 1.0}}),
      apart(5, {{0, 1, 1.0}, {3, 4, 1.0}}),
      repeated(3, {{0, 1, 1.0}, {1, 0, 1.0}, {0, 1, 2.0}, {1, 2, 1.0}}), loop(2, {{1, 1, 1.0}});
  for (const auto& graph : {none, one, edge, apart, repeated, loop}) {
    std::vector<AskedPair> asked;
    for (const auto& [from, to, weight] : graph.edges()) asked.push_back({{from, to}, 1.0, true});
    const ContactGraph contacts(graph, equal_worth(graph));
    const Places<3> start = Places<3>::Zero(3, graph.vertex_count());
    const auto sums = sample_places<3>(contacts, {0.03, 1e-3}, start, asked, 1);
    ASSERT_EQ(sums.near.size(), asked.size());
    for (std::size_t k = 0; k < asked.size(); ++k) {
      EXPECT_GT(sums.near[k], 0.0);
      EXPECT_GT(sums.weight[k], sums.near[k]);
      EXPECT_TRUE(std::isfinite(sums.weight[k]));
    }
  }
}

}  // namespace
}  // namespace isotherm::spectral::detail
