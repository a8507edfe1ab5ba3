#include "prune/consensus/climb/assessment.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "isotherm/base/parallel.hpp"
#include "isotherm/base/random.hpp"
#include "prune/consensus/constants.hpp"
#include "prune/consensus/log_odds.hpp"
#include "prune/consensus/objective/run_density.hpp"
#include "prune/consensus/runs/false_loops.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr int kMostSteps = 12;   // of Gauss-Newton, weights included
constexpr int kMostBiases = 12;  // of odometry, one after the other
constexpr int kFixedPointSteps = 30;

// Maps on which near pairs are counted.
constexpr std::size_t kMaps = 4;

// Covariances, in times of a factorisation (measured).
constexpr double kCovarianceWork = 2.0;

// Times as many accepted loops, a few more aside, until the density of near pairs is found anew.
constexpr double kOtherMap = 1.1;
constexpr std::size_t kFewMore = 5;

bool is_much_more(std::size_t many, std::size_t few) {
  return static_cast<double>(many) > kOtherMap * static_cast<double>(few + kFewMore);
}

}  // namespace

template <class Pose>
Assessment<Pose>::Assessment(const Objective<Pose>& objective, Pace pace, int threads)
    : objective_(objective),
      pace_(std::move(pace)),
      threads_(threads),
      found_{.graph = std::make_shared<ScaledGraph<Pose>>(objective.stated())},
      estimate_(found_.graph->reduced, pace_),
      odometry_(estimate_.layout()) {
  found_.covariances.assign(graph().loops.size(), Matrix::Zero());
  found_.shifts.assign(graph().loops.size(), Tangent::Zero());
}

template <class Pose>
void Assessment<Pose>::start_over() {
  estimate_.restore(odometry_);
  found_.held.clear();
  found_.shifts.assign(graph().loops.size(), Tangent::Zero());
  found_.near_of.reset();
}

template <class Pose>
void Assessment<Pose>::restore(const Explanation<Pose>& before, Findings found) {
  found_ = std::move(found);
  estimate_.use(found_.graph->reduced);
  estimate_.restore(before.layout);
}

template <class Pose>
bool Assessment<Pose>::assess(Explanation<Pose>& now, double least) {
  now.shapes.slip_scale = any_slips(now.shapes.slips) ? now.scale.odometry : 1.0;
  rescale(now.shapes);
  found_.mixture = now.mixture();
  find_peak(now);
  return weigh_peak(now, least);
}

template <class Pose>
bool Assessment<Pose>::assess_on_another_map(Explanation<Pose>& now, double least) {
  estimate_.weigh_loops(accepted_information(now));
  estimate_.lay_out_anew(now.accepted, now.scale);
  find_peak(now);
  return estimate_.differs_from(now.layout, now.scale) && weigh_peak(now, least);
}

template <class Pose>
bool Assessment<Pose>::weigh_peak(Explanation<Pose>& now, double least) {
  find_nearness(now);
  follow_runs(now);
  const double fit = objective_.fit(now, *found_.graph, estimate_, found_.near) +
                     bias_->log_evidence() + found_.false_loops.log_evidence;
  // The more redundancy there is, the narrower is the peak of the scales.
  now.redundancy = {};
  if (fit + objective_.log_scale_peak(now) < least) return false;
  std::vector<Index> bounded = predict(now);
  find_redundancy(now);
  now.layout = estimate_.layout();
  if (pace_) pace_(kCovarianceWork * estimate_.work());
  now.evidence = fit + objective_.log_scale_peak(now);
  if (now.evidence < least) return false;
  weigh(now, predict_others(now, std::move(bounded)));
  return true;
}

// What each loop of a run is likely to measure by the one before, and what that says of false ones.
template <class Pose>
void Assessment<Pose>::follow_runs(const Explanation<Pose>& now) {
  const auto& runs = objective_.runs();
  found_.run_density = run_density(runs, graph(), objective_.stated().reduced, now.scale,
                                   found_.mixture, now.accepted, threads_);
  std::vector<double> log_led(now.accepted.size());
  for (std::size_t k = 0; k < log_led.size(); ++k) {
    const double by_chance = log_alternative(static_cast<Index>(k));
    log_led[k] = found_.run_density[k] - std::max(objective_.log_mean_around(), by_chance);
  }
  found_.false_loops = false_loops(runs, now.accepted, log_led, found_.log_place);
}

