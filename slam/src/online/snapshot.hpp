#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "isotherm/slam/online/online_consensus.hpp"
#include "prune/consensus/climb/climb.hpp"
#include "prune/consensus/estimate/vertex_poses.hpp"
#include "prune/set_aside.hpp"

namespace isotherm::slam::detail {

/// What had come at one time, and what explains it best.
template <class Pose>
class Snapshot {
 public:
  /// `graph` is all that had come. Nothing is computed yet.
  Snapshot(PoseGraph<Pose> graph, const ConsensusOptions& options);
  Snapshot(const Snapshot&) = delete;  // its parts refer to each other
  Snapshot& operator=(const Snapshot&) = delete;

  /// Looks for the explanation: from where the others stand, and, if `everywhere`, from every
  /// start; where none stands anywhere from that of the file.
  /// @throws NumericalError, Cancelled
  void explain(const std::vector<const Snapshot*>& others, bool everywhere, const Pace& pace);

  /// Work of the search, with the density of near pairs found at every assessment, as the batch
  /// does: on that, which takes the same on every graph, and the rest, which grows with loops. Only
  /// where explained everywhere; of the first loop, what its one climb took.
  struct SearchWork {
    double constant = 0.0;
    double growing = 0.0;
  };
  const SearchWork& search_work() const noexcept { return search_work_; }
  /// A batch takes as much as so many.
  double searches_a_batch_takes() const;

  /// False where no loop can be judged by evidence: then there is nothing but graph() and verdicts.
  bool explained() const noexcept { return climb_.has_value(); }
  /// Whether a start led higher than all the others did.
  bool surpassed() const noexcept { return surpassed_; }

  /// Whether what is explained can speak against a loop (see detail::can_refute()).
  bool refutes() const noexcept { return refutes_; }

  /// Only where explained().
  const Explanation<Pose>& best() const noexcept { return best_; }
  const Assessment<Pose>& assessment() const { return climb_->assessment(); }
  const Objective<Pose>& objective() const { return *objective_; }

  const PoseGraph<Pose>& graph() const noexcept { return graph_; }
  const std::vector<Index>& loops() const noexcept { return roles_.candidates; }

  /// One a candidate, with its details.
  const PruneResult& verdicts() const noexcept { return verdicts_; }

  /// The node that a vertex is known by, and how odometry leads from there to it, with the scales
  /// that were learnt; none where nothing that is judged touches the vertex's chain.
  std::optional<Anchor<Pose>> anchor(Index vertex) const;

  /// Where the best explanation has a vertex; none where anchor() has none.
  std::optional<Pose> pose(Index vertex) const;

 private:
  void prepare(const Pace& pace);
  Explanation<Pose> go_on_from(const Snapshot& other, bool everywhere);
  void climb_from_nothing(bool everywhere);
  bool add(const Explanation<Pose>& next);
  Standpoint<Pose> carry(const Snapshot& other) const;
  void judge();

  PoseGraph<Pose> graph_;
  ConsensusOptions options_;
  EdgeRoles roles_;
  std::optional<SetAside> set_aside_;
  std::optional<Objective<Pose>> objective_;
  std::optional<Climb<Pose>> climb_;
  Explanation<Pose> best_;
  bool found_ = false;
  bool surpassed_ = false;
  bool refutes_ = false;
  double work_ = 0.0;
  SearchWork search_work_;
  std::size_t nearness_of_ = 0;  // edges of the graph that the density of near pairs is of
  PruneResult verdicts_;
};

extern template class Snapshot<Pose2>;
extern template class Snapshot<Pose3>;

}  // namespace isotherm::slam::detail
