#include "isotherm/spectral/heat/heat_scales.hpp"

#include <cmath>

#include "isotherm/spectral/eigen/eigen_decomposition.hpp"

namespace isotherm::spectral {

std::vector<double> automatic_scales(double smallest_eigenvalue) {
  constexpr int kCount = 7;
  constexpr double kSaturated = 5.0, kSmallest = 0.001;
  double largest = 1.0;
  if (smallest_eigenvalue > 0.0) {
    const double scale = kSaturated / smallest_eigenvalue;
    if (std::isfinite(scale) && scale > kSmallest) largest = scale;
  }
  std::vector<double> scales;
  for (int k = 0; k < kCount; ++k) {
    scales.push_back(largest * std::pow(kSmallest / largest, k / (kCount - 1.0)));
  }
  return scales;
}

std::vector<double> automatic_scales(const WeightedGraph& graph, const RunContext& run) {
  if (graph.edge_count() == 0) return automatic_scales(0.0);
  const auto eigen = smallest_eigenpairs(Laplacian(graph), {.count = 1,
                                                            .null_vectors = false,
                                                            .tolerance = 1e-6,
                                                            .check_inertia = false,
                                                            .progress = run.progress});
  return automatic_scales(eigen.count() > 0 ? eigen.values[0] : 0.0);
}

}  // namespace isotherm::spectral