template <class Pose>
void Assessment<Pose>::find_nearness(const Explanation<Pose>& now) {
  nearness_found_.assessments += 1.0;
  const std::size_t accepted = now.accepted_count();
  const auto before = found_.near_of;
  const bool same = before && !is_much_more(accepted, *before) && !is_much_more(*before, accepted);
  if (nearness_held_ && same) return find_places(now, {estimate_.poses()});
  const auto maps = drawn_maps(now.scale);
  found_.near = objective_.near(maps);
  found_.near_of = accepted;
  find_places(now, maps);
  nearness_found_.times += 1.0;
  if (pace_) pace_(NearnessFound::kWork);
}

// Of the same maps as what is near by chance. Parts that nothing joins lie anywhere.
template <class Pose>
void Assessment<Pose>::find_places(const Explanation<Pose>& now,
                                   const std::vector<std::vector<Pose>>& maps) {
  found_.log_place.assign(now.accepted.size(), 0.0);
  parallel_for_each(found_.log_place.size(), threads_, [&](std::size_t k) {
    const auto [first, second] = estimate_.parts(graph().loops[k]);
    if (first != second) return;
    found_.log_place[k] =
        objective_.log_place(now, *found_.graph, static_cast<Index>(k), maps, found_.near);
  });
}

template <class Pose>
std::vector<std::vector<Pose>> Assessment<Pose>::drawn_maps(const CovarianceScale& scale) const {
  const Eigen::MatrixXd drawn = estimate_.drawn(scale, kMaps);
  std::vector<std::vector<Pose>> maps;
  Random random(kMaps);  // others than the seeds of those
  for (const auto& moves : drawn.colwise()) {
    const auto deviations = random.normal_vector<TurnBias<Pose>>();
    maps.push_back(estimate_.moved(moves + bias_->moves(bias_->drawn(deviations))));
  }
  return maps;
}

template <class Pose>
void Assessment<Pose>::rescale(const Shapes<Pose>& shapes) {
  if (shapes == found_.shapes) return;
  found_.graph = std::make_shared<ScaledGraph<Pose>>(objective_.scaled(shapes));
  found_.shapes = shapes;
  estimate_.use(found_.graph->reduced);
  found_.held.clear();
}

// Until another bias is not worth mentioning, since odometry is contracted anew for it.
template <class Pose>
void Assessment<Pose>::find_peak(Explanation<Pose>& now) {
  for (int step = 0; step < kMostBiases; ++step) {
    settle(now);
    bias_.emplace(estimate_, graph(), objective_.bias_prior(now, *found_.graph),
                  now.scale.odometry);
    if (bias_->gain() < kBetter || step + 1 == kMostBiases) return;
    turn_by(bias_->likeliest(), now);
  }
}

// With the poses that follow it, and what was found of the loops.
template <class Pose>
void Assessment<Pose>::turn_by(const TurnBias<Pose>& bias, Explanation<Pose>& now) {
  estimate_.follow(bias_->moves(bias - now.shapes.bias));
  now.shapes.bias = bias;
  auto held = std::move(found_.held);
  rescale(now.shapes);
  found_.held = std::move(held);
}

template <class Pose>
void Assessment<Pose>::settle(Explanation<Pose>& now) {
  weigh_new(now);
  estimate_.weigh_loops(accepted_information(now));
  bool believed = false;
  estimate_.settle(now.accepted, now.scale, kMostSteps,
                   [&] { return reweigh(now, !std::exchange(believed, true)); });
}

// Loops accepted since the last assessment, by what the others said of them.
template <class Pose>
void Assessment<Pose>::weigh_new(Explanation<Pose>& now) {
  for (std::size_t k = 0; k < now.accepted.size(); ++k) {
    if (!now.accepted[k] || found_.held.empty() || !found_.held[k].isZero(0.0)) continue;
    const auto loop = static_cast<Index>(k);
    now.weights[k] = loop_gain<Pose>(belief(loop), own_error(loop), found_.mixture).weight;
  }
}

// Zero of the others.
template <class Pose>
std::vector<typename Pose::Matrix> Assessment<Pose>::accepted_information(
    const Explanation<Pose>& now) const {
  std::vector<Matrix> all(now.accepted.size(), Matrix::Zero());
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (now.accepted[k]) all[k] = information(now, static_cast<Index>(k));
  }
  return all;
}

