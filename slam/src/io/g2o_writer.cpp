#include <string>

#include "io/record_writer.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"

namespace isotherm::slam {
namespace {

template <class Pose>
constexpr std::string_view kVertexTag = Pose::kDim == 2 ? "VERTEX_SE2" : "VERTEX_SE3:QUAT";
template <class Pose>
constexpr std::string_view kEdgeTag = Pose::kDim == 2 ? "EDGE_SE2" : "EDGE_SE3:QUAT";

template <class Pose>
void write_g2o_records(OutputFile& file, const PoseGraph<Pose>& graph) {
  detail::check_poses(graph);
  detail::RecordWriter line(file);
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
  write_g2o_records(file, graph);
  file.commit();
}

void write_g2o(const std::string& path, const PoseGraph<Pose3>& graph) {
  OutputFile file(path);
  write_g2o_records(file, graph);
  file.commit();
}

void write_g2o(const std::string& path, const AnyPoseGraph& graph) {
  std::visit([&](const auto& g) { write_g2o(path, g); }, graph);
}

void write_g2o(const std::string& path, const PoseGraphFile& read) {
  OutputFile file(path);
  std::visit([&](const auto& graph) { write_g2o_records(file, graph); }, read.graph);
  for (const auto& line : read.other_lines) {
    file.write(line);
    file.write("\n");
  }
  file.commit();
}

}  // namespace isotherm::slam
