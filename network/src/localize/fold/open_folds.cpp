#include "localize/fold/open_folds.hpp"

#include <cmath>

#include "localize/constants.hpp"
#include "localize/fold/fold_axes.hpp"
#include "localize/fold/loose_parts.hpp"
#include "localize/fold/part_move.hpp"
#include "localize/refine/robust_refine.hpp"

namespace isotherm::network::detail {

bool open_folds(const MapTask& task, Placement& placement) {
  constexpr int kMostRounds = 6;
  bool any = false;
  std::vector<bool> among(task.problem.nodes, true);
  for (int round = 0; round < kMostRounds; ++round) {
    const auto evidence = learn_evidence(task, placement);
    auto moves = loose_parts(task, evidence, placement);
    for (const auto& fold : find_folds(task, evidence, placement, among)) {
      moves.push_back(fold.move(placement));
    }
    const auto moved = take_moves(task.problem, gains(task, evidence, placement, moves), placement);
    if (moved.empty()) break;
    any = true;
    among = within_steps(task.problem, moved, kRegionSteps);
    refine_at_width(task, std::sqrt(task.gate), placement);
  }
  if (any) refine_robustly(task, placement);
  return any;
}

}  // namespace isotherm::network::detail
