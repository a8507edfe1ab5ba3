#include "localize/start/search.hpp"

#include <limits>
#include <utility>

#include "isotherm/spectral/edges/judge_edges.hpp"
#include "localize/evidence/crowd.hpp"
#include "localize/evidence/evidence.hpp"
#include "localize/fold/open_folds.hpp"
#include "localize/refine/robust_refine.hpp"
#include "localize/start/anchor_frame.hpp"
#include "localize/start/path_map.hpp"

namespace isotherm::network::detail {
namespace {

class Search {
 public:
  Search(const RangeProblem& problem, const Placement& anchors, const std::vector<bool>& trusted,
         double gate, const LocalizeOptions& options)
      : problem_(problem),
        free_(problem),
        anchors_(anchors),
        trusted_(trusted),
        gate_(gate),
        options_(options),
        best_(anchors) {
    free_.is_anchor.assign(problem.nodes, false);
  }

  Placement run() {
    constexpr int kMostRounds = 3;
    constexpr double kLikely = 0.5;
    if (options_.method != LocalizeMethod::robust) return started(trusted_, Errors::any);
    try_start(likely_pairs(problem_, kLikely, options_), Errors::any);
    if (is_enough()) return std::move(best_);
    try_start(trusted_, Errors::any);
    try_start(trusted_, Errors::too_long);
    for (int round = 0; round < kMostRounds && try_start(uncontradicted(), errors_); ++round) {
    }
    for (int round = 0; round < kMostRounds && consider(heated(best_)); ++round) {
    }
    return std::move(best_);
  }

 private:
  Placement started(const std::vector<bool>& pairs, Errors errors) const {
    return in_frame(map_by_paths(free_, pairs, errors, gate_, options_));
  }

  bool try_start(const std::vector<bool>& pairs, Errors errors) {
    if (!consider(started(pairs, errors))) return false;
    errors_ = errors;
    return true;
  }

  Placement in_frame(Placement map) const {
    if (!problem_.anchored()) return map;
    if (!align_to_anchors(problem_, anchors_, map)) return anchors_;
    for (Index v = 0; v < problem_.nodes; ++v) {
      if (!problem_.is_anchor[v]) continue;
      map.placed[v] = true;
      map.positions.col(v) = anchors_.positions.col(v);
    }
    return map;
  }

  Placement heated(Placement map) const {
    unfold(problem_, trusted_, errors_, gate_, options_, map);
    return map;
  }

  std::vector<bool> uncontradicted() const {
    auto pairs = trusted_;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const auto& pair = problem_.pairs[p];
      if (is_placed(best_, pair) && squared_deviation(best_, pair) > 4.0 * gate_) pairs[p] = false;
    }
    return pairs;
  }

  bool consider(Placement map) {
    settle(map);
    const double reached = worth(problem_, trusted_, map);
    if (reached <= worth_) return false;
    best_ = std::move(map);
    worth_ = reached;
    return true;
  }

  // From loose to as the ranges are stated.
  void settle(Placement& map) const {
    constexpr double kLoose = 0.1;  // of the typical distance
    for (double factor = kLoose * problem_.typical_distance / problem_.typical_sigma; factor > 1.0;
         factor *= 0.5) {
      auto loose = problem_;
      loose.typical_sigma *= factor;
      for (auto& sigma : loose.sigmas) sigma *= factor;
      for (auto& pair : loose.pairs) pair.sigma *= factor;
      refine_robustly(loose, trusted_, gate_, options_, map);
    }
    refine_robustly(problem_, trusted_, gate_, options_, map);
    open_folds(problem_, trusted_, gate_, options_, map);
  }

  // Whether hardly a trusted pair is contradicted.
  bool is_enough() const {
    constexpr double kHardly = 0.005;
    double pairs = 0.0;
    double against = 0.0;
    for (std::size_t p = 0; p < problem_.pairs.size(); ++p) {
      const auto& pair = problem_.pairs[p];
      if (!trusted_[p] || !is_placed(best_, pair)) continue;
      pairs += 1.0;
      if (squared_deviation(best_, pair) > gate_) against += 1.0;
    }
    return against <= kHardly * pairs;
  }

  const RangeProblem& problem_;
  RangeProblem free_;  // of anchors
  const Placement& anchors_;
  const std::vector<bool>& trusted_;
  double gate_;
  const LocalizeOptions& options_;
  Placement best_;
  double worth_ = -std::numeric_limits<double>::infinity();
  Errors errors_ = Errors::any;  // of the best
};

}  // namespace

std::vector<bool> likely_pairs(const RangeProblem& problem, double chance,
                               const LocalizeOptions& options) {
  std::vector<bool> likely(problem.pairs.size(), true);
  // Heat says nothing about a network that is one neighbourhood.
  if (!options.heat_pruning || options.method != LocalizeMethod::robust ||
      problem.nodes <= options.patch_size) {
    return likely;
  }
  constexpr std::uint64_t kSeed = 1;  // of the random pairs that ranges are compared with
  const auto judged = spectral::judge_edges(
      problem.pair_graph, {.chance = chance}, {},
      {.threads = options.threads, .progress = options.progress, .seed = kSeed});
  for (const auto& verdict : judged.verdicts) {
    likely[verdict.edge] = verdict.verdict != spectral::Verdict::prune;
  }
  return likely;
}

Placement search_map(const RangeProblem& problem, const Placement& anchors,
                     const std::vector<bool>& trusted, double gate,
                     const LocalizeOptions& options) {
  return Search(problem, anchors, trusted, gate, options).run();
}

}  // namespace isotherm::network::detail
