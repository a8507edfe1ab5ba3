#include "slam/pose_arrays.hpp"

#include <algorithm>
#include <limits>
#include <string>

namespace isotherm::python {
namespace {

// A pose in the plane begins with three numbers in a row, as its constructor has them.
static_assert(std::is_standard_layout_v<Pose2>);
static_assert(sizeof(Pose2::Translation) == 2 * sizeof(double));
// One in space ends with its seven numbers in a row.
static_assert(std::is_standard_layout_v<Pose3>);
static_assert(sizeof(Pose3) == 8 * sizeof(double));

constexpr double kUnitTolerance = 1e-3;
constexpr double kRounding = 1e-12;

bool is_known(const double* row, std::int64_t columns) {
  for (std::int64_t c = 0; c < columns; ++c) {
    if (std::isnan(row[c])) return false;
  }
  return true;
}

void read_row(const double* row, const char*, Pose2& pose) { pose = Pose2(row[0], row[1], row[2]); }

void read_row(const double* row, const char* what, Pose3& pose) {
  Eigen::Quaterniond rotation(row[6], row[3], row[4], row[5]);
  const double off = std::abs(rotation.norm() - 1.0);
  if (!(off < kUnitTolerance)) {
    throw nb::value_error((std::string(what) + ": a quaternion (columns 3 to 6: qx, qy, qz, qw) "
                                               "is not of unit norm")
                              .c_str());
  }
  if (off > kRounding) rotation.normalize();
  pose = Pose3(Eigen::Vector3d(row[0], row[1], row[2]), rotation);
}

void write_row(const Pose2& pose, double* row) {
  row[0] = pose.translation().x();
  row[1] = pose.translation().y();
  row[2] = pose.angle();
}

void write_row(const Pose3& pose, double* row) {
  std::copy_n(pose.translation().data(), 3, row);
  std::copy_n(pose.rotation().coeffs().data(), 4, row + 3);
}

PoseRows give_rows(std::vector<double> values, std::size_t rows, std::size_t columns) {
  return PoseRows(give<double, nb::shape<-1, -1>>(std::move(values), {rows, columns}));
}

}  // namespace

int pose_dimension(nb::handle value, const char* what) {
  const auto rows = numbers<double>(value, what, {kAny, kAny});
  if (rows.shape(1) == 3) return Pose2::kDim;
  if (rows.shape(1) == 7) return Pose3::kDim;
  throw nb::value_error((std::string(what) +
                         ": expected 3 columns (x, y, theta) or 7 (x, y, z, qx, qy, qz, qw), got " +
                         std::to_string(rows.shape(1)))
                            .c_str());
}

template <class Pose>
std::vector<Pose> poses_from(nb::handle value, const char* what) {
  const auto rows = numbers<double>(value, what, {kAny, kPoseColumns<Pose>});
  std::vector<Pose> poses(rows.shape(0));
  for (std::size_t k = 0; k < poses.size(); ++k) {
    read_row(rows.data() + k * kPoseColumns<Pose>, what, poses[k]);
  }
  return poses;
}

template <class Pose>
std::vector<std::optional<Pose>> known_poses_from(nb::handle value, const char* what) {
  const auto rows = numbers<double>(value, what, {kAny, kPoseColumns<Pose>});
  std::vector<std::optional<Pose>> poses(rows.shape(0));
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double* const row = rows.data() + k * kPoseColumns<Pose>;
    if (is_known(row, kPoseColumns<Pose>)) read_row(row, what, poses[k].emplace());
  }
  return poses;
}

PoseRows pose_rows(const Pose2* first, std::size_t count, std::size_t stride, nb::handle owner) {
  return strided_rows(reinterpret_cast<const double*>(first), count, 3, stride, owner);
}

PoseRows pose_rows(const Pose3* first, std::size_t count, std::size_t stride, nb::handle owner) {
  const double* const begin = count == 0 ? nullptr : first->translation().data();
  return strided_rows(begin, count, kPoseColumns<Pose3>, stride, owner);
}

template <class Pose>
PoseRows give_poses(const std::vector<Pose>& poses) {
  const std::size_t columns = kPoseColumns<Pose>;
  std::vector<double> values(poses.size() * columns);
  for (std::size_t k = 0; k < poses.size(); ++k) write_row(poses[k], values.data() + k * columns);
  return give_rows(std::move(values), poses.size(), columns);
}

template <class Pose>
PoseRows give_poses(const std::vector<std::optional<Pose>>& poses) {
  const std::size_t columns = kPoseColumns<Pose>;
  std::vector<double> values(poses.size() * columns, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (poses[k]) write_row(*poses[k], values.data() + k * columns);
  }
  return give_rows(std::move(values), poses.size(), columns);
}

template std::vector<Pose2> poses_from(nb::handle, const char*);
template std::vector<Pose3> poses_from(nb::handle, const char*);
template std::vector<std::optional<Pose2>> known_poses_from(nb::handle, const char*);
template std::vector<std::optional<Pose3>> known_poses_from(nb::handle, const char*);
template PoseRows give_poses(const std::vector<Pose2>&);
template PoseRows give_poses(const std::vector<Pose3>&);
template PoseRows give_poses(const std::vector<std::optional<Pose2>>&);
template PoseRows give_poses(const std::vector<std::optional<Pose3>>&);

}  // namespace isotherm::python
