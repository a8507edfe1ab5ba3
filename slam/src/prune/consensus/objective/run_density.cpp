#include "prune/consensus/objective/run_density.hpp"

#include "isotherm/base/parallel.hpp"
#include "prune/consensus/objective/loop_gain.hpp"
#include "prune/consensus/pairs/loop_pair.hpp"

namespace isotherm::slam::detail {

template <class Pose>
std::vector<double> run_density(const Runs<Pose>& runs, const ReducedGraph<Pose>& graph,
                                const ReducedGraph<Pose>& stated, const CovarianceScale& scale,
                                const ScaleMixture& mixture, const std::vector<bool>& accepted,
                                int threads) {
  std::vector<double> densities(graph.loops.size(), 0.0);
  parallel_for_each(densities.size(), threads, [&](std::size_t k) {
    const Index before = runs.before(static_cast<Index>(k));
    if (before == Runs<Pose>::kNone || (accepted[k] && accepted[before])) return;
    const auto known = forward_loop(graph, graph.loops[before], scale);
    const auto loop = forward_loop(graph, graph.loops[k], {});
    const auto belief = pair_belief(graph, scale, known, loop);
    const auto as_stated = forward_loop(stated, stated.loops[k], {});
    const OwnError<Pose> own{loop.measured.covariance, as_stated.measured.covariance};
    densities[k] = loop_gain<Pose>(belief, own, mixture).log_density;
  });
  return densities;
}

template std::vector<double> run_density(const Runs<Pose2>&, const ReducedGraph<Pose2>&,
                                         const ReducedGraph<Pose2>&, const CovarianceScale&,
                                         const ScaleMixture&, const std::vector<bool>&, int);
template std::vector<double> run_density(const Runs<Pose3>&, const ReducedGraph<Pose3>&,
                                         const ReducedGraph<Pose3>&, const CovarianceScale&,
                                         const ScaleMixture&, const std::vector<bool>&, int);

}  // namespace isotherm::slam::detail
