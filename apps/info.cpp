#include <cstdlib>
#include <memory>
#include <variant>

#include <fmt/format.h>

#include "console.hpp"
#include "pose_graph_input.hpp"
#include "verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;

// Counts of what a pose graph holds.
struct Counts {
  int dimension = 0;
  std::size_t vertices = 0;
  std::size_t odometry = 0;
  std::size_t candidates = 0;
  std::size_t consecutive = 0;  // edges with |i - j| = 1, duplicates included
  bool has_poses = false;
};

template <class Pose>
Counts count_parts(const PoseGraph<Pose>& graph) {
  const auto roles = edge_roles(graph);
  Counts counts{Pose::kDim, graph.ids.size(),    roles.odometry.size(), roles.candidates.size(),
                0,          !graph.poses.empty()};
  for (const auto& constraint : graph.constraints) {
    const VertexId from = graph.ids[constraint.from];
    const VertexId to = graph.ids[constraint.to];
    if ((from > to ? from - to : to - from) == 1) ++counts.consecutive;
  }
  return counts;
}

struct InfoVerb {
  CommonFlags flags;
  std::string input;

  int run() const {
    const auto file = slam::read_pose_graph(input, {.strict = flags.strict});
    const auto counts =
        std::visit([](const auto& graph) { return count_parts(graph); }, file.graph);
    const std::size_t edges = counts.odometry + counts.candidates;
    if (flags.json != "-") {
      fmt::print("{}: {} pose graph in {} dimensions\n", input, file.report.format,
                 counts.dimension);
      fmt::print("  vertices    {}{}\n", counts.vertices,
                 counts.has_poses ? "" : " (without initial poses)");
      fmt::print("  edges       {}\n", edges);
      fmt::print("  odometry    {}\n", counts.odometry);
      fmt::print("  candidates  {}\n", counts.candidates);
      for (const auto& diagnostic : file.report.diagnostics) {
        fmt::print("  {}\n", to_string(diagnostic));
      }
    }
    write_json(flags.json, {{"schema", "isotherm.info/1"},
                            {"format", file.report.format},
                            {"dimension", counts.dimension},
                            {"vertices", counts.vertices},
                            {"edges", edges},
                            {"odometry", counts.odometry},
                            {"candidates", counts.candidates},
                            {"consecutive_edges", counts.consecutive},
                            {"other_edges", edges - counts.consecutive},
                            {"repairs", file.report.repairs},
                            {"skipped", file.report.skipped}});
    return kOk;
  }
};

}  // namespace

Verb add_info(CLI::App& root) {
  auto info = std::make_shared<InfoVerb>();
  CLI::App* verb = root.add_subcommand("info", "say what is in a file");
  verb->add_option("input", info->input, "pose graph (- for stdin)")->required();
  add_common_flags(*verb, info->flags);
  return {verb, [info] { return info->run(); }};
}

}  // namespace isotherm::apps
