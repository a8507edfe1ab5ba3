#include "search.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "conflicts.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/statistics.hpp"

namespace isotherm::slam::detail {
namespace {

using spectral::Verdict;

constexpr int kStepsPerRound = 6;        // of Gauss-Newton
constexpr int kMostDrops = 3;            // a loop dropped so often is not tried again
constexpr int kCalibrations = 6;         // of the covariance scales, on proven loops
constexpr int kLastCalibrations = 2;     // and with the likely ones
constexpr int kMostDoublings = 4;        // of odometry's covariance, where it refutes every loop
constexpr double kLargestRescale = 2.0;  // in one calibration
constexpr double kWorthRescaling = 1.1;

double log_odds_of(double probability) { return std::log(probability / (1.0 - probability)); }

// Index of the set a member belongs to, halving paths on the way.
Index find_set(std::vector<Index>& parent, Index member) {
  while (parent[member] != member) member = parent[member] = parent[parent[member]];
  return member;
}

}  // namespace

template <class Pose>
Search<Pose>::Search(const ReducedGraph<Pose>& graph, const ConsensusOptions& options)
    : graph_(graph),
      options_(options),
      gate_(chi_squared_quantile(1.0 - options.significance, Pose::kDof)),
      required_odds_(log_odds_of(1.0 - options.significance)),
      map_(graph.poses),
      estimate_(graph),
      states_(graph.loops.size()),
      accepted_(graph.loops.size(), false) {
  forget_bounds();
  find_support();
}

template <class Pose>
void Search<Pose>::run(ConsensusResult& result) {
  // The scales are learnt from proven loops first: those that are merely likely are
  // the likelier, the wider the covariances, and would feed back.
  accept_and_calibrate(kCalibrations);
  take_likely_ = true;
  accept_and_calibrate(kLastCalibrations);
  report(result);
}

template <class Pose>
void Search<Pose>::accept_and_calibrate(int most_calibrations) {
  accept_while_possible();
  if (!options_.calibrate) return;
  for (int k = 0; k < kMostDoublings && odometry_refutes_all(); ++k) {
    rescale({2.0 * scale_.odometry, scale_.loops});
    accept_while_possible();
  }
  for (int k = 0; k < most_calibrations && calibrate(); ++k) accept_while_possible();
}

// One statement of accuracy stands against all loops: it is doubted first.
template <class Pose>
bool Search<Pose>::odometry_refutes_all() const {
  for (std::size_t k = 0; k < states_.size(); ++k) {
    if (accepted_[k] || inside_gate(static_cast<Index>(k))) return false;
  }
  return true;
}

template <class Pose>
void Search<Pose>::accept_while_possible() {
  while (true) {
    settle();
    assess();
    learn_fractions();
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
  const char* rule = "evidence";
  Selection batch = certain_singles();
  if (batch.empty()) {
    rule = "cluster";
    batch = strongest_clusters();
  }
  if (batch.empty() && take_likely_) {
    rule = "prior";
    batch = likely_rest();
  }
  if (batch.empty()) return false;
  accept(batch, rule);
  return true;
}

// Bounds hold as long as poses move little. At the end every loop that was refuted
// by a bound is judged afresh; true if that lets one be accepted after all.
template <class Pose>
bool Search<Pose>::readmit() {
  Selection refuted;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    if (!accepted_[k] && states_[k].connected && !inside_gate(static_cast<Index>(k))) {
      refuted.push_back(static_cast<Index>(k));
    }
  }
  weigh_afresh(refuted);
  learn_fractions();
  return accept_next_batch();
}

// Poses that agree with every accepted loop; those that cannot be made to agree
// are dropped, the worst first.
template <class Pose>
void Search<Pose>::settle() {
  do {
    estimate_.update(accepted_, scale_, kStepsPerRound);
  } while (drop_inconsistent());
}

template <class Pose>
bool Search<Pose>::drop_inconsistent() {
  const auto judge = [this](Index loop) {
    auto& state = states_[loop];
    state.evidence.chi2 = fitted_chi2(loop, state.covariance);
    return state.evidence.chi2 <= gate_;
  };
  Selection doubtful;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const auto loop = static_cast<Index>(k);
    if (accepted_[k] && !judge(loop)) doubtful.push_back(loop);
  }
  // An old covariance is an upper bound, and so is the chi-squared it gives.
  const auto covariances = estimate_.relative_covariances(doubtful, options_.threads);
  double worst = 0.0;
  for (std::size_t k = 0; k < doubtful.size(); ++k) {
    states_[doubtful[k]].covariance = covariances[k];
    judge(doubtful[k]);
    worst = std::max(worst, states_[doubtful[k]].evidence.chi2);
  }
  if (worst <= gate_) return false;
  for (const Index k : doubtful) {
    if (states_[k].evidence.chi2 >= std::max(gate_, 0.5 * worst)) drop(k);
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
    states_[k].covariance = graph_.odometry_covariance[k] * scale_.odometry;
  }
}

