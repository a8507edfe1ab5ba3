#include "localize/refine/polish.hpp"

#include <utility>

#include "localize/evidence/evidence.hpp"
#include "localize/evidence/relocate.hpp"
#include "localize/refine/refine.hpp"

namespace isotherm::network::detail {

void polish(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
            const LocalizeOptions& options, Placement& placement) {
  constexpr int kMostRounds = 5;
  std::vector<bool> among(problem.nodes, true);
  auto evidence = learn_evidence(problem, trusted, placement);
  double reached = worth(problem, trusted, evidence, placement);
  for (int round = 0; round < kMostRounds; ++round) {
    auto next = placement;
    refine_mixture(problem, evidence.absence, true, options.max_iterations, options.progress,
                   evidence.model, next);
    evidence = learn_evidence(problem, trusted, next);
    const auto moved = relocate(problem, gate, evidence, options, among, next);
    if (!moved.empty()) evidence = learn_evidence(problem, trusted, next);
    const double now = worth(problem, trusted, evidence, next);
    if (!(now > reached)) return;
    placement = std::move(next);
    reached = now;
    if (moved.empty()) return;
    among = within_steps(problem, moved, 1);  // whose surroundings have changed
  }
}

}  // namespace isotherm::network::detail
