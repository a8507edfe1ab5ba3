#include <cmath>
#include <string>

#include "isotherm/base/text_writer.hpp"
#include "isotherm/slam/io/trajectory_file.hpp"

namespace isotherm::slam {
namespace {

// Numbers of one row, with a separator between them.
class Row {
 public:
  explicit Row(char separator) : separator_(separator) {}

  void number(double value) {
    if (!std::isfinite(value)) throw InvalidArgument("trajectory", "value that is not finite");
    start_field();
    append_number(text_, value);
  }
  void nanoseconds(double seconds) {
    // Beyond this the number of nanoseconds does not fit 64 bits.
    if (!(std::abs(seconds) < 9e9)) throw InvalidArgument("trajectory", "time stamp too large");
    start_field();
    append_number(text_, static_cast<long long>(std::llround(seconds * 1e9)));
  }
  void translation(const Pose3& pose) {
    for (const double value : pose.translation()) number(value);
  }
  std::string_view end() {
    text_ += '\n';
    return text_;
  }

 private:
  void start_field() {
    if (!text_.empty()) text_ += separator_;
  }

  char separator_;
  std::string text_;
};

template <class Pose>
double stamp(const Trajectory<Pose>& trajectory, std::size_t k) {
  return trajectory.timestamps.empty() ? static_cast<double>(k) : trajectory.timestamps[k];
}

std::string tum_row(double time, const Pose3& pose) {
  Row row(' ');
  row.number(time);
  row.translation(pose);
  for (const double value : pose.rotation().coeffs()) row.number(value);  // x y z w
  return std::string(row.end());
}

std::string kitti_row(const Pose3& pose) {
  const Eigen::Matrix3d rotation = pose.rotation_matrix();
  Row row(' ');
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) row.number(rotation(i, j));
    row.number(pose.translation()[i]);
  }
  return std::string(row.end());
}

std::string euroc_row(double time, const Pose3& pose) {
  Row row(',');
  row.nanoseconds(time);
  row.translation(pose);
  const auto& q = pose.rotation();
  for (const double value : {q.w(), q.x(), q.y(), q.z()}) row.number(value);
  return std::string(row.end());
}

std::string planar_row(double time, const Pose2& pose) {
  Row row(' ');
  row.number(time);
  row.number(pose.translation().x());
  row.number(pose.translation().y());
  row.number(pose.angle());
  return std::string(row.end());
}

void write_spatial(OutputFile& file, const Trajectory<Pose3>& trajectory, FileFormat format) {
  if (format == FileFormat::euroc) {
    file.write("#timestamp [ns],p_x [m],p_y [m],p_z [m],q_w [],q_x [],q_y [],q_z []\n");
  }
  for (std::size_t k = 0; k < trajectory.poses.size(); ++k) {
    const auto& pose = trajectory.poses[k];
    const double time = stamp(trajectory, k);
    file.write(format == FileFormat::tum     ? tum_row(time, pose)
               : format == FileFormat::kitti ? kitti_row(pose)
                                             : euroc_row(time, pose));
  }
}

void write_planar(OutputFile& file, const AnyTrajectory& any) {
  const auto* trajectory = std::get_if<Trajectory<Pose2>>(&any);
  if (trajectory == nullptr) {
    throw InvalidArgument("format", "planar rows cannot hold spatial poses");
  }
  for (std::size_t k = 0; k < trajectory->poses.size(); ++k) {
    file.write(planar_row(stamp(*trajectory, k), trajectory->poses[k]));
  }
}

void check_stamps(const AnyTrajectory& any) {
  std::visit(
      [](const auto& trajectory) {
        const auto count = trajectory.timestamps.size();
        if (count != 0 && count != trajectory.poses.size()) {
          throw InvalidArgument("trajectory.timestamps", "must be empty or one a pose");
        }
      },
      any);
}

}  // namespace

void write_trajectory(const std::string& path, const AnyTrajectory& trajectory, FileFormat format) {
  if (content_of(format) != FileContent::trajectory || format == FileFormat::points) {
    throw InvalidArgument("format",
                          "trajectories are not written as " + std::string(enum_name(format)));
  }
  check_stamps(trajectory);
  OutputFile file(path);
  if (format == FileFormat::planar) {
    write_planar(file, trajectory);
  } else if (const auto* planar = std::get_if<Trajectory<Pose2>>(&trajectory)) {
    write_spatial(file, lift(*planar), format);
  } else {
    write_spatial(file, std::get<Trajectory<Pose3>>(trajectory), format);
  }
  file.commit();
}

}  // namespace isotherm::slam
