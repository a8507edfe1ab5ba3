#include "localize/fold/open_folds.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "isotherm/base/parallel.hpp"
#include "localize/fold/fold_trial.hpp"
#include "localize/refine/robust_refine.hpp"

namespace isotherm::network::detail {
namespace {

// The mirror images by which a map gains, those that gain most first.
std::vector<FoldOutcome> gains(const RangeProblem& problem, const std::vector<bool>& trusted,
                               double gate, const LocalizeOptions& options,
                               const Placement& placement, const std::vector<bool>& among) {
  constexpr double kGain = 2.0;  // of the cost, for which a fold is worth opening
  const auto evidence = learn_evidence(problem, trusted, placement);
  const Crowd crowd(problem, placement, evidence.absence);
  const auto folds = find_folds(problem, trusted, evidence, options, placement, among);
  std::vector<FoldOutcome> outcomes(folds.size());
  parallel_for(static_cast<std::int64_t>(folds.size()), options.threads, options.progress, "folds",
               [&](std::int64_t k) {
                 outcomes[k] =
                     try_fold(problem, trusted, gate, evidence, crowd, placement, folds[k]);
               });
  std::erase_if(outcomes, [](const FoldOutcome& outcome) {
    return outcome.extra >= -kGain || outcome.moved.empty();
  });
  std::stable_sort(outcomes.begin(), outcomes.end(),
                   [](const FoldOutcome& a, const FoldOutcome& b) { return a.extra < b.extra; });
  return outcomes;
}

struct Taken {
  Index folds = 0;
  std::vector<Index> moved;
};

// Moves the nodes of those that have no node, and no neighbour of one, in common with those before.
Taken take(const RangeProblem& problem, const std::vector<FoldOutcome>& outcomes,
           Placement& placement) {
  std::vector<bool> touched(problem.nodes, false);
  Taken taken;
  for (const auto& outcome : outcomes) {
    const bool overlaps = std::any_of(outcome.moved.begin(), outcome.moved.end(),
                                      [&](Index v) { return touched[v]; });
    if (overlaps) continue;
    ++taken.folds;
    taken.moved.insert(taken.moved.end(), outcome.moved.begin(), outcome.moved.end());
    for (std::size_t k = 0; k < outcome.moved.size(); ++k) {
      const Index v = outcome.moved[k];
      placement.positions.col(v) = outcome.positions.col(static_cast<Eigen::Index>(k));
      touched[v] = true;
      for (const auto& neighbour : problem.pair_graph.neighbours(v)) {
        touched[neighbour.vertex] = true;
      }
    }
  }
  return taken;
}

}  // namespace

Index open_folds(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
                 const LocalizeOptions& options, Placement& placement) {
  constexpr int kMostRounds = 6;
  constexpr int kIterations = 12;
  Index opened = 0;
  std::vector<bool> among(problem.nodes, true);
  for (int round = 0; round < kMostRounds; ++round) {
    const auto taken =
        take(problem, gains(problem, trusted, gate, options, placement, among), placement);
    if (taken.folds == 0) break;
    opened += taken.folds;
    among = lines_near(problem, taken.moved);
    refine_at_width(problem, std::sqrt(gate), kIterations, options, placement);
  }
  if (opened > 0) refine_robustly(problem, trusted, gate, options, placement);
  return opened;
}

}  // namespace isotherm::network::detail
