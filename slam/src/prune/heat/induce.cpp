#include "isotherm/slam/prune/induce.hpp"

#include "isotherm/base/range.hpp"
#include "isotherm/slam/prune/odometry_chi2.hpp"

namespace isotherm::slam {
namespace {

template <class Pose>
std::vector<double> candidate_weights(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                      const InductionOptions& options, const RunContext& run) {
  const bool both = options.weights == LoopWeights::both;
  std::vector<double> weights(roles.candidates.size(), options.loop_weight);
  if (both || options.weights == LoopWeights::chi2) {
    const auto checks = odometry_chi2(graph, roles);
    for (std::size_t c = 0; c < weights.size(); ++c) {
      weights[c] /= 1.0 + checks[c].chi2 / Pose::kDof;
    }
  }
  if (both || options.weights == LoopWeights::lap_line) {
    const auto evidence = curve_evidence(graph, roles, options.curve, run);
    for (std::size_t c = 0; c < weights.size(); ++c) weights[c] *= 1.0 - evidence[c].score;
  }
  return weights;
}

}  // namespace

void InductionOptions::validate() const {
  require_fields_in_range(*this);
  curve.validate();
}

template <class Pose>
InducedGraph induce(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                    const InductionOptions& options, const RunContext& run) {
  options.validate();
  std::vector<double> weight(graph.constraints.size(), 0.0);
  for (const Index k : roles.odometry) weight[k] = options.odometry_weight;
  const auto candidate_weight = candidate_weights(graph, roles, options, run);
  for (std::size_t c = 0; c < candidate_weight.size(); ++c) {
    weight[roles.candidates[c]] = candidate_weight[c];
  }

  InducedGraph induced;
  induced.constraint_edge.assign(graph.constraints.size(), -1);
  std::vector<spectral::WeightedEdge> edges;
  for (Index k = 0; k < graph.constraint_count(); ++k) {
    if (!(weight[k] > 0.0)) continue;
    induced.constraint_edge[k] = static_cast<Index>(edges.size());
    induced.edge_constraint.push_back(k);
    edges.push_back({graph.constraints[k].from, graph.constraints[k].to, weight[k]});
  }
  induced.graph = spectral::WeightedGraph(graph.vertex_count(), std::move(edges));
  return induced;
}

template InducedGraph induce(const PoseGraph<Pose2>&, const EdgeRoles&, const InductionOptions&,
                             const RunContext&);
template InducedGraph induce(const PoseGraph<Pose3>&, const EdgeRoles&, const InductionOptions&,
                             const RunContext&);

}  // namespace isotherm::slam
