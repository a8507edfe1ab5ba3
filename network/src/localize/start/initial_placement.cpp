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
#include "localize/grow/grown_parts.hpp"
#include "localize/patches/stitch.hpp"
#include "localize/problem/patch.hpp"
#include "localize/refine/robust_refine.hpp"
#include "localize/start/anchor_frame.hpp"
#include "localize/start/path_map.hpp"

namespace isotherm::network::detail {
namespace {

constexpr double kFair = 0.5;   // of the nodes, that are firm in a map which is right as a whole
constexpr Index kBody = 500;    // and firm nodes that are no accident, however large the rest
constexpr double kGood = 0.95;  // and in one that needs no rival, if these trusted pairs fit:
constexpr double kFitting = 0.9;
constexpr double kWhole = 0.995;  // and in one that has no tear

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
    patches_ = make_patches(free_, trusted_, options_);
    evidence_ = learn_evidence(free_, trusted_, gate_, patches_);
  }

  // On which side ranges err, as far as the local maps tell.
  Errors errors() const {
    constexpr double kClear = 3.0;  // a fifth of the others, in chi-squared
    const auto& limits = evidence_.limits;
    return limits.apart > limits.close + kClear ? Errors::too_long : Errors::any;
  }

  // Shortest paths, in one go.
  std::vector<Placement> by_paths() const {
    return {map_by_paths(free_, trusted_, evidence_.absence, errors(), gate_, options_)};
  }

  std::vector<Placement> stitched() const {
    std::vector<Placement> parts;
    for (const auto& part : stitch(free_, patches_)) {
      parts.push_back(place_nodes(problem_, part.nodes, part.positions));
      if (options_.method != LocalizeMethod::robust) continue;
      refine_robustly(free_, trusted_, gate_, options_, parts.back());
    }
    return parts;
  }

  // The largest part, with its folds opened.
  std::vector<Placement> stitched_and_unfolded() const {
    const auto parts = stitch(free_, patches_);
    if (parts.empty()) return {};
    auto map = place_nodes(problem_, parts.front().nodes, parts.front().positions);
    unfold(free_, trusted_, evidence_.absence, errors(), gate_, options_, map);
    return {std::move(map)};
  }

  std::vector<Placement> grown() const {
    return grown_parts(free_, trusted_, gate_, evidence_, options_);
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

  // Nodes outside the parts, from those that have a place.
  void complete(Placement& placement) const {
    if (placed_count(placement) == 0) return;
    grow(problem_, trusted_, gate_, evidence_, options_, placement);
    place_more(problem_, gate_, evidence_, placement);
    refine_robustly(problem_, trusted_, gate_, options_, placement);
  }

  // A placement with those of its nodes that are firm, and how well these fit.
  struct Candidate {
    Placement all;
    Placement firm;
    double credit = 0.0;
  };

  bool is_firm(const Candidate& candidate, double part) const {
    return placed_count(candidate.firm) >= part * problem_.nodes;
  }

  // Whether it needs no rival. Of a map that many trusted pairs contradict there may be a better
  // one, however firm it is.
  bool is_good(const Candidate& candidate) const {
    const auto found = agreement(problem_, trusted_, gate_, candidate.all);
    return is_firm(candidate, kGood) &&
           static_cast<double>(found.fitting) >= kFitting * static_cast<double>(found.pairs);
  }

  Candidate candidate(Placement placement) const {
    complete(placement);
    Candidate result;
    result.all = std::move(placement);
    examine(result);
    return result;
  }

  // Without the folds that can be opened; in a map that is wrong almost everywhere there are too
  // many.
  Candidate opened(Candidate candidate) const {
    if (is_firm(candidate, kFair) &&
        open_folds(problem_, trusted_, gate_, options_, candidate.all) > 0) {
      examine(candidate);
    }
    return candidate;
  }

  // Places anew what is not firm, as long as more becomes so, until most is.
  Candidate repair(Candidate best) const {
    constexpr int kMostRounds = 4;
    for (int round = 0; round < kMostRounds && !is_firm(best, kGood); ++round) {
      auto again = candidate(best.firm);
      if (again.credit <= best.credit) break;
      best = opened(std::move(again));
    }
    return best;
  }

  // From a placement of some nodes. Where most of them are wrong, and no large part is right,
  // there is nothing to mend.
  Candidate finished(Placement placement) const {
    auto result = opened(candidate(std::move(placement)));
    const bool has_body = is_firm(result, kFair) || placed_count(result.firm) >= kBody;
    return has_body ? repair(std::move(result)) : result;
  }

  // A large part that hangs on few nodes may have turned, and what lay between it and the rest lost
  // its place: springs of wide loss draw such a tear together.
  Candidate drawn_together(Candidate best) const {
    constexpr double kTear = 0.5;  // of what a range that fits is worth, at least
    if (is_firm(best, kWhole)) return best;
    auto map = best.all;
    unfold(problem_, trusted_, evidence_.absence, errors(), gate_, options_, map);
    refine_robustly(problem_, trusted_, gate_, options_, map);
    if (credit(map) < credit(best.all) + kTear * gate_) return best;
    return challenged(std::move(best), std::move(map));
  }

  // Of a candidate and the one that some parts make, that of which more is explained. Parts that
  // explain much less than a fair candidate does are not worth completing.
  Candidate better(Candidate best, std::vector<Placement> parts) const {
    constexpr double kWorth = 0.5;
    auto map = together(std::move(parts));
    if (is_firm(best, kFair) && credit(map) < kWorth * credit(best.all)) return best;
    return challenged(std::move(best), std::move(map));
  }

 private:
  // Of a candidate and the one that a map makes, that of which more is explained.
  Candidate challenged(Candidate best, Placement map) const {
    auto rival = finished(std::move(map));
    return rival.credit > best.credit ? std::move(rival) : std::move(best);
  }

  void examine(Candidate& candidate) const {
    candidate.firm = candidate.all;
    candidate.firm.placed = firm_nodes(problem_, trusted_, gate_, options_, candidate.all);
    candidate.credit =
        credit(candidate.firm) - absence_cost(problem_, evidence_.absence, candidate.firm);
  }

  double credit(const Placement& placement) const {
    return agreement(problem_, trusted_, gate_, placement).credit;
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
  auto stitched = start.together(start.stitched());
  if (options.method != LocalizeMethod::robust) {
    place_more(problem, gate, {{}, {gate, gate}}, stitched);
    return stitched;
  }
  auto best = start.finished(std::move(stitched));
  if (!start.is_good(best)) best = start.better(std::move(best), start.stitched_and_unfolded());
  if (!start.is_good(best)) best = start.better(std::move(best), start.by_paths());
  if (!start.is_firm(best, kFair)) best = start.better(std::move(best), start.grown());
  if (!start.is_firm(best, kFair)) best = start.repair(std::move(best));
  return std::move(start.drawn_together(std::move(best)).all);
}

}  // namespace isotherm::network::detail
