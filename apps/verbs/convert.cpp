#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "console.hpp"
#include "isotherm/network/io/range_file.hpp"
#include "isotherm/slam/evaluate/labels.hpp"
#include "isotherm/slam/graph/replay_order.hpp"
#include "isotherm/slam/io/file_format.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/slam/io/trajectory_file.hpp"
#include "isotherm/spectral/graph/graph_file.hpp"
#include "option_verb.hpp"
#include "verbs/input/pose_graph_input.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using slam::FileContent;
using slam::FileFormat;

// Which name goes with which format; one that goes with several tells none.
constexpr std::array<std::pair<std::string_view, FileFormat>, 11> kSuffixes = {{
    {".g2o", FileFormat::g2o},
    {".graph", FileFormat::toro},
    {".pyfg", FileFormat::pyfg},
    {".tum", FileFormat::tum},
    {".kitti", FileFormat::kitti},
    {".euroc", FileFormat::euroc},
    {".mtx", FileFormat::matrix_market},
    {".isograph", FileFormat::binary_graph},
    {".csv", FileFormat::euroc},
    {".csv", FileFormat::ranges},
    {".csv", FileFormat::edges},
}};

std::optional<FileFormat> format_of_name(const std::string& path) {
  std::optional<FileFormat> found;
  for (const auto& [suffix, format] : kSuffixes) {
    if (suffix != format_suffix(path)) continue;
    if (found) return std::nullopt;
    found = format;
  }
  return found;
}

std::vector<std::string_view> suffixes_of(FileFormat format) {
  std::vector<std::string_view> found;
  for (const auto& [suffix, other] : kSuffixes) {
    if (other == format) found.push_back(suffix);
  }
  return found;
}

// The structure of a pose graph: one edge of weight 1 a constraint.
template <class Pose>
spectral::GraphFile structure_of(const slam::PoseGraph<Pose>& graph) {
  std::vector<spectral::WeightedEdge> edges;
  for (const auto& constraint : graph.constraints) {
    edges.push_back({constraint.from, constraint.to, 1.0});
  }
  return {{graph.vertex_count(), std::move(edges)}, graph.ids, {}};
}

constexpr const char* kToVehicle = "camera-to-vehicle";
constexpr const char* kToCamera = "vehicle-to-camera";

struct ConvertVerb : OptionVerb<NoOptions> {
  std::vector<std::string> input;
  std::string output;
  std::string to;
  std::string axes;
  std::string labels;
  std::string known_labels;
  std::string truth;
  bool in_time_order = false;

  int run() {
    if (resolve_or_dump()) return kOk;
    if (!known_labels.empty() && labels.empty()) {
      throw InvalidArgument("--known-labels", "goes with --labels");
    }
    const FileFormat target = target_format();
    const ReadReport report = convert(target);
    for (const auto& loss : losses_) warn(flags, loss);
    say(flags, fmt::format("{} ({}) -> {} ({})", fmt::join(input, ", "), report.format, output,
                           enum_name(target)));
    write_json(flags.json, {{"schema", "isotherm.convert/1"},
                            {"from", report.format},
                            {"to", enum_name(target)},
                            {"records", report.records},
                            {"skipped", report.skipped},
                            {"repairs", report.repairs},
                            {"losses", losses_}});
    return kOk;
  }

 private:
  FileFormat target_format() const {
    if (!to.empty()) {
      const auto target = enum_value<FileFormat>("--to", to);
      require_suffix("--output", output, suffixes_of(target));
      return target;
    }
    const auto named = format_of_name(output);
    if (!named) {
      throw InvalidArgument("--to", "is needed where the name of the output tells no format");
    }
    return *named;
  }

  ReadReport convert(FileFormat target) {
    if (input.size() > 1) return convert_pose_graph(read_input_graph(input, flags), target);
    TextReader reader(input.front());
    const auto report = convert(reader, slam::require_format(reader), target);
    warn_of(report, flags);
    return report;
  }