// Chi-squared of an accepted loop against the prediction of all others: with r the
// fitted residual and P the fitted covariance it is r' (Sigma - P)^-1 r. Along
// directions that only this loop measures, Sigma - P and r both vanish.
template <class Pose>
double Search<Pose>::fitted_chi2(Index loop, const Matrix& covariance) const {
  const auto& link = graph_.loops[loop];
  const Tangent r = estimate_.residual(link);
  const Matrix jacobian = residual_jacobian<Pose>(r);
  const Matrix fitted = jacobian * covariance * jacobian.transpose();
  const Eigen::LLT<Matrix> root(link.covariance * scale_.loops);
  const Tangent whitened = root.matrixL().solve(r);
  const Matrix half = root.matrixL().solve(fitted);
  const Matrix known = root.matrixL().solve(half.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix> redundancy(Matrix::Identity() - known);
  const Tangent along = redundancy.eigenvectors().transpose() * whitened;
  double chi2 = 0.0;
  for (int d = 0; d < Pose::kDof; ++d) {
    const double share = redundancy.eigenvalues()[d];
    if (share > 1e-6) chi2 += along[d] * along[d] / share;
  }
  return chi2;
}

template <class Pose>
Evidence Search<Pose>::weigh_loop(Index loop, const Matrix& covariance) const {
  const auto& link = graph_.loops[loop];
  const Tangent r = estimate_.residual(link);
  const Matrix jacobian = residual_jacobian<Pose>(r);
  const Matrix spread =
      link.covariance * scale_.loops + jacobian * covariance * jacobian.transpose();
  return weigh<Pose>(r, spread, map_);
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
  const auto covariances = estimate_.relative_covariances(loops, options_.threads);
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
    if (!accepted_[k] && state.drops < kMostDrops && inside_gate(static_cast<Index>(k))) {
      loops.push_back(static_cast<Index>(k));
    }
  }
  return loops;
}

template <class Pose>
double Search<Pose>::log_odds(Index loop) const {
  return states_[loop].evidence.log_ratio + prior_log_odds();
}

template <class Pose>
typename Search<Pose>::Selection Search<Pose>::certain_singles() const {
  Selection passing;
  for (const Index k : in_question()) {
    if (states_[k].connected && log_odds(k) >= required_odds_) passing.push_back(k);
  }
  return most_certain_third(std::move(passing));
}

template <class Pose>
typename Search<Pose>::Selection Search<Pose>::likely_rest() const {
  Selection passing;
  for (const Index k : in_question()) {
    if (states_[k].connected && log_odds(k) > 0.0) passing.push_back(k);
  }
  return most_certain_third(std::move(passing));
}

// Every accepted loop sharpens the prediction of the others, so that only the most
// certain third is taken; and with it those that are beyond doubt already, as long
// as the expected number of false ones among them is below the significance.
template <class Pose>
typename Search<Pose>::Selection Search<Pose>::most_certain_third(Selection passing) const {
  std::stable_sort(passing.begin(), passing.end(),
                   [this](Index a, Index b) { return log_odds(a) > log_odds(b); });
  const std::size_t third = (passing.size() + 2) / 3;
  std::size_t size = 0;
  double expected_false = 0.0;
  for (; size < passing.size(); ++size) {
    expected_false += 1.0 / (1.0 + std::exp(log_odds(passing[size])));
    if (size >= third && expected_false > options_.significance) break;
  }
  passing.resize(size);
  return passing;
}

// Groups of loops that confirm each other. The group's score is what the graph
// says about its best member, plus what agreement adds: at most the odds against a
// false loop agreeing with its false neighbour, which is learnt from false loops.
template <class Pose>
typename Search<Pose>::Selection Search<Pose>::strongest_clusters() const {
  const Selection eligible = in_question();
  std::vector<Index> parent(states_.size(), -1);
  std::vector<double> best(states_.size(), 0.0);
  std::vector<double> added(states_.size(), 0.0);
  for (const Index k : eligible) {
    parent[k] = k;
    best[k] = log_odds(k);
  }
  const double cap = -std::log(alike_fraction_);
  for (const auto& link : support_.agreeing) {
    if (parent[link.first] < 0 || parent[link.second] < 0) continue;
    const Index a = find_set(parent, link.first);
    const Index b = find_set(parent, link.second);
    if (a == b || link.gain <= 0.0) continue;
    parent[b] = a;
    best[a] = std::max(best[a], best[b]);
    added[a] += added[b] + std::min(link.gain, cap);
  }
  double strongest = required_odds_;
  for (const Index k : eligible) {
    if (parent[k] == k) strongest = std::max(strongest, best[k] + added[k]);
  }
  Selection chosen;
  for (const Index k : eligible) {
    const Index root = find_set(parent, k);
    const double score = best[root] + added[root];
    if (score >= required_odds_ && score >= 0.7 * strongest) chosen.push_back(k);
  }
  return chosen;
}

