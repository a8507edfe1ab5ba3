#pragma once

#include <concepts>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <vector>

#include "isotherm/base/range.hpp"
#include "isotherm/base/run_context.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/spectral/edges/edge_verdicts.hpp"

namespace isotherm::slam {

struct PruneResult;  // prune.hpp

/// One objective: which loops are true is what explains all measurements with the highest
/// evidence. See docs/concepts/consensus.md.
struct ConsensusOptions {
  static std::string_view method() { return "consensus"; }
  static std::string_view title() { return "Consensus"; }

  /// A loop is pruned if it is true with a probability below this one, and kept if it is false
  /// with a probability below it; in (0, 0.5). Where fewer than five are found true none
  /// is pruned, nor one whose ends nothing else joins. The search ends early where no more than
  /// this share of the loops is expected to be false.
  double significance = 0.01;
  /// Loops whose ends lie within this many vertices of each other, at both ends, can be one
  /// run, which is accepted as a whole; > 0.
  Index window = 20;
  /// Learn factors on the covariances of odometry and of most loops; without, the file is taken
  /// at its word.
  bool calibrate = true;
  int max_rounds = 200;  ///< moves at given scales at most, > 0

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, ConsensusOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("significance", options.significance,
        "probability of being true below which a loop is pruned", open(0, 0.5));
  visit("window", options.window, "vertices within which the ends of loops of one run lie",
        closed(1, 1e6));
  visit("calibrate", options.calibrate, "estimate the scale of the covariances from the data");
  visit("max_rounds", options.max_rounds, "moves at given scales at most", closed(1, 1e6));
}

/// What is known of one candidate, given the verdicts on all others. Of one that no run joins, and
/// that is false beyond the last digit of a probability, chi2 may be more and the evidence less.
struct ConsensusDetail {
  double probability = 0.5;  ///< of being true
  double evidence = 0.0;     ///< log of how much likelier true than false, without the prior
  double chi2 = 0.0;         ///< against what odometry and the accepted loops predict
  bool connected = true;     ///< false: neither odometry nor accepted loops join its ends
  /// Of a pruned loop: kept ones (positions among the candidates) that stand against it, at
  /// most three, nearest first. Each contradicts it with no more than the odometry
  /// between their ends; where none alone does, those nearest to it, which do so
  /// together. Empty where no kept loop joins the same odometry chains.
  std::vector<Index> conflicts;
};

/// What one move did.
struct ConsensusMove {
  std::int64_t accepted = 0;
  std::int64_t dropped = 0;
  std::int64_t in_force = 0;  ///< accepted loops after the move
};

/// An edge of odometry that errs more than the others.
struct OdometrySlip {
  VertexId from = 0;
  VertexId to = 0;      ///< the next vertex
  double factor = 1.0;  ///< on its standard deviation, beside that of all odometry
};

struct ConsensusResult {
  /// One a candidate, in file order: score is the log odds that the loop is false, threshold
  /// those from which it is pruned, stage "accepted", "rejected" or "unconnected".
  spectral::EdgeVerdicts verdicts;
  std::vector<ConsensusDetail> details;  ///< one a candidate
  std::vector<ConsensusMove> moves;      ///< of all climbs, in order
  double log_evidence = 0.0;             ///< of the verdicts; nats, up to a constant of the graph
  double odometry_scale = 1.0;           ///< factor on the covariances of odometry, as learnt
  double loop_scale = 1.0;               ///< the same of most loops
  /// The same on the variance of each coordinate, translation first, of which those are the
  /// geometric means.
  std::vector<double> odometry_scales;
  std::vector<double> loop_scales;
  std::vector<OdometrySlip> odometry_slips;  ///< ascending
  /// By how much more than odometry tells the robot turned in each step (rotation vector; rad).
  std::vector<double> odometry_bias;
  double rotation_scale = 1.0;  ///< of loops, rotation's against translation's
  /// Of the loops, those that are less accurate than most.
  double share_of_worse = 0.0;
  bool settled = true;  ///< false: max_rounds ended a climb
};

/// How far a learnt factor on covariances lies from what the file states, in deviations of what is
/// believed of files before: a factor of ten in the standard deviation is one. Beyond two the
/// file's information says nothing.
double prior_deviations(double scale);

/// Finds the set of loops of the highest evidence by climbs from several scales, and how
/// probable each loop is given the rest. Time is that of a sparse factorisation and of the
/// covariances of the loops in question, a move.
/// @throws InvalidArgument, NumericalError, Cancelled
template <class Pose>
ConsensusResult consensus(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                          const ConsensusOptions& options = {}, const RunContext& run = {});

namespace detail {

/// The door of the method's room, through which prune() comes.
template <class Pose>
PruneResult prune_by(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const ConsensusOptions& options, const RunContext& run);

}  // namespace detail

}  // namespace isotherm::slam
