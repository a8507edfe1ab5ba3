#include <cmath>

#include "graph/candidate_verdicts.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/slam/optimize/optimize.hpp"
#include "isotherm/slam/prune/prune.hpp"

namespace isotherm::slam {

template <>
std::string_view ScOptions::title() {
  return "The optimisation with switchable constraints";
}

template <>
std::string_view DcsOptions::title() {
  return "The optimisation with dynamic covariance scaling";
}

template <>
std::string_view CauchyOptions::title() {
  return "The optimisation with Cauchy's kernel";
}

template <>
std::string_view GncOptions::title() {
  return "The optimisation with graduated non-convexity";
}

template <RobustKernel kernel>
void KernelPruneOptions<kernel>::validate() const {
  require_fields_in_range(*this);
}

template struct KernelPruneOptions<RobustKernel::sc>;
template struct KernelPruneOptions<RobustKernel::dcs>;
template struct KernelPruneOptions<RobustKernel::cauchy>;
template struct KernelPruneOptions<RobustKernel::gnc>;

namespace detail {

template <class Pose, RobustKernel kernel>
PruneResult prune_by(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const KernelPruneOptions<kernel>& options, const RunContext& run) {
  options.validate();
  const double width =
      options.kernel_width > 0.0 ? options.kernel_width : default_kernel_width(kernel, Pose::kDof);
  const auto optimized = optimize(
      graph, roles,
      {.kernel = kernel, .kernel_width = width, .initialization = options.initialization}, run);
  const double threshold = kernel_threshold(kernel, width);
  PruneResult result;
  result.method = options.method();
  result.verdicts = detail::candidate_verdicts(graph, roles);
  for (auto& verdict : result.verdicts) {
    verdict.score = optimized.chi2[verdict.edge];
    verdict.threshold = threshold;
    verdict.verdict =
        verdict.score > threshold ? spectral::Verdict::prune : spectral::Verdict::keep;
    verdict.stage = options.method();
  }
  if (optimized.status != OptimizeStatus::converged) {
    result.warnings.push_back("the optimisation ended without converging");
  }
  return result;
}

template PruneResult prune_by(const PoseGraph<Pose2>&, const EdgeRoles&, const ScOptions&,
                              const RunContext&);
template PruneResult prune_by(const PoseGraph<Pose3>&, const EdgeRoles&, const ScOptions&,
                              const RunContext&);
template PruneResult prune_by(const PoseGraph<Pose2>&, const EdgeRoles&, const DcsOptions&,
                              const RunContext&);
template PruneResult prune_by(const PoseGraph<Pose3>&, const EdgeRoles&, const DcsOptions&,
                              const RunContext&);
template PruneResult prune_by(const PoseGraph<Pose2>&, const EdgeRoles&, const CauchyOptions&,
                              const RunContext&);
template PruneResult prune_by(const PoseGraph<Pose3>&, const EdgeRoles&, const CauchyOptions&,
                              const RunContext&);
template PruneResult prune_by(const PoseGraph<Pose2>&, const EdgeRoles&, const GncOptions&,
                              const RunContext&);
template PruneResult prune_by(const PoseGraph<Pose3>&, const EdgeRoles&, const GncOptions&,
                              const RunContext&);

}  // namespace detail

}  // namespace isotherm::slam
