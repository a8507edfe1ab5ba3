#include "online/edge_log.hpp"

#include <algorithm>
#include <iterator>

#include "io/incremental/place_vertices.hpp"
#include "io/information_check.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/slam/graph/information.hpp"
#include "prune/consensus/objective/own_frames.hpp"

namespace isotherm::slam::detail {
namespace {

bool same(const Pose2& a, const Pose2& b) {
  return a.translation() == b.translation() && a.angle() == b.angle();
}

bool same(const Pose3& a, const Pose3& b) {
  return a.translation() == b.translation() && a.rotation().coeffs() == b.rotation().coeffs();
}

template <class Pose>
typename EdgeLog<Pose>::Step step_of(const typename EdgeLog<Pose>::Edge& edge) {
  auto told = edge.measured;
  told.from = edge.from < edge.to ? 0 : 1;
  told.to = 1 - told.from;
  told = in_own_frame(told);
  return {std::min(edge.from, edge.to),
          {told.T_from_to, covariance_from_information<Pose::kDof>(told.information)},
          told.from < told.to};
}

}  // namespace

template <class Pose>
const typename EdgeLog<Pose>::Edge& EdgeLog<Pose>::add(VertexId from, VertexId to,
                                                       const Pose& T_from_to,
                                                       const typename Pose::Matrix& information,
                                                       LinkKind link) {
  if (!T_from_to.log().allFinite()) throw InvalidArgument("T_from_to", "must be finite");
  if (!information.allFinite() || !is_positive_semidefinite(information)) {
    throw InvalidArgument("information", "must be finite and positive semi-definite");
  }
  Edge edge{from, to, {0, 0, T_from_to, information, 0, link}};
  ids_.insert(from);
  ids_.insert(to);
  edge.step = is_step(edge);
  if (edge.step) {
    steps_.try_emplace(std::max(from, to), step_of<Pose>(edge));
  }
  between_[{from, to}].push_back(static_cast<Index>(edges_.size()));
  return edges_.emplace_back(edge);
}

// As edge_roles() has it, of what is known so far: a gap may still close, and is not bridged.
template <class Pose>
bool EdgeLog<Pose>::is_step(const Edge& edge) {
  const auto [first, second] = std::minmax(edge.from, edge.to);
  if (first == second || edge.measured.link == LinkKind::loop) return false;
  const bool neighbours = *std::next(ids_.find(first)) == second && first >> 56 == second >> 56;
  if (!neighbours) return edge.measured.link == LinkKind::odometry;
  return steps_.count(second) == 0 || steps_.at(second).before != first;
}

template <class Pose>
void EdgeLog<Pose>::set_pose(VertexId id, const Pose& pose) {
  if (!pose.log().allFinite()) throw InvalidArgument("T_world_vertex", "must be finite");
  ids_.insert(id);
  poses_[id] = pose;
  posed_.push_back(id);
}

template <class Pose>
void EdgeLog<Pose>::fix(VertexId id) {
  ids_.insert(id);
  fixed_.push_back(id);
}

template <class Pose>
const typename EdgeLog<Pose>::Step* EdgeLog<Pose>::step_to(VertexId id) const {
  const auto found = steps_.find(id);
  return found == steps_.end() ? nullptr : &found->second;
}

template <class Pose>
UncertainPose<Pose> EdgeLog<Pose>::Step::path(const typename Pose::Tangent& variances) const {
  const typename Pose::Tangent deviations = variances.cwiseSqrt();
  const UncertainPose<Pose> scaled{
      measured.T, deviations.asDiagonal() * measured.covariance * deviations.asDiagonal()};
  return forward ? scaled : inverse(scaled);
}

template <class Pose>
std::optional<Index> EdgeLog<Pose>::repeated_by(const Edge& edge) const {
  const auto found = between_.find({edge.from, edge.to});
  if (found == between_.end()) return std::nullopt;
  for (const Index k : found->second) {
    const auto& other = edges_[k];
    if (&other == &edge) break;
    if (same(other.measured.T_from_to, edge.measured.T_from_to) &&
        other.measured.information == edge.measured.information) {
      return k;
    }
  }
  return std::nullopt;
}

template <class Pose>
PoseGraph<Pose> EdgeLog<Pose>::graph() const {
  PoseGraph<Pose> graph;
  graph.ids.assign(ids_.begin(), ids_.end());
  graph.constraints.reserve(edges_.size());
  for (const auto& edge : edges_) {
    auto constraint = edge.measured;
    constraint.from = *graph.find(edge.from);
    constraint.to = *graph.find(edge.to);
    graph.constraints.push_back(constraint);
  }
  if (!poses_.empty()) add_poses(graph);
  const std::set<VertexId> fixed(fixed_.begin(), fixed_.end());
  for (const VertexId id : fixed) graph.fixed.push_back(*graph.find(id));
  return graph;
}

// As files that tell some poses are read.
template <class Pose>
void EdgeLog<Pose>::add_poses(PoseGraph<Pose>& graph) const {
  graph.poses.resize(graph.ids.size());
  std::vector<bool> placed(graph.ids.size(), false);
  for (const auto& [id, pose] : poses_) {
    const Index vertex = *graph.find(id);
    graph.poses[vertex] = pose;
    placed[vertex] = true;
  }
  if (poses_.size() == graph.ids.size()) return;
  place_vertices(graph, std::move(placed), [](Index, std::optional<Index>) {});
}

template class EdgeLog<Pose2>;
template class EdgeLog<Pose3>;

}  // namespace isotherm::slam::detail
