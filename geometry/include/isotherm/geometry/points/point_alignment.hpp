#pragma once

#include <Eigen/Core>

namespace isotherm::geometry {

/// x -> rotation * x + translation, an isometry of the plane or of space.
struct PointAlignment {
  Eigen::MatrixXd rotation;     ///< d x d, orthogonal; a reflection has determinant -1
  Eigen::VectorXd translation;  ///< d
  double residual = 0.0;        ///< sum of the squared distances that remain
  /// Smallest singular value of the points' cross-covariance: 0 where they leave a
  /// reflection (or more) undecided.
  double certainty = 0.0;

  Eigen::MatrixXd apply(const Eigen::MatrixXd& points) const {
    return (rotation * points).colwise() + translation;
  }
};

/// The isometry, reflections included, that maps the columns of `from` onto those
/// of `to` with the least sum of squared distances (P. Schoenemann, "A generalized
/// solution of the orthogonal Procrustes problem", 1966). No points give the
/// identity. O(points).
/// @throws InvalidArgument if the sizes differ.
PointAlignment align_points(const Eigen::MatrixXd& from, const Eigen::MatrixXd& to);

}  // namespace isotherm::geometry
