#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "isotherm/base/run_context.hpp"
#include "isotherm/slam/graph/any_pose_graph.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/slam/prune/chi2_prune.hpp"
#include "isotherm/slam/prune/consensus.hpp"
#include "isotherm/slam/prune/curve_prune.hpp"
#include "isotherm/slam/prune/heat_prune.hpp"
#include "isotherm/slam/prune/kernel_prune.hpp"
#include "isotherm/slam/prune/pcm.hpp"
#include "isotherm/slam/prune/rrr.hpp"
#include "isotherm/spectral/edges/edge_verdicts.hpp"

namespace isotherm::slam {

/// How false loop closures are found: a method with its options. This is the one list of
/// methods; the first is the default. Each offers method(), its name, title(), what it is
/// called in a sentence, validate(), visit_fields() and a door, detail::prune_by().
using PruneOptions =
    std::variant<ConsensusOptions, HeatPruneOptions, Chi2PruneOptions, CurvePruneOptions,
                 RrrOptions, PcmOptions, ScOptions, DcsOptions, CauchyOptions, GncOptions>;

/// Every method with its default options, in the order of the list.
std::vector<PruneOptions> prune_methods();

/// The method of that name with its default options.
/// @throws InvalidArgument listing the names if there is none
PruneOptions prune_method(std::string_view name);

std::string_view method_name(const PruneOptions& options);
std::string_view method_title(const PruneOptions& options);

/// Visits the name of the method, then the fields of its options.
template <class Visitor>
void visit_fields(const PruneOptions& options, Visitor&& visit) {
  visit("method", std::string(method_name(options)), "how false loop closures are found");
  std::visit([&visit](const auto& own) { visit_fields(own, visit); }, options);
}

struct PruneResult {
  std::string method;                 ///< name of the one that decided
  spectral::EdgeVerdicts verdicts;    ///< one a candidate, in file order
  std::vector<HeatRound> rounds;      ///< method heat: one a scale
  ConsensusResult consensus;          ///< method consensus: all but the verdicts
  std::vector<std::string> warnings;  ///< what a user should know about the result
  double seconds = 0.0;               ///< wall time
};

/// Judges every candidate of `roles`. Where all information matrices of odometry or of
/// candidates are zero, consensus gives way to heat with uniform weights; `method` and
/// `warnings` of the result say so.
/// @throws InvalidArgument, NumericalError, Cancelled
template <class Pose>
PruneResult prune(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                  const PruneOptions& options = {}, const RunContext& run = {});

/// The same with the roles that edge_roles() finds.
template <class Pose>
PruneResult prune(const PoseGraph<Pose>& graph, const PruneOptions& options = {},
                  const RunContext& run = {});
PruneResult prune(const AnyPoseGraph& graph, const PruneOptions& options = {},
                  const RunContext& run = {});

/// The graph without the constraints that are pruned, nor, unless
/// `keep_ambiguous`, those that are ambiguous.
/// @throws InvalidArgument if a verdict's edge is not one of the graph's
template <class Pose>
PoseGraph<Pose> apply_verdicts(const PoseGraph<Pose>& graph, const spectral::EdgeVerdicts& verdicts,
                               bool keep_ambiguous = false);
AnyPoseGraph apply_verdicts(const AnyPoseGraph& graph, const spectral::EdgeVerdicts& verdicts,
                            bool keep_ambiguous = false);

}  // namespace isotherm::slam
