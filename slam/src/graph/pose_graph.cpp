#include "isotherm/slam/graph/pose_graph.hpp"

#include <algorithm>
#include <cctype>

#include "isotherm/base/error.hpp"

namespace isotherm::slam {
namespace {

constexpr int kLetterShift = 56;  // GTSAM keys carry the robot's letter in the top byte

// Pairs of neighbours in the order of ids, by the first one's position, that odometry has joined.
using Joined = std::vector<bool>;

// Whether this is the first that joins neighbours, or is said to be odometry.
template <class Pose>
bool take_step(const PoseGraph<Pose>& graph, const Constraint<Pose>& constraint, Joined& joined) {
  if (constraint.link == LinkKind::loop || constraint.from == constraint.to) return false;
  const auto [first, second] = std::minmax(constraint.from, constraint.to);
  const bool neighbours = second - first == 1 && graph.robot(first) == graph.robot(second);
  if (!neighbours) return constraint.link == LinkKind::odometry;
  if (joined[first]) return false;
  joined[first] = true;
  return true;
}

// Whether it leads past one pose, where that and the one before or after it are not joined.
template <class Pose>
bool bridge_gap(const PoseGraph<Pose>& graph, const Constraint<Pose>& constraint, Joined& joined) {
  const auto [first, second] = std::minmax(constraint.from, constraint.to);
  const bool next_but_one = second - first == 2 && graph.robot(first) == graph.robot(second);
  if (constraint.link == LinkKind::loop || !next_but_one) return false;
  if (joined[first] && joined[first + 1]) return false;
  joined[joined[first] ? first + 1 : first] = true;
  return true;
}

}  // namespace

template <class Pose>
std::optional<Index> PoseGraph<Pose>::find(VertexId id) const {
  const auto found = std::lower_bound(ids.begin(), ids.end(), id);
  if (found == ids.end() || *found != id) return std::nullopt;
  return static_cast<Index>(found - ids.begin());
}

template <class Pose>
std::uint64_t PoseGraph<Pose>::robot(Index vertex) const {
  return robots.empty() ? ids[vertex] >> kLetterShift : static_cast<std::uint64_t>(robots[vertex]);
}

std::string robot_letter(VertexId id) {
  const auto letter = static_cast<unsigned char>(id >> kLetterShift);
  if (letter > 127 || std::isalpha(letter) == 0) return {};
  return {static_cast<char>(letter)};
}

std::string vertex_name(VertexId id) {
  const auto letter = robot_letter(id);
  if (letter.empty()) return std::to_string(id);
  return letter + std::to_string(id & ((VertexId{1} << kLetterShift) - 1));
}

template <class Pose>
EdgeRoles edge_roles(const PoseGraph<Pose>& graph) {
  Joined joined(graph.ids.size(), false);
  std::vector<bool> is_odometry;
  for (const auto& constraint : graph.constraints) {
    is_odometry.push_back(take_step(graph, constraint, joined));
  }
  EdgeRoles roles;
  for (std::size_t k = 0; k < is_odometry.size(); ++k) {
    const bool trusted = is_odometry[k] || bridge_gap(graph, graph.constraints[k], joined);
    (trusted ? roles.odometry : roles.candidates).push_back(static_cast<Index>(k));
  }
  return roles;
}

template <class Pose>
PoseGraph<Pose> filter_constraints(const PoseGraph<Pose>& graph, const std::vector<bool>& keep) {
  if (keep.size() != graph.constraints.size()) {
    throw InvalidArgument("keep", "must have one entry per constraint");
  }
  PoseGraph<Pose> kept{graph.ids, graph.poses, {}, graph.fixed, graph.robots};
  for (std::size_t k = 0; k < keep.size(); ++k) {
    if (keep[k]) kept.constraints.push_back(graph.constraints[k]);
  }
  return kept;
}

template <class Pose>
typename Pose::Tangent residual(const Constraint<Pose>& constraint, const Pose& T_world_from,
                                const Pose& T_world_to) {
  return constraint.T_from_to.between(T_world_from.between(T_world_to)).log();
}

template struct PoseGraph<Pose2>;
template struct PoseGraph<Pose3>;
template EdgeRoles edge_roles(const PoseGraph<Pose2>&);
template EdgeRoles edge_roles(const PoseGraph<Pose3>&);
template PoseGraph<Pose2> filter_constraints(const PoseGraph<Pose2>&, const std::vector<bool>&);
template PoseGraph<Pose3> filter_constraints(const PoseGraph<Pose3>&, const std::vector<bool>&);
template Pose2::Tangent residual(const Constraint<Pose2>&, const Pose2&, const Pose2&);
template Pose3::Tangent residual(const Constraint<Pose3>&, const Pose3&, const Pose3&);

}  // namespace isotherm::slam
