#include "prune/evidence/objective/runs.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <tuple>
#include <utility>

#include "prune/consensus/pairs/loop_pair.hpp"
#include "prune/consensus/pairs/near_pairs.hpp"
#include "prune/evidence/objective/log_normal.hpp"

namespace isotherm::slam::detail {

template <class Pose>
Runs<Pose>::Runs(const ReducedGraph<Pose>& graph, Index window)
    : graph_(graph), before_(graph.loops.size(), kNone), copied_(graph.loops.size(), false) {
  const auto loops = forward_loops(graph, {});
  std::vector<Index> nearest(loops.size(), std::numeric_limits<Index>::max());
  // By place, not by the order of the file.
  const auto place = [&loops](Index k) { return std::tuple(loops[k].from, loops[k].to, k); };
  for (const auto& pair : near_pairs(graph, window)) {
    const auto [first, second] =
        place(pair.first) < place(pair.second) ? pair : std::pair(pair.second, pair.first);
    const Index apart = std::abs(loops[first].from - loops[second].from) +
                        std::abs(loops[first].to - loops[second].to);
    if (apart > nearest[second]) continue;
    nearest[second] = apart;
    before_[second] = first;
    copied_[second] = is_copy(graph.loops[first], graph.loops[second]);
  }
}

template <class Pose>
std::vector<double> Runs<Pose>::log_density(const CovarianceScale& scale) const {
  const auto loops = forward_loops(graph_, scale);
  std::vector<double> densities(loops.size(), 0.0);
  const auto along = [&](Index from, Index to) {
    auto path = graph_.odometry.relative(from, to);
    path.covariance *= scale.odometry;
    return path;
  };
  for (std::size_t k = 0; k < loops.size(); ++k) {
    if (before_[k] == kNone) continue;
    const auto& known = loops[before_[k]];
    const auto& loop = loops[k];
    const auto predicted =
        compose(compose(along(loop.from, known.from), known.measured), along(known.to, loop.to));
    const typename Pose::Tangent r = (loop.measured.T.inverse() * predicted.T).log();
    const typename Pose::Matrix J = residual_jacobian<Pose>(r);
    densities[k] =
        log_normal<Pose>(r, loop.measured.covariance + J * predicted.covariance * J.transpose());
  }
  return densities;
}

template class Runs<Pose2>;
template class Runs<Pose3>;

}  // namespace isotherm::slam::detail
