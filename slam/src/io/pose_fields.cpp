#include "io/pose_fields.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/LU>

#include "isotherm/base/text_writer.hpp"
#include "matrices/nearest_rotation.hpp"

namespace isotherm::slam::detail {
namespace {

// Six significant digits, as most programs print, put a norm or an angle off by
// less than this.
constexpr double kPrintedRounding = 1e-5;
constexpr double kLargestNormError = 1e-2;
// A quaternion just normalised is nearer to unit norm, so that reading what was
// written changes nothing.
constexpr double kUnitSquaredNorm = 16 * std::numeric_limits<double>::epsilon();

}  // namespace

double PoseRepairs::wrapped(double radians, const SourceLocation& where) {
  constexpr double kPi = std::numbers::pi;
  if (std::abs(radians) <= kPi) return radians;
  if (std::abs(radians) <= kPi + kPrintedRounding) {
    ++rounded_angles_;
  } else {
    report_.add_repair(options_, {"angle wrapped", where, format_number(radians),
                                  "angle outside [-pi, pi]; wrapped"});
  }
  return wrap_angle(radians);
}

Eigen::Quaterniond PoseRepairs::normalised(const Eigen::Quaterniond& q, const SourceLocation& where,
                                           std::string_view token) {
  if (std::abs(q.squaredNorm() - 1.0) <= kUnitSquaredNorm) return q;
  const double norm = q.norm();
  const double error = std::abs(norm - 1.0);
  if (!(error <= kLargestNormError)) {
    throw ParseError(where, std::string(token),
                     "expected a unit quaternion, its norm is " + format_number(norm));
  }
  if (error <= kPrintedRounding) {
    ++rounded_quaternions_;
  } else {
    report_.add_repair(options_, {"quaternion normalised", where, std::string(token),
                                  "quaternion of norm " + format_number(norm) + "; normalised"});
  }
  return q.normalized();
}

void PoseRepairs::finish() {
  if (rounded_quaternions_ > 0) report_.notes["quaternion rounded"] += rounded_quaternions_;
  if (rounded_angles_ > 0) report_.notes["angle rounded"] += rounded_angles_;
}

std::string PoseFields::text_from(const SourceLocation& where) const {
  return std::string(reader_.text_from(where.column));
}

double PoseFields::angle() {
  const double radians = reader_.number("an angle in radians");
  if (std::abs(radians) <= std::numbers::pi) return radians;  // where it stands is not asked
  return repairs_.wrapped(radians, reader_.location());
}

Pose2 PoseFields::planar_step() {
  const Pose2 step = planar();
  // A heading may have been added up over turns, what is measured between two poses not.
  const auto where = reader_.location();
  double stated = 0.0;
  if (parse_number(reader_.text_from(where.column), stated) &&
      std::abs(stated) > 2.0 * std::numbers::pi) {
    report_.add_note({"turn beyond a full one", where, format_number(stated),
                      "edge with more than a full turn: are angles in degrees?"});
  }
  return step;
}

Pose2 PoseFields::planar() {
  const double x = reader_.number("x");
  const double y = reader_.number("y");
  return {x, y, angle()};
}

Eigen::Quaterniond PoseFields::quaternion(bool w_first) {
  Eigen::Quaterniond q;
  if (w_first) q.w() = reader_.number("qw");
  q.x() = reader_.number("qx");
  const auto where = reader_.location();
  q.y() = reader_.number("qy");
  q.z() = reader_.number("qz");
  if (!w_first) q.w() = reader_.number("qw");
  return repairs_.normalised(q, where, reader_.text_from(where.column));
}

Pose3 PoseFields::spatial() {
  const double x = reader_.number("x");
  const double y = reader_.number("y");
  const double z = reader_.number("z");
  return {{x, y, z}, quaternion()};
}

Pose3 PoseFields::spatial_euler() {
  const double x = reader_.number("x");
  const double y = reader_.number("y");
  const double z = reader_.number("z");
  const double roll = reader_.number("roll");
  const double pitch = reader_.number("pitch");
  const double yaw = reader_.number("yaw");
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const Eigen::Quaterniond rotation = AngleAxisd(yaw, Vector3d::UnitZ()) *
                                      AngleAxisd(pitch, Vector3d::UnitY()) *
                                      AngleAxisd(roll, Vector3d::UnitX());
  return {{x, y, z}, rotation.normalized()};
}

Pose3 PoseFields::matrix() {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
  SourceLocation where;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      rotation(i, j) = reader_.number("an entry of the rotation matrix");
      if (i == 0 && j == 0) where = reader_.location();
    }
    translation[i] = reader_.number("an entry of the translation");
  }
  return {translation, nearest_rotation(rotation, where)};
}

// The rotation whose matrix differs least (in the Frobenius norm).
Eigen::Quaterniond PoseFields::nearest_rotation(const Eigen::Matrix3d& matrix,
                                                const SourceLocation& where) {
  const double error = (matrix.transpose() * matrix - Eigen::Matrix3d::Identity()).norm();
  if (!(error <= kLargestNormError) || matrix.determinant() < 0.0) {
    const std::string reason = error <= kLargestNormError ? "this one is a reflection"
                                                          : "|R'R - I| is " + format_number(error);
    throw ParseError(where, text_from(where), "expected a rotation matrix, " + reason);
  }
  if (error > kPrintedRounding) {
    report_.add_repair(options_, {"rotation matrix orthonormalised", where, text_from(where),
                                  "matrix is a rotation only up to " + format_number(error) +
                                      "; replaced by the nearest one"});
  } else if (error > kUnitSquaredNorm) {
    ++rounded_matrices_;
  }
  const Eigen::Matrix3d nearest = detail::nearest_rotation(matrix).rotation;
  return Eigen::Quaterniond(nearest).normalized();
}

void PoseFields::finish() {
  repairs_.finish();
  if (rounded_matrices_ > 0) report_.notes["rotation matrix rounded"] += rounded_matrices_;
}

}  // namespace isotherm::slam::detail
