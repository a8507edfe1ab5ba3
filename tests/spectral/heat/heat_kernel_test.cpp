#include "isotherm/spectral/heat/heat_kernel.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/spectral/eigen/embedding.hpp"
#include "spectral/graphs.hpp"

namespace isotherm::spectral {
namespace {

using namespace isotherm_test;

TEST(HeatKernel, RowsSumToOneAndTimeZeroIsTheIdentity) {
  Random random(41);
  const HeatKernel kernel(
      Laplacian(disjoint_union(random_geometric(40, 0.3, random), path_graph(5))));
  EXPECT_TRUE(kernel.matrix(0.0).isIdentity(1e-12));
  const Eigen::MatrixXd heat = kernel.matrix(1.7);
  EXPECT_TRUE(heat.rowwise().sum().isOnes(1e-12));
  EXPECT_GT(heat.minCoeff(), -1e-14);
  EXPECT_NEAR(kernel.entry(3, 9, 1.7), heat(3, 9), 1e-14);
  EXPECT_TRUE(kernel.signature(1.7).isApprox(heat.diagonal(), 1e-12));
}

TEST(HeatKernel, IsASemigroup) {
  const HeatKernel kernel{Laplacian(grid_graph(6, 5))};
  EXPECT_TRUE((kernel.matrix(0.4) * kernel.matrix(1.1)).isApprox(kernel.matrix(1.5), 1e-12));
}

TEST(HeatKernel, DistanceIsTheEmbeddingsDistance) {
  Random random(42);
  const HeatKernel kernel(Laplacian(loopy_path(50, 9, random)));
  const auto rows = heat_embedding(kernel.eigen(), 3.0);
  for (int round = 0; round < 20; ++round) {
    const VertexPair pair = {random_vertex(random, 50), random_vertex(random, 50)};
    const double squared = (rows.row(pair.from) - rows.row(pair.to)).squaredNorm();
    EXPECT_NEAR(kernel.distance(pair, 3.0), squared, 1e-13);
    EXPECT_NEAR(kernel.distance(pair, 3.0),
                kernel.entry(pair.from, pair.from, 3.0) + kernel.entry(pair.to, pair.to, 3.0) -
                    2.0 * kernel.entry(pair.from, pair.to, 3.0),
                1e-13);
  }
}

TEST(HeatKernel, TruncationHidesNoMoreThanItsRemainder) {
  Random random(43);
  const Laplacian laplacian(loopy_path(120, 15, random));
  const HeatKernel full(laplacian);
  const HeatKernel truncated(
      smallest_eigenpairs(laplacian, {.count = 20, .method = EigenMethod::shift_invert}));
  for (int round = 0; round < 30; ++round) {
    const VertexPair pair = {random_vertex(random, 120), random_vertex(random, 120)};
    for (const double scale : {0.1, 1.0, 30.0}) {
      const double hidden = full.distance(pair, scale) - truncated.distance(pair, scale);
      EXPECT_GE(hidden, -1e-10);
      EXPECT_LE(hidden, truncated.remainder(pair, scale) + 1e-10);
    }
    EXPECT_EQ(full.remainder(pair, 1.0), 0.0);
  }
}

TEST(HeatKernel, LocalLanczosAgrees) {
  Random random(44);
  const auto graph = loopy_path(200, 30, random);
  const HeatKernel kernel{Laplacian(graph)};
  const auto pairs = edge_pairs(graph);
  const std::vector<double> scales = {0.001, 1.0, 100.0};
  const auto result = heat_distances(graph, pairs, scales, {.tolerance = 1e-9});
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    for (std::size_t s = 0; s < scales.size(); ++s) {
      EXPECT_NEAR(result.at(k, s).value, kernel.distance(pairs[k], scales[s]), 1e-9);
    }
  }
}

TEST(Embedding, CommuteTimeDistancesAreResistances) {
  // On a path the resistance between two vertices is their distance.
  const auto eigen = HeatKernel(Laplacian(path_graph(30))).eigen();
  const auto rows = commute_time_embedding(eigen);
  ASSERT_EQ(rows.cols(), 29);
  EXPECT_NEAR((rows.row(4) - rows.row(21)).squaredNorm(), 17.0, 1e-10);
  EXPECT_EQ(laplacian_eigenmap(eigen).cols(), 29);
}

TEST(Embedding, HeatDistancesIntegrateToTheResistance) {
  Random random(45);
  const auto graph = spread_weights(random_geometric(40, 0.35, random), 2.0, random);
  ASSERT_EQ(connected_components(graph).count, 1);
  const HeatKernel kernel{Laplacian(graph)};
  const auto rows = commute_time_embedding(kernel.eigen());
  for (int round = 0; round < 10; ++round) {
    const VertexPair pair = {random_vertex(random, 40), random_vertex(random, 40)};
    // Trapezoids in log t are spectrally accurate for what decays at both ends.
    const double step = 0.02;
    double integral = 0.0;
    for (double log_scale = -35.0; log_scale < 12.0; log_scale += step) {
      const double scale = std::exp(log_scale);
      integral += step * scale * kernel.distance(pair, scale);
    }
    const double resistance = (rows.row(pair.from) - rows.row(pair.to)).squaredNorm();
    EXPECT_NEAR(integral, resistance, 1e-9 * (1.0 + resistance));
  }
}

TEST(Embedding, RejectsABadScale) {
  const HeatKernel kernel{Laplacian(path_graph(3))};
  EXPECT_THROW(heat_embedding(kernel.eigen(), -1.0), InvalidArgument);
  EXPECT_THROW(heat_embedding(kernel.eigen(), std::numeric_limits<double>::infinity()),
               InvalidArgument);
}

}  // namespace
}  // namespace isotherm::spectral
