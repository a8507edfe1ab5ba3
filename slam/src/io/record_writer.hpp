#pragma once

#include <cmath>
#include <string>
#include <string_view>

#include "isotherm/base/error.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam::detail {

/// @throws InvalidArgument unless there are no poses or one an id.
template <class Pose>
void check_poses(const PoseGraph<Pose>& graph) {
  if (!graph.poses.empty() && graph.poses.size() != graph.ids.size()) {
    throw InvalidArgument("graph.poses", "must be empty or one an id");
  }
}

/// One record in the making, handed on to the file when it ends.
class RecordWriter {
 public:
  explicit RecordWriter(OutputFile& file) : file_(file) {}

  RecordWriter& tag(std::string_view name) {
    line_ = name;
    return *this;
  }
  RecordWriter& id(VertexId value) {
    line_ += ' ';
    append_number(line_, value);
    return *this;
  }
  RecordWriter& number(double value) {
    if (!std::isfinite(value)) {
      throw InvalidArgument("graph", "holds a value that is not finite: " + line_);
    }
    line_ += ' ';
    append_number(line_, value);
    return *this;
  }
  RecordWriter& pose(const Pose2& pose) {
    return number(pose.translation().x()).number(pose.translation().y()).number(pose.angle());
  }
  RecordWriter& pose(const Pose3& pose) {
    for (const double value : pose.translation()) number(value);
    for (const double value : pose.rotation().coeffs()) number(value);  // x y z w
    return *this;
  }
  template <class Matrix>
  RecordWriter& upper_triangle(const Matrix& m) {
    for (int row = 0; row < m.rows(); ++row) {
      for (int column = row; column < m.cols(); ++column) number(m(row, column));
    }
    return *this;
  }
  void end() {
    line_ += '\n';
    file_.write(line_);
  }

 private:
  OutputFile& file_;
  std::string line_;
};

}  // namespace isotherm::slam::detail
