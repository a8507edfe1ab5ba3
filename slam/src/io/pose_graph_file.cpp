#include "isotherm/slam/io/pose_graph_file.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include "io/graph_draft.hpp"
#include "io/place_reader.hpp"

namespace isotherm::slam {
namespace {

// Several files make one graph if each has poses with ids.
FileFormat format_of_part(TextReader& reader) {
  const auto format = require_format(reader);
  const bool has_ids =
      format == FileFormat::pyfg ||
      (content_of(format) == FileContent::pose_graph && format != FileFormat::places);
  if (!has_ids) {
    throw ParseError({reader.path(), 0, 0}, "",
                     "several files are read as one pose graph, but this one is in format " +
                         std::string(enum_name(format)));
  }
  return format;
}

// Names of files without folder and suffix, where that tells them apart.
std::vector<std::string> short_names(const std::vector<std::string>& paths) {
  std::vector<std::string> names;
  for (const auto& path : paths) names.push_back(std::filesystem::path(path).stem().string());
  return std::set(names.begin(), names.end()).size() == names.size() ? names : paths;
}

}  // namespace

PoseGraphFile read_pose_graph(TextReader& reader, const ReadOptions& options) {
  return read_pose_graph(reader, detect_format(reader), options);
}

PoseGraphFile read_pose_graph(TextReader& reader, FileFormat format, const ReadOptions& options) {
  options.validate();
  if (format == FileFormat::places) return detail::read_places(reader);
  return finish(detail::read_draft(reader, format, options), options);
}

PoseGraphFile read_pose_graph(const std::string& path, const ReadOptions& options) {
  TextReader reader(path);
  return read_pose_graph(reader, options);
}

PoseGraphFile read_pose_graphs(const std::vector<std::string>& paths, const ReadOptions& options) {
  options.validate();
  if (paths.empty()) throw InvalidArgument("paths", "must name a file");
  if (paths.size() == 1) return read_pose_graph(paths.front(), options);
  std::optional<detail::FileDraft> all;
  for (const auto& path : paths) {
    TextReader reader(path);
    auto next = detail::read_draft(reader, format_of_part(reader), options);
    if (all) {
      append(*all, std::move(next));
    } else {
      all = std::move(next);
    }
  }
  return finish(std::move(*all), options);
}

std::vector<Robot> robots_of(const PoseGraphFile& file) {
  return std::visit(
      [&](const auto& graph) {
        std::vector<Robot> robots;
        std::vector<std::uint64_t> seen;
        const auto names = short_names(file.paths);
        for (Index v = 0; v < graph.vertex_count(); ++v) {
          const auto robot = graph.robot(v);
          const auto found = std::find(seen.begin(), seen.end(), robot);
          if (found != seen.end()) {
            ++robots[static_cast<std::size_t>(found - seen.begin())].vertices;
            continue;
          }
          seen.push_back(robot);
          robots.push_back(
              {graph.robots.empty() ? robot_letter(graph.ids[v]) : names[robot], 1, robot});
        }
        if (robots.size() == 1 && robots.front().name.empty()) robots.clear();
        return robots;
      },
      file.graph);
}

}  // namespace isotherm::slam
