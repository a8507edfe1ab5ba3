#include "isotherm/spectral/heat/heat_affinity.hpp"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/spectral/heat/heat_kernel.hpp"
#include "spectral/graphs.hpp"

namespace isotherm::spectral {
namespace {

using namespace isotherm_test;

const std::vector<double> kScales = {0.2, 1.0, 3.0, 40.0};
constexpr std::array kMethods = {HeatMethod::automatic, HeatMethod::lanczos, HeatMethod::rational};

double dense_affinity(const HeatKernel& kernel, VertexPair pair, double scale) {
  return kernel.entry(pair.from, pair.to, scale) /
         std::sqrt(kernel.entry(pair.from, pair.from, scale) *
                   kernel.entry(pair.to, pair.to, scale));
}

void expect_inside(const CertifiedValue& value, double exact) {
  EXPECT_LE(value.lower, exact + 1e-12);
  EXPECT_GE(value.upper, exact - 1e-12);
  EXPECT_NEAR(value.value, exact, 1e-4);
}

TEST(HeatAffinity, AgreesWithTheDenseKernel) {
  Random random(71);
  for (const auto& graph : {random_geometric(60, 0.3, random), loopy_path(60, 12, random),
                            disjoint_union(grid_graph(5, 5), path_graph(6))}) {
    const HeatKernel kernel{Laplacian(graph)};
    auto pairs = edge_pairs(graph);
    pairs.push_back({0, 3});
    pairs.push_back({2, graph.vertex_count() - 1});
    for (const auto method : kMethods) {
      const auto result = heat_affinities(graph, pairs, kScales, {.method = method});
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        for (std::size_t s = 0; s < kScales.size(); ++s) {
          expect_inside(result.at(k, s), dense_affinity(kernel, pairs[k], kScales[s]));
        }
      }
      EXPECT_LT(result.widest, 1e-3);
    }
  }
}

TEST(HeatAffinity, LeaveOneOutIsTheGraphWithoutTheEdge) {
  Random random(72);
  auto base = spread_weights(random_geometric(40, 0.35, random), 1.0, random);
  std::vector<WeightedEdge> edges(base.edges().begin(), base.edges().end());
  edges.push_back({edges[0].to, edges[0].from, 0.7});  // parallel to the first
  const WeightedGraph graph(base.vertex_count(), edges);
  std::vector<Index> ids(edges.size());
  std::iota(ids.begin(), ids.end(), 0);
  for (const auto method : kMethods) {
    const auto result = leave_one_out_affinities(graph, ids, kScales, {.method = method});
    for (Index e = 0; e < graph.edge_count(); e += (e == 0 ? 1 : 13)) {
      std::vector<bool> keep(edges.size(), true);
      keep[e] = false;
      const HeatKernel kernel{Laplacian(filter_edges(graph, keep))};
      for (std::size_t s = 0; s < kScales.size(); ++s) {
        expect_inside(result.at(e, s),
                      dense_affinity(kernel, {edges[e].from, edges[e].to}, kScales[s]));
      }
    }
  }
}

TEST(HeatAffinity, DegenerateEdgesAndPairs) {
  const WeightedGraph graph(5, {{0, 1, 1.0}, {1, 1, 2.0}, {2, 3, 1.0}});
  const std::vector<VertexPair> pairs = {{2, 2}, {0, 2}, {4, 0}};
  const auto result = heat_affinities(graph, pairs, kScales);
  EXPECT_EQ(result.at(0, 0).value, 1.0);
  EXPECT_NEAR(result.at(1, 1).value, 0.0, 1e-5);
  EXPECT_NEAR(result.at(2, 1).value, 0.0, 1e-5);
  for (const auto method : kMethods) {
    const auto left_out =
        leave_one_out_affinities(graph, std::vector<Index>{0, 1}, kScales, {.method = method});
    EXPECT_NEAR(left_out.at(0, 2).value, 0.0, 1e-5);
    EXPECT_EQ(left_out.at(1, 2).value, 1.0);
  }
  EXPECT_THROW(leave_one_out_affinities(graph, std::vector<Index>{3}, kScales), InvalidArgument);
  EXPECT_EQ(result.column(0).size(), 3u);
}

}  // namespace
}  // namespace isotherm::spectral
