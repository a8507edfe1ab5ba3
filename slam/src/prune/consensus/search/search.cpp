#include "prune/consensus/search/search.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "isotherm/base/error.hpp"
#include "prune/consensus/estimate/held_out.hpp"
#include "prune/consensus/judge/log_odds.hpp"
#include "prune/consensus/pairs/batches.hpp"
#include "prune/consensus/pairs/conflicts.hpp"

namespace isotherm::slam::detail {
namespace {

using spectral::Verdict;

constexpr int kStepsPerRound = 6;      // of Gauss-Newton
constexpr double kWithinReach = 10.0;  // times the gate
constexpr int kMostDrops = 3;          // a loop dropped so often is not tried again
constexpr int kCalibrations = 6;       // of the covariance scales, on proven loops
constexpr int kLastCalibrations = 1;   // and with the likely ones
constexpr int kReconsiderations = 3;
constexpr int kMostDoublings = 4;  // of odometry's covariance, where it refutes every loop
constexpr Index kFewParts = 10;
constexpr double kBridgeProbability = 0.95;  // of a loop of which only its span is known

}  // namespace

template <class Pose>
Search<Pose>::Search(const ReducedGraph<Pose>& graph, const Pairs& pairs,
                     const ConsensusOptions& options, const RunContext& run, bool may_widen)
    : graph_(graph),
      options_(options),
      run_(run),
      required_odds_(log_odds_of(1.0 - options.significance)),
      map_(graph.poses),
      estimate_(graph),
      near_pairs_(pairs),
      calibration_(graph, near_pairs_, may_widen),
      records_(graph.loops.size()),
      accepted_(graph.loops.size(), false),
      judge_(graph, estimate_, calibration_, map_, accepted_, options.significance) {
  if (options.calibrate) calibration_.learn_from_cycles(map_);
  judge_anew();
}

template <class Pose>
void Search<Pose>::run() {
  // The scales are learnt from proven loops first: those that are merely likely are
  // the likelier, the wider the covariances, and would feed back.
  accept_and_calibrate(kCalibrations);
  // Loops that fit a sharp prediction first, then those that need room for drift: wide ones
  // let false loops between near poses in before the true ones that contradict them.
  if (options_.calibrate && calibration_.allow_for_drift()) {
    judge_anew();
    accept_and_calibrate(kCalibrations);
  }
  take_likely_ = true;
  judge_.suspect_unlikely();
  accept_and_calibrate(kLastCalibrations);
  for (int k = 0; k < kReconsiderations && reconsider();) ++k;
  readmit_together();
  doubt_company();
  closing_ = true;
  accept_while_possible();
}

template <class Pose>
void Search<Pose>::accept_and_calibrate(int most_calibrations) {
  accept_while_possible();
  if (!options_.calibrate) return;
  for (int k = 0; k < kMostDoublings && odometry_leaves_none(); ++k) {
    calibration_.double_odometry();
    judge_anew();
    accept_while_possible();
  }
  for (int k = 0; k < most_calibrations && calibrate(); ++k) accept_while_possible();
}

// One statement of accuracy stands against all loops: it is doubted first. At the end
// it is doubted as well where it leaves none likely.
template <class Pose>
bool Search<Pose>::odometry_leaves_none() const {
  bool any_connected = false;
  for (std::size_t k = 0; k < accepted_.size(); ++k) {
    const auto loop = static_cast<Index>(k);
    if (accepted_[k] || (!take_likely_ && judge_.inside_gate(loop))) return false;
    any_connected = any_connected || judge_.connected(loop);
  }
  return any_connected;
}

template <class Pose>
void Search<Pose>::accept_while_possible() {
  while (true) {
    settle();
    assess();
    learn_from_decided();
    if (static_cast<int>(rounds_.size()) >= options_.max_rounds) {
      settled_ = false;
      return;
    }
    if (accept(next_batch()) || readmit()) continue;
    if ((take_likely_ || few_parts()) && !closing_ && join_on_trial()) continue;
    if (!few_parts() || !accept(clusters_of(in_question(), judge_.log_odds()))) return;
  }
}

// Bounds hold as long as poses move little. Loops that were refuted by one are judged afresh,
// those far beyond it only at the end; true if that lets one be accepted after all.
template <class Pose>
bool Search<Pose>::readmit() {
  Selection out;
  for (std::size_t k = 0; k < accepted_.size(); ++k) {
    const auto loop = static_cast<Index>(k);
    if (judge_.connected(loop) && judge_.refuted(loop) &&
        (closing_ || judge_.evidence(loop).chi2 <= kWithinReach * judge_.refuting_gate(loop))) {
      out.push_back(loop);
    }
  }
  tell_progress();
  judge_.weigh_afresh(out);
  learn_from_decided();
  return accept(next_batch());
}

// Poses that agree with every accepted loop; those that cannot be made to agree
// are dropped, the worst first.
template <class Pose>
void Search<Pose>::settle() {
  while (true) {
    tell_progress();
    estimate_.update(accepted_, calibration_.scale(), kStepsPerRound);
    const Selection out = judge_.inconsistent();
    if (out.empty()) return;
    for (const Index k : out) {
      accepted_[k] = false;
      records_[k].round = 0;
      ++records_[k].drops;
    }
    if (!rounds_.empty()) rounds_.back().dropped += static_cast<std::int64_t>(out.size());
    judge_.forget_bounds();
  }
}

template <class Pose>
void Search<Pose>::assess() {
  tell_progress();
  judge_.assess();
}

template <class Pose>
typename Search<Pose>::Selection Search<Pose>::in_question() const {
  Selection loops;
  for (std::size_t k = 0; k < accepted_.size(); ++k) {
    const auto loop = static_cast<Index>(k);
    const Record& record = records_[k];
    if (!accepted_[k] && !record.on_trial && record.drops < kMostDrops &&
        judge_.inside_gate(loop)) {
      loops.push_back(loop);
    }
  }
  return loops;
}

template <class Pose>
typename Search<Pose>::Batch Search<Pose>::next_batch() const {
  const Selection eligible = in_question();
  const auto odds = judge_.log_odds();
  const auto passing = [&](double least) {
    Selection loops;
    std::ranges::copy_if(eligible, std::back_inserter(loops),
                         [&](Index k) { return judge_.connected(k) && odds[k] > least; });
    return most_certain_third(std::move(loops), odds, options_.significance);
  };
  Batch batch{"evidence", passing(required_odds_)};
  if (batch.loops.empty()) {
    Selection within = eligible;
    if (few_parts()) std::erase_if(within, [&](Index k) { return !judge_.connected(k); });
    batch = clusters_of(within, odds);
  }
  if (!batch.loops.empty() || !take_likely_) return batch;
  batch = {"prior", passing(0.0)};
  if (batch.loops.empty()) batch = {"span", bridges(eligible, odds)};
  return batch;
}

// Hundreds of pieces of broken odometry are joined by clusters, whose loops are mostly
// short; each trial would tell little. The joint between a few parts decides of all.
template <class Pose>
bool Search<Pose>::few_parts() const {
  return estimate_.component_count() > 1 && estimate_.component_count() <= kFewParts;
}

template <class Pose>
typename Search<Pose>::Batch Search<Pose>::clusters_of(const Selection& eligible,
                                                       const std::vector<double>& odds) const {
  return {"cluster", strongest_clusters(support_, eligible, odds, agreement_, required_odds_)};
}

// Short loops between parts that nothing joins: broken odometry. They have no evidence
// but their span. What is said of a longer one, as between robots, would be a guess.
template <class Pose>
typename Search<Pose>::Selection Search<Pose>::bridges(const Selection& eligible,
                                                       const std::vector<double>& odds) const {
  const double least = log_odds_of(kBridgeProbability);
  Selection loops;
  std::ranges::copy_if(eligible, std::back_inserter(loops), [&](Index k) {
    return !judge_.connected(k) && graph_.span(k) <= options_.window && odds[k] > least;
  });
  return most_certain_third(std::move(loops), odds, options_.significance);
}

// False if there is none.
template <class Pose>
bool Search<Pose>::accept(const Batch& batch) {
  if (batch.loops.empty()) return false;
  const int round = static_cast<int>(rounds_.size()) + 1;
  for (const Index k : batch.loops) {
    accepted_[k] = true;
    records_[k].round = round;
    judge_.sharpen(k);
  }
  ConsensusRound summary;
  summary.accepted = static_cast<std::int64_t>(batch.loops.size());
  summary.in_force = accepted_count();
  summary.rule = batch.rule;
  rounds_.push_back(summary);
  return true;
}

// Between the steps of a round, so that a stop is heeded soon.
template <class Pose>
void Search<Pose>::tell_progress() const {
  if (!run_.progress) return;
  const auto done = static_cast<std::uint64_t>(accepted_count());
  if (!run_.progress({"consensus", done, accepted_.size()})) throw Cancelled();
}

template <class Pose>
void Search<Pose>::learn_from_decided() {
  judge_.learn_prior();

  // True loops need not agree better than the gate asks unless false ones crowd there.
  std::vector<double> of_accepted;
  std::vector<double> of_refuted;
  for (const auto* pairs : {&support_.agreeing, &support_.contradicting}) {
    for (const auto& [first, second, gain, chi2] : *pairs) {
      if (judge_.crowded() && accepted_[first] && accepted_[second]) of_accepted.push_back(chi2);
      if (judge_.refuted(first) && judge_.refuted(second)) of_refuted.push_back(chi2);
    }
  }
  agreement_ = learn_agreement(std::move(of_accepted), of_refuted, judge_.widest_gate());
}

template <class Pose>
bool Search<Pose>::asks_for_wider() const {
  return accepted_count() == 0 ||
         calibration_.asks_for_wider(estimate_, accepted_, probabilities());
}

// On a map that false loops have drawn together to a point every loop says what all say: it
// is no likelier than one anywhere on that map.
template <class Pose>
std::int64_t Search<Pose>::count_proven() const {
  const MapVolume<Pose> map(estimate_.poses());
  const auto loops = held_out(graph_, estimate_, accepted_, calibration_.scale().loops, map);
  return std::ranges::count_if(
      loops, [this](const HeldOut& loop) { return loop.evidence.log_ratio >= required_odds_; });
}

template <class Pose>
std::vector<double> Search<Pose>::probabilities() const {
  std::vector<double> probability = judge_.log_odds();
  for (double& p : probability) p = 1.0 / (1.0 + std::exp(-p));
  return probability;
}

template <class Pose>
bool Search<Pose>::calibrate() {
  const bool changed =
      calibration_.learn_from_accepted(estimate_, accepted_, probabilities(), judge_.tail_share());
  if (changed) judge_anew();
  return changed;
}

// At new scales every old judgement is void.
template <class Pose>
void Search<Pose>::judge_anew() {
  for (auto& record : records_) record.drops = 0;
  judge_.forget_bounds();
  support_ = mutual_support(graph_, near_pairs_, map_, calibration_.scale(), judge_.widest_gate());
}

template <class Pose>
void Search<Pose>::report(ConsensusResult& result) const {
  result.rounds = rounds_;
  result.inlier_fraction = judge_.inlier_fraction();
  result.odometry_scale = calibration_.scale().odometry;
  result.loop_scale = calibration_.scale().loops;
  result.tail_factor = judge_.tail_factor();
  result.settled = settled_;
  result.details.resize(accepted_.size());
  std::vector<bool> pruned(accepted_.size(), false);
  for (std::size_t k = 0; k < accepted_.size(); ++k) {
    const auto loop = static_cast<Index>(k);
    const Evidence& evidence = judge_.evidence(loop);
    auto& verdict = result.verdicts[k];
    verdict.score = evidence.chi2;
    verdict.threshold = accepted_[k] ? judge_.drop_gate(loop) : judge_.refuting_gate(loop);
    if (accepted_[k]) {
      verdict.verdict = Verdict::keep;
      verdict.stage = "round " + std::to_string(records_[k].round);
    } else if (judge_.refuted(loop)) {
      pruned[k] = true;
      verdict.verdict = Verdict::prune;
      verdict.stage = "refuted";
    } else {
      verdict.verdict = Verdict::ambiguous;
      verdict.stage = judge_.connected(loop) ? "unproven" : "unconnected";
    }
    auto& info = result.details[k];
    info.chi2 = evidence.chi2;
    info.evidence = evidence.log_ratio;
    info.round = records_[k].round;
    info.connected = judge_.connected(loop);
  }
  auto conflicts =
      name_conflicts(graph_, map_, calibration_.scale(), judge_.widest_gate(), accepted_, pruned);
  for (std::size_t k = 0; k < accepted_.size(); ++k) {
    result.details[k].conflicts = std::move(conflicts[k]);
  }
}

template class Search<Pose2>;
template class Search<Pose3>;

}  // namespace isotherm::slam::detail
