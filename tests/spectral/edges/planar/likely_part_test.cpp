#include "edges/planar/likely_part.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "edges/planar/planarity.hpp"
#include "isotherm/base/error.hpp"
#include "spectral/graphs.hpp"

namespace isotherm::spectral::detail {
namespace {

using namespace isotherm_test;

WalkAffinityOptions long_walks() { return {.scale = 2.0, .horizon = 12}; }

/// A grid, and then edges between any two vertices, which are false.
struct Roads {
  static constexpr Index kSide = 15, kFalse = 25;
  WeightedGraph graph;
  Index true_count = 0;
  std::vector<VertexPair> pairs;

  explicit Roads(Random& random) {
    const auto grid = grid_graph(kSide, kSide);
    true_count = grid.edge_count();
    std::vector<WeightedEdge> edges(grid.edges().begin(), grid.edges().end());
    for (const auto& [from, to] : random_pairs(random, kFalse)) edges.push_back({from, to, 1.0});
    graph = WeightedGraph(grid.vertex_count(), std::move(edges));
    pairs = random_pairs(random, 1000);
  }

  /// Inside the grid, as its border can be joined around it, and four columns from each other at
  /// least, so that none is an edge of the grid.
  static std::vector<VertexPair> random_pairs(Random& random, int count) {
    constexpr Index kApart = 4, kBorder = 2, kInside = kSide - 2 * kBorder;
    const auto inside = [&] { return kBorder + random_vertex(random, kInside); };
    std::vector<VertexPair> found;
    while (std::ssize(found) < count) {
      const Index column = inside(), other = inside();
      if (std::abs(column - other) < kApart) continue;
      found.push_back({inside() * kSide + column, inside() * kSide + other});
    }
    return found;
  }
};

TEST(LikelyPart, OddsAreThoseOfTheTruth) {
  Random random(71);
  PairFeatures features{Eigen::MatrixXd(400, 1), Eigen::MatrixXd(500, 1)};
  for (double& x : features.edges.reshaped()) x = random.normal();
  for (double& x : features.pairs.reshaped()) x = random.normal(2.0, 1.0);
  const auto found = edge_odds(features, std::vector<double>(400, 0.9));
  const auto odds = log_odds_of_true(found.scores, found.false_count);
  for (std::size_t e = 0; e < odds.size(); ++e) {
    EXPECT_NEAR(1.0 / (1.0 + std::exp(-odds[e])), found.truth[e], 1e-12);
  }
  for (const double none : log_odds_of_true(std::vector{0.0, 1.0, -1.0}, 0.0)) {
    EXPECT_TRUE(std::isfinite(none));
  }
}

TEST(LikelyPart, EvidenceCountsWhatIsNotDrawnAsFalse) {
  // From the definition: log ((1 - c) f_true / f_pairs + c) of what is drawn, log c of the others.
  const std::vector<double> scores = {-3.0, -1.0, 0.5, 4.0};
  const double share = 0.3, prior = 0.7;
  const std::vector<bool> chosen = {true, false, true, false};
  double all = -prior, part = -prior;
  for (std::size_t e = 0; e < scores.size(); ++e) {
    const double either = std::log((1.0 - share) * std::exp(-scores[e]) + share);
    all += either;
    part += chosen[e] ? either : std::log(share);
  }
  const EdgeOdds odds{scores, {}, share * 4.0, all};
  EXPECT_NEAR(evidence_of_part(odds, chosen), part, 1e-12);
  EXPECT_NEAR(evidence_of_part(odds, {true, true, true, true}), all, 1e-12);
}

TEST(LikelyPart, KeepsAGridWhateverWasThoughtOfItsEdges) {
  Random random(72);
  for (int k = 0; k < 3; ++k) {
    const Roads roads(random);
    std::vector<double> odds;  // which err: of true edges some are doubted, of false ones some not
    for (Index e = 0; e < roads.graph.edge_count(); ++e) {
      odds.push_back(random.normal(e < roads.true_count ? 2.0 : 0.0, 2.0));
    }
    const auto part = likely_planar_part(roads.graph, odds, roads.pairs, long_walks());
    ASSERT_EQ(part.chosen.size(), roads.graph.edges().size());
    EXPECT_TRUE(is_planar(roads.graph, part.chosen));
    const auto first_false = part.chosen.begin() + roads.true_count;
    EXPECT_EQ(std::count(part.chosen.begin(), first_false, true), roads.true_count);
    EXPECT_EQ(std::count(first_false, part.chosen.end(), true), 0);
    EXPECT_EQ(part.chosen, likely_planar_part(roads.graph, odds, roads.pairs, long_walks()).chosen);
  }
}

TEST(LikelyPart, LeavesOutTheLeastLikelyEdge) {
  // Of the complete graph of five vertices one edge has to go: the least likely one.
  const auto complete = complete_graph(5);
  const std::vector<VertexPair> pairs = {{0, 1}, {2, 3}};
  std::vector<double> odds(complete.edges().size(), 3.0);
  odds[4] = -1.0;
  const auto part = likely_planar_part(complete, odds, pairs, long_walks());
  EXPECT_EQ(std::count(part.chosen.begin(), part.chosen.end(), false), 1);
  EXPECT_FALSE(part.chosen[4]);
}

TEST(LikelyPart, TakesDegenerateGraphsAndIsCancelled) {
  EXPECT_TRUE(likely_planar_part(WeightedGraph(), {}, {}, long_walks()).chosen.empty());
  const auto dense = complete_graph(30);
  EXPECT_TRUE(likely_planar_part(dense, equal_worth(dense), {}, long_walks()).chosen.empty());
  Random random(73);
  const Roads roads(random);
  auto cancelled = long_walks();
  cancelled.progress = [](const Progress&) { return false; };
  EXPECT_THROW(likely_planar_part(roads.graph, equal_worth(roads.graph), roads.pairs, cancelled),
               Cancelled);
}

}  // namespace
}  // namespace isotherm::spectral::detail
