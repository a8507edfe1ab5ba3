#include <cmath>

#include <gtest/gtest.h>

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

/// Brackets of this rank's pairs hold what a dense eigendecomposition gives. Returns how many
/// values there are over all ranks.
std::size_t check_distances(const WeightedGraph& graph, const std::vector<VertexPair>& pairs,
                            double tolerance) {
  constexpr double kOracle = 1e-13;  // error of the dense solver in values up to 2
  const HeatKernel oracle{Laplacian(graph)};
  const auto mine = share(std::span<const VertexPair>(pairs));
  const auto result =
      distributed::heat_distances(distribute(graph), mine, kScales, {.tolerance = tolerance});
  for (std::size_t k = 0; k < mine.size(); ++k) {
    for (std::size_t s = 0; s < kScales.size(); ++s) {
      const auto& value = result.at(k, s);
      const double exact = oracle.distance(mine[k], kScales[s]);
      EXPECT_LE(value.lower, exact + kOracle);
      EXPECT_GE(value.upper, exact - kOracle);
      EXPECT_LE(value.lower, value.value);
      EXPECT_LE(value.value, value.upper);
    }
  }
  return pairs.size() * kScales.size();
}

TEST(DistributedHeat, BracketsHoldTheExactValue) {
  Random random(7);
  std::size_t checked = 0;
  for (int round = 0; round < 3; ++round) {
    for (const auto& shape : shapes(random)) {
      for (const double decades : {0.0, 8.0}) {
        const auto graph = spread_weights(shape, decades, random);
        for (const double tolerance : {1e-3, 1e-6, 1e-8}) {
          checked +=
              check_distances(graph, random_pairs(graph.vertex_count(), 20, random), tolerance);
        }
      }
    }
  }
  EXPECT_GE(checked, 10000u);
}

TEST(DistributedHeat, AgreesWithOneMachineNearbyAndEverywhere) {
  Random random(8);
  // A mesh is reached as a whole at the largest scale, a path is not.
  const auto mesh = grid_graph(50, 50);
  const auto graph = relabel(disjoint_union(mesh, loopy_path(2500, 100, random)),
                             random_permutation(5000, random));
  auto pairs = random_pairs(5000, 30, random);
  for (Index e = 0; e < graph.edge_count(); e += 50) {
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
