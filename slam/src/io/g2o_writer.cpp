#include <cmath>
#include <string>

#include "isotherm/base/text_writer.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"

namespace isotherm::slam {
namespace {

template <class Pose>
constexpr std::string_view kVertexTag = Pose::kDim == 2 ? "VERTEX_SE2" : "VERTEX_SE3:QUAT";
template <class Pose>
constexpr std::string_view kEdgeTag = Pose::kDim == 2 ? "EDGE_SE2" : "EDGE_SE3:QUAT";

// One line in the making, handed on to the file when it ends.
class LineWriter {
 public:
  explicit LineWriter(OutputFile& file) : file_(file) {}

  LineWriter& tag(std::string_view name) {
    line_ = name;
    return *this;
  }
  LineWriter& id(VertexId value) {
    line_ += ' ';
    append_number(line_, value);
    return *this;
  }
  LineWriter& number(double value) {
    if (!std::isfinite(value)) {
      throw InvalidArgument("graph", "holds a value that is not finite: " + line_);
    }
    line_ += ' ';
    append_number(line_, value);
    return *this;
  }
  LineWriter& pose(const Pose2& pose) {
    return number(pose.translation().x()).number(pose.translation().y()).number(pose.angle());
  }
  LineWriter& pose(const Pose3& pose) {
    for (const double value : pose.translation()) number(value);
    for (const double value : pose.rotation().coeffs()) number(value);  // x y z w
    return *this;
  }
  template <class Matrix>
  LineWriter& upper_triangle(const Matrix& m) {
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

template <class Pose>
void write_graph(OutputFile& file, const PoseGraph<Pose>& graph) {
  if (!graph.poses.empty() && graph.poses.size() != graph.ids.size()) {
    throw InvalidArgument("graph.poses", "must be empty or one an id");
  }
  LineWriter line(file);
  for (std::size_t v = 0; v < graph.poses.size(); ++v) {
    line.tag(kVertexTag<Pose>).id(graph.ids[v]).pose(graph.poses[v]).end();
  }
  for (const Index v : graph.fixed) line.tag("FIX").id(graph.ids[v]).end();
  for (const auto& constraint : graph.constraints) {
    line.tag(kEdgeTag<Pose>).id(graph.ids[constraint.from]).id(graph.ids[constraint.to]);
    line.pose(constraint.T_from_to).upper_triangle(constraint.information).end();
  }
}

}  // namespace

void write_g2o(const std::string& path, const PoseGraph<Pose2>& graph) {
  OutputFile file(path);
  write_graph(file, graph);
  file.commit();
}

void write_g2o(const std::string& path, const PoseGraph<Pose3>& graph) {
  OutputFile file(path);
  write_graph(file, graph);
  file.commit();
}

void write_g2o(const std::string& path, const AnyPoseGraph& graph) {
  std::visit([&](const auto& g) { write_g2o(path, g); }, graph);
}

void write_g2o(const std::string& path, const PoseGraphFile& read) {
  OutputFile file(path);
  std::visit([&](const auto& graph) { write_graph(file, graph); }, read.graph);
  for (const auto& line : read.other_lines) {
    file.write(line);
    file.write("\n");
  }
  file.commit();
}

}  // namespace isotherm::slam
