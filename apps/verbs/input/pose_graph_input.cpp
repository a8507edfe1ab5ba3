#include "verbs/input/pose_graph_input.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "console.hpp"
#include "isotherm/base/words.hpp"
#include "isotherm/slam/graph/trusted_edges.hpp"

namespace isotherm::apps {
namespace {

// One line a kind of finding: a file may have thousands of the same.
void warn_of_kinds(const ReadReport& report, const std::map<std::string, std::uint64_t>& counts,
                   const CommonFlags& flags) {
  for (const auto& [kind, times] : counts) {
    const auto first =
        std::find_if(report.diagnostics.begin(), report.diagnostics.end(),
                     [&kind](const Diagnostic& found) { return found.kind == kind; });
    if (first == report.diagnostics.end()) continue;
    const std::string more =
        times > 1 ? fmt::format(", and {} more like it ('isotherm info' lists them)", times - 1)
                  : "";
    warn(flags, to_string(*first) + more);
  }
}

std::string merged_in_words(const slam::PoseGraphFile& file) {
  const auto [vertices, edges] = std::visit(
      [](const auto& graph) { return std::pair(graph.ids.size(), graph.constraints.size()); },
      file.graph);
  const auto repeated = file.report.notes.find("repeated edge");
  std::string text = fmt::format("{} read as one graph: {}, {}", counted(file.paths.size(), "file"),
                                 counted(vertices, "pose"), counted(edges, "edge"));
  if (repeated != file.report.notes.end()) {
    text += fmt::format(", {} counted once", counted(repeated->second, "repeated edge"));
  }
  const auto robots = robots_in_words(file);
  return robots.empty() ? text : text + "; " + robots;
}

}  // namespace

void warn_of(const ReadReport& report, const CommonFlags& flags) {
  warn_of_kinds(report, report.repairs, flags);
  warn_of_kinds(report, report.notes, flags);
}

slam::PoseGraphFile read_input_graph(const std::vector<std::string>& paths,
                                     const CommonFlags& flags) {
  auto file = slam::read_pose_graphs(paths, {.strict = flags.strict});
  warn_of(file.report, flags);
  if (paths.size() > 1) say(flags, merged_in_words(file));
  return file;
}

void add_graph_inputs(CLI::App& verb, std::vector<std::string>& paths, const std::string& help) {
  verb.add_option("input", paths, help)->required()->type_name("FILE");
}

template <class Pose>
slam::EdgeRoles roles_of(const slam::PoseGraph<Pose>& graph, const std::string& trusted) {
  return trusted.empty() ? slam::edge_roles(graph) : slam::read_trusted_edges(trusted, graph);
}

template slam::EdgeRoles roles_of(const slam::PoseGraph<slam::Pose2>&, const std::string&);
template slam::EdgeRoles roles_of(const slam::PoseGraph<slam::Pose3>&, const std::string&);

template <class Pose>
std::vector<slam::Doubt> warn_of_doubts(const slam::PoseGraph<Pose>& graph,
                                        const slam::EdgeRoles& roles, const CommonFlags& flags) {
  auto doubts = slam::diagnose(graph, roles);
  for (const auto& doubt : doubts) {
    // Usual in benchmarks; 'info' has it.
    if (doubt.kind != "identical information") warn(flags, doubt.kind + "? " + doubt.message);
  }
  return doubts;
}

template std::vector<slam::Doubt> warn_of_doubts(const slam::PoseGraph<slam::Pose2>&,
                                                 const slam::EdgeRoles&, const CommonFlags&);
template std::vector<slam::Doubt> warn_of_doubts(const slam::PoseGraph<slam::Pose3>&,
                                                 const slam::EdgeRoles&, const CommonFlags&);

void warn_of_missing_times(const slam::AnyTrajectory& trajectory, slam::FileFormat format,
                           const CommonFlags& flags) {
  const bool known =
      std::visit([](const auto& poses) { return !poses.timestamps.empty(); }, trajectory);
  if (known || format == slam::FileFormat::kitti) return;
  warn(flags, fmt::format("the poses have no times, which {} needs: pose k is given the time k",
                          enum_name(format)));
}

std::string robots_in_words(const slam::PoseGraphFile& file) {
  const auto robots = slam::robots_of(file);
  if (robots.size() < 2) return {};
  std::vector<std::string> parts;
  for (const auto& robot : robots) {
    parts.push_back(fmt::format("{} ({})", robot.name.empty() ? "without a letter" : robot.name,
                                counted(robot.vertices, "pose")));
  }
  return fmt::format("robots {}", fmt::join(parts, ", "));
}

}  // namespace isotherm::apps
