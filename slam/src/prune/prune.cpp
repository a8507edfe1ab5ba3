#include "isotherm/slam/prune/prune.hpp"

#include <chrono>
#include <utility>

#include "graph/candidate_verdicts.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/slam/graph/usable_odometry.hpp"

namespace isotherm::slam {
namespace {

using spectral::EdgeVerdicts;

template <std::size_t... kMethods>
std::vector<PruneOptions> one_of_each(std::index_sequence<kMethods...>) {
  return {PruneOptions(std::in_place_index<kMethods>)...};
}

// Takes the candidates that join a vertex with itself out of `roles`: whatever they
// measure, they say nothing about where two poses lie.
template <class Pose>
std::vector<Index> take_self_edges(const PoseGraph<Pose>& graph, EdgeRoles& roles) {
  std::vector<Index> self_edges;
  std::erase_if(roles.candidates, [&](Index k) {
    const bool own = graph.constraints[k].from == graph.constraints[k].to;
    if (own) self_edges.push_back(k);
    return own;
  });
  return self_edges;
}

// Gives self-edges their rows among those of the candidates, in order of the edges.
template <class Pose>
void set_aside(const PoseGraph<Pose>& graph, const std::vector<Index>& self_edges,
               PruneResult& result) {
  auto own = candidate_verdicts(graph, {{}, self_edges});
  for (auto& row : own) {
    row.verdict = spectral::Verdict::ambiguous;
    row.stage = "self-edge";
  }
  const bool detailed = !result.consensus.details.empty();
  EdgeVerdicts rows;
  std::vector<ConsensusDetail> details;
  std::vector<Index> place;  // of the candidates that were judged
  auto next = own.begin();
  for (std::size_t k = 0; k <= result.verdicts.size(); ++k) {
    const bool last = k == result.verdicts.size();
    while (next != own.end() && (last || next->edge < result.verdicts[k].edge)) {
      rows.push_back(std::move(*next++));
      details.emplace_back();
    }
    if (last) break;
    place.push_back(static_cast<Index>(rows.size()));
    rows.push_back(std::move(result.verdicts[k]));
    if (detailed) details.push_back(std::move(result.consensus.details[k]));
  }
  result.verdicts = std::move(rows);
  if (detailed) {
    for (auto& detail : details) {
      for (Index& conflict : detail.conflicts) conflict = place[conflict];
    }
    result.consensus.details = std::move(details);
  }
  result.warnings.push_back(std::to_string(self_edges.size()) +
                            " edges join a vertex with itself; they are set aside");
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
  const auto self_edges = take_self_edges(graph, judged);
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
  if (!self_edges.empty()) set_aside(graph, self_edges, result);
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
