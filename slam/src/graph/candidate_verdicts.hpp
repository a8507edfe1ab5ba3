#pragma once

#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/spectral/edges/edge_verdicts.hpp"

namespace isotherm::slam::detail {

/// One verdict "keep" per candidate, with its place in the file and its ids, for
/// a method to fill in.
template <class Pose>
spectral::EdgeVerdicts candidate_verdicts(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  spectral::EdgeVerdicts verdicts;
  verdicts.reserve(roles.candidates.size());
  for (const Index k : roles.candidates) {
    const auto& constraint = graph.constraints[k];
    spectral::EdgeVerdict verdict;
    verdict.edge = k;
    verdict.from = graph.ids[constraint.from];
    verdict.to = graph.ids[constraint.to];
    verdicts.push_back(std::move(verdict));
  }
  return verdicts;
}

}  // namespace isotherm::slam::detail
