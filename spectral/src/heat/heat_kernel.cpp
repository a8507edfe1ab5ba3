#include "isotherm/spectral/heat/heat_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "isotherm/spectral/eigen/embedding.hpp"

namespace isotherm::spectral {
namespace {

EigenDecomposition all_pairs(const Laplacian& laplacian) {
  EigenOptions options;
  options.count = std::max<Index>(1, laplacian.size());
  options.method = EigenMethod::dense;
  options.check_inertia = false;
  return smallest_eigenpairs(laplacian, options);
}

}  // namespace

HeatKernel::HeatKernel(const Laplacian& laplacian) : eigen_(all_pairs(laplacian)) {}

HeatKernel::HeatKernel(EigenDecomposition eigen) : eigen_(std::move(eigen)) {}

double HeatKernel::entry(Index row, Index column, double scale) const {
  const Eigen::ArrayXd decay = (-scale * eigen_.values.array()).exp();
  return (eigen_.vectors.row(row).array() * decay.transpose() * eigen_.vectors.row(column).array())
      .sum();
}

Eigen::MatrixXd HeatKernel::matrix(double scale) const {
  const Eigen::MatrixXd rows = heat_embedding(eigen_, scale);
  return rows * rows.transpose();
}

Eigen::VectorXd HeatKernel::signature(double scale) const {
  return heat_embedding(eigen_, scale).rowwise().squaredNorm();
}

double HeatKernel::distance(VertexPair pair, double scale) const {
  const Eigen::ArrayXd decay = (-scale * eigen_.values.array()).exp();
  const Eigen::ArrayXd difference =
      (eigen_.vectors.row(pair.from) - eigen_.vectors.row(pair.to)).transpose();
  return (decay * difference.square()).sum();
}

double HeatKernel::remainder(VertexPair pair, double scale) const {
  if (eigen_.count() == eigen_.size()) return 0.0;
  const double seen = (eigen_.vectors.row(pair.from) - eigen_.vectors.row(pair.to)).squaredNorm();
  const double unseen = pair.from == pair.to ? 0.0 : std::max(0.0, 2.0 - seen);
  return unseen * std::exp(-scale * eigen_.values[eigen_.count() - 1]);
}

}  // namespace isotherm::spectral
