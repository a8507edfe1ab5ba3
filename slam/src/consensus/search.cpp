#include "search.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "batches.hpp"
#include "conflicts.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/statistics.hpp"
#include "near_pairs.hpp"
#include "prediction.hpp"

namespace isotherm::slam::detail {
namespace {

using spectral::Verdict;

constexpr int kStepsPerRound = 6;     // of Gauss-Newton
constexpr int kMostDrops = 3;         // a loop dropped so often is not tried again
constexpr int kCalibrations = 6;      // of the covariance scales, on proven loops
constexpr int kLastCalibrations = 1;  // and with the likely ones
constexpr int kReconsiderations = 3;
constexpr int kMostDoublings = 4;  // of odometry's covariance, where it refutes every loop
// An accepted loop is dropped beyond twice the deviations that an average one would
// need to meet the gate: real errors have heavy tails, and where it was accepted it had
// evidence of its own.
constexpr double kDropFactor = 4.0;
constexpr double kBridgeProbability = 0.95;  // of a loop of which only its span is known

double log_odds_of(double probability) { return std::log(probability / (1.0 - probability)); }

}  // namespace

template <class Pose>
Search<Pose>::Search(const ReducedGraph<Pose>& graph, const ConsensusOptions& options)
    : graph_(graph),
      options_(options),
      gate_(chi_squared_quantile(1.0 - options.significance, Pose::kDof)),
      required_odds_(log_odds_of(1.0 - options.significance)),
      map_(graph.poses),
      estimate_(graph),
      near_pairs_(near_pairs(graph, options.window)),
      calibration_(graph, near_pairs_),
      states_(graph.loops.size()),
      accepted_(graph.loops.size(), false) {
  if (options.calibrate) calibration_.learn_from_cycles(map_);
  judge_anew();
}

template <class Pose>
void Search<Pose>::run(ConsensusResult& result) {
  // The scales are learnt from proven loops first: those that are merely likely are
  // the likelier, the wider the covariances, and would feed back.
  accept_and_calibrate(kCalibrations);
  take_likely_ = true;
  accept_and_calibrate(kLastCalibrations);
  for (int k = 0; k < kReconsiderations && reconsider();) ++k;
  report(result);
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
  for (std::size_t k = 0; k < states_.size(); ++k) {
    if (accepted_[k] || (!take_likely_ && inside_gate(static_cast<Index>(k)))) return false;
    any_connected = any_connected || states_[k].connected;
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
    if (accept_next_batch()) continue;
    if (!readmit()) return;
  }
}

template <class Pose>
bool Search<Pose>::accept_next_batch() {
  const Batch batch = next_batch();
  if (!batch.loops.empty()) accept(batch);
  return !batch.loops.empty();
}

// Bounds hold as long as poses move little. At the end every loop that was refuted
// by a bound is judged afresh; true if that lets one be accepted after all.
template <class Pose>
bool Search<Pose>::readmit() {
  Selection out;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const auto loop = static_cast<Index>(k);
    if (states_[k].connected && refuted(loop)) out.push_back(loop);
  }
  weigh_afresh(out);
  learn_from_decided();
  return accept_next_batch();
}

// Poses that agree with every accepted loop; those that cannot be made to agree
// are dropped, the worst first.
template <class Pose>
void Search<Pose>::settle() {
  do {
    tell_progress();
    estimate_.update(accepted_, calibration_.scale(), kStepsPerRound);
  } while (drop_inconsistent());
}

template <class Pose>
double Search<Pose>::drop_gate() const {
  return gate_ * std::max(1.0, kDropFactor * calibration_.loop_level());
}

template <class Pose>
bool Search<Pose>::drop_inconsistent() {
  const double gate = drop_gate();
  const auto judge = [&](Index loop) {
    auto& state = states_[loop];
    const auto& link = graph_.loops[loop];
    state.evidence.chi2 =
        fitted_chi2(link, estimate_.residual(link), state.covariance, calibration_.scale().loops);
    return state.evidence.chi2 <= gate;
  };
  // An old covariance is an upper bound, and so is the chi-squared it gives.
  Selection doubtful;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const auto loop = static_cast<Index>(k);
    if (accepted_[k] && (!states_[k].fit_known || !judge(loop))) doubtful.push_back(loop);
  }
  const auto covariances = estimate_.relative_covariances(doubtful);
  double worst = 0.0;
  for (std::size_t k = 0; k < doubtful.size(); ++k) {
    auto& state = states_[doubtful[k]];
    state.covariance = covariances[k];
    state.fit_known = true;
    judge(doubtful[k]);
    worst = std::max(worst, state.evidence.chi2);
  }
  if (worst <= gate) return false;
  for (const Index k : doubtful) {
    if (states_[k].evidence.chi2 >= std::max(gate, 0.5 * worst)) drop(k);
  }
  forget_bounds();
  return true;
}

