#include "localize/initial_placement.hpp"

#include <utility>

#include "isotherm/spectral/judge_edges.hpp"
#include "localize/agreement.hpp"
#include "localize/anchor_frame.hpp"
#include "localize/firmness.hpp"
#include "localize/grow.hpp"
#include "localize/grown_parts.hpp"
#include "localize/patch.hpp"
#include "localize/placing.hpp"
#include "localize/robust_refine.hpp"
#include "localize/stitch.hpp"

namespace isotherm::geometry::detail {
namespace {

// How maps are started, and brought together.
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
  }

  std::vector<Placement> stitched() const {
    std::vector<Placement> parts;
    for (const auto& part : stitch(free_, make_patches(free_, trusted_, options_))) {
      parts.push_back(place_nodes(problem_, part.nodes, part.positions));
      if (options_.method != LocalizeMethod::robust) continue;
      refine_robustly(free_, parts.back(), gate_, options_);
    }
    return parts;
  }

  std::vector<Placement> grown() const { return grown_parts(free_, trusted_, gate_, options_); }

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

  // Nodes outside the parts, from those that have a place.
  void complete(Placement& placement) const {
    if (placed_count(placement) == 0) return;
    grow(problem_, trusted_, gate_, options_, placement);
    place_more(problem_, gate_, placement);
    refine_robustly(problem_, placement, gate_, options_);
  }

  // A placement with those of its nodes that are firm, and how well these fit.
  struct Candidate {
    Placement all;
    Placement firm;
    double credit = 0.0;
  };

  Candidate candidate(Placement placement) const {
    complete(placement);
    Candidate result;
    result.firm = placement;
    result.firm.placed = firm_nodes(problem_, trusted_, gate_, options_, placement);
    result.all = std::move(placement);
    result.credit = agreement(problem_, trusted_, gate_, result.firm).credit;
    return result;
  }

  // Places anew what is not firm, as long as more becomes so.
  Candidate repair(Candidate best) const {
    constexpr int kMostRounds = 4;
    for (int round = 0; round < kMostRounds; ++round) {
      auto again = candidate(best.firm);
      if (again.credit <= best.credit) break;
      best = std::move(again);
    }
    return best;
  }

 private:
  const RangeProblem& problem_;
  RangeProblem free_;  // of anchors
  const Placement& anchors_;
  const std::vector<bool>& trusted_;
  double gate_;
  const LocalizeOptions& options_;
};

}  // namespace

std::vector<bool> trusted_pairs(const RangeProblem& problem, const LocalizeOptions& options) {
  std::vector<bool> trusted(problem.pairs.size(), true);
  // Heat says nothing about a network that is one neighbourhood.
  if (!options.heat_pruning || options.method != LocalizeMethod::robust ||
      problem.nodes <= options.patch_size) {
    return trusted;
  }
  const auto judged = spectral::judge_edges(
      problem.pair_graph,
      {.chance = options.heat_chance, .threads = options.threads, .progress = options.progress});
  for (const auto& verdict : judged.verdicts) {
    trusted[verdict.edge] = verdict.verdict != spectral::Verdict::prune;
  }
  return trusted;
}

Placement place_initially(const RangeProblem& problem, const Placement& anchors,
                          const std::vector<bool>& trusted, double gate,
                          const LocalizeOptions& options) {
  const Start start(problem, anchors, trusted, gate, options);
  auto stitched = start.together(start.stitched());
  if (options.method != LocalizeMethod::robust) {
    place_more(problem, gate, stitched);
    return stitched;
  }
  // A start of which this part is firm needs no rival.
  constexpr double kGood = 0.95;
  auto best = start.candidate(std::move(stitched));
  if (placed_count(best.firm) < kGood * problem.nodes) {
    auto rival = start.candidate(start.together(start.grown()));
    if (rival.credit > best.credit) best = std::move(rival);
    best = start.repair(std::move(best));
  }
  return std::move(best.all);
}

}  // namespace isotherm::geometry::detail
