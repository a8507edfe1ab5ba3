#include "isotherm/spectral/eigen/embedding.hpp"

#include <cmath>

#include "isotherm/base/error.hpp"

namespace isotherm::spectral {

Eigen::MatrixXd laplacian_eigenmap(const EigenDecomposition& eigen) {
  return eigen.vectors.rightCols(eigen.count() - eigen.null_count);
}

Eigen::MatrixXd commute_time_embedding(const EigenDecomposition& eigen) {
  const Index count = eigen.count() - eigen.null_count;
  const auto values = eigen.values.tail(count).array();
  const Eigen::ArrayXd positive = (values > 0.0).select(values, eigen.bounds.tail(count).array());
  const Eigen::VectorXd factor = positive.rsqrt();
  return eigen.vectors.rightCols(count) * factor.asDiagonal();
}

Eigen::MatrixXd heat_embedding(const EigenDecomposition& eigen, double scale) {
  if (!std::isfinite(scale) || scale < 0.0) {
    throw InvalidArgument("scale", "must be finite and not negative");
  }
  const Eigen::VectorXd factor = (-0.5 * scale * eigen.values.array()).exp();
  return eigen.vectors * factor.asDiagonal();
}

}  // namespace isotherm::spectral
