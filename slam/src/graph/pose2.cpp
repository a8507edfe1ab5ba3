#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "isotherm/slam/graph/pose.hpp"

namespace isotherm::slam {
namespace {

// sin(t)/t and (1-cos(t))/t, with their series where the quotients cancel.
struct SinCosQuotients {
  double sin_over = 1.0;
  double versin_over = 0.0;
};

SinCosQuotients sin_cos_quotients(double t) {
  if (std::abs(t) < 1e-4) return {1.0 - t * t / 6.0, t / 2.0 - t * t * t / 24.0};
  // 1 - cos t = 2 sin^2(t/2) keeps full precision for small t.
  const double half_sin = std::sin(0.5 * t);
  return {std::sin(t) / t, 2.0 * half_sin * half_sin / t};
}

// V with translation(exp(rho, t)) = V rho.
Eigen::Matrix2d translation_map(double t) {
  const auto [a, b] = sin_cos_quotients(t);
  Eigen::Matrix2d v;
  v << a, -b, b, a;
  return v;
}

}  // namespace

double wrap_angle(double radians) {
  if (radians >= -std::numbers::pi && radians < std::numbers::pi) return radians;
  const double wrapped = std::remainder(radians, 2.0 * std::numbers::pi);
  return wrapped >= std::numbers::pi ? wrapped - 2.0 * std::numbers::pi : wrapped;
}

Eigen::Matrix2d Pose2::rotation_matrix() const {
  const double c = std::cos(angle_);
  const double s = std::sin(angle_);
  Eigen::Matrix2d r;
  r << c, -s, s, c;
  return r;
}

double Pose2::rotation_angle() const { return std::abs(wrap_angle(angle_)); }

Pose2 Pose2::inverse() const {
  return {-(rotation_matrix().transpose() * translation_), wrap_angle(-angle_)};
}

Pose2 Pose2::between(const Pose2& other) const {
  return {rotation_matrix().transpose() * (other.translation_ - translation_),
          wrap_angle(other.angle_ - angle_)};
}

Pose2 Pose2::operator*(const Pose2& other) const {
  return {translation_ + rotation_matrix() * other.translation_, wrap_angle(angle_ + other.angle_)};
}

Pose2::Translation Pose2::operator*(const Translation& point) const {
  return translation_ + rotation_matrix() * point;
}

Pose2 Pose2::exp(const Tangent& xi) {
  return {translation_map(xi[2]) * xi.head<2>(), wrap_angle(xi[2])};
}

Pose2::Tangent Pose2::log() const {
  const double t = rotation_log()[0];
  Tangent xi;
  xi << translation_map(t).inverse() * translation_, t;
  return xi;
}

Eigen::Matrix<double, 1, 1> Pose2::rotation_log() const {
  return Eigen::Matrix<double, 1, 1>(wrap_angle(angle_));
}

Pose2::Matrix Pose2::adjoint() const {
  Matrix ad = Matrix::Identity();
  ad.topLeftCorner<2, 2>() = rotation_matrix();
  ad(0, 2) = translation_.y();
  ad(1, 2) = -translation_.x();
  return ad;
}

Pose2::Matrix Pose2::right_jacobian(const Tangent& xi) {
  const double t = xi[2];
  const auto [a, b] = sin_cos_quotients(t);
  // c = (t - sin t)/t^2 and d = (1 - cos t)/t^2.
  const double c =
      std::abs(t) < 1e-2 ? t / 6.0 * (1.0 - t * t / 20.0 * (1.0 - t * t / 42.0)) : (1.0 - a) / t;
  const double d = std::abs(t) < 1e-4 ? 0.5 - t * t / 24.0 : b / t;
  Matrix j = Matrix::Identity();
  j.topLeftCorner<2, 2>() << a, b, -b, a;
  j(0, 2) = c * xi[0] - d * xi[1];
  j(1, 2) = d * xi[0] + c * xi[1];
  return j;
}

Pose2::Matrix Pose2::right_jacobian_inverse(const Tangent& xi) {
  return right_jacobian(xi).inverse();
}

}  // namespace isotherm::slam
