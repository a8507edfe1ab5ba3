#include <cmath>

#include <gtest/gtest.h>

#include "distributed/heat/heat_queries.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/spectral/heat/heat_kernel.hpp"
#include "spectral/distributed/ranks.hpp"

namespace isotherm::spectral {
namespace {

using namespace isotherm_test;

const std::vector<double> kScales = {100, 70, 10, 5, 1, 0.1, 0.001};

std::vector<VertexPair> random_pairs(Index n, int count, Random& random) {
  std::vector<VertexPair> pairs;
  for (int k = 0; k < count; ++k) {
    pairs.push_back({random_vertex(random, n), random_vertex(random, n)});
  }
  return pairs;
}

/// Whether a bracket holds what a dense eigendecomposition gives, up to what that is off.
void expect_holds(const CertifiedValue& value, double exact) {
  constexpr double kOracle = 1e-13;
  EXPECT_LE(value.lower, exact + kOracle);
  EXPECT_GE(value.upper, exact - kOracle);
  EXPECT_LE(value.lower, value.value);
  EXPECT_LE(value.value, value.upper);
}

TEST(DistributedHeat, BracketsHoldTheExactValue) {
  Random random(7);
  std::size_t checked = 0;
  for (const auto& shape : joined_shapes(random)) {
    for (const double decades : {0.0, 8.0}) {
      const auto graph = spread_weights(shape, decades, random);
      const auto parts = distribute(graph);
      const HeatKernel oracle{Laplacian(graph)};
      for (const double tolerance : {1e-3, 1e-6, 1e-8}) {
        const auto pairs = random_pairs(graph.vertex_count(), 120, random);
        const auto mine = share(std::span<const VertexPair>(pairs));
        const auto result =
            distributed::heat_distances(parts, mine, kScales, {.tolerance = tolerance});
        checked += pairs.size() * kScales.size();
        for (std::size_t k = 0; k < mine.size(); ++k) {
          for (std::size_t s = 0; s < kScales.size(); ++s) {
            expect_holds(result.at(k, s), oracle.distance(mine[k], kScales[s]));
          }
        }
      }
    }
  }
  EXPECT_GE(checked, 10000u);
}

TEST(DistributedHeat, BracketsOfVectorsOverAllRanksHoldTheExactValue) {
  Random random(9);
  const auto shape = joined_shapes(random).front();
  for (const double decades : {0.0, 8.0}) {
    const auto graph = spread_weights(shape, decades, random);
    const auto parts = distribute(graph);
    const auto& state = parts.state();  // small graphs are not partitioned: rows are positions
    const HeatKernel oracle{Laplacian(graph)};
    std::vector<distributed::detail::HeatQuery> queries;
    std::vector<std::size_t> which;
    for (const auto& pair : random_pairs(graph.vertex_count(), 40, random)) {
      if (!state.owns(pair.from) || pair.from == pair.to) continue;
      which.push_back(queries.size());
      queries.push_back({pair, std::vector<CertifiedValue>(kScales.size()), 0});
    }
    const detail::HeatGoal goal{kScales, 1e-7, {}, 1000};
    const ProgressCallback nobody;
    distributed::detail::answer_everywhere(state, goal, {state.comm(), nobody}, which, queries);
    for (const auto& query : queries) {
      for (std::size_t s = 0; s < kScales.size(); ++s) {
        expect_holds(query.values[s], oracle.distance(query.rows, kScales[s]));
      }
    }
  }
}

TEST(DistributedHeat, AgreesWithOneMachineNearbyAndEverywhere) {
  Random random(8);
  // A mesh is reached as a whole at the largest scale, a path is not.
  const auto mesh = grid_graph(50, 50);
  const auto graph = relabel(disjoint_union(mesh, loopy_path(2500, 100, random)),
                             random_permutation(5000, random));
  auto pairs = random_pairs(5000, 10, random);
  for (Index e = 0; e < graph.edge_count(); e += 300) {
    pairs.push_back({graph.edge(e).from, graph.edge(e).to});
  }
  const std::vector<double> scales = {300, 10, 1};
  const auto serial = heat_distances(graph, pairs, scales, {.tolerance = 1e-7});
  const auto mine = share(std::span<const VertexPair>(pairs));
  const auto result =
      distributed::heat_distances(distribute(graph), mine, scales, {.tolerance = 1e-7});
  EXPECT_EQ(result.unconverged, 0);
  EXPECT_LE(result.widest, 1e-7);
  for (std::size_t k = 0; k < mine.size(); ++k) {
    for (std::size_t s = 0; s < scales.size(); ++s) {
      EXPECT_LE(result.at(k, s).lower, serial.at(share_begin(pairs) + k, s).upper);
      EXPECT_GE(result.at(k, s).upper, serial.at(share_begin(pairs) + k, s).lower);
    }
  }
}

TEST(DistributedHeat, ReportsWhatHasNotConverged) {
  const auto graph = path_graph(120);
  const std::vector<VertexPair> pairs = {{50, 51}, {10, 110}};
  const std::vector<double> scales = {1000.0};
  const auto result = distributed::heat_distances(
      distribute(graph), share(std::span<const VertexPair>(pairs)), scales, {.max_steps = 5});
  EXPECT_EQ(result.unconverged, 2);
}

TEST(DistributedHeat, DegeneratePairsAndScales) {
  const auto graph = distribute(disjoint_union(path_graph(3), WeightedGraph(2, {})));
  const std::vector<VertexPair> pairs = {{1, 1}, {3, 4}, {0, 3}};
  const std::vector<double> scales = {0.0, 2.0};
  const auto result = distributed::heat_distances(graph, pairs, scales, {.tolerance = 1e-10});
  EXPECT_EQ(result.at(0, 1).value, 0.0);
  EXPECT_NEAR(result.at(1, 1).value, 2.0, 1e-10);
  EXPECT_NEAR(result.at(2, 0).value, 2.0, 1e-10);
  const double corner = 1.0 / 3 + std::exp(-2.0) / 2 + std::exp(-6.0) / 6;
  EXPECT_NEAR(result.at(2, 1).value, 1.0 + corner, 1e-10);
  EXPECT_TRUE(distributed::heat_distances(graph, {}, scales).values.empty());
  EXPECT_TRUE(distributed::heat_distances(graph, pairs, {}).values.empty());
  const std::vector<VertexPair> outside = {{0, 5}};
  EXPECT_THROW(distributed::heat_distances(graph, outside, scales), InvalidArgument);
}

TEST(DistributedHeat, EndsOnAllRanksWhereOneIsToEnd) {
  const auto graph = distribute(grid_graph(40, 40));
  const std::vector<VertexPair> pairs = {{0, 1}, {5, 700}};
  const int last = session().size() - 1;
  HeatDistanceOptions options;
  options.progress = [last](const Progress&) { return session().rank() != last; };
  EXPECT_THROW(distributed::heat_distances(graph, pairs, kScales, options), Cancelled);
}

}  // namespace
}  // namespace isotherm::spectral
