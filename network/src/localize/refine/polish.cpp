#include "localize/refine/polish.hpp"

#include <utility>

#include "localize/evidence/evidence.hpp"
#include "localize/evidence/relocate.hpp"
#include "localize/refine/refine.hpp"

namespace isotherm::network::detail {

void polish(const MapTask& task, Placement& placement) {
  constexpr int kMostRounds = 5;
  const RangeProblem& problem = task.problem;
  std::vector<bool> among(problem.nodes, true);
  auto evidence = learn_evidence(task, placement);
  double reached = worth(task, evidence, placement);
  for (int round = 0; round < kMostRounds; ++round) {
    auto next = placement;
    refine_mixture(problem, evidence.absence, true, task.options, evidence.model, next);
    evidence = learn_evidence(task, next);
    const auto moved = relocate(task, evidence, among, next);
    if (!moved.empty()) evidence = learn_evidence(task, next);
    const double now = worth(task, evidence, next);
    if (!(now > reached)) return;
    placement = std::move(next);
    reached = now;
    if (moved.empty()) return;
    among = within_steps(problem, moved, 1);  // whose surroundings have changed
  }
}

}  // namespace isotherm::network::detail
