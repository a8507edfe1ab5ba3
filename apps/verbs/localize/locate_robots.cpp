#include "verbs/localize/locate_robots.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/base/text_reader.hpp"
#include "isotherm/base/words.hpp"
#include "isotherm/network/io/position_file.hpp"
#include "isotherm/network/io/range_file.hpp"
#include "isotherm/slam/io/file_format.hpp"
#include "isotherm/slam/io/trajectory_file.hpp"
#include "isotherm/slam/ranges/range_graph_file.hpp"
#include "isotherm/slam/ranges/range_robots.hpp"
#include "output_flags.hpp"
#include "verbs/input/pose_graph_input.hpp"

namespace isotherm::apps {
namespace {

using network::NodeStatus;

// Points with a position that the input, or a file beside it, gives.
template <class Pose>
std::vector<slam::Index> known_points(slam::RangeGraph<Pose>& graph, const RobotInput& input,
                                      const CommonFlags& flags) {
  std::vector<slam::Index> anchors;
  if (!input.anchors.empty()) {
    const auto known = network::read_positions(input.anchors);
    if (known.dimension() != Pose::kDim) {
      throw InvalidArgument("anchors", "have another number of coordinates than the odometry");
    }
    const auto column_of = known.column_of();
    std::size_t found = 0;
    for (slam::Index v = 0; v < graph.node_count(); ++v) {
      const auto entry = column_of.find(graph.names[v]);
      if (entry == column_of.end()) continue;
      typename Pose::Tangent tangent = Pose::Tangent::Zero();
      tangent.template head<Pose::kDim>() = known.positions.col(entry->second);
      graph.positions[v] = Pose::exp(tangent);
      graph.placed[v] = true;
      anchors.push_back(v);
      ++found;
    }
    if (found < known.names.size()) warn(flags, "not all anchors are among the nodes");
  } else if (input.file_anchors) {
    for (slam::Index v = 0; v < graph.node_count(); ++v) {
      if (graph.is_point[v] && graph.placed[v]) anchors.push_back(v);
    }
  }
  return anchors;
}

std::string trajectory_path(const std::string& path, const std::string& robot, bool several) {
  if (!several || path == "-") return path;
  const auto dot = path.size() - format_suffix(path).size();
  return path.substr(0, dot) + "_" + robot + path.substr(dot);
}

slam::FileFormat trajectory_format(const std::string& path) {
  const auto suffix = format_suffix(path);
  if (suffix == ".kitti") return slam::FileFormat::kitti;
  if (suffix == ".csv") return slam::FileFormat::euroc;
  return slam::FileFormat::tum;
}

template <class Pose>
void write_trajectories(const slam::RangeGraph<Pose>& graph, const slam::LocateResult<Pose>& result,
                        const std::string& path) {
  if (path.empty()) return;
  const auto robots = slam::robot_trajectories(graph, result);
  if (path == "-" && robots.size() > 1) {
    throw InvalidArgument("trajectory", "of several robots needs a file, not -");
  }
  for (const auto& [robot, trajectory] : robots) {
    slam::write_trajectory(trajectory_path(path, robot, robots.size() > 1), trajectory,
                           trajectory_format(path));
  }
}

template <class Pose>
std::string used(const slam::RangeGraph<Pose>& graph, std::size_t anchors) {
  const auto points = std::ranges::count(graph.is_point, true);
  const auto poses = graph.node_count() - points;
  std::string line = fmt::format("used: {}, {} of odometry, {}, {}", counted(poses, "pose"),
                                 counted(graph.steps.size(), "step"), counted(points, "beacon"),
                                 counted(graph.ranges.size(), "range"));
  if (anchors > 0) line += fmt::format(", {}", counted(anchors, "known position"));
  if (!graph.priors.empty()) line += fmt::format(", {}", counted(graph.priors.size(), "prior"));
  return line;
}

std::string learned(const slam::RangeErrors& errors) {
  std::string line =
      fmt::format("learned: ranges {:.3g} times as spread as stated, odometry {:.3g} times",
                  errors.scale, std::sqrt(errors.odometry));
  if (errors.too_long > 0.0) {
    line += fmt::format("; {:.1f} % too long, by {:.3g} m on average", 100.0 * errors.too_long,
                        errors.excess);
  }
  line += fmt::format("; {:.1f} % false", 100.0 * errors.anything);
  if (errors.calibrated) {
    line += fmt::format("; all ranges {:+.3g} m off and {:.4g} times the distance", errors.offset,
                        errors.stretch);
  }
  return line;
}

template <class Pose>
Json summary_of(const slam::RangeGraph<Pose>& graph, const slam::LocateResult<Pose>& result,
                std::size_t anchors) {
  const auto points = std::ranges::count(graph.is_point, true);
  const auto& errors = result.errors;
  return {{"used",
           {{"poses", graph.node_count() - points},
            {"steps", graph.steps.size()},
            {"beacons", points},
            {"ranges", graph.ranges.size()},
            {"anchors", anchors},
            {"priors", graph.priors.size()}}},
          {"range_scale", errors.scale},
          {"odometry_scale", std::sqrt(errors.odometry)},
          {"share_too_long", errors.too_long},
          {"excess", errors.excess},
          {"share_false", errors.anything},
          {"calibrated", errors.calibrated},
          {"offset", errors.offset},
          {"stretch", errors.stretch},
          {"cost", result.cost},
          {"evidence", result.evidence}};
}

template <class Pose>
RobotOutcome locate_in(slam::RangeGraph<Pose> graph, const RobotInput& input,
                       const slam::LocateOptions& options, const std::string& trajectory,
                       const CommonFlags& flags) {
  const auto anchors = known_points(graph, input, flags);
  say(flags, used(graph, anchors.size()));
  const RunContext run{.threads = flags.threads, .progress = progress_line(flags)};
  const auto result = slam::locate(graph, anchors, options, run);
  say(flags, learned(result.errors));
  write_trajectories(graph, result, trajectory);
  return {slam::network_of(graph), slam::as_localize_result(graph, result), result.errors,
          summary_of(graph, result, anchors.size())};
}

bool holds_steps(const slam::AnyRangeGraph& any) {
  return std::visit([](const auto& graph) { return !graph.steps.empty(); }, any);
}

slam::AnyRangeGraph read_odometry(const std::string& path, const CommonFlags& flags) {
  auto file = slam::read_range_graph(path, {.strict = flags.strict});
  warn_of(file.report, flags);
  if (!holds_steps(file.graph)) {
    throw ParseError({path, 0, 0}, "", "no odometry; expected PyFG or libRSF with steps");
  }
  return std::move(file.graph);
}

}  // namespace

std::optional<slam::AnyRangeGraph> read_robots(const std::string& path, const std::string& text,
                                               const std::string& odometry,
                                               const CommonFlags& flags) {
  TextReader reader(path, text);
  if (!odometry.empty()) {
    auto graph = read_odometry(odometry, flags);
    const auto log = network::read_ranges(reader, {.strict = flags.strict});
    const auto attached =
        std::visit([&](auto& one) { return slam::attach_ranges(log.network, one); }, graph);
    say(flags, fmt::format("{} matched to odometry by time", counted(attached.attached, "range")));
    if (attached.outside > 0) {
      warn(flags, fmt::format("{} left out: no odometry at their time",
                              counted(attached.outside, "range")));
    }
    return graph;
  }
  const auto format = slam::detect_format(reader);
  if (format != slam::FileFormat::pyfg && format != slam::FileFormat::librsf) return std::nullopt;
  if (text.find("EDGE_SE") == std::string::npos && text.find("odom2diff") == std::string::npos) {
    return std::nullopt;
  }
  auto file = slam::read_range_graph(reader, {.strict = flags.strict});
  if (!holds_steps(file.graph)) return std::nullopt;
  warn_of(file.report, flags);
  return std::move(file.graph);
}

RobotOutcome locate_robots(const RobotInput& input, const slam::LocateOptions& options,
                           const std::string& trajectory, const CommonFlags& flags) {
  return std::visit(
      [&](const auto& graph) { return locate_in(graph, input, options, trajectory, flags); },
      input.graph);
}

}  // namespace isotherm::apps
