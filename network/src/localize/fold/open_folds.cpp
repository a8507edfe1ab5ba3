#include "localize/fold/open_folds.hpp"

#include <cmath>

#include "localize/constants.hpp"
#include "localize/fold/fold_axes.hpp"
#include "localize/fold/loose_parts.hpp"
#include "localize/fold/part_move.hpp"
#include "localize/refine/robust_refine.hpp"

namespace isotherm::network::detail {

bool open_folds(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
                const LocalizeOptions& options, Placement& placement) {
  constexpr int kMostRounds = 6;
  bool any = false;
  std::vector<bool> among(problem.nodes, true);
  for (int round = 0; round < kMostRounds; ++round) {
    const auto evidence = learn_evidence(problem, trusted, placement);
    auto moves = loose_parts(problem, trusted, gate, evidence, options, placement);
    for (const auto& fold : find_folds(problem, trusted, evidence, options, placement, among)) {
      moves.push_back(fold.move(placement));
    }
    const auto moved = take_moves(
        problem, gains(problem, trusted, gate, evidence, options, placement, moves), placement);
    if (moved.empty()) break;
    any = true;
    among = within_steps(problem, moved, kRegionSteps);
    refine_at_width(problem, std::sqrt(gate), options, placement);
  }
  if (any) refine_robustly(problem, trusted, gate, options, placement);
  return any;
}

}  // namespace isotherm::network::detail