  ReadReport convert(TextReader& reader, FileFormat source, FileFormat target) {
    const ReadOptions reading{.strict = flags.strict};
    const bool to_ranges = target == FileFormat::ranges || target == FileFormat::pyfg;
    switch (slam::content_of(source)) {
      case FileContent::ranges:
        if (source == FileFormat::pyfg && !to_ranges) break;  // its poses are wanted
        return convert_ranges(network::read_ranges(reader, reading), target);
      case FileContent::trajectory:
        return convert_trajectory(slam::read_trajectory(reader, source, reading), target);
      case FileContent::graph:
        return convert_graph(spectral::read_graph(reader, reading), target);
      case FileContent::pose_graph:
      case FileContent::unknown:
        break;
    }
    return convert_pose_graph(slam::read_pose_graph(reader, source, reading), target);
  }

  [[noreturn]] void refuse(const ReadReport& report, FileFormat target) const {
    throw InvalidArgument("--to", fmt::format("a file in format {} cannot become {}", report.format,
                                              enum_name(target)));
  }

  // What the target has no place for.
  void note_losses(const slam::PoseGraphFile& file) {
    const auto fixed = std::visit([](const auto& graph) { return graph.fixed.size(); }, file.graph);
    if (fixed > 0) {
      losses_.push_back(
          fmt::format("TORO has no FIX: the marks of fixed vertices are lost ({})", fixed));
    }
    if (!file.other_lines.empty()) {
      losses_.push_back(
          fmt::format("comments and unknown records are lost ({})", file.other_lines.size()));
    }
  }
  void note_losses(const spectral::GraphFile& file) {
    for (std::size_t k = 0; k < file.ids.size(); ++k) {
      if (file.ids[k] == k + 1) continue;
      losses_.push_back(fmt::format("vertices are numbered from 1 in ascending order: {} is now {}",
                                    file.ids[k], k + 1));
      return;
    }
  }

  ReadReport convert_pose_graph(slam::PoseGraphFile file, FileFormat target) {
    if (!axes.empty() && slam::content_of(target) != FileContent::trajectory) {
      throw InvalidArgument("--axes", "are turned in trajectories only");
    }
    auto rows = labels.empty() ? std::vector<slam::EdgeLabel>() : known_labels_of(file);
    if (!truth.empty()) write_known_truth(file);
    if (in_time_order) put_in_time_order(file.graph, rows);
    if (!labels.empty()) slam::write_labels(labels, rows);
    if (target == FileFormat::g2o) {
      slam::write_g2o(output, file);
    } else if (target == FileFormat::toro) {
      note_losses(file);
      slam::write_toro(output, file.graph);
    } else if (slam::content_of(target) == FileContent::trajectory) {
      slam::TrajectoryFile trajectory;
      trajectory.report = std::move(file.report);
      std::visit([&](const auto& g) { trajectory.trajectory = trajectory_of(g); }, file.graph);
      return convert_trajectory(trajectory, target);
    } else if (slam::content_of(target) == FileContent::graph) {
      auto graph = std::visit([](const auto& g) { return structure_of(g); }, file.graph);
      graph.report = std::move(file.report);
      return convert_graph(graph, target);
    } else {
      refuse(file.report, target);
    }
    return file.report;
  }

  // What a JRL file says of its poses.
  void write_known_truth(const slam::PoseGraphFile& file) const {
    if (!file.truth) {
      throw InvalidArgument("--truth",
                            "is known of JRL files that have it only, not of " + file.report.path);
    }
    slam::write_g2o(truth, *file.truth);
  }

  // Those of --known-labels, or what an IRL or JRL file says of its loops.
  std::vector<slam::EdgeLabel> known_labels_of(const slam::PoseGraphFile& file) const {
    if (!known_labels.empty()) return slam::read_labels(known_labels);
    if (file.correct.empty()) {
      throw InvalidArgument("--labels",
                            "are known of IRL and JRL files that have them only, not of " +
                                file.report.path + "; --known-labels tells them of other files");
    }
    std::vector<slam::EdgeLabel> rows;
    std::visit(
        [&](const auto& graph) {
          for (const auto k : edge_roles(graph).candidates) {
            const auto& edge = graph.constraints[k];
            const auto label = file.correct[k] ? slam::Label::correct : slam::Label::incorrect;
            rows.push_back({k, graph.ids[edge.from], graph.ids[edge.to], label});
          }
        },
        file.graph);
    return rows;
  }

