#include "localize/start/search.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <utility>

#include "isotherm/spectral/edges/judge_edges.hpp"
#include "localize/constants.hpp"
#include "localize/evidence/crowd.hpp"
#include "localize/evidence/evidence.hpp"
#include "localize/fold/open_folds.hpp"
#include "localize/fold/recombine.hpp"
#include "localize/refine/polish.hpp"
#include "localize/refine/robust_refine.hpp"
#include "localize/start/anchor_frame.hpp"
#include "localize/start/path_map.hpp"
#include "localize/start/redraw.hpp"

namespace isotherm::network::detail {
namespace {

constexpr std::size_t kMostRounds = 10;  // of what is tried as long as it helps

class Search {
 public:
  Search(const MapTask& task, const Placement& anchors)
      : task_(task), problem_(task.problem), free_(problem_), anchors_(anchors), best_(anchors) {
    free_.is_anchor.assign(problem_.nodes, false);
  }

  Placement run() {
    if (task_.options.method != LocalizeMethod::robust) {
      return started(task_.trusted, Errors::any);
    }
    const auto likely = likely_pairs(problem_, kLikely, task_.options);
    const bool has_false = std::find(likely.begin(), likely.end(), false) != likely.end();
    consider(started(has_false ? supported_pairs(problem_, likely) : likely, Errors::any));
    unfold_best();
    if (!is_enough()) try_other_starts();
    for (std::size_t round = 0; round < kMostRounds && consider_redrawn(); ++round) unfold_best();
    return std::move(best_);
  }

 private:
  Placement started(const std::vector<bool>& pairs, Errors errors) const {
    return in_frame(map_by_paths({free_, pairs, task_.gate, task_.options}, errors));
  }

  // What follows from the best map in turns, until nothing of it helps.
  void try_other_starts() {
    consider(started(task_.trusted, Errors::too_long));
    unfold_best();
    const std::array<std::function<Placement()>, 4> ways = {
        [&] { return heated(Errors::any); }, [&] { return heated(Errors::too_long); },
        [&] { return anew_from(uncontradicted()); },
        [&] { return anew_from(supported_pairs(problem_, uncontradicted())); }};
    std::size_t vain = 0;
    for (std::size_t turn = 0; turn < kMostRounds * ways.size() && vain < ways.size(); ++turn) {
      const bool helps = consider(ways[turn % ways.size()]());
      if (helps) unfold_best();
      vain = helps ? 0 : vain + 1;
    }
  }

  // A start from these pairs; nodes of which they say nothing stay where the best map has them.
  Placement anew_from(const std::vector<bool>& pairs) const {
    auto map = started(pairs, Errors::any);
    if (!in_frame_of_best(map)) return map;
    for (Index v = 0; v < problem_.nodes; ++v) {
      if (map.placed[v] || !best_.placed[v]) continue;
      map.placed[v] = true;
      map.positions.col(v) = best_.positions.col(v);
    }
    return map;
  }

  // Trusted pairs but those that the best map contradicts.
  std::vector<bool> uncontradicted() const {
    auto pairs = task_.trusted;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const auto& pair = problem_.pairs[p];
      if (is_placed(best_, pair) && !task_.fits(best_, pair)) pairs[p] = false;
    }
    return pairs;
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

  Placement heated(Errors errors) const {
    auto map = best_;
    unfold(task_, errors, map);
    return map;
  }

  // Whether a map that is settled makes the best one better.
  bool consider(Placement map) {
    refine_robustly(task_, map);
    polish(task_, map);
    return merge(std::move(map));
  }

  // Whether some region of it is better drawn anew, of those that are not as they were last time.
  bool consider_redrawn() {
    const auto changed = changed_since(redrawn_);
    redrawn_ = best_;
    return merge(
        redraw(task_, within_steps(problem_, changed, kRegionSteps, task_.trusted), best_));
  }

  // Nodes that are elsewhere in the best map; all since there was none.
  std::vector<Index> changed_since(const Placement& before) const {
    std::vector<Index> changed;
    for (Index v = 0; v < problem_.nodes; ++v) {
      const bool is_same = !before.placed.empty() && before.placed[v] == best_.placed[v] &&
                           (before.positions.col(v) - best_.positions.col(v)).norm() <=
                               kApart * problem_.typical_sigma;
      if (!is_same) changed.push_back(v);
    }
    return changed;
  }

  // The better one of both, with the parts that are better in the other.
  bool merge(Placement map) {
    const double before = worth_;
    take_if_better(map);
    if (before > -std::numeric_limits<double>::infinity()) {
      auto both = best_;
      if (in_frame_of_best(map) && recombine(task_, map, both)) take_if_better(both);
    }
    return worth_ > before + kBetter;
  }

  // `map` is what was the best then.
  void take_if_better(Placement& map) {
    const double reached = worth(task_, map);
    if (reached <= worth_) return;
    std::swap(map, best_);
    worth_ = reached;
  }

  // Without anchors every map has its own.
  bool in_frame_of_best(Placement& map) const {
    if (problem_.anchored()) return true;
    auto shared = free_;
    for (Index v = 0; v < problem_.nodes; ++v) {
      shared.is_anchor[v] = map.placed[v] && best_.placed[v];
    }
    return align_to_anchors(shared, best_, map);
  }

  // The best map with what its folds gain.
  void unfold_best() {
    if (unfolded_ == worth_) return;
    auto map = best_;
    if (open_folds(task_, map)) {
      polish(task_, map);
      merge(std::move(map));
    }
    unfolded_ = worth_;
  }

  // Whether hardly a trusted pair is contradicted.
  bool is_enough() const {
    double pairs = 0.0;
    double against = 0.0;
    task_.visit_pairs(best_, [&](const RangePair& pair) {
      pairs += 1.0;
      if (!task_.fits(best_, pair)) against += 1.0;
    });
    return against <= kHardlyAny * pairs;
  }

  const MapTask& task_;
  const RangeProblem& problem_;
  RangeProblem free_;  // of anchors
  const Placement& anchors_;
  Placement best_;
  Placement redrawn_;  // the best map when regions were drawn last
  double worth_ = -std::numeric_limits<double>::infinity();
  double unfolded_ = worth_;  // when folds were opened last
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
  // Places are for the ranges to tell, which know more of them than that two nodes have one.
  const auto judged = spectral::judge_edges(
      problem.pair_graph, {.chance = chance, .places = false}, {},
      {.threads = options.threads, .progress = options.progress, .seed = kSeed});
  for (const auto& verdict : judged.verdicts) {
    likely[verdict.edge] = verdict.verdict != spectral::Verdict::prune;
  }
  return likely;
}

std::vector<bool> supported_pairs(const RangeProblem& problem, const std::vector<bool>& pairs) {
  std::vector<bool> supported(pairs.size(), false);
  std::vector<Index> seen(problem.nodes, -1);  // as a neighbour of which node last
  for (Index v = 0; v < problem.nodes; ++v) {
    const auto around = problem.pair_graph.neighbours(v);
    for (const auto& [vertex, edge] : around) {
      if (pairs[edge]) seen[vertex] = v;
    }
    for (const auto& [vertex, edge] : around) {
      if (!pairs[edge] || vertex < v) continue;
      int common = 0;
      for (const auto& [other, second] : problem.pair_graph.neighbours(vertex)) {
        if (pairs[second] && seen[other] == v) ++common;
      }
      supported[edge] = common >= problem.dimension;
    }
  }
  return supported;
}

Placement search_map(const MapTask& task, const Placement& anchors) {
  return Search(task, anchors).run();
}

}  // namespace isotherm::network::detail
