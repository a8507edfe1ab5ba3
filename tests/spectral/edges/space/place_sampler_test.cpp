#include "edges/space/place_sampler.hpp"

#include <gtest/gtest.h>

#include "spectral/edges/space/points.hpp"

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

}  // namespace
}  // namespace isotherm::spectral::detail
