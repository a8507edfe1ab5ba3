#include "isotherm/slam/prune/prune.hpp"

#include <chrono>
#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/graph/usable_odometry.hpp"
#include "prune/set_aside.hpp"

namespace isotherm::slam {
namespace {

using spectral::EdgeVerdicts;

template <std::size_t... kMethods>
std::vector<PruneOptions> one_of_each(std::index_sequence<kMethods...>) {
  return {PruneOptions(std::in_place_index<kMethods>)...};
}

}  // namespace

std::vector<PruneOptions> prune_methods() {
  return one_of_each(std::make_index_sequence<std::variant_size_v<PruneOptions>>());
}

PruneOptions prune_method(std::string_view name) {
  std::string known;
  for (const auto& options : prune_methods()) {
    if (method_name(options) == name) return options;
    known += known.empty() ? "" : "|";
    known += method_name(options);
  }
  throw InvalidArgument("method",
                        "unknown value '" + std::string(name) + "', expected one of " + known);
}

std::string_view method_name(const PruneOptions& options) {
  return std::visit([](const auto& own) { return own.method(); }, options);
}

std::string_view method_title(const PruneOptions& options) {
  return std::visit([](const auto& own) { return own.title(); }, options);
}

template <class Pose>
PruneResult prune(const PoseGraph<Pose>& graph, const EdgeRoles& roles, const PruneOptions& options,
                  const RunContext& run) {
  const auto start = std::chrono::steady_clock::now();
  EdgeRoles judged = roles;
  const detail::SetAside set_aside(graph, judged);
  const auto judge = [&](const PoseGraph<Pose>& usable) {
    return std::visit([&](const auto& own) { return detail::prune_by(usable, judged, own, run); },
                      options);
  };
  const auto unusable = unusable_information(graph, judged);
  PruneResult result =
      unusable.empty() ? judge(graph) : judge(with_usable_information(graph, judged, unusable));
  if (!unusable.empty()) {
    result.warnings.push_back(describe_unusable(graph, unusable) + "; made less extreme");
  }
  set_aside.return_to(result);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

template <class Pose>
PruneResult prune(const PoseGraph<Pose>& graph, const PruneOptions& options,
                  const RunContext& run) {
  return prune(graph, edge_roles(graph), options, run);
}

PruneResult prune(const AnyPoseGraph& any, const PruneOptions& options, const RunContext& run) {
  return std::visit([&](const auto& graph) { return prune(graph, options, run); }, any);
}

template <class Pose>
PoseGraph<Pose> apply_verdicts(const PoseGraph<Pose>& graph, const EdgeVerdicts& verdicts,
                               bool keep_ambiguous) {
  std::vector<bool> keep(graph.constraints.size(), true);
  for (const auto& verdict : verdicts) {
    if (verdict.edge < 0 || verdict.edge >= graph.constraint_count()) {
      throw InvalidArgument("verdicts",
                            "edge " + std::to_string(verdict.edge) + " is not in the graph");
    }
    keep[verdict.edge] = stays(verdict, keep_ambiguous);
  }
  return filter_constraints(graph, keep);
}

AnyPoseGraph apply_verdicts(const AnyPoseGraph& any, const EdgeVerdicts& verdicts,
                            bool keep_ambiguous) {
  return std::visit(
      [&](const auto& graph) -> AnyPoseGraph {
        return apply_verdicts(graph, verdicts, keep_ambiguous);
      },
      any);
}

template PruneResult prune(const PoseGraph<Pose2>&, const EdgeRoles&, const PruneOptions&,
                           const RunContext&);
template PruneResult prune(const PoseGraph<Pose3>&, const EdgeRoles&, const PruneOptions&,
                           const RunContext&);
template PruneResult prune(const PoseGraph<Pose2>&, const PruneOptions&, const RunContext&);
template PruneResult prune(const PoseGraph<Pose3>&, const PruneOptions&, const RunContext&);
template PoseGraph<Pose2> apply_verdicts(const PoseGraph<Pose2>&, const EdgeVerdicts&, bool);
template PoseGraph<Pose3> apply_verdicts(const PoseGraph<Pose3>&, const EdgeVerdicts&, bool);

}  // namespace isotherm::slam
