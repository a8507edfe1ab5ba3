#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "isotherm/slam/optimize/optimize.hpp"
#include "isotherm/slam/pipeline.hpp"
#include "pages.hpp"
#include "report/build/pose_graph_report.hpp"
#include "run.hpp"
#include "slam/pose_arrays.hpp"
#include "slam/pruned.hpp"

namespace isotherm::python {
namespace {

template <class Pose>
std::string page_of_poses(const slam::PoseGraph<Pose>& graph, const Pruned& pruned,
                          std::vector<std::optional<Pose>> truth) {
  const auto& file = graph_of(pruned);
  apps::PruneRun<Pose> run{
      title_of(file.report.path, "pose graph"), {}, std::move(truth), slam::robots_of(file)};
  run.options.prune = pruned.options;
  return without_gil({}, nb::find(pruned), [&graph, &pruned, run](const RunContext& context) {
    slam::PipelineResult<slam::PoseGraph<Pose>> result{
        pruned.roles, pruned.result, slam::apply_verdicts(graph, pruned.result.verdicts), {}};
    auto solved = slam::optimize(result.pruned, *run.options.optimize, context);
    result.pruned.poses = std::move(solved.poses);
    result.optimized = std::move(solved);
    return python::page_of(apps::pose_graph_report(graph, result, run, context));
  });
}

}  // namespace

std::string page_of(const Pruned& pruned, nb::handle truth) {
  return std::visit(
      [&](const auto& graph) {
        using Pose = std::decay_t<decltype(graph.constraints[0].T_from_to)>;
        std::vector<std::optional<Pose>> known;
        if (!truth.is_none()) {
          known = known_poses_from<Pose>(truth, "truth");
          require_length("truth", known.size(), graph.ids.size());
        }
        return page_of_poses(graph, pruned, std::move(known));
      },
      graph_of(pruned).graph);
}

}  // namespace isotherm::python
