#include <cmath>

#include <Eigen/LU>

#include "isotherm/slam/graph/pose.hpp"

namespace isotherm::slam {
namespace {

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

// Functions of the angle t that the closed forms below need; each has a
// removable singularity at 0 and is replaced by its series there.
struct AngleFunctions {
  double sinc;  // sin(t)/t
  double b;     // (1 - cos t)/t^2
  double c;     // (t - sin t)/t^3
  double d;     // (t^2 + 2 cos t - 2)/(2 t^4)
  double e;     // (2t - 3 sin t + t cos t)/(2 t^5)
};

AngleFunctions angle_functions(double t) {
  const double t2 = t * t;
  // At 0.3 the truncated series are exact to 1e-16 and the closed forms still
  // have twelve digits.
  if (t < 0.3) {
    const auto series = [t2](double c0, double c1, double c2, double c3, double c4, double c5) {
      return c0 + t2 * (c1 + t2 * (c2 + t2 * (c3 + t2 * (c4 + t2 * c5))));
    };
    return {
        series(1.0, -1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880, -1.0 / 39916800),
        series(1.0 / 2, -1.0 / 24, 1.0 / 720, -1.0 / 40320, 1.0 / 3628800, -1.0 / 479001600),
        series(1.0 / 6, -1.0 / 120, 1.0 / 5040, -1.0 / 362880, 1.0 / 39916800, -1.0 / 6227020800),
        series(1.0 / 24, -1.0 / 720, 1.0 / 40320, -1.0 / 3628800, 1.0 / 479001600,
               -1.0 / 87178291200),
        series(1.0 / 120, -1.0 / 2520, 1.0 / 120960, -1.0 / 9979200, 1.0 / 1245404160,
               -1.0 / 217945728000),
    };
  }
  const double s = std::sin(t);
  const double c = std::cos(t);
  return {s / t, (1.0 - c) / t2, (t - s) / (t2 * t), (t2 + 2.0 * c - 2.0) / (2.0 * t2 * t2),
          (2.0 * t - 3.0 * s + t * c) / (2.0 * t2 * t2 * t)};
}

// Left Jacobian of SO(3); also the map from rho to translation in exp.
Eigen::Matrix3d rotation_left_jacobian(const Eigen::Vector3d& phi) {
  const auto f = angle_functions(phi.norm());
  const Eigen::Matrix3d p = skew(phi);
  return Eigen::Matrix3d::Identity() + f.b * p + f.c * p * p;
}

// The off-diagonal block of the left Jacobian of SE(3): T. Barfoot, "State
// Estimation for Robotics", 2017, eq. 7.86b.
Eigen::Matrix3d coupling_block(const Eigen::Vector3d& rho, const Eigen::Vector3d& phi) {
  const auto f = angle_functions(phi.norm());
  const Eigen::Matrix3d r = skew(rho);
  const Eigen::Matrix3d p = skew(phi);
  const Eigen::Matrix3d prp = p * r * p;
  return 0.5 * r + f.c * (p * r + r * p + prp) + f.d * (p * p * r + r * p * p - 3.0 * prp) +
         f.e * (prp * p + p * prp);
}

Pose3::Matrix left_jacobian(const Pose3::Tangent& xi) {
  const Eigen::Matrix3d j = rotation_left_jacobian(xi.tail<3>());
  Pose3::Matrix m = Pose3::Matrix::Zero();
  m.topLeftCorner<3, 3>() = j;
  m.bottomRightCorner<3, 3>() = j;
  m.topRightCorner<3, 3>() = coupling_block(xi.head<3>(), xi.tail<3>());
  return m;
}

Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& q) {
  // Of the two quaternions of a rotation, the one with w >= 0 has the angle in
  // [0, pi].
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d v = sign * q.vec();
  const double sin_half = v.norm();
  const double cos_half = sign * q.w();
  if (sin_half < 1e-8) return 2.0 / cos_half * v;
  return 2.0 * std::atan2(sin_half, cos_half) / sin_half * v;
}

}  // namespace

double Pose3::rotation_angle() const { return rotation_vector(rotation_).norm(); }

Pose3 Pose3::inverse() const {
  const Eigen::Quaterniond inverse_rotation = rotation_.conjugate();
  return {-(inverse_rotation * translation_), inverse_rotation};
}

Pose3 Pose3::between(const Pose3& other) const {
  const Eigen::Quaterniond inverse_rotation = rotation_.conjugate();
  return {inverse_rotation * (other.translation_ - translation_),
          (inverse_rotation * other.rotation_).normalized()};
}

Pose3 Pose3::operator*(const Pose3& other) const {
  return {translation_ + rotation_ * other.translation_,
          (rotation_ * other.rotation_).normalized()};
}

Pose3::Translation Pose3::operator*(const Translation& point) const {
  return translation_ + rotation_ * point;
}

Pose3 Pose3::exp(const Tangent& xi) {
  const Eigen::Vector3d phi = xi.tail<3>();
  const double half = 0.5 * phi.norm();
  Eigen::Quaterniond q;
  q.w() = std::cos(half);
  q.vec() = 0.5 * angle_functions(half).sinc * phi;
  return {rotation_left_jacobian(phi) * xi.head<3>(), q.normalized()};
}

Pose3::Tangent Pose3::log() const {
  Tangent xi;
  const Eigen::Vector3d phi = rotation_log();
  xi << rotation_left_jacobian(phi).inverse() * translation_, phi;
  return xi;
}

Eigen::Vector3d Pose3::rotation_log() const { return rotation_vector(rotation_); }

Pose3::Matrix Pose3::adjoint() const {
  const Eigen::Matrix3d r = rotation_matrix();
  Matrix ad = Matrix::Zero();
  ad.topLeftCorner<3, 3>() = r;
  ad.bottomRightCorner<3, 3>() = r;
  ad.topRightCorner<3, 3>() = skew(translation_) * r;
  return ad;
}

Pose3::Matrix Pose3::right_jacobian(const Tangent& xi) { return left_jacobian(-xi); }

Pose3::Matrix Pose3::right_jacobian_inverse(const Tangent& xi) {
  const Matrix j = right_jacobian(xi);
  const Eigen::Matrix3d inverse = j.topLeftCorner<3, 3>().inverse();
  Matrix m = Matrix::Zero();
  m.topLeftCorner<3, 3>() = inverse;
  m.bottomRightCorner<3, 3>() = inverse;
  m.topRightCorner<3, 3>() = -inverse * j.topRightCorner<3, 3>() * inverse;
  return m;
}

}  // namespace isotherm::slam
