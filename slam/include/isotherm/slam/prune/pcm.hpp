#pragma once

#include <concepts>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "isotherm/base/options.hpp"
#include "isotherm/base/range.hpp"
#include "isotherm/base/run_context.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/spectral/edges/edge_verdicts.hpp"

namespace isotherm::slam {

struct PruneResult;  // prune.hpp

/// Pairwise consistent measurement set maximization: J. Mangelson, D. Dominic, R.
/// Eustice, R. Vasudevan, "Pairwise Consistent Measurement Set Maximization for
/// Robust Multi-Robot Map Merging", ICRA 2018.
struct PcmOptions {
  static std::string_view method() { return "pcm"; }
  static std::string_view title() { return "Pairwise consistent measurement"; }

  /// Probability with which a correct loop passes the check against odometry; in
  /// (0, 1].
  double pcm_odometry_confidence = 0.99;
  /// Probability with which two correct loops pass the check of their cycle; in
  /// (0, 1).
  double pcm_pair_confidence = 0.99;
  /// Branches the exact clique search may take before the best clique so far
  /// counts; >= 0.
  std::int64_t pcm_clique_budget = 1000000;

  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, PcmOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("pcm_odometry_confidence", options.pcm_odometry_confidence,
        "probability that a correct loop agrees with odometry; 1: no such check", left_open(0, 1));
  visit("pcm_pair_confidence", options.pcm_pair_confidence,
        "probability that two correct loops agree", open(0, 1));
  visit("pcm_clique_budget", options.pcm_clique_budget,
        "branches of the exact clique search before the best so far counts", closed(0, 1e12));
}

struct PcmResult {
  spectral::EdgeVerdicts verdicts;
  bool proven = true;  ///< the clique is a largest one; false: the budget ran out
};

/// Keeps a largest set of loops that agree in pairs.
///
/// A loop must first agree with odometry (score: chi-squared of that, stage
/// "odometry"). Two loops agree if the cycle of both and the odometry between their
/// ends closes: log of the cycle, weighted by its first-order covariance, below the
/// chi-squared quantile (eq. 4-5). The largest clique of the graph of agreement is
/// kept (stage "clique"; the score of a loop is then the share of the clique's
/// other members it does not agree with, the threshold 0). Loops between parts that
/// odometry does not join are compared within the pairs that can be closed.
/// O(q^2) time and q^2 bits for q loops.
/// @throws InvalidArgument, Cancelled
template <class Pose>
PcmResult pcm(const PoseGraph<Pose>& graph, const EdgeRoles& roles, const PcmOptions& options = {},
              const RunContext& run = {});

namespace detail {

/// The door of the method's room, through which prune() comes.
template <class Pose>
PruneResult prune_by(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const PcmOptions& options, const RunContext& run);

}  // namespace detail

}  // namespace isotherm::slam
