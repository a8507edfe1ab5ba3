// Finds the nodes of a simulated sensor network from ranges of which a tenth join
// nodes that never saw each other.
#include <algorithm>
#include <cstdio>
#include <vector>

#include <isotherm/network.hpp>

int main() {
  using namespace isotherm::network;

  const auto simulated = simulate_network(
      {.nodes = 150, .anchors = 8, .degree = 20.0, .noise = 0.02, .false_fraction = 0.1});
  const auto result = localize(simulated.network);

  std::vector<double> errors;
  for (Index v = 0; v < simulated.network.node_count(); ++v) {
    if (result.nodes[v] != NodeStatus::localised) continue;
    errors.push_back((result.positions.col(v) - simulated.truth.col(v)).norm());
  }
  if (errors.empty()) return 1;
  std::sort(errors.begin(), errors.end());
  const double median = errors[errors.size() / 2];
  std::printf("%zu of 142 nodes found, median error %.4f (ranges reach %.3f)\n", errors.size(),
              median, simulated.radius);
  std::printf("%lld of %zu ranges pruned\n",
              static_cast<long long>(count(result.verdicts, isotherm::spectral::Verdict::prune)),
              result.verdicts.size());
  return median < 0.1 * simulated.radius ? 0 : 1;
}
