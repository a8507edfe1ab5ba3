#pragma once

#include <vector>

#include "isotherm/slam/prune/evidence.hpp"
#include "prune/evidence/climb/standing.hpp"
#include "prune/evidence/objective/loop_gain.hpp"
#include "prune/evidence/objective/objective.hpp"

namespace isotherm::slam::detail {

/// Climbs to an explanation of higher evidence, one move after the other: accept the loops and
/// the runs of loops that raise it, the most certain first, since every one accepted sharpens
/// what is predicted of the rest; drop those that lower it, the worst first; once
/// neither is left, learn the scales and the tail from what is accepted.
template <class Pose>
class Climb {
 public:
  using Selection = std::vector<Index>;

  /// All must outlive this object. Starts with nothing accepted.
  Climb(const Objective<Pose>& objective, const EvidenceOptions& options,
        const ProgressCallback& progress);

  /// Climbs from nothing accepted, with `start` as the factors on the covariances.
  Explanation<Pose> from(const CovarianceScale& start);

  /// What each loop is worth given all others of an explanation.
  std::vector<Standing> standings(const Explanation<Pose>& explanation);

  /// What the climbs did, and whether all ended.
  const std::vector<EvidenceMove>& moves() const noexcept { return moves_; }
  bool settled() const noexcept { return settled_; }

 private:
  using Matrix = typename Pose::Matrix;

  void start(const CovarianceScale& scale);
  void grow();
  void estimate();
  bool reweigh_loops();
  void weigh();
  void weigh_accepted();
  void weigh_others();
  void refresh(const Selection& loops);
  Standing weigh(Index loop) const;
  void add_prior();
  Selection misfits() const;
  Selection next_batch() const;
  void forget_bounds();
  double evidence();
  bool rescale();
  bool adapt_tail();
  void tell_progress() const;

  const Objective<Pose>& objective_;
  const ReducedGraph<Pose>& graph_;
  const EvidenceOptions& options_;
  const ProgressCallback& progress_;
  Estimate<Pose> estimate_;
  typename Estimate<Pose>::Layout odometry_;
  double refuting_chi2_;
  Explanation<Pose> now_;
  typename Objective<Pose>::NearByClass near_{};
  std::vector<Standing> standings_;
  std::vector<Matrix> covariances_;  // of T_a^-1 T_b without the loop: an upper bound
  std::vector<double> run_density_;  // log p(z | the loop before in its run)
  std::vector<int> drops_;
  std::vector<EvidenceMove> moves_;
  bool settled_ = true;
};

extern template class Climb<Pose2>;
extern template class Climb<Pose3>;

}  // namespace isotherm::slam::detail