// Whether weights changed, by so much as matters or `anyway`. Else all stay those that the factor
// was formed with, and what was found with them: of other weights the evidence would be off by
// their change times the squared error, and so it is by the square of the change.
template <class Pose>
bool Assessment<Pose>::reweigh(Explanation<Pose>& now, bool anyway) {
  double change = 0.0;
  double count = 0.0;
  std::vector<LoopWeight> weights = now.weights;
  ScaleShares found;
  double evidence = 0.0;
  const ScaleMixture& mixture = found_.mixture;
  for (std::size_t k = 0; k < now.accepted.size(); ++k) {
    if (!now.accepted[k]) continue;
    const ErrorScale scale = error_scale(mixture, misfit(now, static_cast<Index>(k)));
    const double step = std::log(mixture.factor(scale.weight) / mixture.factor(now.weights[k]));
    change += step * step;
    count += 1.0;
    weights[k] = scale.weight;
    evidence += scale.evidence;
    found.add(scale);
  }
  if (!anyway && change <= kSameWeight * kSameWeight * count) return false;
  now.weights = std::move(weights);
  now.found = found;
  now.scale_evidence = evidence;
  estimate_.weigh_loops(accepted_information(now));
  return change > 0.0;
}

template <class Pose>
Misfit Assessment<Pose>::misfit(const Explanation<Pose>& now, Index loop) const {
  const auto& link = graph().loops[loop];
  const typename Pose::Tangent r = estimate_.residual(link);
  const Matrix expected = r * r.transpose() + uncertainty(now, loop);
  return {
      .chi2 = link.information.cwiseProduct(expected).sum() / now.scale.loops,
      .stated = objective_.stated().reduced.loops[loop].information.cwiseProduct(expected).sum(),
      .dof = Pose::kDof,
      .log_stated = -Pose::kDof * std::log(now.scale.loops)};
}

// The covariance of a loop's residual, by that with the information it was held with (0 where it
// is new). It is Omega^-1 where nothing else is known, and more nowhere.
template <class Pose>
typename Pose::Matrix Assessment<Pose>::uncertainty(const Explanation<Pose>& now,
                                                    Index loop) const {
  const Matrix& P = found_.covariances[loop];
  const Matrix Omega = information(now, loop);
  const Matrix more = found_.held.empty() ? Omega : Matrix(Omega - found_.held[loop]);
  const Matrix left =
      more.isZero(0.0) ? P : Matrix((Matrix::Identity() + P * more).partialPivLu().solve(P));
  const double share = Omega.cwiseProduct(left).sum();
  return share >= 0.0 && share <= Pose::kDof ? left : Matrix(Omega.inverse());
}

// Covariances of odometry's steps and of the accepted loops, which tell how accurate both are, and
// bounds of the others' whose ends are joined, which it returns. Where nothing is accepted and
// odometry is chains alone they have been composed already.
template <class Pose>
std::vector<Index> Assessment<Pose>::predict(Explanation<Pose>& now) {
  const bool alone = now.accepted_count() == 0 && found_.graph->is_chains();
  now.standings.resize(now.accepted.size());
  std::vector<Index> bounded;
  std::vector<Index> accepted;
  std::vector<Index> composed;
  for (Index loop = 0; loop < static_cast<Index>(now.accepted.size()); ++loop) {
    const auto [first, second] = estimate_.parts(graph().loops[loop]);
    auto& joined = now.accepted[loop] ? accepted : bounded;
    (alone || first != second ? composed : joined).push_back(loop);
  }
  parallel_for_each(composed.size(), threads_, [&](std::size_t i) {
    believe(composed[i], odometry_says(composed[i], now.scale.odometry));
  });
  found_.steps = nullptr;
  now.odometry_cost.setZero();
  if (!alone) solve(now, accepted, bounded);
  found_.held = accepted_information(now);
  return bounded;
}

// Of the loops that are bounded those that are not refuted however their ends are correlated; one
// flag a loop that is.
template <class Pose>
std::vector<char> Assessment<Pose>::predict_others(Explanation<Pose>& now,
                                                   std::vector<Index> bounded) {
  std::vector<char> refuted(now.accepted.size(), 0);
  parallel_for_each(bounded.size(), threads_,
                    [&](std::size_t i) { refuted[bounded[i]] = refute(now, bounded[i]) ? 1 : 0; });
  std::erase_if(bounded, [&](Index loop) { return refuted[loop] != 0; });
  const auto covariances = estimate_.residual_covariances(links_of(bounded), threads_);
  for (std::size_t i = 0; i < bounded.size(); ++i) believe(bounded[i], covariances[i]);
  return refuted;
}

