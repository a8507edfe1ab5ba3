// Reading a large spatial g2o file: bytes a second on one core, and memory, with
// the library's reader and, in the same run, with a plain iostream parser.
// usage: read_speed [FILE.g2o | VERTICES]     (default: 1000000 vertices)
#include <sys/resource.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "isotherm/base/random.hpp"
#include "isotherm/base/text_reader.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"

namespace {

using namespace isotherm;
using namespace isotherm::slam;

constexpr double kMegabyte = 1e6;

// A noisy walk with a loop edge for every tenth vertex and full information.
PoseGraph<Pose3> walk(Index vertices) {
  Random random(1);
  const auto noise = [&random](double sigma) {
    Pose3::Tangent xi;
    for (double& value : xi) value = random.normal(0.0, sigma);
    return Pose3::exp(xi);
  };
  PoseGraph<Pose3> graph;
  const Pose3::Matrix mix = 0.1 * Pose3::Matrix::Random();
  const Pose3::Matrix information = 100.0 * (Pose3::Matrix::Identity() + mix.transpose() * mix);
  Pose3 pose;
  const auto add_edge = [&](Index from, Index to) {
    Constraint<Pose3> edge;
    edge.from = from;
    edge.to = to;
    edge.T_from_to = graph.poses[from].inverse() * graph.poses[to] * noise(0.01);
    edge.information = information * random.uniform(0.5, 2.0);
    graph.constraints.push_back(edge);
  };
  for (Index v = 0; v < vertices; ++v) {
    graph.ids.push_back(v);
    graph.poses.push_back(pose);
    pose = pose * noise(0.1);
    if (v > 0) add_edge(v - 1, v);
    if (v % 10 == 9) add_edge(static_cast<Index>(random.index(v - 1)), v);
  }
  return graph;
}

// What one writes first: tokens from a stream, no checks, the same values kept.
PoseGraph<Pose3> read_plainly(const std::string& path) {
  std::ifstream file(path);
  PoseGraph<Pose3> graph;
  const auto read_pose = [&file] {
    Pose3::Translation t;
    Eigen::Quaterniond q;
    file >> t.x() >> t.y() >> t.z() >> q.x() >> q.y() >> q.z() >> q.w();
    return Pose3(t, q.normalized());
  };
  std::string tag;
  while (file >> tag) {
    if (tag == "VERTEX_SE3:QUAT") {
      VertexId id = 0;
      file >> id;
      graph.ids.push_back(id);
      graph.poses.push_back(read_pose());
    } else if (tag == "EDGE_SE3:QUAT") {
      auto& edge = graph.constraints.emplace_back();
      file >> edge.from >> edge.to;
      edge.T_from_to = read_pose();
      for (int i = 0; i < 6; ++i) {
        for (int j = i; j < 6; ++j) {
          file >> edge.information(i, j);
          edge.information(j, i) = edge.information(i, j);
        }
      }
    }
  }
  return graph;
}

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// A value in kB from /proc/self/status.
double status_megabytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    if (line.starts_with(key)) return std::stod(line.substr(key.size() + 1)) * 1024 / kMegabyte;
  }
  return 0.0;
}

void reset_peak_memory() { std::ofstream("/proc/self/clear_refs") << "5"; }

double graph_megabytes(const PoseGraph<Pose3>& graph) {
  return static_cast<double>(graph.ids.size() * sizeof(VertexId) +
                             graph.poses.size() * sizeof(Pose3) +
                             graph.constraints.size() * sizeof(Constraint<Pose3>)) /
         kMegabyte;
}

// Returns megabytes of text a second of processor time.
double measure(const char* name, const std::string& path,
               const std::function<PoseGraph<Pose3>()>& read) {
  const double size = static_cast<double>(std::filesystem::file_size(path)) / kMegabyte;
  reset_peak_memory();
  const double memory_before = status_megabytes("VmRSS:");
  const double start = cpu_seconds();
  const auto graph = read();
  const double seconds = cpu_seconds() - start;
  const double peak = status_megabytes("VmHWM:") - memory_before;
  const double kept = graph_megabytes(graph);
  std::printf("%-9s %7.1f MB of text in %6.2f s CPU: %6.1f MB/s; ", name, size, seconds,
              size / seconds);
  std::printf("graph %.0f MB, peak %.0f MB (%.2f times)\n", kept, peak, peak / kept);
  return size / seconds;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string argument = argc > 1 ? argv[1] : "1000000";
  std::string path = argument;
  const bool generate = !std::filesystem::exists(argument);
  if (generate) {
    path = (std::filesystem::temp_directory_path() / "isotherm_read_speed.g2o").string();
    write_g2o(path, walk(static_cast<Index>(std::atol(argument.c_str()))));
  }
  const double ours =
      measure("isotherm", path, [&path] { return as<Pose3>(read_pose_graph(path)); });
  const double plain = measure("iostream", path, [&path] { return read_plainly(path); });
  std::printf("ratio     %.1f\n", ours / plain);
  if (generate) std::filesystem::remove(path);
  return 0;
}
