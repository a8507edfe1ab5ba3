#include "isotherm/slam/prune/prune.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include "graph/candidate_verdicts.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/statistics.hpp"
#include "isotherm/slam/optimize/optimize.hpp"
#include "isotherm/slam/prune/curve_evidence.hpp"
#include "isotherm/slam/prune/odometry_chi2.hpp"

namespace isotherm::slam {
namespace {

using spectral::EdgeVerdicts;
using spectral::Verdict;

constexpr double kChi2Significance = 0.01;

// Whether covariances can be had of odometry and of loops: some matrix of each says
// something.
template <class Pose>
bool has_information(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  const auto says_something = [&graph](Index k) {
    return !graph.constraints[k].information.isZero(0.0);
  };
  return std::ranges::any_of(roles.odometry, says_something) &&
         std::ranges::any_of(roles.candidates, says_something);
}

template <class Pose>
PruneResult prune_by_consensus(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                               const PruneOptions& options) {
  ConsensusOptions own = options.consensus;
  if (options.significance > 0.0) own.significance = options.significance;
  own.progress = options.progress;
  PruneResult result;
  result.consensus = consensus(graph, roles, own);
  result.verdicts = std::move(result.consensus.verdicts);
  if (!result.consensus.settled) {
    result.warnings.push_back("consensus stopped after " + std::to_string(own.max_rounds) +
                              " rounds with loops still in question");
  }
  return result;
}

template <class Pose>
PruneResult prune_by_heat(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                          const PruneOptions& options) {
  HeatPruneOptions heat = options.heat;
  heat.threads = options.threads;
  heat.progress = options.progress;
  auto found = heat_prune(graph, roles, heat);
  PruneResult result;
  result.verdicts = std::move(found.verdicts);
  result.rounds = std::move(found.rounds);
  if (found.unconverged > 0) {
    result.warnings.push_back(std::to_string(found.unconverged) +
                              " heat distances are known less exactly than asked for");
  }
  return result;
}

template <class Pose>
PruneResult prune_by_chi2(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                          const PruneOptions& options) {
  const double significance = options.significance > 0.0 ? options.significance : kChi2Significance;
  const double gate = chi_squared_quantile(1.0 - significance, Pose::kDof);
  const auto checks = odometry_chi2(graph, roles);
  PruneResult result;
  result.verdicts = candidate_verdicts(graph, roles);
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

RobustKernel kernel_of(PruneMethod method) {
  switch (method) {
    case PruneMethod::sc:
      return RobustKernel::sc;
    case PruneMethod::dcs:
      return RobustKernel::dcs;
    case PruneMethod::cauchy:
      return RobustKernel::cauchy;
    case PruneMethod::gnc:
      return RobustKernel::gnc;
    default:
      return RobustKernel::none;
  }
}

template <class Pose>
PruneResult prune_by_kernel(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                            const PruneOptions& options) {
  const RobustKernel kernel = kernel_of(options.method);
  const double width =
      options.kernel_width > 0.0 ? options.kernel_width : default_kernel_width(kernel, Pose::kDof);
  const auto optimized = optimize(graph, roles,
                                  {.kernel = kernel,
                                   .kernel_width = width,
                                   .initialization = options.initialization,
                                   .progress = options.progress});
  const double threshold = kernel_threshold(kernel, width);
  PruneResult result;
  result.verdicts = candidate_verdicts(graph, roles);
  for (auto& verdict : result.verdicts) {
    verdict.score = optimized.chi2[verdict.edge];
    verdict.threshold = threshold;
    verdict.verdict = verdict.score > threshold ? Verdict::prune : Verdict::keep;
    verdict.stage = enum_name(kernel);
  }
  if (optimized.status != OptimizeStatus::converged) {
    result.warnings.push_back("the optimisation ended without converging");
  }
  return result;
}

template <class Pose>
PruneResult prune_by_rrr(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                         const PruneOptions& options) {
  RrrOptions own = options.rrr;
  own.initialization = options.initialization;
  PruneResult result;
  result.verdicts = rrr(graph, roles, own, options.progress);
  return result;
}

template <class Pose>
PruneResult prune_by_pcm(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                         const PruneOptions& options) {
  auto found = pcm(graph, roles, options.pcm, options.progress);
  PruneResult result;
  result.verdicts = std::move(found.verdicts);
  if (!found.proven) {
    result.warnings.push_back("the consistent set is the largest found, not proven the largest");
  }
  return result;
}

template <class Pose>
PruneResult prune_by_curves(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                            const PruneOptions& options) {
  const auto& curve = options.heat.induction.curve;
  const auto evidence = curve_evidence(graph, roles, curve, options.threads, options.progress);
  PruneResult result;
  result.verdicts = candidate_verdicts(graph, roles);
  std::size_t silent = 0;
  for (std::size_t c = 0; c < evidence.size(); ++c) {
    auto& verdict = result.verdicts[c];
    const bool unlike = evidence[c].compared && evidence[c].score > options.curve_threshold;
    verdict.score = evidence[c].score;
    verdict.threshold = options.curve_threshold;
    verdict.verdict = unlike ? Verdict::prune : Verdict::keep;
    verdict.stage = evidence[c].compared ? std::string(enum_name(curve.comparison)) : "short-path";
    if (!evidence[c].compared) ++silent;
  }
  if (silent > 0) {
    result.warnings.push_back(std::to_string(silent) +
                              " loops end on paths too short to compare, so they are kept");
  }
  return result;
}

template <class Pose>
PruneResult run_method(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                       const PruneOptions& options) {
  switch (options.method) {
    case PruneMethod::consensus:
      return prune_by_consensus(graph, roles, options);
    case PruneMethod::heat:
      return prune_by_heat(graph, roles, options);
    case PruneMethod::chi2:
      return prune_by_chi2(graph, roles, options);
    case PruneMethod::rrr:
      return prune_by_rrr(graph, roles, options);
    case PruneMethod::pcm:
      return prune_by_pcm(graph, roles, options);
    case PruneMethod::sc:
    case PruneMethod::dcs:
    case PruneMethod::cauchy:
    case PruneMethod::gnc:
      return prune_by_kernel(graph, roles, options);
    case PruneMethod::lap_line:
      return prune_by_curves(graph, roles, options);
  }
  throw InvalidArgument("method", "unknown");
}

}  // namespace

void PruneOptions::validate() const {
  if (!(significance >= 0.0 && significance < 1.0)) {
    throw InvalidArgument("significance", "must be in (0, 1), or 0 for the default");
  }
  if (threads < 0) throw InvalidArgument("threads", "must not be negative");
  if (!(curve_threshold >= 0.0 && curve_threshold <= 1.0)) {
    throw InvalidArgument("curve_threshold", "must be in [0, 1]");
  }
  heat.validate();
  consensus.validate();
  rrr.validate();
  pcm.validate();
  if (!(kernel_width >= 0.0) || !std::isfinite(kernel_width)) {
    throw InvalidArgument("kernel_width", "must be a positive number, or 0 for the default");
  }
}

template <class Pose>
PruneResult prune(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                  const PruneOptions& options) {
  options.validate();
  const auto start = std::chrono::steady_clock::now();
  PruneOptions used = options;
  const bool blind = options.method == PruneMethod::consensus && !roles.candidates.empty() &&
                     !has_information(graph, roles);
  if (blind) {
    used.method = PruneMethod::heat;
    used.heat.induction.init = Initialisation::uniform;
  }
  PruneResult result = run_method(graph, roles, used);
  result.method = used.method;
  if (blind) {
    result.warnings.push_back(
        "information matrices say nothing; heat distances with uniform weights decided instead");
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
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
    keep[verdict.edge] = verdict.verdict == Verdict::keep ||
                         (verdict.verdict == Verdict::ambiguous && keep_ambiguous);
  }
  return filter_constraints(graph, keep);
}

template PruneResult prune(const PoseGraph<Pose2>&, const EdgeRoles&, const PruneOptions&);
template PruneResult prune(const PoseGraph<Pose3>&, const EdgeRoles&, const PruneOptions&);
template PoseGraph<Pose2> apply_verdicts(const PoseGraph<Pose2>&, const EdgeVerdicts&, bool);
template PoseGraph<Pose3> apply_verdicts(const PoseGraph<Pose3>&, const EdgeVerdicts&, bool);

}  // namespace isotherm::slam
