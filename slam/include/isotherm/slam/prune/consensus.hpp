#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "isotherm/base/range.hpp"
#include "isotherm/base/run_context.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/spectral/edges/edge_verdicts.hpp"

namespace isotherm::slam {

struct PruneResult;  // prune.hpp

/// Forward consensus: loops are accepted in the order in which the rest of the
/// graph can vouch for them. See docs/concepts/consensus.md.
struct ConsensusOptions {
  static std::string_view method() { return "consensus"; }
  static std::string_view title() { return "Forward consensus"; }

  /// Probability with which a correct loop may be pruned, and with which an
  /// accepted one may be false; in (0, 0.5). Every threshold follows from it.
  double significance = 0.0001;
  /// Loops whose ends lie within this many vertices of each other, at both ends,
  /// can confirm each other; > 0.
  Index window = 20;
  /// Estimate factors on the covariances of odometry and of loops from the data. Those
  /// of loops are never taken as smaller than the file says, those of odometry only as
  /// far as short cycles vouch for.
  bool calibrate = true;
  int max_rounds = 200;  ///< batches accepted at most, > 0

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, ConsensusOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("significance", options.significance, "probability with which a correct loop may be pruned",
        open(0, 0.5));
  visit("window", options.window,
        "vertices within which the ends of loops that confirm each other lie", closed(1, 1e6));
  visit("calibrate", options.calibrate, "estimate the scale of the covariances from the data");
  visit("max_rounds", options.max_rounds, "batches accepted at most", closed(1, 1e6));
}

/// Why one candidate was decided as it was.
struct ConsensusDetail {
  double chi2 = 0.0;      ///< against the prediction of the other accepted loops
  double evidence = 0.0;  ///< log odds of inlier against anywhere, without the prior
  int round = 0;          ///< round that accepted it; 0: never accepted
  bool connected = true;  ///< false: neither odometry nor accepted loops join its ends
  /// Of a pruned loop: accepted ones (positions among the candidates) that stand against it, at
  /// most three, nearest first. Each contradicts it with no more than the odometry
  /// between their ends; where none alone does, those nearest to it, which do so
  /// together. Empty where no accepted loop joins the same odometry chains.
  std::vector<Index> conflicts;
};

/// What one round did.
struct ConsensusRound {
  std::int64_t accepted = 0;  ///< in this round
  std::int64_t dropped = 0;   ///< accepted before, inconsistent now
  std::int64_t in_force = 0;  ///< accepted loops after the round
  /// "evidence", "cluster", "prior", "span", "trial" or "together"
  std::string rule;
};

struct ConsensusResult {
  /// One a candidate, in file order: score is chi-squared against the prediction of
  /// the accepted loops, threshold its gate (wider for an accepted loop), stage the
  /// round or reason.
  spectral::EdgeVerdicts verdicts;
  std::vector<ConsensusDetail> details;  ///< one a candidate
  std::vector<ConsensusRound> rounds;
  double inlier_fraction = 0.5;  ///< of the loops that were decided, as learnt
  double odometry_scale = 1.0;   ///< factor on the covariances of odometry
  double loop_scale = 1.0;       ///< factor on the covariances of loops
  /// How many times farther out than for Gaussian errors accepted loops may lie by the
  /// tail of their chi-squared, 1 to 4; 4 where too few were accepted to tell.
  double tail_factor = 4.0;
  bool settled = true;  ///< false: max_rounds ended the search
};

/// Decides which candidates agree with odometry and with each other.
///
/// Odometry is contracted between the ends of candidates. Each round estimates
/// the poses from odometry and the accepted loops, predicts every other candidate
/// with its covariance, and accepts those whose residual is inside the chi-squared
/// gate and far more likely than a residual anywhere on the map; the most certain
/// first. Where no single loop is certain, groups of loops that confirm each other
/// compete. Accepted loops that the others come to contradict are dropped again.
/// Time is that of a sparse factorisation a round and of one sparse half-solve for
/// every candidate still in question.
/// @throws InvalidArgument, NumericalError, Cancelled
template <class Pose>
ConsensusResult consensus(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                          const ConsensusOptions& options = {}, const RunContext& run = {});

/// Odometry (constraint numbers) whose information matrix is too near to a singular one, see
/// is_usable_information(). prune() repairs it and warns; consensus() takes it as it is.
template <class Pose>
std::vector<Index> unusable_odometry(const PoseGraph<Pose>& graph, const EdgeRoles& roles);

namespace detail {

/// The door of the method's room, through which prune() comes.
template <class Pose>
PruneResult prune_by(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const ConsensusOptions& options, const RunContext& run);

}  // namespace detail

}  // namespace isotherm::slam
