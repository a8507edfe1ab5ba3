#include "localize/start/initial_placement.hpp"

#include <utility>

#include "isotherm/spectral/edges/judge_edges.hpp"
#include "localize/evidence/agreement.hpp"
#include "localize/evidence/crowd.hpp"
#include "localize/evidence/evidence.hpp"
#include "localize/evidence/placing.hpp"
#include "localize/firm/firmness.hpp"
#include "localize/fold/open_folds.hpp"
#include "localize/grow/grow.hpp"
#include "localize/problem/patch.hpp"
#include "localize/refine/robust_refine.hpp"
#include "localize/start/anchor_frame.hpp"
#include "localize/start/path_map.hpp"

namespace isotherm::network::detail {
namespace {

// How maps are started, brought into their frame and mended.
class Start {
 public:
  Start(const RangeProblem& problem, const Placement& anchors, const std::vector<bool>& trusted,
        double gate, const LocalizeOptions& options)
      : problem_(problem),
        free_(problem),
        anchors_(anchors),
        trusted_(trusted),
        gate_(gate),
        options_(options) {
    free_.is_anchor.assign(problem.nodes, false);
    patches_ = make_patches(free_, trusted_, options_);
    evidence_ = learn_evidence(free_, trusted_, gate_, patches_);
  }

  // By the pairs that local maps bear out: false ones are short cuts.
  Placement by_local_pairs() const { return by_paths(borne_out(free_, trusted_, patches_)); }

  // Of that map, one by all pairs, and the better one with all its nodes loose, which draws
  // together what lies torn apart, the one that explains most.
  Placement best_map() const {
    auto best = mended(by_local_pairs());
    if (!is_good(best)) challenge(best, by_paths(trusted_));
    if (!is_good(best)) challenge(best, unfolded(best.all));
    return std::move(best.all);
  }

 private:
  // A placement with those of its nodes that are firm, and how well these fit.
  struct Candidate {
    Placement all;
    Placement firm;
    double credit = 0.0;
  };

  // On which side ranges err, as far as the local maps tell.
  Errors errors() const {
    constexpr double kClear = 3.0;  // a fifth of the others, in chi-squared
    const auto& limits = evidence_.limits;
    return limits.apart > limits.close + kClear ? Errors::too_long : Errors::any;
  }

  Placement by_paths(const std::vector<bool>& pairs) const {
    return together(maps_by_paths(free_, pairs, evidence_.absence, errors(), gate_, options_));
  }

  Placement unfolded(Placement map) const {
    unfold(problem_, trusted_, evidence_.absence, errors(), gate_, options_, map);
    return map;
  }

  // Parts in the frame of the anchors; without anchors, the largest only.
  Placement together(std::vector<Placement> parts) const {
    Placement all = anchors_;
    for (auto& part : parts) {
      if (problem_.anchored() && !align_to_anchors(problem_, anchors_, part)) continue;
      for (Index v = 0; v < problem_.nodes; ++v) {
        if (all.placed[v] || !part.placed[v]) continue;
        all.placed[v] = true;
        all.positions.col(v) = part.positions.col(v);
      }
      if (!problem_.anchored()) break;
    }
    return all;
  }

  // Whether so many nodes are firm that there is little to gain.
  bool is_good(const Candidate& candidate) const {
    constexpr double kGood = 0.95;
    return placed_count(candidate.firm) >= kGood * problem_.nodes;
  }

  // With the nodes outside the map, placed from those that have a place.
  Candidate completed(Placement map) const {
    if (placed_count(map) > 0) {
      grow(problem_, trusted_, gate_, evidence_, options_, map);
      place_more(problem_, gate_, evidence_, map);
      refine_robustly(problem_, trusted_, gate_, options_, map);
    }
    Candidate result;
    result.all = std::move(map);
    examine(result);
    if (open_folds(problem_, trusted_, gate_, options_, result.all) > 0) examine(result);
    return result;
  }

  // Places anew what is not firm, as long as more is explained.
  Candidate mended(Placement map) const {
    constexpr int kMostRounds = 4;
    auto best = completed(std::move(map));
    for (int round = 0; round < kMostRounds && !is_good(best); ++round) {
      auto again = completed(best.firm);
      if (again.credit <= best.credit) break;
      best = std::move(again);
    }
    return best;
  }

  // Takes what comes of a map if that explains more.
  void challenge(Candidate& best, Placement map) const {
    auto rival = mended(std::move(map));
    if (rival.credit > best.credit) best = std::move(rival);
  }

  void examine(Candidate& candidate) const {
    candidate.firm = candidate.all;
    candidate.firm.placed = firm_nodes(problem_, trusted_, gate_, options_, candidate.all);
    candidate.credit = agreement(problem_, trusted_, gate_, candidate.firm).credit -
                       absence_cost(problem_, evidence_.absence, candidate.firm);
  }

  const RangeProblem& problem_;
  RangeProblem free_;  // of anchors
  const Placement& anchors_;
  const std::vector<bool>& trusted_;
  double gate_;
  const LocalizeOptions& options_;
  std::vector<Patch> patches_;
  Evidence evidence_;
};

}  // namespace

std::vector<bool> trusted_pairs(const RangeProblem& problem, const LocalizeOptions& options) {
  std::vector<bool> trusted(problem.pairs.size(), true);
  // Heat says nothing about a network that is one neighbourhood.
  if (!options.heat_pruning || options.method != LocalizeMethod::robust ||
      problem.nodes <= options.patch_size) {
    return trusted;
  }
  constexpr std::uint64_t kSeed = 1;  // of the random pairs that ranges are compared with
  const auto judged = spectral::judge_edges(
      problem.pair_graph, {.chance = options.heat_chance}, {},
      {.threads = options.threads, .progress = options.progress, .seed = kSeed});
  for (const auto& verdict : judged.verdicts) {
    trusted[verdict.edge] = verdict.verdict != spectral::Verdict::prune;
  }
  return trusted;
}

Placement place_initially(const RangeProblem& problem, const Placement& anchors,
                          const std::vector<bool>& trusted, double gate,
                          const LocalizeOptions& options) {
  const Start start(problem, anchors, trusted, gate, options);
  if (options.method == LocalizeMethod::robust) return start.best_map();
  auto map = start.by_local_pairs();
  place_more(problem, gate, {{}, {gate, gate}}, map);
  return map;
}

}  // namespace isotherm::network::detail
