#include "edges/space/classical_scaling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Spectra/MatOp/DenseSymMatProd.h>
#include <Spectra/SymEigsSolver.h>

namespace isotherm::spectral::detail {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Vertex by vertex in the order of their steps, from a list for each number of them (Dial 1969).
Eigen::VectorXd steps_from(const WeightedGraph& graph, std::span<const double> lengths,
                           std::span<const double> trust, Index start) {
  Eigen::VectorXd steps = Eigen::VectorXd::Constant(graph.vertex_count(), kFar);
  steps[start] = 0.0;
  std::vector<std::vector<Index>> rims = {{start}};
  for (std::size_t reached = 0; reached < rims.size(); ++reached) {
    const auto rim = std::move(rims[reached]);
    for (const Index vertex : rim) {
      if (static_cast<double>(reached) > steps[vertex]) continue;
      for (const auto& [other, edge] : graph.neighbours(vertex)) {
        const double next = steps[vertex] + lengths[edge];
        if (trust[edge] == 0.0 || next >= steps[other]) continue;
        steps[other] = next;
        const auto place = static_cast<std::size_t>(next);
        if (place >= rims.size()) rims.resize(place + 1);
        rims[place].push_back(other);
      }
    }
  }
  return steps;
}

}  // namespace

Eigen::MatrixXd steps_between(const WeightedGraph& graph, std::span<const double> lengths,
                              std::span<const double> trust) {
  const Index count = graph.vertex_count();
  Eigen::MatrixXd steps(count, count);
  for (Index v = 0; v < count; ++v) steps.col(v) = steps_from(graph, lengths, trust, v);
  double longest = 0.0;
  for (const double distance : steps.reshaped()) {
    if (distance < kFar) longest = std::max(longest, distance);
  }
  for (double& distance : steps.reshaped()) distance = std::min(distance, longest + 1.0);
  return steps;
}

Eigen::MatrixXd classical_scaling(const Eigen::MatrixXd& distances, Eigen::Index dimension) {
  Eigen::MatrixXd products = -0.5 * distances.cwiseAbs2();
  products.rowwise() -= products.colwise().mean().eval();
  products.colwise() -= products.rowwise().mean().eval();
  Spectra::DenseSymMatProd<double> product(products);
  const Eigen::Index kept = std::min(distances.rows(), 2 * dimension + 20);
  Spectra::SymEigsSolver solver(product, dimension, kept);
  solver.init();
  solver.compute(Spectra::SortRule::LargestAlge);
  Eigen::MatrixXd places = Eigen::MatrixXd::Zero(dimension, distances.rows());
  for (Eigen::Index k = 0; k < solver.eigenvalues().size(); ++k) {
    places.row(k) = std::sqrt(std::max(0.0, solver.eigenvalues()[k])) *
                    solver.eigenvectors().col(k).transpose();
  }
  return places;
}

}  // namespace isotherm::spectral::detail
