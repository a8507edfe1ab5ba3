#include "isotherm/spectral/judge_edges.hpp"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "graphs.hpp"
#include "isotherm/base/error.hpp"

namespace isotherm::spectral {
namespace {

using namespace isotherm_test;

constexpr std::array kMethods = {EdgeScore::heat, EdgeScore::resistance, EdgeScore::jaccard};

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
    // Resistance says little where neighbourhoods are dense (von Luxburg et al. 2014).
    if (method == EdgeScore::resistance) {
      EXPECT_GT(area, 0.75);
      continue;
    }
    EXPECT_GT(area, 0.97) << enum_name(method);
    std::int64_t found = 0;
    for (Index e = graph.edge_count() - false_count; e < graph.edge_count(); ++e) {
      if (result.verdicts[e].verdict == Verdict::prune) ++found;
    }
    EXPECT_GT(found, false_count * 8 / 10) << enum_name(method);
  }
}

TEST(JudgeEdges, BridgesAreAmbiguousAndSelfLoopsKept) {
  const WeightedGraph graph(
      7, {{0, 1, 1.0}, {1, 2, 1.0}, {2, 0, 1.0}, {2, 3, 1.0}, {4, 4, 1.0}, {5, 6, 2.0}});
  for (const auto method : kMethods) {
    const JudgeEdgesOptions options = {
        .method = method, .threshold = ThresholdRule::mean_sigma, .konst = 3.0};
    const auto verdicts = judge_edges(graph, options).verdicts;
    EXPECT_EQ(verdicts[0].verdict, Verdict::keep) << enum_name(method);
    EXPECT_EQ(verdicts[4].stage, "self-loop");
    EXPECT_EQ(verdicts[4].verdict, Verdict::keep);
    EXPECT_EQ(verdicts[5].verdict, Verdict::ambiguous) << enum_name(method);
  }
  for (const auto method : {EdgeScore::heat, EdgeScore::resistance}) {
    EXPECT_EQ(judge_edges(graph, {.method = method}).verdicts[3].stage, "bridge");
  }
}

TEST(JudgeEdges, JaccardIndexByHand) {
  const WeightedGraph graph(5, {{0, 1, 1.0}, {0, 2, 1.0}, {2, 0, 1.0}, {1, 2, 1.0}, {1, 3, 1.0}});
  EXPECT_DOUBLE_EQ(jaccard_index(graph, 0), 0.5);  // common {2}, all {2, 3}
  EXPECT_DOUBLE_EQ(jaccard_index(graph, 4), 0.0);
  EXPECT_EQ(jaccard_index(path_graph(2), 0), -1.0);
}

TEST(JudgeEdges, EmptyGraphAndBadOptions) {
  EXPECT_TRUE(judge_edges(WeightedGraph()).verdicts.empty());
  EXPECT_THROW(judge_edges(path_graph(3), {.scale = 0.0}), InvalidArgument);
  EXPECT_THROW(judge_edges(path_graph(3), {.konst = std::nan("")}), InvalidArgument);
  EXPECT_THROW(judge_edges(path_graph(3), {.tolerance = 0.0}), InvalidArgument);
  EXPECT_THROW(judge_edges(path_graph(3), {.threads = -1}), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::spectral
