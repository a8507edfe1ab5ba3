#pragma once

#include <concepts>
#include <iosfwd>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "isotherm/base/range.hpp"
#include "isotherm/base/run_context.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/slam/prune/prune.hpp"

namespace isotherm::slam {

namespace detail {
template <class Pose>
class OnlineEngine;
}  // namespace detail

/// How verdicts are kept up to date while edges come.
struct OnlineOptions {
  /// Of the objective, the same as the batch's.
  ConsensusOptions consensus;
  /// Work while edges come, in times of one batch's on what has come; in [0, 100]. A third of it
  /// may follow up on new loops, the rest searches the whole. With 0 that is done only where there
  /// are eight times as many loops. finish() comes on top.
  double effort = 2.5;

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, OnlineOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit_fields(options.consensus, visit);
  visit("effort", options.effort, "work while edges come, in times of one batch's on what has come",
        closed(0, 100));
}

/// What is now thought of a loop, and why.
struct LoopChange {
  spectral::EdgeVerdict verdict;  ///< its edge counts all that were added, from 0
  std::string reason;             ///< one sentence
  bool first = false;             ///< whether it had no verdict before
};

/// Tells false loops from true ones while a robot drives.
///
/// Edges are added as they come, in any order. Each loop has a verdict at once, from the map as it
/// is known; every further call goes on with a search for what explains all measurements best, by
/// the objective of consensus() (docs/concepts/consensus.md), as far as its share of `effort` goes,
/// and returns every verdict that changed. finish() gives what prune() gives for the same edges, to
/// the last bit. What comes out does not depend on time: the same calls give the same answers.
template <class Pose>
class OnlineConsensus {
 public:
  using Matrix = typename Pose::Matrix;

  /// Of `run` the progress callback is asked whether to go on: where it returns false the call
  /// throws Cancelled, and the next one goes on.
  explicit OnlineConsensus(const OnlineOptions& options = {}, RunContext run = {});
  ~OnlineConsensus();
  OnlineConsensus(OnlineConsensus&&) noexcept;
  OnlineConsensus& operator=(OnlineConsensus&&) noexcept;

  /// A step that is trusted. Ids are those of GTSAM where there are several robots: the top byte is
  /// a robot's letter.
  /// @throws InvalidArgument for a measurement or information that is not finite, or information
  ///   that is not positive semi-definite
  std::vector<LoopChange> add_odometry(VertexId from, VertexId to, const Pose& T_from_to,
                                       const Matrix& information);

  /// A loop to be judged. Its ends need not be known yet: it then waits.
  std::vector<LoopChange> add_loop(VertexId from, VertexId to, const Pose& T_from_to,
                                   const Matrix& information);

  /// An edge as files have it: a step where its ends follow each other and none is known
  /// between them, a loop elsewhere (edge_roles(), but that gaps are not bridged).
  std::vector<LoopChange> add_edge(VertexId from, VertexId to, const Pose& T_from_to,
                                   const Matrix& information, LinkKind link = LinkKind::unknown);

  /// Where a vertex is believed to be before any measurement. The first of each robot is where its
  /// map starts; without one it is the origin.
  void set_pose(VertexId id, const Pose& T_world_vertex);

  /// Holds a vertex where set_pose() puts it, as FIX lines do.
  void fix(VertexId id);

  /// The verdict on every loop so far, as of now.
  spectral::EdgeVerdicts verdicts() const;

  /// All vertices and edges so far; where there are loops, with the current estimate as poses,
  /// which takes a few solutions of the map where the search has not seen all loops yet: without
  /// those that all others contradict, whatever was thought of them when they came. After finish()
  /// it takes one, of what is kept.
  PoseGraph<Pose> graph() const;

  /// The same as added, without an estimate: what a file of the same edges holds.
  PoseGraph<Pose> input() const;

  /// What the batch says of all so far. As much work as that.
  PruneResult result() const;

  /// The same, and makes it the present verdicts.
  std::vector<LoopChange> finish();

  /// Goes on with what was begun, and with what has come since, until nothing is left to do.
  std::vector<LoopChange> catch_up();

  /// Writes all that was added, as lines of text with numbers that read back to the same values.
  void save(std::ostream& out) const;

  /// Writes what was added since the last call, so that what all calls wrote is what save() would
  /// write: a journal, of which nothing that was written out is lost whenever a process ends.
  void journal(std::ostream& out);

  /// Adds all that save() or journal() wrote, but for a last line without its end, and catches up;
  /// journal() then goes on from there. @throws ParseError, InvalidArgument
  static OnlineConsensus load(std::istream& in, const OnlineOptions& options = {},
                              RunContext run = {});

 private:
  std::unique_ptr<detail::OnlineEngine<Pose>> engine_;
};

extern template class OnlineConsensus<Pose2>;
extern template class OnlineConsensus<Pose3>;

}  // namespace isotherm::slam
