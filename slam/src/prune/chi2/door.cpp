#include <string>

#include "graph/candidate_verdicts.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/statistics.hpp"
#include "isotherm/slam/prune/odometry_chi2.hpp"
#include "isotherm/slam/prune/prune.hpp"

namespace isotherm::slam {

void Chi2PruneOptions::validate() const { require_fields_in_range(*this); }

namespace detail {

template <class Pose>
PruneResult prune_by(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const Chi2PruneOptions& options, const RunContext&) {
  using spectral::Verdict;
  options.validate();
  const double gate = chi_squared_quantile(1.0 - options.significance, Pose::kDof);
  const auto checks = odometry_chi2(graph, roles);
  PruneResult result;
  result.method = Chi2PruneOptions::method();
  result.verdicts = detail::candidate_verdicts(graph, roles);
  std::size_t unconnected = 0;
  for (std::size_t c = 0; c < checks.size(); ++c) {
    auto& verdict = result.verdicts[c];
    verdict.score = checks[c].chi2;
    verdict.threshold = gate;
    verdict.verdict = checks[c].chi2 > gate ? Verdict::prune : Verdict::keep;
    verdict.stage = checks[c].connected ? "chi2" : "no-odometry-path";
    if (!checks[c].connected) ++unconnected;
  }
  if (unconnected > 0) {
    result.warnings.push_back(std::to_string(unconnected) +
                              " loops join parts without an odometry path between them; "
                              "odometry cannot contradict them, so they are kept");
  }
  return result;
}

template PruneResult prune_by(const PoseGraph<Pose2>&, const EdgeRoles&, const Chi2PruneOptions&,
                              const RunContext&);
template PruneResult prune_by(const PoseGraph<Pose3>&, const EdgeRoles&, const Chi2PruneOptions&,
                              const RunContext&);

}  // namespace detail

}  // namespace isotherm::slam
