#pragma once

#include <Eigen/Core>

namespace isotherm::slam::detail {

/// The rotation of a square matrix which differs least from it (in the Frobenius norm), and the
/// singular values of that, the largest first (Umeyama, Least-squares estimation of transformation
/// parameters between two point patterns, 1991, lemma).
struct NearestRotation {
  Eigen::MatrixXd rotation;
  Eigen::VectorXd singular_values;
};

NearestRotation nearest_rotation(const Eigen::MatrixXd& matrix);

}  // namespace isotherm::slam::detail
