#include "prune/consensus/judge/judge.hpp"

#include <algorithm>

#include "isotherm/base/statistics.hpp"
#include "prune/consensus/estimate/held_out.hpp"
#include "prune/consensus/estimate/prediction.hpp"

namespace isotherm::slam::detail {
namespace {

// However heavy the tails of real errors, an accepted loop is dropped beyond twice the
// deviations that an average one would need to meet the gate.
constexpr double kMostTailFactor = 4.0;
// Where false loops crowd around the gate, correct ones may be pruned with so many times
// the probability, but at most with this one; so may those in doubt.
constexpr double kCrowded = 25.0;
constexpr double kMostLost = 0.01;

double lost_where_crowded(double significance) {
  return std::max(significance, std::min(kCrowded * significance, kMostLost));
}

}  // namespace

template <class Pose>
Judge<Pose>::Judge(const ReducedGraph<Pose>& graph, const Estimate<Pose>& estimate,
                   const Calibration<Pose>& calibration, const MapVolume<Pose>& map,
                   const std::vector<bool>& accepted, double significance)
    : graph_(graph),
      estimate_(estimate),
      calibration_(calibration),
      map_(map),
      accepted_(accepted),
      significance_(significance),
      widest_gate_(chi_squared_quantile(1.0 - significance, Pose::kDof)),
      narrowest_refuting_gate_(
          chi_squared_quantile(1.0 - lost_where_crowded(significance), Pose::kDof)),
      doubtful_share_(chi_squared_quantile(1.0 - std::max(significance, kMostLost), Pose::kDof) /
                      widest_gate_),
      doubtful_(graph.loops.size(), false),
      tail_{widest_gate_, kMostTailFactor},
      standings_(graph.loops.size()) {
  gates_.fill(widest_gate_);
}

template <class Pose>
double Judge<Pose>::tail_factor() const {
  return std::min(tail_.factor, kMostTailFactor);
}

template <class Pose>
bool Judge<Pose>::crowded() const {
  return std::ranges::any_of(gates_, [this](double gate) { return gate < widest_gate_; });
}

template <class Pose>
double Judge<Pose>::refuting_gate(Index loop) const {
  if (doubtful_[loop]) return doubtful_share_ * widest_gate_;
  if (gate(loop) < widest_gate_) return std::max(gate(loop), narrowest_refuting_gate_);
  return suspicious_ && evidence(loop).log_ratio < 0.0 ? narrowest_refuting_gate_ : widest_gate_;
}

template <class Pose>
double Judge<Pose>::tail_gate() const {
  return widest_gate_ * tail_factor() * calibration_.loop_level();
}

template <class Pose>
double Judge<Pose>::drop_gate(Index loop) const {
  const double all = std::max(gate(loop), tail_gate());
  return doubtful_[loop] ? doubtful_share_ * all : all;
}

template <class Pose>
void Judge<Pose>::doubt(const Selection& loops) {
  for (const Index k : loops) doubtful_[k] = true;
}

template <class Pose>
double Judge<Pose>::log_odds(Index loop, const Evidence& evidence) const {
  return evidence.log_ratio + prior_.log_odds(graph_.span(loop));
}

template <class Pose>
std::vector<double> Judge<Pose>::log_odds() const {
  std::vector<double> odds;
  odds.reserve(standings_.size());
  for (std::size_t k = 0; k < standings_.size(); ++k) {
    odds.push_back(log_odds(static_cast<Index>(k), standings_[k].evidence));
  }
  return odds;
}

// Accepting loops only ever sharpens predictions, so that an old covariance is an
// upper bound and its chi-squared a lower one: loops that fail even so are not
// solved for again.
template <class Pose>
void Judge<Pose>::assess() {
  Selection unclear;
  for (std::size_t k = 0; k < standings_.size(); ++k) {
    if (accepted_[k]) continue;
    const auto loop = static_cast<Index>(k);
    auto& standing = standings_[k];
    standing.connected = estimate_.connected(graph_.loops[k]);
    standing.evidence = standing.connected ? weigh(loop) : Evidence();
    if (standing.connected && !refuted(loop)) unclear.push_back(loop);
  }
  weigh_afresh(unclear);
}

template <class Pose>
void Judge<Pose>::weigh_afresh(const Selection& loops) {
  const auto covariances = estimate_.relative_covariances(loops);
  for (std::size_t k = 0; k < loops.size(); ++k) {
    auto& standing = standings_[loops[k]];
    standing.covariance = covariances[k];
    standing.evidence = weigh(loops[k]);
  }
}

template <class Pose>
Evidence Judge<Pose>::weigh(Index loop) const {
  const auto& link = graph_.loops[loop];
  return weigh_prediction(link, estimate_.residual(link), standings_[loop].covariance,
                          calibration_.scale().loops, map_);
}

template <class Pose>
typename Judge<Pose>::Selection Judge<Pose>::inconsistent() {
  const auto gates_before = gates_;
  const double tail_before = tail_gate();
  Selection doubtful = misfits();
  learn_tail();
  learn_gate();
  if (tail_gate() < tail_before || gates_ != gates_before) doubtful = misfits();
  double worst = 0.0;
  for (const Index k : doubtful) worst = std::max(worst, evidence(k).chi2);
  std::erase_if(doubtful, [&](Index k) { return evidence(k).chi2 < 0.5 * worst; });
  return doubtful;
}

// The accepted loops beyond the gate.
template <class Pose>
typename Judge<Pose>::Selection Judge<Pose>::misfits() {
  const auto fits = [&](Index loop) {
    auto& standing = standings_[loop];
    const auto& link = graph_.loops[loop];
    standing.evidence.chi2 = fitted_chi2(link, estimate_.residual(link), standing.covariance,
                                         calibration_.scale().loops);
    return standing.evidence.chi2 <= drop_gate(loop);
  };
  // An old covariance is an upper bound, and so is the chi-squared it gives.
  Selection doubtful;
  for (std::size_t k = 0; k < standings_.size(); ++k) {
    const auto loop = static_cast<Index>(k);
    if (accepted_[k] && (!standings_[k].fit_known || !fits(loop))) doubtful.push_back(loop);
  }
  const auto covariances = estimate_.relative_covariances(doubtful);
  for (std::size_t k = 0; k < doubtful.size(); ++k) {
    standings_[doubtful[k]].covariance = covariances[k];
    standings_[doubtful[k]].fit_known = true;
  }
  std::erase_if(doubtful, fits);
  return doubtful;
}

template <class Pose>
void Judge<Pose>::learn_tail() {
  std::vector<double> chi2;
  for (std::size_t k = 0; k < standings_.size(); ++k) {
    if (accepted_[k]) chi2.push_back(standings_[k].evidence.chi2);
  }
  tail_ = chi2.empty() ? Tail{widest_gate_, kMostTailFactor}
                       : student_tail(chi2, Pose::kDof, significance_);
}

template <class Pose>
void Judge<Pose>::learn_gate() {
  gates_.fill(widest_gate_);
  // Only there do the correct loops end well before the gate.
  if (!calibration_.overstated()) return;
  std::vector<SpannedChi2> loops;
  for (std::size_t k = 0; k < standings_.size(); ++k) {
    const auto& [connected, covariance, fit_known, evidence] = standings_[k];
    if (connected) loops.push_back({graph_.span(static_cast<Index>(k)), evidence.chi2});
  }
  gates_ = crowded_gate(loops, widest_gate_);
}

template <class Pose>
typename Judge<Pose>::Selection Judge<Pose>::held_by_themselves(double required_odds) const {
  Selection suspects;
  for (const auto& [loop, evidence] :
       held_out(graph_, estimate_, accepted_, calibration_.scale().loops, map_)) {
    if (log_odds(loop, evidence) < required_odds) suspects.push_back(loop);
  }
  return suspects;
}

template <class Pose>
void Judge<Pose>::sharpen(Index loop) {
  const auto& link = graph_.loops[loop];
  auto& standing = standings_[loop];
  standing.covariance =
      sharpened(link, estimate_.residual(link), standing.covariance, calibration_.scale().loops);
  standing.fit_known = true;
}

template <class Pose>
void Judge<Pose>::forget_bounds() {
  for (std::size_t k = 0; k < standings_.size(); ++k) {
    standings_[k].covariance = graph_.odometry_covariance[k] * calibration_.scale().odometry;
    standings_[k].fit_known = false;
  }
}

template <class Pose>
void Judge<Pose>::learn_prior() {
  std::vector<PriorBySpan::Decision> decided;
  for (std::size_t k = 0; k < standings_.size(); ++k) {
    const auto loop = static_cast<Index>(k);
    if (accepted_[k] || refuted(loop)) decided.push_back({graph_.span(loop), accepted_[k]});
  }
  prior_ = PriorBySpan(decided);
}

template class Judge<Pose2>;
template class Judge<Pose3>;

}  // namespace isotherm::slam::detail
