#pragma once

#include <string>
#include <string_view>

#include "isotherm/base/read_report.hpp"
#include "isotherm/base/text_reader.hpp"
#include "isotherm/slam/graph/pose.hpp"

namespace isotherm::slam::detail {

/// Repairs what rounding did to poses.
///
/// A quaternion whose norm is off by what six printed digits explain, or an angle
/// as little outside [-pi, pi], is corrected and only counted; a larger deviation
/// is a located repair; a quaternion further than 1 % from unit norm is an error.
class PoseRepairs {
 public:
  /// Both must outlive this object.
  PoseRepairs(const ReadOptions& options, ReadReport& report)
      : options_(options), report_(report) {}

  double wrapped(double radians, const SourceLocation& where);

  /// `token` is the text of all four numbers.
  Eigen::Quaterniond normalised(const Eigen::Quaterniond& q, const SourceLocation& where,
                                std::string_view token);

  /// Adds what was only counted to the report.
  void finish();

 private:
  const ReadOptions& options_;
  ReadReport& report_;
  std::uint64_t rounded_quaternions_ = 0;
  std::uint64_t rounded_angles_ = 0;
};

/// Reads poses from the fields of a line and repairs them.
class PoseFields {
 public:
  PoseFields(TextReader& reader, const ReadOptions& options, ReadReport& report)
      : reader_(reader), options_(options), report_(report), repairs_(options, report) {}

  /// x y theta
  Pose2 planar();
  /// The same of an edge, which notes a turn beyond a full one.
  Pose2 planar_step();
  /// x y z qx qy qz qw
  Pose3 spatial();
  /// x y z roll pitch yaw, with R = Rz(yaw) Ry(pitch) Rx(roll)
  Pose3 spatial_euler();
  /// r11 r12 r13 x  r21 r22 r23 y  r31 r32 r33 z
  Pose3 matrix();
  /// qx qy qz qw or, `w_first`, qw qx qy qz
  Eigen::Quaterniond quaternion(bool w_first = false);
  double angle();

  /// Adds what was only counted to the report.
  void finish();

 private:
  std::string text_from(const SourceLocation& where) const;
  Eigen::Quaterniond nearest_rotation(const Eigen::Matrix3d& matrix, const SourceLocation& where);

  TextReader& reader_;
  const ReadOptions& options_;
  ReadReport& report_;
  PoseRepairs repairs_;
  std::uint64_t rounded_matrices_ = 0;
};

}  // namespace isotherm::slam::detail