template <class Pose>
void Search<Pose>::drop(Index loop) {
  accepted_[loop] = false;
  states_[loop].round = 0;
  ++states_[loop].drops;
  if (!rounds_.empty()) ++rounds_.back().dropped;
}

// Once a loop is dropped or the scales change, predictions may be wider than any
// since odometry alone.
template <class Pose>
void Search<Pose>::forget_bounds() {
  for (std::size_t k = 0; k < states_.size(); ++k) {
    states_[k].covariance = graph_.odometry_covariance[k] * calibration_.scale().odometry;
    states_[k].fit_known = false;
  }
}

template <class Pose>
Evidence Search<Pose>::weigh_loop(Index loop, const Matrix& covariance) const {
  const auto& link = graph_.loops[loop];
  return weigh_prediction(link, estimate_.residual(link), covariance, calibration_.scale().loops,
                          map_);
}

// Accepting loops only ever sharpens predictions, so that an old covariance is an
// upper bound and its chi-squared a lower one: loops that fail even so are not
// solved for again.
template <class Pose>
void Search<Pose>::assess() {
  Selection unclear;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    if (accepted_[k]) continue;
    auto& state = states_[k];
    state.connected = estimate_.connected(graph_.loops[k]);
    if (!state.connected) {
      state.evidence = {};
      continue;
    }
    state.evidence = weigh_loop(static_cast<Index>(k), state.covariance);
    if (state.evidence.chi2 <= gate_) unclear.push_back(static_cast<Index>(k));
  }
  weigh_afresh(unclear);
}

template <class Pose>
void Search<Pose>::weigh_afresh(const Selection& loops) {
  tell_progress();
  const auto covariances = estimate_.relative_covariances(loops);
  for (std::size_t k = 0; k < loops.size(); ++k) {
    states_[loops[k]].covariance = covariances[k];
    states_[loops[k]].evidence = weigh_loop(loops[k], covariances[k]);
  }
}

template <class Pose>
typename Search<Pose>::Selection Search<Pose>::in_question() const {
  Selection loops;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const auto& state = states_[k];
    if (!accepted_[k] && !state.on_trial && state.drops < kMostDrops &&
        inside_gate(static_cast<Index>(k))) {
      loops.push_back(static_cast<Index>(k));
    }
  }
  return loops;
}

template <class Pose>
std::vector<double> Search<Pose>::log_odds() const {
  std::vector<double> odds;
  odds.reserve(states_.size());
  for (std::size_t k = 0; k < states_.size(); ++k) {
    odds.push_back(log_odds(static_cast<Index>(k), states_[k].evidence));
  }
  return odds;
}

template <class Pose>
typename Search<Pose>::Batch Search<Pose>::next_batch() const {
  const Selection eligible = in_question();
  const auto odds = log_odds();
  const auto passing = [&](double least) {
    Selection loops;
    std::ranges::copy_if(eligible, std::back_inserter(loops),
                         [&](Index k) { return states_[k].connected && odds[k] > least; });
    return most_certain_third(std::move(loops), odds, options_.significance);
  };
  Batch batch{"evidence", passing(required_odds_)};
  if (batch.loops.empty()) {
    batch = {"cluster",
             strongest_clusters(support_, eligible, odds, alike_fraction_, required_odds_)};
  }
  if (!batch.loops.empty() || !take_likely_) return batch;
  batch = {"prior", passing(0.0)};
  if (batch.loops.empty()) batch = {"span", bridges(eligible, odds)};
  return batch;
}

// Short loops between parts that nothing joins: broken odometry. They have no evidence
// but their span. What is said of a longer one, as between robots, would be a guess.
template <class Pose>
typename Search<Pose>::Selection Search<Pose>::bridges(const Selection& eligible,
                                                       const std::vector<double>& odds) const {
  const double least = log_odds_of(kBridgeProbability);
  Selection loops;
  std::ranges::copy_if(eligible, std::back_inserter(loops), [&](Index k) {
    return !states_[k].connected && span(k) <= options_.window && odds[k] > least;
  });
  return most_certain_third(std::move(loops), odds, options_.significance);
}

