#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

/// Rigid motions of the plane and of space.
///
/// A tangent vector is ordered (translation, rotation), in metres and radians;
/// exp and log are those of the Lie group, so that the translation part of a
/// logarithm is not the translation of the pose. Perturbations act on the
/// right: T exp(xi). See J. Sola, J. Deray, D. Atchuthan, "A micro Lie theory
/// for state estimation in robotics", 2018.
namespace isotherm::slam {

/// The angle in [-pi, pi) that equals `radians` up to full turns.
double wrap_angle(double radians);

/// A pose in the plane: T maps coordinates of its own frame to the parent's.
class Pose2 {
 public:
  static constexpr int kDim = 2;  ///< dimension of space
  static constexpr int kDof = 3;  ///< degrees of freedom
  using Translation = Eigen::Matrix<double, kDim, 1>;
  using Tangent = Eigen::Matrix<double, kDof, 1>;  ///< (x, y, theta)
  using Matrix = Eigen::Matrix<double, kDof, kDof>;

  /// The identity.
  Pose2() = default;

  /// `angle` in radians, kept as given.
  Pose2(const Translation& translation, double angle) : translation_(translation), angle_(angle) {}
  Pose2(double x, double y, double angle) : translation_(x, y), angle_(angle) {}

  const Translation& translation() const noexcept { return translation_; }
  double angle() const noexcept { return angle_; }
  Eigen::Matrix2d rotation_matrix() const;

  /// Absolute rotation angle in [0, pi].
  double rotation_angle() const;

  Pose2 inverse() const;
  /// inverse() * other, with one rotation less.
  Pose2 between(const Pose2& other) const;
  Pose2 operator*(const Pose2& other) const;
  Translation operator*(const Translation& point) const;

  static Pose2 exp(const Tangent& xi);
  Tangent log() const;
  /// The rotation's, which is the last part of log().
  Eigen::Matrix<double, kDof - kDim, 1> rotation_log() const;

  /// Ad with T exp(xi) = exp(Ad xi) T.
  Matrix adjoint() const;

  /// Jr with exp(xi + d) = exp(xi) exp(Jr d) to first order.
  static Matrix right_jacobian(const Tangent& xi);
  static Matrix right_jacobian_inverse(const Tangent& xi);

 private:
  Translation translation_ = Translation::Zero();
  double angle_ = 0.0;
};

/// A pose in space: T maps coordinates of its own frame to the parent's.
class Pose3 {
 public:
  static constexpr int kDim = 3;
  static constexpr int kDof = 6;
  using Translation = Eigen::Matrix<double, kDim, 1>;
  using Tangent = Eigen::Matrix<double, kDof, 1>;  ///< (x, y, z, rotation vector)
  using Matrix = Eigen::Matrix<double, kDof, kDof>;

  /// The identity.
  Pose3() = default;

  /// `rotation` must have unit norm (up to rounding) and is kept as given.
  Pose3(const Translation& translation, const Eigen::Quaterniond& rotation)
      : translation_(translation), rotation_(rotation) {}

  const Translation& translation() const noexcept { return translation_; }
  const Eigen::Quaterniond& rotation() const noexcept { return rotation_; }
  Eigen::Matrix3d rotation_matrix() const { return rotation_.toRotationMatrix(); }

  /// Absolute rotation angle in [0, pi].
  double rotation_angle() const;

  Pose3 inverse() const;
  /// inverse() * other, with one rotation less.
  Pose3 between(const Pose3& other) const;
  /// The product's quaternion is normalised, so that long chains do not drift.
  Pose3 operator*(const Pose3& other) const;
  Translation operator*(const Translation& point) const;

  static Pose3 exp(const Tangent& xi);
  /// Near a half turn the axis is defined up to sign; either is returned.
  Tangent log() const;
  /// The rotation's, which is the last part of log().
  Eigen::Matrix<double, kDof - kDim, 1> rotation_log() const;

  /// Ad with T exp(xi) = exp(Ad xi) T.
  Matrix adjoint() const;

  /// Jr with exp(xi + d) = exp(xi) exp(Jr d) to first order.
  static Matrix right_jacobian(const Tangent& xi);
  static Matrix right_jacobian_inverse(const Tangent& xi);

 private:
  // A quaternion is aligned to 16 bytes or more. The gap stands here and not behind the
  // translation, so that all seven numbers are in a row, as others have them.
  [[maybe_unused]] double gap_ = 0.0;
  Translation translation_ = Translation::Zero();
  Eigen::Quaterniond rotation_ = Eigen::Quaterniond::Identity();
};

}  // namespace isotherm::slam
