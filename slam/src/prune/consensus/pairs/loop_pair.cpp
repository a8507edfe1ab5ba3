#include "prune/consensus/pairs/loop_pair.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr double kSame = 1e-9;  // of two measurements

template <class Pose>
UncertainPose<Pose> along(const ReducedGraph<Pose>& graph, const CovarianceScale& scale, Index from,
                          Index to) {
  auto path = graph.odometry.relative(from, to);
  path.covariance *= scale.odometry;
  return path;
}

}  // namespace

template <class Pose>
ForwardLoop<Pose> forward_loop(const ReducedGraph<Pose>& graph, const Link<Pose>& loop,
                               const CovarianceScale& scale) {
  const Index a = graph.vertex[loop.a];
  const Index b = graph.vertex[loop.b];
  const UncertainPose<Pose> measured{loop.T_a_b, loop.covariance * scale.loops};
  if (graph.is_forward(loop)) return {a, b, measured};
  return {b, a, inverse(measured)};
}

template <class Pose>
std::vector<ForwardLoop<Pose>> forward_loops(const ReducedGraph<Pose>& graph,
                                             const CovarianceScale& scale) {
  std::vector<ForwardLoop<Pose>> loops;
  loops.reserve(graph.loops.size());
  for (const auto& loop : graph.loops) loops.push_back(forward_loop(graph, loop, scale));
  return loops;
}

template <class Pose>
bool measure_the_same(const Pose& a, const Pose& b) {
  return a.between(b).log().norm() < kSame && a.log().norm() >= kSame;
}

template <class Pose>
Belief<Pose> pair_belief(const ReducedGraph<Pose>& graph, const CovarianceScale& scale,
                         const ForwardLoop<Pose>& known, const ForwardLoop<Pose>& measured) {
  const auto before = along(graph, scale, measured.from, known.from);
  const auto after = along(graph, scale, known.to, measured.to);
  const auto predicted = compose(compose(before, known.measured), after);
  const typename Pose::Tangent r = measured.measured.T.between(predicted.T).log();
  const typename Pose::Matrix j = residual_jacobian<Pose>(r);
  return {r, j * predicted.covariance * j.transpose()};
}

template <class Pose>
Belief<Pose> pair_residual(const ReducedGraph<Pose>& graph, const CovarianceScale& scale,
                           const ForwardLoop<Pose>& known, const ForwardLoop<Pose>& measured) {
  auto belief = pair_belief(graph, scale, known, measured);
  belief.P += measured.measured.covariance;
  return belief;
}

template ForwardLoop<Pose2> forward_loop(const ReducedGraph<Pose2>&, const Link<Pose2>&,
                                         const CovarianceScale&);
template ForwardLoop<Pose3> forward_loop(const ReducedGraph<Pose3>&, const Link<Pose3>&,
                                         const CovarianceScale&);
template std::vector<ForwardLoop<Pose2>> forward_loops(const ReducedGraph<Pose2>&,
                                                       const CovarianceScale&);
template std::vector<ForwardLoop<Pose3>> forward_loops(const ReducedGraph<Pose3>&,
                                                       const CovarianceScale&);
template bool measure_the_same(const Pose2&, const Pose2&);
template bool measure_the_same(const Pose3&, const Pose3&);
template Belief<Pose2> pair_belief(const ReducedGraph<Pose2>&, const CovarianceScale&,
                                   const ForwardLoop<Pose2>&, const ForwardLoop<Pose2>&);
template Belief<Pose3> pair_belief(const ReducedGraph<Pose3>&, const CovarianceScale&,
                                   const ForwardLoop<Pose3>&, const ForwardLoop<Pose3>&);
template Belief<Pose2> pair_residual(const ReducedGraph<Pose2>&, const CovarianceScale&,
                                     const ForwardLoop<Pose2>&, const ForwardLoop<Pose2>&);
template Belief<Pose3> pair_residual(const ReducedGraph<Pose3>&, const CovarianceScale&,
                                     const ForwardLoop<Pose3>&, const ForwardLoop<Pose3>&);

}  // namespace isotherm::slam::detail
