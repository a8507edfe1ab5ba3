#include "isotherm/slam/prune/consensus.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/base/statistics.hpp"
#include "isotherm/slam/graph/information.hpp"
#include "prune/consensus/judge.hpp"
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

// At the scales that were learnt; a pair of true loops is taken for a conflict as rarely as asked.
template <class Pose>
void add_conflicts(const PoseGraph<Pose>& graph, const EdgeRoles& roles, double significance,
                   ConsensusResult& result) {
  const auto kept = decided_as(result.verdicts, Verdict::keep);
  const auto pruned = decided_as(result.verdicts, Verdict::prune);
  if (std::ranges::count(kept, true) == 0 || std::ranges::count(pruned, true) == 0) return;
  const auto reduced = detail::scaled_graph(graph, roles, result.rotation_scale).reduced;
  const detail::CovarianceScale scale = {result.odometry_scale, result.loop_scale};
  const double gate = chi_squared_quantile(1.0 - significance, Pose::kDof);
  auto conflicts = detail::name_conflicts(reduced, scale, gate, kept, pruned);
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
std::vector<Index> unusable_odometry(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  std::vector<Index> unusable;
  for (const Index k : roles.odometry) {
    if (!is_usable_information<Pose::kDof>(graph.constraints[k].information)) unusable.push_back(k);
  }
  return unusable;
}

template <class Pose>
ConsensusResult consensus(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                          const ConsensusOptions& options, const RunContext& run) {
  options.validate();
  auto result = detail::judge_by_evidence(graph, roles, options, run);
  for (std::size_t k = 0; k < result.details.size(); ++k) {
    result.verdicts[k].probability = result.details[k].probability;
  }
  add_conflicts(graph, roles, options.significance, result);
  return result;
}

template std::vector<Index> unusable_odometry(const PoseGraph<Pose2>&, const EdgeRoles&);
template std::vector<Index> unusable_odometry(const PoseGraph<Pose3>&, const EdgeRoles&);
template ConsensusResult consensus(const PoseGraph<Pose2>&, const EdgeRoles&,
                                   const ConsensusOptions&, const RunContext&);
template ConsensusResult consensus(const PoseGraph<Pose3>&, const EdgeRoles&,
                                   const ConsensusOptions&, const RunContext&);

}  // namespace isotherm::slam