  // Labels count edges in the order of the output.
  static void put_in_time_order(slam::AnyPoseGraph& any, std::vector<slam::EdgeLabel>& rows) {
    const auto order = std::visit([](const auto& graph) { return replay_order(graph); }, any);
    std::vector<std::int64_t> place(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
      place[static_cast<std::size_t>(order[k])] = static_cast<std::int64_t>(k);
    }
    for (auto& row : rows) {
      if (row.edge < 0 || row.edge >= static_cast<std::int64_t>(place.size())) {
        throw InvalidArgument("--known-labels", fmt::format("has an edge {}, the graph has {}",
                                                            row.edge, place.size()));
      }
      row.edge = place[static_cast<std::size_t>(row.edge)];
    }
    std::ranges::sort(rows, {}, &slam::EdgeLabel::edge);
    std::visit([](auto& graph) { graph = in_replay_order(std::move(graph)); }, any);
  }

  ReadReport convert_trajectory(const slam::TrajectoryFile& file, FileFormat target) const {
    if (slam::content_of(target) != FileContent::trajectory || target == FileFormat::points) {
      refuse(file.report, target);
    }
    auto trajectory = file.trajectory;
    if (!axes.empty()) turn(trajectory);
    warn_of_missing_times(trajectory, target, flags);
    slam::write_trajectory(output, trajectory, target);
    return file.report;
  }

  void turn(slam::AnyTrajectory& any) const {
    auto* trajectory = std::get_if<slam::Trajectory<slam::Pose3>>(&any);
    if (trajectory == nullptr) throw InvalidArgument("--axes", "are those of poses in space");
    const auto change = axes == kToVehicle ? slam::camera_to_vehicle : slam::vehicle_to_camera;
    for (auto& pose : trajectory->poses) pose = change(pose);
  }

  ReadReport convert_ranges(const network::RangeFile& file, FileFormat target) const {
    if (target == FileFormat::pyfg) {
      network::write_pyfg(output, file.network);
    } else if (target == FileFormat::ranges) {
      network::write_range_csv(output, file.network);
    } else {
      refuse(file.report, target);
    }
    return file.report;
  }

  ReadReport convert_graph(const spectral::GraphFile& file, FileFormat target) {
    if (target == FileFormat::edges) {
      spectral::write_edge_csv(output, file.graph, file.ids);
    } else if (target == FileFormat::binary_graph) {
      spectral::write_binary_graph(output, file.graph, file.ids);
    } else if (target == FileFormat::matrix_market) {
      note_losses(file);
      spectral::write_matrix_market(output, file.graph);
    } else {
      refuse(file.report, target);
    }
    return file.report;
  }

  std::vector<std::string> losses_;
};

}  // namespace

Verb add_convert(CLI::App& root) {
  auto convert = std::make_shared<ConvertVerb>();
  CLI::App* verb = root.add_subcommand("convert", "write a file in another format");
  add_graph_inputs(*verb, convert->input,
                   "pose graph (also several files of one), trajectory, ranges or plain graph "
                   "(- for stdin)");
  convert->flags.outputs
      .add(*verb, "-o,--output", convert->output, "file to write (- for stdout)", {})
      ->required();
  verb->add_option("--to", convert->to,
                   "g2o, toro, tum, kitti, euroc, planar, pyfg, ranges, edges, matrix-market or "
                   "binary-graph; by default what the output's suffix says (.g2o .graph .tum "
                   ".kitti .euroc .pyfg .mtx .isograph)")
      ->type_name("FORMAT");
  convert->flags.outputs.add(*verb, "--labels", convert->labels,
                             "which loops are true, as CSV: what an IRL or JRL file says, or "
                             "--known-labels",
                             {".csv"});
  verb->add_option("--known-labels", convert->known_labels,
                   "labels of the input, to be written to --labels for the edges of the output")
      ->type_name("FILE");
  convert->flags.outputs.add(*verb, "--truth", convert->truth,
                             "the true poses that a JRL file has, as g2o", {".g2o"});
  verb->add_flag("--in-time-order", convert->in_time_order,
                 "write the edges of a pose graph in an order that 'follow' can replay");
  verb->add_option("--axes", convert->axes,
                   "turn a trajectory in space: a camera's axes are z forward, x right, y down, "
                   "a vehicle's x forward, y left, z up")
      ->check(CLI::IsMember({kToVehicle, kToCamera}))
      ->type_name("CHANGE");
  convert->add_flags(*verb);
  return verb_of(verb, convert);
}

}  // namespace isotherm::apps
