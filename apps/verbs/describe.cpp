#include "verbs/describe.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "isotherm/slam/graph/diagnose.hpp"
#include "isotherm/slam/graph/graph_summary.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;

Json start(const std::string& content, const ReadReport& report) {
  return {{"schema", "isotherm.info/1"},
          {"content", content},
          {"format", report.format},
          {"lines", report.lines}};
}

// What the reader noticed, after the counts.
void add_report(Json& json, const ReadReport& report) {
  json["records"] = report.records;
  json["skipped"] = report.skipped;
  json["repairs"] = report.repairs;
  json["notes"] = report.notes;
  Json found = Json::array();
  for (const auto& diagnostic : report.diagnostics) {
    found.push_back({{"kind", diagnostic.kind},
                     {"line", diagnostic.where.line},
                     {"column", diagnostic.where.column},
                     {"token", diagnostic.token},
                     {"message", diagnostic.message}});
  }
  json["diagnostics"] = std::move(found);
}

Json health_as_json(const InformationHealth& health) {
  return {{"edges", health.edges},
          {"distinct", health.distinct},
          {"singular", health.singular},
          {"off_diagonal", health.off_diagonal},
          {"worst_condition", health.worst_condition},
          {"median_translation_sigma_m", health.median_translation_sigma},
          {"median_rotation_sigma_rad", health.median_rotation_sigma}};
}

Json drift_as_json(const OdometryDrift& drift) {
  return {{"path_length_m", drift.path_length},   {"mean_distance_m", drift.mean_distance},
          {"max_distance_m", drift.max_distance}, {"max_at_vertex", drift.max_vertex},
          {"end_distance_m", drift.end_distance}, {"end_rotation_rad", drift.end_rotation}};
}

void add_summary(Json& json, const GraphSummary& summary) {
  json["dimension"] = summary.dimension;
  json["vertices"] = summary.vertices;
  json["has_poses"] = summary.has_poses;
  json["edges"] = summary.edges;
  json["odometry"] = summary.odometry;
  json["candidates"] = summary.candidates;
  json["consecutive_edges"] = summary.consecutive_edges;
  json["other_edges"] = summary.other_edges;
  json["repeated_edges"] = summary.repeated_edges;
  json["exact_repeats"] = summary.exact_repeats;
  json["self_edges"] = summary.self_edges;
  json["fixed"] = summary.fixed;
  json["robots"] = summary.robots;
  json["connectivity"] = {{"components", summary.components},
                          {"largest_component", summary.largest_component},
                          {"isolated_vertices", summary.isolated_vertices},
                          {"odometry_chains", summary.odometry_chains}};
  json["information"] = {{"odometry", health_as_json(summary.odometry_information)},
                         {"candidates", health_as_json(summary.candidate_information)}};
  json["drift"] = summary.drift ? drift_as_json(*summary.drift) : Json();
  json["suspicious"] = summary.suspicious;
  Json found = Json::array();
  for (const auto& suspicion : summary.suspicions) {
    found.push_back(
        {{"kind", suspicion.kind}, {"line", suspicion.line}, {"message", suspicion.message}});
  }
  json["suspicions"] = std::move(found);
}

Json doubts_of(const PoseGraphFile& file) {
  Json found = Json::array();
  std::visit(
      [&](const auto& graph) {
        for (const auto& doubt : diagnose(graph, edge_roles(graph))) {
          found.push_back(
              {{"kind", doubt.kind}, {"line", 0}, {"message", doubt.kind + "? " + doubt.message}});
        }
      },
      file.graph);
  return found;
}

template <class Pose>
void add_trajectory(Json& json, const Trajectory<Pose>& trajectory) {
  double length = 0.0;
  double longest_step = 0.0;
  for (std::size_t k = 1; k < trajectory.poses.size(); ++k) {
    const double step =
        (trajectory.poses[k].translation() - trajectory.poses[k - 1].translation()).norm();
    length += step;
    longest_step = std::max(longest_step, step);
  }
  json["dimension"] = static_cast<int>(Pose::kDim);
  json["poses"] = trajectory.poses.size();
  json["path_length_m"] = length;
  json["longest_step_m"] = longest_step;
  json["has_timestamps"] = !trajectory.timestamps.empty();
  if (!trajectory.timestamps.empty()) {
    json["first_timestamp_s"] = trajectory.timestamps.front();
    json["last_timestamp_s"] = trajectory.timestamps.back();
  }
}

