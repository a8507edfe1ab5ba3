// Prunes false loop closures from a pose graph: simulate a city, corrupt it, prune and
// optimise it, and compare the verdicts and the map with the truth.
#include <cstdio>

#include <isotherm/slam.hpp>

int main() {
  using namespace isotherm::slam;

  const auto city = simulate_city({.poses = 1000, .measurements = {.loops = 400}, .seed = 7});
  const auto corrupted = corrupt(city.graph, city.truth, {.count = 200, .seed = 7});

  const auto map = prune_and_optimize(corrupted.graph, {.prune = HeatPruneOptions{}});

  for (const auto& round : map.decisions.rounds) {
    std::printf("t = %7g: %3lld of %3lld loops pruned (heat distance above %.4f)\n", round.scale,
                static_cast<long long>(round.pruned), static_cast<long long>(round.candidates),
                round.threshold);
  }
  const auto metrics = evaluate_loops(map.decisions.verdicts, corrupted.labels);
  std::printf("%d constraints left of %d; precision %.3f, recall %.3f\n",
              map.pruned.constraint_count(), corrupted.graph.constraint_count(),
              metrics.precision(), metrics.recall());
  const auto end = map.pruned.poses.back().translation();
  std::printf("the map ends %.2f m from the truth\n",
              (end - city.truth.back().translation()).norm());
  return metrics.precision() > 0.9 && metrics.recall() > 0.9 ? 0 : 1;
}