// If it can be, by itself: what of a run is likely the others tell. Of a smaller covariance a
// density may be higher by the ratio of the volumes at most.
template <class Pose>
bool Assessment<Pose>::refute(Explanation<Pose>& now, Index loop) const {
  if (!objective_.runs().by_itself(loop)) return false;
  Standing standing = other_standing(now, loop);
  const auto most = detail::predict<Pose>(belief(loop), own_error(loop).learnt);
  standing.evidence += 0.5 * (most.variance.array() / found_.mixture.scale).log1p().sum();
  if (standing.evidence >= -kNoDigit) return false;
  now.standings[loop] = standing;
  return true;
}

template <class Pose>
typename Estimate<Pose>::Links Assessment<Pose>::links_of(const std::vector<Index>& loops) const {
  typename Estimate<Pose>::Links links;
  for (const Index k : loops) links.push_back(&graph().loops[k]);
  return links;
}

// By the covariance of its residual where odometry's bias is known.
template <class Pose>
void Assessment<Pose>::believe(Index loop, const Matrix& covariance) {
  const auto more = bias_->of_loop(graph().loops[loop]);
  found_.covariances[loop] = covariance + more.P;
  found_.shifts[loop] = more.r;
}

// The covariance of a loop's residual where nothing but odometry is known, and its bias.
template <class Pose>
typename Pose::Matrix Assessment<Pose>::odometry_says(Index loop, double scale) const {
  const auto J = residual_jacobian<Pose>(estimate_.residual(graph().loops[loop]));
  return scale * J * graph().odometry_covariance(graph().loops[loop]) * J.transpose();
}

// Those of these loops, bounds, and what odometry tells of its accuracy.
template <class Pose>
void Assessment<Pose>::solve(Explanation<Pose>& now, const std::vector<Index>& accepted,
                             const std::vector<Index>& bounded) {
  auto links = links_of(accepted);
  for (const auto& step : graph().steps) links.push_back(&step);
  const auto covariances = estimate_.residual_covariances(links, threads_, links_of(bounded));
  for (std::size_t i = 0; i < accepted.size(); ++i) believe(accepted[i], covariances[i]);
  for (std::size_t i = 0; i < bounded.size(); ++i) {
    believe(bounded[i], covariances[links.size() + i]);
  }
  auto steps = std::make_shared<std::vector<Belief<Pose>>>(graph().steps.size());
  parallel_for_each(steps->size(), threads_, [&](std::size_t k) {
    const auto more = bias_->of_step(k);
    (*steps)[k] = {estimate_.residual(graph().steps[k]) + more.r,
                   covariances[accepted.size() + k] + more.P};
  });
  const auto told = objective_.odometry(now, *found_.graph, *steps, threads_);
  found_.steps = std::move(steps);
  now.odometry_cost = told.cost;
  now.redundancy.odometry = told.redundancy;
}

template <class Pose>
std::vector<SlipChange> Assessment<Pose>::slip_changes(const Explanation<Pose>& now) const {
  if (!found_.steps) return {};
  return objective_.slip_changes(now, *found_.graph, *found_.steps, threads_);
}

template <class Pose>
void Assessment<Pose>::weigh(Explanation<Pose>& now, const std::vector<char>& refuted) {
  parallel_for_each(now.accepted.size(), threads_, [&](std::size_t k) {
    const auto loop = static_cast<Index>(k);
    if (refuted[k] != 0) return;
    now.standings[k] = now.accepted[k] ? accepted_standing(now, loop) : other_standing(now, loop);
  });
  add_prior(now);
}

template <class Pose>
typename Pose::Tangent Assessment<Pose>::redundancy(const Explanation<Pose>& now,
                                                    Index loop) const {
  const Matrix fitted = information(now, loop) * found_.covariances[loop];
  return (1.0 - fitted.diagonal().array()).max(0.0);
}

template <class Pose>
void Assessment<Pose>::find_redundancy(Explanation<Pose>& now) const {
  now.redundancy.loops.setZero();
  for (std::size_t k = 0; k < now.accepted.size(); ++k) {
    if (!now.accepted[k] || graph().loops[k].a == graph().loops[k].b) continue;
    now.redundancy.loops += (1.0 - now.weights[k].stated) * redundancy(now, static_cast<Index>(k));
  }
}