template <class Pose>
void Search<Pose>::accept(const Selection& batch, const char* rule) {
  const int round = static_cast<int>(rounds_.size()) + 1;
  for (const Index k : batch) {
    accepted_[k] = true;
    states_[k].round = round;
    // What it adds to its own prediction: C - C (C + Sigma)^-1 C.
    Matrix& covariance = states_[k].covariance;
    const Matrix jacobian = residual_jacobian<Pose>(estimate_.residual(graph_.loops[k]));
    const Matrix sum =
        jacobian * covariance * jacobian.transpose() + graph_.loops[k].covariance * scale_.loops;
    const Matrix across = jacobian * covariance;
    covariance -= across.transpose() * Eigen::LLT<Matrix>(sum).solve(across);
  }
  ConsensusRound summary;
  summary.accepted = static_cast<std::int64_t>(batch.size());
  summary.in_force = std::count(accepted_.begin(), accepted_.end(), true);
  summary.rule = rule;
  rounds_.push_back(summary);
  if (options_.progress) {
    const auto done = static_cast<std::uint64_t>(summary.in_force);
    if (!options_.progress({"consensus", done, states_.size()})) throw Cancelled();
  }
}

// Beta posteriors with uniform priors; loops that are refuted count as false.
template <class Pose>
void Search<Pose>::learn_fractions() {
  double kept = 1.0;
  double refuted = 1.0;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    if (accepted_[k]) {
      kept += 1.0;
    } else if (!inside_gate(static_cast<Index>(k))) {
      refuted += 1.0;
    }
  }
  inlier_fraction_ = kept / (kept + refuted);

  const auto both_refuted = [this](const Support& pair) {
    return !accepted_[pair.first] && !accepted_[pair.second] && !inside_gate(pair.first) &&
           !inside_gate(pair.second);
  };
  const auto alike = static_cast<double>(
      std::count_if(support_.agreeing.begin(), support_.agreeing.end(), both_refuted));
  const auto unlike = static_cast<double>(
      std::count_if(support_.contradicting.begin(), support_.contradicting.end(), both_refuted));
  alike_fraction_ = (alike + 1.0) / (alike + unlike + 5.0);
}

// Variance components (F. Helmert): cost over redundancy, for odometry and for the
// accepted loops, moved towards by a bounded factor.
template <class Pose>
bool Search<Pose>::calibrate() {
  Selection loops;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    if (accepted_[k] && graph_.loops[k].a != graph_.loops[k].b)
      loops.push_back(static_cast<Index>(k));
  }
  const auto covariances = estimate_.relative_covariances(loops, options_.threads);
  double loop_cost = 0.0;
  double loop_redundancy = 0.0;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const auto& link = graph_.loops[loops[k]];
    const Tangent r = estimate_.residual(link);
    const Matrix jacobian = residual_jacobian<Pose>(r);
    loop_cost += r.dot(link.information * r);
    loop_redundancy +=
        Pose::kDof - (link.information * jacobian * covariances[k] * jacobian.transpose()).trace() /
                         scale_.loops;
  }
  const double redundancy =
      Pose::kDof * (static_cast<double>(graph_.steps.size() + loops.size()) -
                    static_cast<double>(graph_.node_count() - estimate_.component_count()));
  const auto moved = [](double present, double cost, double freedom) {
    if (freedom < 1.0) return present;
    return std::max(
        1.0, std::clamp(cost / freedom, present / kLargestRescale, present * kLargestRescale));
  };
  const CovarianceScale next = {
      moved(scale_.odometry, estimate_.odometry_cost(), redundancy - loop_redundancy),
      moved(scale_.loops, loop_cost, loop_redundancy)};
  const double loop_change = std::abs(std::log(next.loops / scale_.loops));
  const double odometry_change = std::abs(std::log(next.odometry / scale_.odometry));
  if (std::max(loop_change, odometry_change) < std::log(kWorthRescaling)) return false;
  rescale(next);
  return true;
}

template <class Pose>
void Search<Pose>::rescale(const CovarianceScale& scale) {
  scale_ = scale;
  for (auto& state : states_) state.drops = 0;
  forget_bounds();
  find_support();
}

template <class Pose>
void Search<Pose>::find_support() {
  support_ = mutual_support(graph_, map_, scale_, options_.window, gate_);
}

template <class Pose>
void Search<Pose>::report(ConsensusResult& result) const {
  result.rounds = rounds_;
  result.inlier_fraction = inlier_fraction_;
  result.odometry_scale = scale_.odometry;
  result.loop_scale = scale_.loops;
  result.settled = settled_;
  result.details.resize(states_.size());
  std::vector<bool> refuted(states_.size(), false);
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const auto& state = states_[k];
    auto& verdict = result.verdicts[k];
    verdict.score = state.evidence.chi2;
    verdict.threshold = gate_;
    if (accepted_[k]) {
      verdict.stage = "round " + std::to_string(state.round);
    } else if (state.evidence.chi2 > gate_) {
      refuted[k] = true;
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
  auto conflicts = name_conflicts(graph_, map_, scale_, gate_, accepted_, refuted);
  for (std::size_t k = 0; k < states_.size(); ++k) {
    result.details[k].conflicts = std::move(conflicts[k]);
  }
}

template class Search<Pose2>;
template class Search<Pose3>;

}  // namespace isotherm::slam::detail
