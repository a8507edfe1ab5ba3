#include "isotherm/spectral/heat/heat_scales.hpp"

#include <cmath>

#include "isotherm/spectral/eigen/eigen_decomposition.hpp"

namespace isotherm::spectral {

std::vector<double> automatic_scales(const WeightedGraph& graph, const RunContext& run) {
  constexpr int kCount = 7;
  constexpr double kSaturated = 5.0, kSmallest = 0.001;
  double largest = 1.0;
  if (graph.edge_count() > 0) {
    const auto eigen = smallest_eigenpairs(Laplacian(graph), {.count = 1,
                                                              .null_vectors = false,
                                                              .tolerance = 1e-6,
                                                              .check_inertia = false,
                                                              .progress = run.progress});
    if (eigen.count() > 0 && eigen.values[0] > 0.0) {
      const double scale = kSaturated / eigen.values[0];
      if (std::isfinite(scale) && scale > kSmallest) largest = scale;
    }
  }
  std::vector<double> scales;
  for (int k = 0; k < kCount; ++k) {
    scales.push_back(largest * std::pow(kSmallest / largest, k / (kCount - 1.0)));
  }
  return scales;
}

}  // namespace isotherm::spectral
