#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "isotherm/slam/prune/prune.hpp"
#include "prune/consensus/judge.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr double kMeaningless = 2.0;  // deviations of the prior, each a factor of ten in errors

// What needs no information matrices, in place of consensus.
template <class Pose>
PruneResult prune_by_structure(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                               const RunContext& run) {
  HeatPruneOptions structure;
  structure.induction.weights = LoopWeights::uniform;
  PruneResult result = prune_by(graph, roles, structure, run);
  result.warnings.push_back(
      "information matrices say nothing; heat distances with uniform weights decided instead");
  return result;
}

// Factors on what the file states that are beyond what is believed of files.
void warn_of_meaningless(const ConsensusResult& result, std::vector<std::string>& warnings) {
  const std::pair<const char*, double> scales[] = {
      {"odometry", result.odometry_scale},
      {"loops", result.loop_scale},
      {"rotation against translation", result.rotation_scale}};
  for (const auto& [what, scale] : scales) {
    if (prior_deviations(scale) <= kMeaningless) continue;
    std::ostringstream text;
    text << "information of " << what << " says nothing: errors are " << std::setprecision(3)
         << std::sqrt(scale) << " times as large as it states; learnt from the data instead";
    warnings.push_back(text.str());
  }
}

}  // namespace

template <class Pose>
PruneResult prune_by(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const ConsensusOptions& options, const RunContext& run) {
  options.validate();
  if (!roles.candidates.empty() && !has_information(graph, roles)) {
    return prune_by_structure(graph, roles, run);
  }
  PruneResult result;
  result.method = ConsensusOptions::method();
  result.consensus = consensus(graph, roles, options, run);
  result.verdicts = std::move(result.consensus.verdicts);
  if (!result.consensus.settled) {
    result.warnings.push_back("consensus stopped after " + std::to_string(options.max_rounds) +
                              " moves with loops still in question");
  }
  warn_of_meaningless(result.consensus, result.warnings);
  return result;
}

template PruneResult prune_by(const PoseGraph<Pose2>&, const EdgeRoles&, const ConsensusOptions&,
                              const RunContext&);
template PruneResult prune_by(const PoseGraph<Pose3>&, const EdgeRoles&, const ConsensusOptions&,
                              const RunContext&);

}  // namespace isotherm::slam::detail