// Given all loops but itself, in what is known of the accuracy of odometry, too.
template <class Pose>
Standing Assessment<Pose>::accepted_standing(const Explanation<Pose>& now, Index loop) const {
  const auto all = belief(loop);
  const auto others = without(all, information(now, loop));
  const typename Pose::Tangent own = redundancy(now, loop);
  const double learnt = 1.0 - now.weights[loop].stated;
  const Redundancy<Pose> told{
      .odometry = (now.redundancy.odometry.array() - (1.0 - own.array())).max(0.0),
      .loops = (now.redundancy.loops - learnt * own).cwiseMax(0.0)};
  const auto gain = loop_gain(others, own_error(loop), found_.mixture, scale_deviation(told));
  // Alone it would join parts that lie anywhere on the map.
  const double density = std::max(gain.log_density, -objective_.log_volume() - 0.5 * gain.chi2);
  const double nearer = objective_.log_nearer(loop, all.r);
  return {
      .chi2 = gain.chi2,
      .evidence = density + nearer - log_alternative(loop) -
                  log_alone(objective_.log_place(now, *found_.graph, loop, others, found_.near)),
      .weight = gain.weight};
}

template <class Pose>
Standing Assessment<Pose>::other_standing(const Explanation<Pose>& now, Index loop) const {
  const auto& link = graph().loops[loop];
  Standing standing{.parts = estimate_.parts(link)};
  double density = -objective_.log_volume();
  if (standing.connected()) {
    const auto others = belief(loop);
    const auto gain =
        loop_gain(others, own_error(loop), found_.mixture, scale_deviation(now.redundancy));
    const Matrix Omega = objective_.information(now, *found_.graph, loop, gain.weight);
    standing.chi2 = gain.chi2;
    density = gain.log_density + objective_.log_nearer(loop, residual_with(others, Omega));
  }
  standing.evidence = density - log_alternative(loop) - log_alone(found_.log_place[loop]);
  return standing;
}

// By how labels follow each other, as expected.
template <class Pose>
void Assessment<Pose>::add_prior(Explanation<Pose>& now) const {
  auto& standings = now.standings;
  std::vector<double> is_true(standings.size(), 1.0);
  now.labels = {};
  for (int step = 0; step < kFixedPointSteps; ++step) {
    for (std::size_t k = 0; k < standings.size(); ++k) {
      const auto loop = static_cast<Index>(k);
      standings[k].log_odds = standings[k].evidence + log_prior_odds(now, std::span(&loop, 1));
      if (!now.accepted[k]) is_true[k] = probability_of(standings[k].log_odds);
    }
    now.labels = objective_.runs().labels(is_true);
  }
}

template <class Pose>
double Assessment<Pose>::log_prior_odds(const Explanation<Pose>& now,
                                        std::span<const Index> loops) const {
  const auto& runs = objective_.runs();
  const auto is_one = [&loops](Index k) { return std::ranges::binary_search(loops, k); };
  const auto next_odds = [&](bool before_if_true, bool if_true, bool before, bool is) {
    return now.labels.log_next(before_if_true, if_true) - now.labels.log_next(before, is);
  };
  double odds = 0.0;
  for (const Index k : loops) {
    const Index leader = runs.leader(k);
    if (leader == Runs<Pose>::kNone) {
      odds += now.labels.log_odds(runs.alone(k));
    } else if (is_one(leader)) {
      odds += next_odds(true, true, false, false);
    } else {
      odds += next_odds(now.accepted[leader], true, now.accepted[leader], false);
    }
    for (const Index next : runs.followers(k)) {
      if (!is_one(next)) odds += next_odds(true, now.accepted[next], false, now.accepted[next]);
    }
  }
  return odds;
}

template <class Pose>
double Assessment<Pose>::log_false_run(std::span<const Index> loops) const {
  const auto& follows = found_.false_loops.log_follows;
  double sum = 0.0;
  for (const Index k : loops) {
    sum += follows[k];
    for (const Index next : objective_.runs().followers(k)) {
      if (!std::ranges::binary_search(loops, next)) sum += follows[next];
    }
  }
  return sum;
}

template class Assessment<Pose2>;
template class Assessment<Pose3>;

}  // namespace isotherm::slam::detail
