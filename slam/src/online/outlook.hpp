#pragma once

#include <memory>
#include <optional>
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

  /// Of an edge of the log, by its number.
  Standing standing(Index edge) const;

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

  std::optional<Place> place(VertexId id) const;
  std::optional<UncertainPose<Pose>> tail(VertexId from, VertexId to) const;
  UncertainPose<Pose> between(const Place& a, const Place& b) const;
  double log_alternative(Index edge, const Place& a, const Place& b, const Matrix& Sigma) const;
  bool is_copied(Index edge) const;

  const EdgeLog<Pose>& log_;
  const Snapshot<Pose>& map_;
  Index window_;
  spectral::BranchCovariance<Pose::kDof> covariance_;
  double prior_ = 0.0;  // log odds of any loop being true
};

extern template class Outlook<Pose2>;
extern template class Outlook<Pose3>;

}  // namespace isotherm::slam::detail
