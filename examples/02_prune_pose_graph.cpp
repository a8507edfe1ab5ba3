// Prunes false loop closures from a pose graph: simulate a city, corrupt it,
// prune it, and compare the verdicts with the truth.
#include <cstdio>

#include <isotherm/slam/evaluate/evaluate_loops.hpp>
#include <isotherm/slam/prune/prune.hpp>
#include <isotherm/slam/simulate/corrupt.hpp>
#include <isotherm/slam/simulate/simulate.hpp>

int main() {
  using namespace isotherm::slam;

  const auto city = simulate_city({.poses = 1000, .measurements = {.loops = 400}, .seed = 7});
  const auto corrupted = corrupt(city.graph, city.truth, {.count = 200, .seed = 7});

  const auto roles = edge_roles(corrupted.graph);
  const auto result = prune(corrupted.graph, roles, {.method = PruneMethod::heat});
  const auto pruned = apply_verdicts(corrupted.graph, result.verdicts);

  for (const auto& round : result.rounds) {
    std::printf("t = %7g: %3lld of %3lld loops pruned (heat distance above %.4f)\n", round.scale,
                static_cast<long long>(round.pruned), static_cast<long long>(round.candidates),
                round.threshold);
  }
  const auto metrics = evaluate_loops(result.verdicts, corrupted.labels);
  std::printf("%d constraints left of %d; precision %.3f, recall %.3f\n", pruned.constraint_count(),
              corrupted.graph.constraint_count(), metrics.precision(), metrics.recall());
  return metrics.precision() > 0.9 && metrics.recall() > 0.9 ? 0 : 1;
}
