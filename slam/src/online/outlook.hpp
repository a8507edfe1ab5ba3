#pragma once

#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "isotherm/spectral/sparse/branch_covariance.hpp"
#include "online/edge_log.hpp"
#include "online/snapshot.hpp"

namespace isotherm::slam::detail {

/// How loops that came after a snapshot stand on its map, followed by the odometry that came since.
template <class Pose>
class Outlook {
 public:
  /// All must outlive this object. The snapshot must be explained.
  Outlook(const EdgeLog<Pose>& log, const Snapshot<Pose>& map, const ConsensusOptions& options);

  /// Of an edge of the log, by its number: how it stands on the map.
  Standing standing(Index edge) const;

  /// Of an edge that has come since: the squared length of its residual, by its own error, at which
  /// it would be as likely false as true if the map were known.
  double chi2_at_even_odds(Index edge) const;

  /// Takes an edge that has come since for true: from here on its later vertex is known by it,
  /// where that is known better so than along odometry.
  void follow(Index edge);

  /// Of the loops of the snapshot.
  const LabelCounts& labels() const noexcept { return map_.best().labels; }

  /// The loop before another in its run, and log of how much likelier true than false the other is
  /// where that is true.
  struct Lead {
    Index edge = 0;
    double evidence = 0.0;
  };

  /// The nearest of the loops just before an edge, among those that the snapshot has not accepted.
  std::optional<Lead> lead(Index edge) const;

 private:
  using Matrix = typename Pose::Matrix;

  // A vertex: the node of the map that it is known by, and the way from there.
  struct Place {
    Index node = 0;
    Index part = 0;
    Index chain = 0;
    Index position = 0;      // of the last vertex on the map
    Index steps = 0;         // since
    UncertainPose<Pose> at;  // from the node
  };

  // The log odds of the first of a run being true.
  double prior() const { return labels().log_odds(LabelCounts::kFirst); }

  std::optional<Place> place(VertexId id) const;
  std::optional<Place> known_place(VertexId id) const;
  std::optional<UncertainPose<Pose>> steps(VertexId from, VertexId to, bool on_map) const;

  // An edge of the log, told from its own end (in_own_frame()).
  struct Told {
    VertexId from = 0;
    VertexId to = 0;
    Pose T_from_to;
    Matrix information;  // as stated
    Matrix stated;       // its covariance
    Matrix learnt;       // with the factors on coordinates; but for the scale of loops
  };
  Told told(Index edge) const;

  // From the vertex of the lower id to the other, at the scales of the snapshot.
  struct Forward {
    VertexId from = 0;
    VertexId to = 0;
    UncertainPose<Pose> measured;
  };
  Forward forward(Index edge) const;
  std::optional<double> log_density(const Forward& known, const Forward& other) const;
  UncertainPose<Pose> between(const Place& a, const Place& b) const;
  double log_alternative(Index edge) const;
  std::optional<std::size_t> loop_of(Index edge) const;
  bool is_open(Index edge) const;
  bool is_copied(Index edge) const;
  template <class Visit>
  void for_each_near(Index edge, const Visit& visit) const;

  const EdgeLog<Pose>& log_;
  const Snapshot<Pose>& map_;
  Index window_;
  spectral::BranchCovariance<Pose::kDof> covariance_;
  mutable std::unordered_map<VertexId, Place> places_;  // that were asked for
};

extern template class Outlook<Pose2>;
extern template class Outlook<Pose3>;

}  // namespace isotherm::slam::detail
