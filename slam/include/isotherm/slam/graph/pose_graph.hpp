#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "isotherm/slam/graph/pose.hpp"
#include "isotherm/spectral/types.hpp"

namespace isotherm::slam {

using spectral::Index;

/// The number a file gives to a vertex (64 bits: GTSAM keys use them all).
using VertexId = std::uint64_t;

/// What a file says an edge is, beside where it leads.
enum class LinkKind : std::uint8_t {
  unknown,   ///< nothing: its role follows from its ends
  odometry,  ///< a step of the robot
  loop,      ///< a recognised place
};

/// A measured relative pose between two vertices, as in an EDGE_SE2 or
/// EDGE_SE3:QUAT line.
template <class Pose>
struct Constraint {
  Index from = 0;  ///< positions in PoseGraph::ids
  Index to = 0;
  Pose T_from_to;  ///< measured pose of `to` in the frame of `from`
  /// Inverse covariance of the residual log(T_from_to^-1 T_from^-1 T_to), ordered
  /// (translation, rotation); symmetric positive semi-definite; 1/m^2, 1/rad^2.
  typename Pose::Matrix information = Pose::Matrix::Identity();
  std::uint64_t line = 0;  ///< line of the input file; 0 if there is none
  LinkKind link = LinkKind::unknown;
};

/// Poses and the measurements between them. A plain value.
///
/// Vertices are ordered by id, whatever the order of the file, so that
/// consecutive positions are consecutive in time. Constraints keep the order of
/// the file: position k is the k-th edge line.
template <class Pose>
struct PoseGraph {
  std::vector<VertexId> ids;  ///< ascending, without repeats
  std::vector<Pose> poses;    ///< T_world_vertex, one an id; or empty
  std::vector<Constraint<Pose>> constraints;
  std::vector<Index> fixed;  ///< positions of vertices held by FIX lines
  /// The robot of each vertex, where files and not ids tell robots apart; else empty.
  std::vector<Index> robots = {};

  Index vertex_count() const noexcept { return static_cast<Index>(ids.size()); }
  Index constraint_count() const noexcept { return static_cast<Index>(constraints.size()); }

  /// Position of `id`, or nothing. O(log n).
  std::optional<Index> find(VertexId id) const;

  /// A number that vertices of one robot have in common: that of `robots`, or else the
  /// top byte of the id, in which GTSAM's keys have the robot's letter.
  std::uint64_t robot(Index vertex) const;
};

/// The letter in the top byte of a GTSAM key; empty if there is none.
std::string robot_letter(VertexId id);

/// `a196` for a GTSAM key; else the number.
std::string vertex_name(VertexId id);

/// Which constraints are trusted odometry and which are candidates for pruning.
struct EdgeRoles {
  std::vector<Index> odometry;    ///< positions of constraints, ascending
  std::vector<Index> candidates;  ///< all other positions, ascending
};

/// Odometry is the first constraint, in either direction, between vertices that
/// are neighbours in the order of ids; every other constraint is a candidate.
/// Where none joins two neighbours (ids may be out of order by one, as of two sensors on one
/// robot), it is the first that leads past one vertex there. Vertices of different robots are
/// never neighbours. What a file calls a loop is a candidate wherever it leads; what it calls
/// odometry is that between any two vertices, unless it repeats a step. O(m).
template <class Pose>
EdgeRoles edge_roles(const PoseGraph<Pose>& graph);

/// The graph without the constraints whose `keep` entry is false; vertices stay.
/// @throws InvalidArgument unless `keep` has one entry per constraint.
template <class Pose>
PoseGraph<Pose> filter_constraints(const PoseGraph<Pose>& graph, const std::vector<bool>& keep);

/// Residual of a constraint at given end poses: log(T_from_to^-1 T_w_from^-1 T_w_to).
template <class Pose>
typename Pose::Tangent residual(const Constraint<Pose>& constraint, const Pose& T_world_from,
                                const Pose& T_world_to);

extern template struct PoseGraph<Pose2>;
extern template struct PoseGraph<Pose3>;

}  // namespace isotherm::slam
