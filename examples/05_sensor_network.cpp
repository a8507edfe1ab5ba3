// Finds the nodes of a simulated sensor network from ranges of which a tenth join
// nodes that never saw each other.
#include <cmath>
#include <cstdio>

#include <isotherm/geometry/localize.hpp>
#include <isotherm/geometry/simulate_network.hpp>

int main() {
  using namespace isotherm::geometry;

  const auto simulated = simulate_network(
      {.nodes = 150, .anchors = 8, .degree = 20.0, .noise = 0.02, .false_fraction = 0.1});
  const auto result = localize(simulated.network);

  double squared = 0.0;
  for (Index v = 0; v < simulated.network.node_count(); ++v) {
    if (result.nodes[v] != NodeStatus::localised) continue;
    squared += (result.positions.col(v) - simulated.truth.col(v)).squaredNorm();
  }
  const auto localised = static_cast<double>(result.count(NodeStatus::localised));
  const double rmsd = std::sqrt(squared / localised);
  std::printf("%.0f of 142 nodes found, RMSD %.4f (ranges reach %.3f)\n", localised, rmsd,
              simulated.radius);
  std::printf("%lld of %zu ranges pruned\n",
              static_cast<long long>(count(result.verdicts, isotherm::spectral::Verdict::prune)),
              result.verdicts.size());
  return rmsd < 0.1 * simulated.radius ? 0 : 1;
}
