#include <cmath>

#include "io/record_writer.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"

namespace isotherm::slam {
namespace {

// Roll, pitch and yaw with R = Rz(yaw) Ry(pitch) Rx(roll); where pitch is a
// quarter turn only yaw - roll is defined, and roll is set to 0.
Eigen::Vector3d roll_pitch_yaw(const Eigen::Matrix3d& r) {
  const double cosine = std::hypot(r(0, 0), r(1, 0));
  const double pitch = std::atan2(-r(2, 0), cosine);
  if (cosine < 1e-12) return {0.0, pitch, std::atan2(-r(0, 1), r(1, 1))};
  return {std::atan2(r(2, 1), r(2, 2)), pitch, std::atan2(r(1, 0), r(0, 0))};
}

void write_record_pose(detail::RecordWriter& line, const Pose2& pose) { line.pose(pose); }

void write_record_pose(detail::RecordWriter& line, const Pose3& pose) {
  for (const double value : pose.translation()) line.number(value);
  for (const double value : roll_pitch_yaw(pose.rotation_matrix())) line.number(value);
}

// TORO's own order in the plane; by rows in space.
void write_information(detail::RecordWriter& line, const Pose2::Matrix& m) {
  for (const double value : {m(0, 0), m(0, 1), m(1, 1), m(2, 2), m(0, 2), m(1, 2)}) {
    line.number(value);
  }
}

void write_information(detail::RecordWriter& line, const Pose3::Matrix& m) {
  line.upper_triangle(m);
}

template <class Pose>
void write_toro_records(OutputFile& file, const PoseGraph<Pose>& graph) {
  detail::check_poses(graph);
  detail::RecordWriter line(file);
  for (std::size_t v = 0; v < graph.poses.size(); ++v) {
    line.tag(Pose::kDim == 2 ? "VERTEX2" : "VERTEX3").id(graph.ids[v]);
    write_record_pose(line, graph.poses[v]);
    line.end();
  }
  for (const auto& constraint : graph.constraints) {
    line.tag(Pose::kDim == 2 ? "EDGE2" : "EDGE3");
    line.id(graph.ids[constraint.from]).id(graph.ids[constraint.to]);
    write_record_pose(line, constraint.T_from_to);
    write_information(line, constraint.information);
    line.end();
  }
}

}  // namespace

void write_toro(const std::string& path, const AnyPoseGraph& any) {
  OutputFile file(path);
  std::visit([&](const auto& graph) { write_toro_records(file, graph); }, any);
  file.commit();
}

}  // namespace isotherm::slam
