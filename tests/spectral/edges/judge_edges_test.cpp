#include "isotherm/spectral/edges/judge_edges.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "spectral/graphs.hpp"

namespace isotherm::spectral {
namespace {

using namespace isotherm_test;

constexpr std::array kAllMethods = {
    EdgeScore::heat,    EdgeScore::affinity,          EdgeScore::resistance,
    EdgeScore::jaccard, EdgeScore::common_neighbours, EdgeScore::rank};
// Those that need no positions.
constexpr std::array kMethods = {EdgeScore::heat, EdgeScore::affinity, EdgeScore::resistance,
                                 EdgeScore::jaccard, EdgeScore::common_neighbours};

/// Points in the unit square joined to those near them, and `false_count` edges
/// at the end that join points far from each other.
WeightedGraph with_false_edges(Index n, double radius, Index false_count, Random& random) {
  std::vector<std::pair<double, double>> points(n);
  for (auto& point : points) point = {random.uniform(), random.uniform()};
  const auto distance = [&points](Index i, Index j) {
    return std::hypot(points[i].first - points[j].first, points[i].second - points[j].second);
  };
  std::vector<WeightedEdge> edges;
  for (Index i = 0; i < n; ++i) {
    for (Index j = i + 1; j < n; ++j) {
      if (distance(i, j) < radius) edges.push_back({i, j, 1.0});
    }
  }
  for (Index k = 0; k < false_count;) {
    const Index i = random_vertex(random, n);
    const Index j = random_vertex(random, n);
    if (distance(i, j) < 2.0 * radius) continue;
    edges.push_back({i, j, 1.0});
    ++k;
  }
  return {n, std::move(edges)};
}

double area_under_curve(const EdgeVerdicts& verdicts, Index false_count) {
  const std::size_t true_count = verdicts.size() - false_count;
  double wins = 0.0;
  for (std::size_t t = 0; t < true_count; ++t) {
    for (std::size_t f = true_count; f < verdicts.size(); ++f) {
      if (verdicts[f].score > verdicts[t].score) wins += 1.0;
      if (verdicts[f].score == verdicts[t].score) wins += 0.5;
    }
  }
  return wins / (static_cast<double>(true_count) * false_count);
}

TEST(JudgeEdges, FindsShortCircuitsOfAGeometricGraph) {
  Random random(81);
  const Index false_count = 60;
  const auto graph = with_false_edges(400, 0.09, false_count, random);
  for (const auto method : kMethods) {
    const auto result = judge_edges(graph, {.method = method});
    ASSERT_EQ(result.verdicts.size(), graph.edges().size());
    const double area = area_under_curve(result.verdicts, false_count);
    RecordProperty(std::string(enum_name(method)), std::to_string(area));
    EXPECT_GT(area, method == EdgeScore::resistance ? 0.95 : 0.97) << enum_name(method);
    std::int64_t found = 0;
    for (Index e = graph.edge_count() - false_count; e < graph.edge_count(); ++e) {
      if (result.verdicts[e].verdict == Verdict::prune) ++found;
    }
    EXPECT_GT(found, false_count * 8 / 10) << enum_name(method);
  }
}

/// Share of the true edges that heat prunes, and of the false ones that it leaves.
std::pair<double, double> heat_errors(const WeightedGraph& graph, Index false_count) {
  const auto verdicts = judge_edges(graph).verdicts;
  const Index true_count = graph.edge_count() - false_count;
  double pruned = 0.0, left = 0.0;
  for (Index e = 0; e < graph.edge_count(); ++e) {
    const bool prune = verdicts[e].verdict == Verdict::prune;
    if (e < true_count && prune) pruned += 1.0;
    if (e >= true_count && !prune) left += 1.0;
  }
  return {pruned / true_count, left / std::max<Index>(1, false_count)};
}

TEST(JudgeEdges, HeatWeighsPlacesUnlessToldNotTo) {
  Random random(93);
  const Index false_count = 120;
  const auto graph = with_false_edges(300, 0.1, false_count, random);
  const auto errors = [&](const JudgeEdgesOptions& options) {
    Index count = 0;
    for (const auto& verdict : judge_edges(graph, options).verdicts) {
      const bool is_false = verdict.edge >= graph.edge_count() - false_count;
      if ((verdict.verdict == Verdict::prune) != is_false) ++count;
    }
    return count;
  };
  EXPECT_LT(errors({}), errors({.places = false}));
}

TEST(JudgeEdges, HeatKeepsCleanGraphs) {
  Random random(82);
  EXPECT_LE(heat_errors(with_false_edges(800, 0.07, 0, random), 0).first, 0.003);
  EXPECT_EQ(heat_errors(grid_graph(30, 30), 0).first, 0.0);
  EXPECT_EQ(heat_errors(complete_graph(20), 0).first, 0.0);
  EXPECT_EQ(heat_errors(ring_graph(40), 0).first, 0.0);
}

TEST(JudgeEdges, HeatStandsAsManyFalseEdgesAsTrueOnes) {
  Random random(83);
  const Index true_count = with_false_edges(1000, 0.07, 0, random).edge_count();
  for (const Index false_count : {true_count / 10, true_count}) {
    const auto graph = with_false_edges(1000, 0.07, false_count, random);
    const auto [pruned, left] = heat_errors(graph, false_count);
    EXPECT_LT(pruned, 0.04) << false_count;
    EXPECT_LT(left, 0.02) << false_count;
    EXPECT_GT(
        area_under_curve(judge_edges(graph).verdicts, false_count),
        area_under_curve(judge_edges(graph, {.method = EdgeScore::jaccard}).verdicts, false_count));
  }
}

TEST(JudgeEdges, HeatFindsShortcutsWhereThereAreNoTriangles) {
  const auto grid = grid_graph(25, 25);
  std::vector<WeightedEdge> edges(grid.edges().begin(), grid.edges().end());
  Random random(84);
  while (edges.size() < grid.edges().size() + 20) {
    const Index from = random_vertex(random, 625), to = random_vertex(random, 625);
    // The diagonal of a square crosses nothing and could be a true edge.
    const auto steps = std::abs(from % 25 - to % 25) + std::abs(from / 25 - to / 25);
    if (steps > 2) edges.push_back({from, to, 1.0});
  }
  const WeightedGraph graph(625, std::move(edges));
  const auto [pruned, left] = heat_errors(graph, 20);
  EXPECT_LT(pruned, 0.001);
  EXPECT_LT(left, 0.1);
  EXPECT_NE(judge_edges(graph).verdicts[0].stage.find("crossings"), std::string::npos);
}

TEST(JudgeEdges, HeatBlamesNoEdgeOfALongChain) {
  // A grid, ten shortcuts, and a way through four more vertices that is one as well: at most
  // one of its five edges is false.
  const auto grid = grid_graph(20, 20);
  std::vector<WeightedEdge> edges(grid.edges().begin(), grid.edges().end());
  for (Index k = 0; k < 10; ++k) edges.push_back({84 + k, 210 + 11 * k, 1.0});
  const std::vector<Index> chain = {105, 400, 401, 402, 403, 294};
  for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
    edges.push_back({chain[k], chain[k + 1], 1.0});
  }
  const auto verdicts = judge_edges({404, edges}).verdicts;
  const auto first = verdicts.begin() + grid.edge_count();
  const auto pruned = [](const EdgeVerdict& v) { return v.verdict == Verdict::prune; };
  EXPECT_GE(std::count_if(first, first + 10, pruned), 8);
  EXPECT_EQ(std::count_if(first + 10, verdicts.end(), pruned), 0);
}

TEST(JudgeEdges, NearControlFindsShortCircuitsSideBySide) {
  // Two sheets, one above the other, and short circuits straight up.
  Random random(87);
  const auto sheet = with_false_edges(500, 0.09, 0, random);
  const auto both = disjoint_union(sheet, sheet);
  std::vector<WeightedEdge> edges(both.edges().begin(), both.edges().end());
  constexpr Index kShort = 25;
  for (Index k = 0; k < kShort; ++k) edges.push_back({20 * k, 20 * k + 500, 1.0});
  const auto verdicts = judge_edges({1000, edges}, {.control = ControlGroup::near}).verdicts;
  const auto pruned = [](const EdgeVerdict& v) { return v.verdict == Verdict::prune; };
  EXPECT_GE(std::count_if(verdicts.end() - kShort, verdicts.end(), pruned), 22);
  EXPECT_LE(std::count_if(verdicts.begin(), verdicts.end() - kShort, pruned),
            both.edge_count() / 100);
}

TEST(JudgeEdges, HeatDependsOnTheSeedAndNothingElse) {
  Random random(85);
  const auto graph = with_false_edges(300, 0.1, 50, random);
  const auto first = judge_edges(graph, {}, {}, {.threads = 1, .seed = 7});
  const auto second = judge_edges(graph, {}, {}, {.threads = 3, .seed = 7});
  for (std::size_t e = 0; e < first.verdicts.size(); ++e) {
    EXPECT_EQ(first.verdicts[e].score, second.verdicts[e].score);
    EXPECT_EQ(first.verdicts[e].verdict, second.verdicts[e].verdict);
  }
  EXPECT_EQ(first.threshold.value, second.threshold.value);
}

TEST(JudgeEdges, HeatTakesDegenerateGraphs) {
  Random random(86);
  const auto island = with_false_edges(200, 0.12, 10, random);
  EXPECT_EQ(judge_edges(disjoint_union(island, island)).verdicts.size(), 2 * island.edges().size());
  // Repeated edges do not vouch for each other.
  std::vector<WeightedEdge> twice;
  for (const auto& edge : island.edges()) {
    twice.push_back(edge);
    twice.push_back({edge.to, edge.from, edge.weight});
  }
  const auto once = judge_edges(island).verdicts;
  const auto both = judge_edges({200, twice}).verdicts;
  for (std::size_t e = 0; e < once.size(); ++e) {
    EXPECT_EQ(both[2 * e].verdict, once[e].verdict);
    EXPECT_EQ(both[2 * e + 1].verdict, once[e].verdict);
  }
  const auto wide = judge_edges(spread_weights(island, 600.0, random));
  for (const auto& verdict : wide.verdicts) EXPECT_FALSE(std::isnan(verdict.score));
  EXPECT_EQ(count(judge_edges(star_graph(50)).verdicts, Verdict::ambiguous), 49);
}

// A grid squeezed to ever smaller steps towards one side, with edges across it at the end.
struct Map {
  WeightedGraph graph;
  Eigen::MatrixXd positions;
};

Map squeezed_grid(Index width, const std::vector<std::pair<Index, Index>>& across) {
  const auto grid = grid_graph(width, width);
  std::vector<WeightedEdge> edges(grid.edges().begin(), grid.edges().end());
  for (const auto& [from, to] : across) edges.push_back({from, to, 1.0});
  Eigen::MatrixXd positions(2, width * width);
  for (Index v = 0; v < width * width; ++v) {
    positions.col(v) << std::exp(0.15 * (v % width)), std::exp(0.15 * (v / width));
  }
  return {{width * width, std::move(edges)}, std::move(positions)};
}

TEST(JudgeEdges, RankFindsWhatReachesPastOthers) {
  // The longest true edge is longer than some of the false ones.
  const auto [graph, positions] =
      squeezed_grid(30, {{0, 465}, {31, 680}, {62, 610}, {5, 455}, {400, 870}});
  const auto verdicts = judge_edges(graph, {.method = EdgeScore::rank}, positions).verdicts;
  const auto pruned = [](const EdgeVerdict& v) { return v.verdict == Verdict::prune; };
  EXPECT_EQ(std::count_if(verdicts.end() - 5, verdicts.end(), pruned), 5);
  EXPECT_EQ(std::count_if(verdicts.begin(), verdicts.end() - 5, pruned), 0);
  const auto [clean, same] = squeezed_grid(30, {});
  EXPECT_EQ(count(judge_edges(clean, {.method = EdgeScore::rank}, same).verdicts, Verdict::keep),
            clean.edge_count());
}

TEST(JudgeEdges, RankTakesDegenerateInputAndNeedsPositions) {
  const JudgeEdgesOptions rank = {.method = EdgeScore::rank};
  const auto graph = grid_graph(6, 6);
  const Eigen::MatrixXd heap = Eigen::MatrixXd::Zero(2, 36);
  EXPECT_EQ(count(judge_edges(graph, rank, heap).verdicts, Verdict::keep), graph.edge_count());
  EXPECT_EQ(judge_edges(complete_graph(5), rank, heap.leftCols(5)).verdicts.size(), 10);
  EXPECT_TRUE(judge_edges(WeightedGraph(), rank, Eigen::MatrixXd(2, 0)).verdicts.empty());
  const auto pair = judge_edges({2, {{0, 1, 1.0}, {1, 1, 1.0}}}, rank, heap.leftCols(2)).verdicts;
  EXPECT_EQ(pair[0].stage, "bridge");
  EXPECT_EQ(pair[1].stage, "self-loop");
  EXPECT_THROW(judge_edges(graph, rank), InvalidArgument);
  EXPECT_THROW(judge_edges(graph, rank, heap.leftCols(35)), InvalidArgument);
  EXPECT_THROW(judge_edges(graph, rank, heap.array() / 0.0), InvalidArgument);
}

TEST(ApplyVerdicts, LeavesOutPrunedAndIfAskedAmbiguousEdges) {
  const WeightedGraph graph(3, {{0, 1, 1.0}, {1, 2, 2.0}, {2, 0, 3.0}});
  EdgeVerdicts verdicts(3);
  verdicts[0].verdict = Verdict::prune;
  verdicts[2].verdict = Verdict::ambiguous;
  const auto kept = apply_verdicts(graph, verdicts, false);
  ASSERT_EQ(kept.edge_count(), 1);
  EXPECT_EQ(kept.edge(0).weight, 2.0);
  EXPECT_EQ(kept.vertex_count(), 3);
  EXPECT_EQ(apply_verdicts(graph, verdicts).edge_count(), 2);
  verdicts.pop_back();
  EXPECT_THROW(apply_verdicts(graph, verdicts), InvalidArgument);
}

TEST(JudgeEdges, BridgesAreAmbiguousAndSelfLoopsKept) {
  const WeightedGraph graph(
      7, {{0, 1, 1.0}, {1, 2, 1.0}, {2, 0, 1.0}, {2, 3, 1.0}, {4, 4, 1.0}, {5, 6, 2.0}});
  const Eigen::MatrixXd positions = Eigen::MatrixXd::Zero(2, 7);
  for (const auto method : kAllMethods) {
    const JudgeEdgesOptions options = {.method = method, .threshold = EdgeThreshold::mean_sigma};
    const auto verdicts = judge_edges(graph, options, positions).verdicts;
    EXPECT_EQ(verdicts[0].verdict, Verdict::keep) << enum_name(method);
    EXPECT_EQ(verdicts[4].stage, "self-loop");
    EXPECT_EQ(verdicts[4].verdict, Verdict::keep);
    EXPECT_EQ(verdicts[3].stage, "bridge") << enum_name(method);
    EXPECT_EQ(verdicts[5].verdict, Verdict::ambiguous) << enum_name(method);
  }
}

TEST(JudgeEdges, TheGraphSaysWhatABridgeIsWhateverTheWeights) {
  // Two complete graphs joined by one edge, which is given in both directions, or in one.
  for (const double weight : {1e-14, 1e-6, 1.0, 1e6, 1e14}) {
    const auto both = disjoint_union(complete_graph(10), complete_graph(10));
    std::vector<WeightedEdge> edges(both.edges().begin(), both.edges().end());
    edges.push_back({0, 10, weight});
    for (const auto method : kMethods) {
      const auto once = judge_edges({20, edges}, {.method = method}).verdicts;
      auto twice_edges = edges;
      twice_edges.push_back({10, 0, weight});
      const auto twice = judge_edges({20, twice_edges}, {.method = method}).verdicts;
      for (Index e = 0; e < both.edge_count(); ++e) {
        EXPECT_EQ(once[e].verdict, Verdict::keep) << enum_name(method) << ' ' << weight;
      }
      EXPECT_EQ(once.back().stage, "bridge") << enum_name(method) << ' ' << weight;
      EXPECT_EQ(twice[90].stage, "bridge");
      EXPECT_EQ(twice[91].stage, "bridge");
    }
  }
}

TEST(JudgeEdges, NoEdgeOfACycleIsABridge) {
  for (const double scale : {0.01, 1.0, 100.0, 1e6}) {
    const auto verdicts =
        judge_edges(ring_graph(60), {.method = EdgeScore::affinity, .scale = scale}).verdicts;
    for (const auto& verdict : verdicts) {
      EXPECT_EQ(verdict.verdict, Verdict::keep) << scale;
      EXPECT_TRUE(std::isfinite(verdict.score));
    }
  }
}

TEST(JudgeEdges, EveryMethodLeavesCleanGraphsWhole) {
  Random random(88);
  const auto tree = random_tree(60, random);
  const auto sheet = with_false_edges(500, 0.09, 0, random);
  for (const auto method : kMethods) {
    for (const auto& graph : {path_graph(51), tree, ring_graph(40), grid_graph(20, 20)}) {
      const auto verdicts = judge_edges(graph, {.method = method}).verdicts;
      EXPECT_EQ(apply_verdicts(graph, verdicts).edge_count(), graph.edge_count())
          << enum_name(method);
    }
    const auto verdicts = judge_edges(sheet, {.method = method}).verdicts;
    EXPECT_LE(count(verdicts, Verdict::prune), sheet.edge_count() / 200) << enum_name(method);
  }
}

TEST(JudgeEdges, FourFalseEdgesOfOneVertexAreFound) {
  // Four edges of one vertex lead to places far from each other: none vouches for another.
  Random random(90);
  const auto sheet = with_false_edges(300, 0.13, 0, random);
  const auto far = [&](Index v) {
    std::vector<Index> steps(300, -1), queue = {v};
    steps[v] = 0;
    for (std::size_t k = 0; k < queue.size(); ++k) {
      for (const auto& n : sheet.neighbours(queue[k])) {
        if (steps[n.vertex] >= 0) continue;
        steps[n.vertex] = steps[queue[k]] + 1;
        queue.push_back(n.vertex);
      }
    }
    return queue;  // from near to far
  };
  std::vector<WeightedEdge> edges(sheet.edges().begin(), sheet.edges().end());
  const auto order = far(0);
  for (const std::size_t place :
       {std::size_t{0}, order.size() / 3, 2 * order.size() / 3, order.size() - 1}) {
    edges.push_back({300, order[place], 1.0});
  }
  const auto verdicts = judge_edges({301, edges}).verdicts;
  const auto pruned = [](const EdgeVerdict& v) { return v.verdict == Verdict::prune; };
  EXPECT_EQ(std::count_if(verdicts.end() - 4, verdicts.end(), pruned), 4);
  EXPECT_LE(std::count_if(verdicts.begin(), verdicts.end() - 4, pruned), 2);
}

TEST(JudgeEdges, EveryMethodTakesItsThresholdFromWhatHeatMeasures) {
  // Common neighbours say nothing of a grid, and so prune nothing of it; affinity finds most.
  const auto grid = grid_graph(20, 20);
  std::vector<WeightedEdge> edges(grid.edges().begin(), grid.edges().end());
  for (Index k = 0; k < 12; ++k) edges.push_back({21 + 3 * k, 399 - 17 * k, 1.0});
  const WeightedGraph graph(400, edges);
  for (const auto method : {EdgeScore::jaccard, EdgeScore::common_neighbours}) {
    EXPECT_EQ(count(judge_edges(graph, {.method = method}).verdicts, Verdict::prune), 0);
  }
  for (const auto method : {EdgeScore::affinity, EdgeScore::heat_multiscale}) {
    const auto verdicts = judge_edges(graph, {.method = method}).verdicts;
    const auto pruned = [](const EdgeVerdict& v) { return v.verdict == Verdict::prune; };
    EXPECT_GE(std::count_if(verdicts.end() - 12, verdicts.end(), pruned), 8) << enum_name(method);
    EXPECT_LE(std::count_if(verdicts.begin(), verdicts.end() - 12, pruned), 4) << enum_name(method);
  }
}

TEST(JudgeEdges, WarnsOfImpreciseValues) {
  // Affinities of 1e-9 beside an absolute tolerance of 1e-9.
  const auto path = path_graph(30);
  std::vector<WeightedEdge> edges(path.edges().begin(), path.edges().end());
  edges.push_back({0, 29, 1.0});
  const auto result = judge_edges({30, edges}, {.method = EdgeScore::affinity, .scale = 0.1});
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_NE(result.warnings[0].find("of 30 heat affinities have bounds wider than 1e-6 relative"),
            std::string::npos)
      << result.warnings[0];
  const auto few = judge_edges(complete_graph(6), {.method = EdgeScore::resistance});
  EXPECT_TRUE(few.warnings.empty());
}

/// Points on a sheet, joined to their nearest neighbours; its layers, rolled up, are `layer` of
/// its length from each other, and short circuits join points that lie one above the other.
WeightedGraph rolled_sheet(Index count, Index short_circuits, Random& random) {
  constexpr double kLength = 10.0, kLayer = 2.5;
  constexpr Index kNeighbours = 7;
  std::vector<std::pair<double, double>> points(count);
  for (auto& point : points) point = {kLength * random.uniform(), random.uniform()};
  const auto nearest = [&](double x, double y, Index howmany) {
    std::vector<std::pair<double, Index>> found;
    for (Index v = 0; v < count; ++v) {
      found.emplace_back(std::hypot(points[v].first - x, points[v].second - y), v);
    }
    std::partial_sort(found.begin(), found.begin() + howmany, found.end());
    found.resize(howmany);
    return found;
  };
  std::vector<WeightedEdge> edges;
  std::set<std::pair<Index, Index>> known;
  const auto join = [&](Index from, Index to) {
    if (from != to && known.insert(std::minmax(from, to)).second) edges.push_back({from, to, 1.0});
  };
  for (Index v = 0; v < count; ++v) {
    const auto [x, y] = points[v];
    for (const auto& [distance, other] : nearest(x, y, kNeighbours + 1)) join(v, other);
  }
  for (const auto end = edges.size() + short_circuits; edges.size() < end;) {
    const Index from = random_vertex(random, count);
    const auto [x, y] = points[from];
    if (x + kLayer < kLength) join(from, nearest(x + kLayer, y, 1).front().second);
  }
  return {count, std::move(edges)};
}

TEST(JudgeEdges, HeatFindsShortCircuitsOfARolledSheetByDefault) {
  Random random(89);
  constexpr Index kShort = 50;
  const auto graph = rolled_sheet(1500, kShort, random);
  const auto [pruned, left] = heat_errors(graph, kShort);
  EXPECT_LT(pruned, 0.003);
  EXPECT_LT(left, 0.1);
  EXPECT_LE(heat_errors(rolled_sheet(1500, 0, random), 0).first, 0.001);
}

TEST(JudgeEdges, JaccardIndexByHand) {
  const WeightedGraph graph(5, {{0, 1, 1.0}, {0, 2, 1.0}, {2, 0, 1.0}, {1, 2, 1.0}, {1, 3, 1.0}});
  EXPECT_DOUBLE_EQ(jaccard_index(graph, 0), 0.5);  // common {2}, all {2, 3}
  EXPECT_DOUBLE_EQ(jaccard_index(graph, 4), 0.0);
  EXPECT_EQ(jaccard_index(path_graph(2), 0), -1.0);
}

TEST(JudgeEdges, EmptyGraphAndBadOptions) {
  EXPECT_TRUE(judge_edges(WeightedGraph()).verdicts.empty());
  EXPECT_TRUE(judge_edges(WeightedGraph(1, {})).verdicts.empty());
  EXPECT_THROW(judge_edges(path_graph(3), {.rounds = 0}), InvalidArgument);
  EXPECT_THROW(judge_edges(path_graph(3), {.chance = 1.0}), InvalidArgument);
  EXPECT_THROW(judge_edges(path_graph(3), {.scale = 0.0}), InvalidArgument);
  EXPECT_THROW(judge_edges(path_graph(3), {.konst = {std::nan("")}}), InvalidArgument);
  EXPECT_THROW(judge_edges(path_graph(3), {.tolerance = 0.0}), InvalidArgument);
  EXPECT_THROW(judge_edges(path_graph(3), {}, {}, {.threads = -1}), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::spectral