double quantile(const std::vector<double>& sorted, double q) {
  return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}

Json spread(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {{"min", values.front()},
          {"median", quantile(values, 0.5)},
          {"p95", quantile(values, 0.95)},
          {"max", values.back()}};
}

// How far the ranges are from the distances of the positions in the file.
Json range_errors(const network::RangeNetwork& network) {
  std::vector<double> errors;
  for (const auto& range : network.ranges) {
    const double truth =
        (network.positions.col(range.from) - network.positions.col(range.to)).norm();
    if (std::isfinite(truth)) errors.push_back(std::abs(range.distance - truth));
  }
  return spread(std::move(errors));
}

std::string shown(const Json& value) {
  if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_null()) return "unknown";
  return value.dump();
}

// "line 12: edge ..." for an entry of a list of findings.
std::string finding(const Json& entry) {
  const auto line = entry.at("line").get<std::uint64_t>();
  const std::string where = line > 0 ? fmt::format("line {}: ", line) : "";
  return where + entry.at("message").get<std::string>();
}

void append_text(std::string& text, const Json& json, std::size_t indent) {
  const std::string margin(indent, ' ');
  for (const auto& [key, value] : json.items()) {
    if (key == "schema" || (value.is_structured() && value.empty())) continue;
    std::string name = key;
    // Tags of records, in capitals, stay as they are.
    if (std::islower(static_cast<unsigned char>(name.front())) != 0) {
      std::replace(name.begin(), name.end(), '_', ' ');
    }
    if (value.is_object()) {
      text += margin + name + "\n";
      append_text(text, value, indent + 2);
    } else if (value.is_array()) {
      text += margin + name + "\n";
      for (const auto& entry : value) text += margin + "  " + finding(entry) + "\n";
    } else {
      text += fmt::format("{}{:<{}} {}\n", margin, name, 30 - indent, shown(value));
    }
  }
}

}  // namespace

Json describe(const PoseGraphFile& file) {
  Json json = start("pose-graph", file.report);
  std::visit([&](const auto& graph) { add_summary(json, summarize(graph)); }, file.graph);
  json["doubts"] = doubts_of(file);
  const auto robots = robots_of(file);
  for (const auto& robot : robots) json["poses_of_robots"][robot.name] = robot.vertices;
  add_report(json, file.report);
  return json;
}

Json describe(const TrajectoryFile& file) {
  Json json = start("trajectory", file.report);
  std::visit([&](const auto& trajectory) { add_trajectory(json, trajectory); }, file.trajectory);
  add_report(json, file.report);
  return json;
}

Json describe(const network::RangeFile& file) {
  const auto& network = file.network;
  Json json = start("ranges", file.report);
  std::vector<double> distances;
  std::uint64_t exact = 0;
  for (const auto& range : network.ranges) {
    distances.push_back(range.distance);
    if (range.variance == 0.0) ++exact;
  }
  json["dimension"] = network.dimension;
  json["nodes"] = network.node_count();
  json["landmarks"] = network.landmarks.size();
  json["ranges"] = network.ranges.size();
  json["without_variance"] = exact;
  json["distance_m"] = spread(std::move(distances));
  json["error_to_positions_m"] = range_errors(network);
  add_report(json, file.report);
  return json;
}

Json describe(const spectral::GraphFile& file) {
  Json json = start("graph", file.report);
  std::vector<double> weights;
  for (const auto& edge : file.graph.edges()) weights.push_back(edge.weight);
  json["vertices"] = file.graph.vertex_count();
  json["edges"] = file.graph.edge_count();
  json["components"] = spectral::connected_components(file.graph).count;
  json["weight"] = spread(std::move(weights));
  add_report(json, file.report);
  return json;
}

std::string to_text(const Json& description) {
  std::string text;
  append_text(text, description, 0);
  return text;
}

}  // namespace isotherm::apps