template <class Pose>
void Search<Pose>::accept(const Batch& batch) {
  const int round = static_cast<int>(rounds_.size()) + 1;
  for (const Index k : batch.loops) {
    accepted_[k] = true;
    const auto& link = graph_.loops[k];
    auto& state = states_[k];
    state.round = round;
    state.covariance =
        sharpened(link, estimate_.residual(link), state.covariance, calibration_.scale().loops);
    state.fit_known = true;
  }
  ConsensusRound summary;
  summary.accepted = static_cast<std::int64_t>(batch.loops.size());
  summary.in_force = accepted_count();
  summary.rule = batch.rule;
  rounds_.push_back(summary);
}

// Between the steps of a round, so that a stop is heeded soon.
template <class Pose>
void Search<Pose>::tell_progress() const {
  if (!options_.progress) return;
  const auto done = static_cast<std::uint64_t>(accepted_count());
  if (!options_.progress({"consensus", done, states_.size()})) throw Cancelled();
}

// Loops that are refuted count as false.
template <class Pose>
void Search<Pose>::learn_from_decided() {
  std::vector<PriorBySpan::Decision> decided;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const auto loop = static_cast<Index>(k);
    if (accepted_[k] || refuted(loop)) decided.push_back({span(loop), accepted_[k]});
  }
  prior_ = PriorBySpan(decided);

  // A Beta posterior from the pairs of which both are refuted.
  const auto both_refuted = [this](const Support& pair) {
    return refuted(pair.first) && refuted(pair.second);
  };
  const auto alike = static_cast<double>(std::ranges::count_if(support_.agreeing, both_refuted));
  const auto unlike =
      static_cast<double>(std::ranges::count_if(support_.contradicting, both_refuted));
  alike_fraction_ = (alike + 1.0) / (alike + unlike + 5.0);
}

template <class Pose>
Index Search<Pose>::span(Index loop) const {
  const auto& link = graph_.loops[loop];
  return std::abs(graph_.vertex[link.a] - graph_.vertex[link.b]);
}

template <class Pose>
double Search<Pose>::log_odds(Index loop, const Evidence& evidence) const {
  return evidence.log_ratio + prior_.log_odds(span(loop));
}

template <class Pose>
bool Search<Pose>::calibrate() {
  std::vector<double> probability = log_odds();
  for (double& p : probability) p = 1.0 / (1.0 + std::exp(-p));
  const bool changed = calibration_.learn_from_accepted(estimate_, accepted_, probability);
  if (changed) judge_anew();
  return changed;
}

// At new scales every old judgement is void.
template <class Pose>
void Search<Pose>::judge_anew() {
  for (auto& state : states_) state.drops = 0;
  forget_bounds();
  support_ = mutual_support(graph_, near_pairs_, map_, calibration_.scale(), gate_);
}

template <class Pose>
void Search<Pose>::report(ConsensusResult& result) const {
  result.rounds = rounds_;
  result.inlier_fraction = prior_.fraction();
  result.odometry_scale = calibration_.scale().odometry;
  result.loop_scale = calibration_.scale().loops;
  result.settled = settled_;
  result.details.resize(states_.size());
  std::vector<bool> pruned(states_.size(), false);
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const auto& state = states_[k];
    auto& verdict = result.verdicts[k];
    verdict.score = state.evidence.chi2;
    verdict.threshold = accepted_[k] ? drop_gate() : gate_;
    if (accepted_[k]) {
      verdict.stage = "round " + std::to_string(state.round);
    } else if (refuted(static_cast<Index>(k))) {
      pruned[k] = true;
      verdict.verdict = Verdict::prune;
      verdict.stage = "refuted";
    } else {
      verdict.verdict = Verdict::ambiguous;
      verdict.stage = state.connected ? "unproven" : "unconnected";
    }
    auto& info = result.details[k];
    info.chi2 = state.evidence.chi2;
    info.evidence = state.evidence.log_ratio;
    info.round = state.round;
    info.connected = state.connected;
  }
  auto conflicts = name_conflicts(graph_, map_, calibration_.scale(), gate_, accepted_, pruned);
  for (std::size_t k = 0; k < states_.size(); ++k) {
    result.details[k].conflicts = std::move(conflicts[k]);
  }
}

template class Search<Pose2>;
template class Search<Pose3>;

}  // namespace isotherm::slam::detail
