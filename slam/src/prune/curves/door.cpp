#include <string>

#include "graph/candidate_verdicts.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/slam/prune/prune.hpp"

namespace isotherm::slam {

void CurvePruneOptions::validate() const {
  require_fields_in_range(*this);
  curve.validate();
}

namespace detail {

template <class Pose>
PruneResult prune_by(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const CurvePruneOptions& options, const RunContext& run) {
  using spectral::Verdict;
  options.validate();
  const auto evidence = curve_evidence(graph, roles, options.curve, run);
  PruneResult result;
  result.method = CurvePruneOptions::method();
  result.verdicts = detail::candidate_verdicts(graph, roles);
  std::size_t silent = 0;
  for (std::size_t c = 0; c < evidence.size(); ++c) {
    auto& verdict = result.verdicts[c];
    const bool unlike = evidence[c].compared && evidence[c].score > options.curve_threshold;
    verdict.score = evidence[c].score;
    verdict.threshold = options.curve_threshold;
    verdict.verdict = unlike ? Verdict::prune : Verdict::keep;
    verdict.stage = evidence[c].compared ? enum_name(options.curve.comparison) : "short-path";
    if (!evidence[c].compared) ++silent;
  }
  if (silent > 0) {
    result.warnings.push_back(std::to_string(silent) +
                              " loops end on paths too short to compare, so they are kept");
  }
  return result;
}

template PruneResult prune_by(const PoseGraph<Pose2>&, const EdgeRoles&, const CurvePruneOptions&,
                              const RunContext&);
template PruneResult prune_by(const PoseGraph<Pose3>&, const EdgeRoles&, const CurvePruneOptions&,
                              const RunContext&);

}  // namespace detail

}  // namespace isotherm::slam
