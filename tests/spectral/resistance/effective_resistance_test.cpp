#include "isotherm/spectral/resistance/effective_resistance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/QR>
#include <boost/multiprecision/cpp_bin_float.hpp>

#include "isotherm/base/error.hpp"
#include "isotherm/spectral/graph/laplacian.hpp"
#include "isotherm/spectral/sparse/laplacian_solver.hpp"
#include "spectral/graphs.hpp"

namespace isotherm::spectral {
namespace {

using namespace isotherm_test;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Eigen::MatrixXd pseudo_inverse(const WeightedGraph& graph) {
  return Eigen::MatrixXd(Laplacian(graph).matrix())
      .completeOrthogonalDecomposition()
      .pseudoInverse();
}

TEST(EffectiveResistance, ClosedForms) {
  for (const double r : edge_resistances(path_graph(40, 4.0)).values) EXPECT_NEAR(r, 0.25, 1e-13);
  for (const double r : edge_resistances(star_graph(9)).values) EXPECT_NEAR(r, 1.0, 1e-13);
  for (const double r : edge_resistances(ring_graph(12)).values) EXPECT_NEAR(r, 11.0 / 12, 1e-13);
  for (const double r : edge_resistances(complete_graph(80)).values) {
    EXPECT_NEAR(r, 2.0 / 80, 1e-14);
  }
  const std::vector<VertexPair> far = {{3, 30}, {39, 0}};
  const auto path = effective_resistances(path_graph(40), far);
  EXPECT_NEAR(path.values[0], 27.0, 1e-12);
  EXPECT_NEAR(path.values[1], 39.0, 1e-12);
}

TEST(EffectiveResistance, AgreesWithTheDensePseudoInverse) {
  Random random(51);
  for (int round = 0; round < 6; ++round) {
    for (const auto& graph :
         {loopy_path(80, 25, random), grid_graph(11, 9), random_geometric(90, 0.3, random),
          random_tree(50, random), complete_graph(50)}) {
      const auto weighted = spread_weights(graph, round, random);
      const auto result = edge_resistances(weighted);
      if (connected_components(weighted).count > 1) continue;
      const auto inverse = pseudo_inverse(weighted);
      for (Index e = 0; e < weighted.edge_count(); ++e) {
        const auto& edge = weighted.edge(e);
        const double expected = inverse(edge.from, edge.from) + inverse(edge.to, edge.to) -
                                2.0 * inverse(edge.from, edge.to);
        EXPECT_NEAR(result.values[e], expected, 1e-9 * inverse.diagonal().maxCoeff());
      }
      EXPECT_LT(result.residual, 1e-9);
    }
  }
}

TEST(EffectiveResistance, LargeMeshesAgreeWithSolves) {
  const auto graph = grid_graph(70, 60);
  LaplacianSolver solver{Laplacian(graph)};
  const auto pairs = edge_pairs(graph);
  const auto result = effective_resistances(graph, pairs);
  for (std::size_t k = 0; k < pairs.size(); k += 997) {
    Eigen::VectorXd b = Eigen::VectorXd::Zero(graph.vertex_count());
    b[pairs[k].from] = 1.0;
    b[pairs[k].to] = -1.0;
    EXPECT_NEAR(result.values[k], b.dot(solver.solve(b)), 1e-12);
  }
}

TEST(EffectiveResistance, FostersTheorem) {
  // The sum of w R over the edges is n less the number of components.
  Random random(52);
  const auto graph = spread_weights(
      disjoint_union(loopy_path(300, 90, random), random_geometric(120, 0.2, random)), 8.0, random);
  const auto result = edge_resistances(graph);
  double sum = 0.0;
  for (Index e = 0; e < graph.edge_count(); ++e) sum += graph.edge(e).weight * result.values[e];
  EXPECT_NEAR(sum, graph.vertex_count() - connected_components(graph).count, 1e-6);
}

TEST(EffectiveResistance, ComponentsSelfLoopsAndParallelEdges) {
  const WeightedGraph graph(5, {{0, 1, 1.0}, {1, 0, 3.0}, {2, 2, 1.0}, {2, 3, 0.5}});
  const auto edges = edge_resistances(graph);
  EXPECT_DOUBLE_EQ(edges.values[0], 0.25);
  EXPECT_DOUBLE_EQ(edges.values[1], 0.25);
  EXPECT_EQ(edges.values[2], 0.0);
  EXPECT_DOUBLE_EQ(edges.values[3], 2.0);
  const std::vector<VertexPair> pairs = {{0, 2}, {4, 4}, {4, 3}};
  const auto others = effective_resistances(graph, pairs);
  EXPECT_EQ(others.values[0], kInfinity);
  EXPECT_EQ(others.values[1], 0.0);
  EXPECT_EQ(others.values[2], kInfinity);
  EXPECT_TRUE(edge_resistances(WeightedGraph()).values.empty());
  EXPECT_TRUE(edge_resistances(WeightedGraph(3, {})).values.empty());
  const std::vector<VertexPair> outside = {{0, 5}};
  EXPECT_THROW(effective_resistances(graph, outside), InvalidArgument);
}

TEST(EffectiveResistance, CommuteTimeIsResistanceTimesVolume) {
  const auto graph = disjoint_union(path_graph(5), ring_graph(4));
  const std::vector<VertexPair> pairs = {{0, 4}, {5, 6}, {0, 5}, {1, 1}};
  const auto times = commute_times(graph, pairs);
  EXPECT_NEAR(times.values[0], 8.0 * 4.0, 1e-12);
  EXPECT_NEAR(times.values[1], 8.0 * 0.75, 1e-12);
  EXPECT_EQ(times.values[2], kInfinity);
  EXPECT_EQ(times.values[3], 0.0);
}

using Exact = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<80>>;

/// The conductance between two vertices of a graph, by eliminating all others one after the
/// other in 80 digits; `without` is left out.
Exact exact_conductance(const WeightedGraph& graph, VertexPair pair, Index without = -1) {
  const Index n = graph.vertex_count();
  std::vector<std::vector<Exact>> mesh(n, std::vector<Exact>(n, 0));
  for (Index e = 0; e < graph.edge_count(); ++e) {
    const auto& edge = graph.edge(e);
    if (e == without || edge.from == edge.to) continue;
    mesh[edge.from][edge.to] += edge.weight;
    mesh[edge.to][edge.from] += edge.weight;
  }
  for (Index v = 0; v < n; ++v) {
    if (v == pair.from || v == pair.to) continue;
    Exact sum = 0;
    for (Index a = 0; a < n; ++a) sum += mesh[v][a];
    if (sum == 0) continue;
    for (Index a = 0; a < n; ++a) {
      if (mesh[v][a] == 0) continue;
      for (Index b = 0; b < n; ++b) {
        if (a != b) mesh[a][b] += mesh[v][a] * mesh[v][b] / sum;
      }
    }
    for (Index a = 0; a < n; ++a) mesh[v][a] = mesh[a][v] = 0;
  }
  return mesh[pair.from][pair.to];
}

void expect_within_bound(double value, const Exact& conductance, double bound) {
  if (conductance == 0) {
    EXPECT_EQ(value, kInfinity);
    return;
  }
  const Exact error = abs(Exact(value) * conductance - 1);
  EXPECT_LE(static_cast<double>(error), bound) << value;
}

TEST(EffectiveResistance, IsWithinItsBoundForWeightsOverSixteenDecades) {
  Random random(54);
  for (int round = 0; round < 4; ++round) {
    for (const auto& plain : {loopy_path(24, 14, random), grid_graph(5, 5), complete_graph(12),
                              random_geometric(26, 0.4, random)}) {
      const auto graph = spread_weights(plain, 16.0, random);
      auto pairs = edge_pairs(graph);
      for (int k = 0; k < 10; ++k) {
        const Index n = graph.vertex_count();
        pairs.push_back({random_vertex(random, n), random_vertex(random, n)});
      }
      const auto result = effective_resistances(graph, pairs);
      EXPECT_LT(result.bound, 1e-12);
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        if (pairs[k].from == pairs[k].to) continue;
        expect_within_bound(result.values[k], exact_conductance(graph, pairs[k]), result.bound);
      }
    }
  }
}

TEST(EffectiveResistance, TwoCliquesAndABridgeOfAnyWeight) {
  const auto both = disjoint_union(complete_graph(10), complete_graph(10));
  for (const double weight : {1e-14, 1e-7, 1e-6, 1.0, 1e6, 1e7, 1e14}) {
    std::vector<WeightedEdge> edges(both.edges().begin(), both.edges().end());
    edges.push_back({0, 10, weight});
    const auto result = edge_resistances({20, edges});
    for (Index e = 0; e < both.edge_count(); ++e) {
      EXPECT_NEAR(result.values[e], 0.2, 1e-14) << weight;
      EXPECT_NEAR(result.without[e], 0.25, 1e-14) << weight;
    }
    EXPECT_NEAR(result.values.back() * weight, 1.0, 1e-14);
    EXPECT_EQ(result.without.back(), kInfinity);
  }
}

TEST(EffectiveResistance, WithoutAnEdgeIsThatOfTheRestInEightyDigits) {
  Random random(55);
  const auto graph = spread_weights(loopy_path(25, 20, random), 16.0, random);
  const auto result = edge_resistances(graph);
  for (Index e = 0; e < graph.edge_count(); ++e) {
    const auto& edge = graph.edge(e);
    if (edge.from == edge.to) continue;
    const auto parallel =
        std::count_if(graph.edges().begin(), graph.edges().end(), [&](const WeightedEdge& other) {
          return std::minmax(other.from, other.to) == std::minmax(edge.from, edge.to);
        });
    if (parallel > 1) continue;
    expect_within_bound(result.without[e], exact_conductance(graph, {edge.from, edge.to}, e),
                        result.bound);
  }
}

TEST(EffectiveResistance, LeaveOneOut) {
  Random random(53);
  const auto graph = spread_weights(ring_graph(20), 2.0, random);
  const auto resistances = edge_resistances(graph).values;
  for (Index e = 0; e < graph.edge_count(); ++e) {
    std::vector<bool> keep(graph.edges().size(), true);
    keep[e] = false;
    const std::vector<VertexPair> pair = {{graph.edge(e).from, graph.edge(e).to}};
    const double without = effective_resistances(filter_edges(graph, keep), pair).values[0];
    EXPECT_NEAR(leave_one_out_resistance(resistances[e], graph.edge(e).weight), without,
                1e-8 * without);
  }
  EXPECT_EQ(leave_one_out_resistance(0.5, 2.0), kInfinity);
}

}  // namespace
}  // namespace isotherm::spectral
