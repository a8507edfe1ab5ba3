#include "isotherm/slam/simulate/densify.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "isotherm/slam/graph/odometry.hpp"

namespace isotherm::slam {
namespace {

template <class Pose>
class Densifier {
 public:
  Densifier(const PoseGraph<Pose>& graph, const EdgeRoles& roles)
      : graph_(graph), odometry_(graph, roles) {
    for (const auto& constraint : graph.constraints) {
      joined_.insert(std::minmax(constraint.from, constraint.to));
    }
  }

  void replicate(const Constraint<Pose>& loop, Index step, PoseGraph<Pose>& dense) {
    const Index from = loop.from + step, to = loop.to + step;
    if (from == to || !on_chain(loop.from, from) || !on_chain(loop.to, to)) return;
    if (!joined_.insert(std::minmax(from, to)).second) return;
    auto copy = loop;
    copy.from = from;
    copy.to = to;
    copy.line = 0;
    copy.T_from_to =
        odometry_.relative(from, loop.from).T * loop.T_from_to * odometry_.relative(loop.to, to).T;
    dense.constraints.push_back(std::move(copy));
  }

 private:
  bool on_chain(Index vertex, Index other) const {
    return other >= 0 && other < graph_.vertex_count() &&
           odometry_.chain(vertex) == odometry_.chain(other);
  }

  const PoseGraph<Pose>& graph_;
  OdometryChain<Pose> odometry_;
  std::set<std::pair<Index, Index>> joined_;
};

}  // namespace

void DensifyOptions::validate() const { require_fields_in_range(*this); }

template <class Pose>
PoseGraph<Pose> densify(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                        const DensifyOptions& options) {
  options.validate();
  const auto most = static_cast<Index>(options.copies);
  Densifier<Pose> densifier(graph, roles);
  auto dense = graph;
  for (const Index loop : roles.candidates) {
    for (Index step = -most; step <= most; ++step) {
      if (step != 0) densifier.replicate(graph.constraints[loop], step, dense);
    }
  }
  return dense;
}

template PoseGraph<Pose2> densify(const PoseGraph<Pose2>&, const EdgeRoles&, const DensifyOptions&);
template PoseGraph<Pose3> densify(const PoseGraph<Pose3>&, const EdgeRoles&, const DensifyOptions&);

}  // namespace isotherm::slam
