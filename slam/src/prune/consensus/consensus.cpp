#include "isotherm/slam/prune/consensus.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/base/statistics.hpp"
#include "prune/consensus/constants.hpp"
#include "prune/consensus/judge.hpp"
#include "prune/consensus/objective/own_frames.hpp"
#include "prune/consensus/objective/scale_prior.hpp"
#include "prune/consensus/objective/scaled_graph.hpp"
#include "prune/consensus/pairs/conflicts.hpp"

namespace isotherm::slam {
namespace {

using spectral::Verdict;

std::vector<bool> decided_as(const spectral::EdgeVerdicts& verdicts, Verdict wanted) {
  std::vector<bool> flags;
  for (const auto& verdict : verdicts) flags.push_back(verdict.verdict == wanted);
  return flags;
}

template <class Pose>
typename Pose::Tangent shape_of(const std::vector<double>& scales, double mean) {
  return Pose::Tangent::Map(scales.data()) / mean;
}

template <class Pose>
detail::TurnBias<Pose> bias_of(const std::vector<double>& found) {
  return detail::TurnBias<Pose>::Map(found.data());
}

template <class Pose>
detail::Slips slips_as(const PoseGraph<Pose>& graph, const std::vector<OdometrySlip>& found) {
  detail::Slips slips;
  if (!found.empty()) slips.resize(graph.ids.size() - 1);
  for (const auto& slip : found) {
    const double deviations = prior_deviations(slip.factor * slip.factor);
    slips[*graph.find(slip.from)] = static_cast<std::uint8_t>(std::lround(deviations));
  }
  return slips;
}

// At the scales that were learnt; a pair of true loops is taken for a conflict as rarely as asked.
template <class Pose>
void add_conflicts(const PoseGraph<Pose>& graph, const EdgeRoles& roles, double significance,
                   int threads, ConsensusResult& result) {
  const auto kept = decided_as(result.verdicts, Verdict::keep);
  const auto pruned = decided_as(result.verdicts, Verdict::prune);
  if (std::ranges::count(kept, true) == 0 || std::ranges::count(pruned, true) == 0) return;
  const detail::CovarianceScale scale = {result.odometry_scale, result.loop_scale};
  const detail::Shapes<Pose> shapes = {shape_of<Pose>(result.odometry_scales, scale.odometry),
                                       shape_of<Pose>(result.loop_scales, scale.loops),
                                       slips_as(graph, result.odometry_slips),
                                       bias_of<Pose>(result.odometry_bias), scale.odometry};
  const auto own = detail::in_own_frames(graph, roles);
  const auto reduced =
      detail::scaled_graph(own, roles, detail::chain_of(own, roles), shapes).reduced;
  const double gate = chi_squared_quantile(1.0 - significance, Pose::kDof);
  auto conflicts = detail::name_conflicts(reduced, scale, gate, kept, pruned, threads);
  for (std::size_t k = 0; k < conflicts.size(); ++k) {
    result.details[k].conflicts = std::move(conflicts[k]);
  }
}

}  // namespace

double prior_deviations(double scale) {
  return std::abs(std::log(scale)) / detail::kScaleDeviation;
}

void ConsensusOptions::validate() const { require_fields_in_range(*this); }

template <class Pose>
ConsensusResult consensus(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                          const ConsensusOptions& options, const RunContext& run) {
  options.validate();
  auto result = detail::judge_by_evidence(graph, roles, options, run);
  add_conflicts(graph, roles, options.significance, run.threads, result);
  return result;
}

template ConsensusResult consensus(const PoseGraph<Pose2>&, const EdgeRoles&,
                                   const ConsensusOptions&, const RunContext&);
template ConsensusResult consensus(const PoseGraph<Pose3>&, const EdgeRoles&,
                                   const ConsensusOptions&, const RunContext&);

}  // namespace isotherm::slam
