#include "prune/consensus/climb/standpoint.hpp"

#include <algorithm>
#include <memory>

#include "prune/consensus/estimate/vertex_poses.hpp"

namespace isotherm::slam::detail {
namespace {

template <class Pose>
using Layout = typename Estimate<Pose>::Layout;

// Of nodes that have none, by odometry from the next ones on their chain, if these have.
template <class Pose>
void follow_odometry(const ReducedGraph<Pose>& graph, Layout<Pose>& layout) {
  const Index count = graph.node_count();
  const auto follow = [&](Index a, Index neighbour) {
    if (layout.component[a] >= 0 || layout.component[neighbour] < 0) return;
    if (graph.chain[a] != graph.chain[neighbour]) return;
    const auto path = graph.odometry.relative(graph.vertex[neighbour], graph.vertex[a]);
    layout.poses[a] = layout.poses[neighbour] * path.T;
    layout.component[a] = layout.component[neighbour];
  };
  for (Index a = 1; a < count; ++a) follow(a, a - 1);
  for (Index a = count - 1; a > 0; --a) follow(a - 1, a);
}

// An edge slips that is between the same vertices.
Slips carry_slips(const Slips& before, std::size_t edges, const KnownBefore& known) {
  Slips slips;
  for (Index v = 0; !before.empty() && v < static_cast<Index>(edges); ++v) {
    const auto from = known.vertex(v);
    const auto to = known.vertex(v + 1);
    slips.push_back(from && to && *to == *from + 1 ? slip_of(before, *from) : std::uint8_t{0});
  }
  return slips;
}

template <class Pose>
Layout<Pose> carry_layout(const Layout<Pose>& before, const ReducedGraph<Pose>& from,
                          const ReducedGraph<Pose>& to, const KnownBefore& known) {
  const Index count = to.node_count();
  Layout<Pose> layout{to.poses, std::vector<Index>(count, -1)};
  for (Index a = 0; a < count; ++a) {
    const auto vertex = known.vertex(to.vertex[a]);
    const auto anchor = vertex ? nearest_node(from, *vertex) : std::nullopt;
    if (!anchor) continue;
    layout.poses[a] = *pose_of(from, before.poses, *vertex);
    layout.component[a] = before.component[anchor->node];
  }
  follow_odometry(to, layout);
  const auto& parts = before.component;
  const Index first_new = parts.empty() ? 0 : 1 + *std::ranges::max_element(parts);
  for (Index a = 0; a < count; ++a) {
    if (layout.component[a] < 0) layout.component[a] = first_new + to.chain[a];
  }
  return layout;
}

}  // namespace

template <class Pose>
Standpoint<Pose> carry(const Explanation<Pose>& before,
                       const typename Assessment<Pose>::Findings& found,
                       const Objective<Pose>& objective, const KnownBefore& known) {
  Standpoint<Pose> next{{.scale = before.scale, .shapes = before.shapes, .shares = before.shares},
                        {.mixture = found.mixture}};
  auto& [explanation, findings] = next;
  explanation.shapes.slips = carry_slips(before.shapes.slips, objective.odometry_edges(), known);
  findings.shapes = explanation.shapes;
  explanation.redundancy = before.redundancy;
  const double more = static_cast<double>(known.loops.size()) /
                      static_cast<double>(std::max<std::size_t>(before.accepted.size(), 1));
  for (double& share : explanation.shares.loops) share *= more;
  findings.graph = std::make_shared<ScaledGraph<Pose>>(
      findings.shapes == Shapes<Pose>{} ? objective.stated() : objective.scaled(findings.shapes));
  for (const auto& loop : known.loops) {
    explanation.accepted.push_back(loop && before.accepted[*loop]);
    explanation.weights.push_back(loop ? before.weights[*loop] : LoopWeight{});
    findings.held.push_back(loop ? found.held[*loop] : Pose::Matrix::Zero());
    findings.covariances.push_back(loop ? found.covariances[*loop] : Pose::Matrix::Zero());
    findings.shifts.push_back(loop ? found.shifts[*loop] : Pose::Tangent::Zero());
  }
  explanation.layout =
      carry_layout<Pose>(before.layout, found.graph->reduced, findings.graph->reduced, known);
  return next;
}

template Standpoint<Pose2> carry(const Explanation<Pose2>&, const Assessment<Pose2>::Findings&,
                                 const Objective<Pose2>&, const KnownBefore&);
template Standpoint<Pose3> carry(const Explanation<Pose3>&, const Assessment<Pose3>::Findings&,
                                 const Objective<Pose3>&, const KnownBefore&);

}  // namespace isotherm::slam::detail
