#include "isotherm/network/localize/localize.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/base/statistics.hpp"
#include "localize/constants.hpp"
#include "localize/firm/firmness.hpp"
#include "localize/problem/range_problem.hpp"
#include "localize/problem/repeats.hpp"
#include "localize/refine/determinacy.hpp"
#include "localize/refine/range_information.hpp"
#include "localize/refine/robust_refine.hpp"
#include "localize/refine/weigh_ranges.hpp"
#include "localize/start/search.hpp"

namespace isotherm::network {
namespace {

using detail::Placement;
using detail::RangeCheck;
using detail::RangeProblem;
using spectral::EdgeVerdict;
using spectral::Verdict;

class Localization {
 public:
  Localization(const RangeNetwork& network, const LocalizeOptions& options)
      : options_(options),
        problem_(detail::make_problem(network)),
        placement_(detail::anchors_only(network, problem_)),
        anchors_(placement_),
        gate_(chi_squared_quantile(1.0 - options.significance, 1)) {}

  LocalizeResult run() {
    trusted_ = detail::likely_pairs(problem_, options_.heat_chance, options_);
    placement_ = detail::search_map(task(), anchors_);
    if (options_.method == LocalizeMethod::robust) {
      use_ = detail::ranges_within(problem_, placement_, gate_);
      decide();
      whole_ = judged_;
      leave_out_undetermined();
    } else {
      use_ = detail::ranges_within(problem_, placement_, std::numeric_limits<double>::infinity());
      fit();
    }
    judge();
    explain_the_rest();
    return finish();
  }

 private:
  detail::MapTask task() const { return {problem_, trusted_, gate_, options_}; }

  // Beyond a millionth of chi-squared it is only single nodes that creep along the arcs of very
  // short ranges.
  void fit() {
    constexpr double kStill = 1e-6;
    const auto outcome = detail::refine(problem_, use_, placement_,
                                        {.max_iterations = options_.max_iterations,
                                         .still = kStill,
                                         .progress = options_.progress});
    result_.iterations += outcome.iterations;
    converged_ = outcome.converged;
  }

  // Places by what all ranges are, and by turns how accurate these are.
  void decide() {
    constexpr int kMostRounds = 10;
    for (int round = 0; round < kMostRounds; ++round) {
      ++result_.rounds;
      const auto absence = detail::Absence::learn(problem_, trusted_, placement_);
      weighed_ = round == 0 ? detail::weigh_ranges(problem_, absence, options_, placement_)
                            : detail::weigh_ranges_again(problem_, absence, options_, weighed_,
                                                         placement_);
      judge_placed();
      if (!update_noise()) return;
    }
  }

  void judge_placed() {
    judged_ = detail::judge_ranges(problem_, weighed_, placement_);
    result_.iterations += weighed_.outcome.iterations;
    converged_ = weighed_.outcome.converged;
    for (std::size_t k = 0; k < use_.size(); ++k) use_[k] = is_correct(k);
  }

  // Likelier than not, given all others, and held to: a part that turns freely could meet any of
  // its ties, and is held by none that it does not.
  bool is_correct(std::size_t k) const {
    const auto& range = judged_[k];
    return range.checked ? range.fits && range.loss.probability[kCorrect] >= detail::kLikely
                         : weighed_.weighs[k];
  }

  // Scales the standard deviations to those that the errors most likely have. True if that changed
  // much.
  bool update_noise() {
    bool changed = false;
    for (const bool given : {true, false}) {
      if (given && !options_.estimate_noise) continue;
      const double factor = noise_factor(given);
      if (given) result_.noise_factor *= factor;
      std::vector<bool> scaled(problem_.pairs.size(), false);
      for (std::size_t k = 0; k < problem_.sigmas.size(); ++k) {
        if (problem_.sigma_given[k] != given) continue;
        problem_.sigmas[k] *= factor;
        const auto pair = static_cast<std::size_t>(problem_.pair_of[k]);
        if (!scaled[pair]) problem_.pairs[pair].sigma *= factor;
        scaled[pair] = true;
      }
      changed = changed || std::abs(std::log(factor)) > detail::kSameNoise;
    }
    problem_.typical_sigma = detail::lower_median(problem_.sigmas);
    return changed;
  }

  double noise_factor(bool given) const {
    RangeStatistics statistics;
    double fitted = 0.0;
    double largest = 0.0;
    for (std::size_t k = 0; k < judged_.size(); ++k) {
      if (problem_.sigma_given[k] != given) continue;
      largest = std::max(largest, problem_.sigmas[k]);
      statistics.add(judged_[k].moments);
      fitted += judged_[k].fitted;
    }
    const auto& count = statistics.count;
    // A given one is corrected only on better evidence than one that has to be found.
    const double enough = given ? detail::kEnoughRanges : 1.0;
    if (count[kCorrect] + count[kTooLong] - fitted < enough) return 1.0;
    return std::max(most_likely_scale(statistics, fitted, 1.0), finest_noise(given) / largest);
  }

  // Least standard deviation that ranges can be found to have: exact ones in arithmetic that is
  // not, and not so far below the others that the system of equations loses these.
  double finest_noise(bool given) const {
    constexpr double kOfDistance = 1e-10;
    constexpr double kOfOthers = 1e-3;
    double finest = kOfDistance * problem_.typical_distance;
    std::vector<double> others;
    for (std::size_t k = 0; k < problem_.sigmas.size(); ++k) {
      if (problem_.sigma_given[k] != given) others.push_back(problem_.sigmas[k]);
    }
    if (!others.empty())
      finest = std::max(finest, kOfOthers * detail::lower_median(std::move(others)));
    return finest;
  }

  // Nodes without one place lose it, and so do those that hung on them.
  void leave_out_undetermined() {
    constexpr int kMostRounds = 4;
    statuses_.assign(problem_.nodes, NodeStatus::not_placed);
    for (int round = 0; round < kMostRounds; ++round) {
      const bool dropped = drop_undetermined();
      if (round > 0 && !dropped) return;
      decide();
    }
  }

  // One look at all placed nodes. True if any was dropped.
  bool drop_undetermined() {
    auto statuses = detail::determinacy(problem_, use_, placement_);
    const auto known = covariances();
    const auto firm = detail::firm_nodes(task(), placement_);
    bool any = false;
    for (Index v = 0; v < problem_.nodes; ++v) {
      if (!placement_.placed[v] || problem_.is_anchor[v]) continue;
      const bool bends = std::sqrt(known[v].trace()) > problem_.typical_distance;
      if (bends && statuses[v] == NodeStatus::localised) {
        statuses[v] = NodeStatus::not_rigid;  // one range to a neighbour tells as much
      }
      if (statuses[v] == NodeStatus::localised && firm[v]) continue;
      const bool has_rival = statuses[v] == NodeStatus::localised;
      statuses_[v] = has_rival ? NodeStatus::mirrored : statuses[v];
      placement_.placed[v] = false;
      any = true;
    }
    for (std::size_t k = 0; k < use_.size(); ++k) {
      const auto& range = problem_.ranges[k];
      use_[k] = use_[k] && placement_.placed[range.from] && placement_.placed[range.to];
    }
    return any;
  }

  std::vector<Eigen::MatrixXd> covariances() const {
    return options_.method == LocalizeMethod::robust
               ? detail::RangeInformation(problem_, weighed_.weighs, placement_,
                                          weighed_.information)
                     .covariances()
               : detail::RangeInformation(problem_, use_, placement_).covariances();
  }

  void judge() {
    const bool robust = options_.method == LocalizeMethod::robust;
    if (!robust) checks_ = detail::RangeInformation(problem_, use_, placement_).check_ranges();
    for (std::size_t k = 0; k < problem_.ranges.size(); ++k) {
      EdgeVerdict verdict;
      verdict.edge = static_cast<std::int64_t>(k);
      verdict.from = static_cast<std::uint64_t>(problem_.ranges[k].from);
      verdict.to = static_cast<std::uint64_t>(problem_.ranges[k].to);
      const auto& range = problem_.ranges[k];
      if (!detail::are_placed(placement_, range.from, range.to)) {
        const bool trusted = trusted_[problem_.pair_of[k]];
        verdict.verdict = trusted ? Verdict::ambiguous : Verdict::prune;
        verdict.stage = trusted ? "no position" : "heat";
        if (robust && whole_[k].checked) judge_by_kind(whole_[k], Verdict::ambiguous, verdict);
      } else if (robust ? !judged_[k].checked : !checks_[k].is_tested()) {
        verdict.verdict = Verdict::ambiguous;
        verdict.stage = "unchecked";
      } else if (robust) {
        judge_by_kind(judged_[k], Verdict::keep, verdict);
      } else {
        verdict.score = checks_[k].chi2;
        verdict.threshold = std::numeric_limits<double>::infinity();
        verdict.stage = "least-squares";
      }
      result_.verdicts.push_back(std::move(verdict));
    }
  }

  // The score is the log of the odds of being wrong. Where an end has another place that fits
  // nearly as well, what the likeliest map contradicts is wrong, but what it does not may be so in
  // another.
  static void judge_by_kind(const detail::JudgedRange& range, Verdict if_correct,
                            EdgeVerdict& verdict) {
    const double correct = range.loss.probability[kCorrect];
    verdict.probability = correct;
    verdict.score = std::log((1.0 - correct) / correct);
    verdict.threshold = 0.0;
    verdict.verdict = correct < detail::kLikely ? Verdict::prune : if_correct;
    verdict.stage = name_of(range.loss);
  }

  // Why nodes have no position, from the graph of the ranges no test speaks against.
  void explain_the_rest() {
    statuses_.resize(problem_.nodes, NodeStatus::not_placed);
    std::vector<bool> standing(problem_.ranges.size());
    for (std::size_t k = 0; k < standing.size(); ++k) {
      standing[k] = result_.verdicts[k].verdict != Verdict::prune;
    }
    const auto generic = detail::generic_determinacy(problem_, standing, anchors_);
    for (Index v = 0; v < problem_.nodes; ++v) {
      if (placement_.placed[v]) {
        statuses_[v] = problem_.is_anchor[v] ? NodeStatus::anchor : NodeStatus::localised;
      } else if (statuses_[v] == NodeStatus::not_placed && generic[v] != NodeStatus::localised) {
        statuses_[v] = generic[v];
      }
    }
  }

  LocalizeResult finish() {
    result_.covariances = covariances();
    result_.positions = placement_.positions;
    for (Index v = 0; v < problem_.nodes; ++v) {
      if (placement_.placed[v]) continue;
      result_.positions.col(v).setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    result_.nodes = statuses_;
    result_.anchored = problem_.anchored();
    std::int64_t kept = 0;
    for (std::size_t k = 0; k < use_.size(); ++k) {
      if (!problem_.sigma_given[k]) result_.sigma = problem_.sigmas[k];
      const auto& range = problem_.ranges[k];
      if (!use_[k] || (problem_.is_anchor[range.from] && problem_.is_anchor[range.to])) continue;
      const double length = detail::distance_of(placement_, range.from, range.to);
      result_.chi2 += std::pow((length - range.distance) / problem_.sigmas[k], 2);
      ++kept;
    }
    const auto d = problem_.dimension;
    const auto localised = result_.count(NodeStatus::localised);
    const std::int64_t frame = result_.anchored || localised == 0 ? 0 : d * (d + 1) / 2;
    result_.dof = kept - (d * localised - frame);
    result_.status = localised == 0 ? LocalizeStatus::no_start
                     : converged_   ? LocalizeStatus::converged
                                    : LocalizeStatus::not_converged;
    return std::move(result_);
  }

  const LocalizeOptions& options_;
  RangeProblem problem_;
  Placement placement_;
  const Placement anchors_;
  double gate_;
  std::vector<bool> trusted_;  // pairs
  std::vector<bool> use_;      // ranges
  std::vector<RangeCheck> checks_;
  detail::WeighedRanges weighed_;
  std::vector<detail::JudgedRange> judged_;
  std::vector<detail::JudgedRange> whole_;  // in the map with all nodes
  std::vector<NodeStatus> statuses_;
  bool converged_ = true;
  LocalizeResult result_;
};

// One range a pair of nodes, then verdicts on all that there were.
LocalizeResult localize_merged(const RangeNetwork& network, const LocalizeOptions& options) {
  const auto merged = detail::merge_repeats(network);
  auto result = Localization(merged.network, options).run();
  const double gate = options.method == LocalizeMethod::robust
                          ? chi_squared_quantile(1.0 - options.significance, 1)
                          : std::numeric_limits<double>::infinity();
  std::vector<double> sigmas;
  for (const auto& range : merged.network.ranges) {
    sigmas.push_back(range.variance > 0.0 ? result.noise_factor * std::sqrt(range.variance)
                                          : result.sigma);
  }
  result.verdicts = detail::verdicts_on_repeats(network, merged, result.verdicts, sigmas, gate);
  return result;
}

}  // namespace

void LocalizeOptions::validate() const {
  require_fields_in_range(*this);
  if (threads < 0) throw InvalidArgument("threads", "must not be negative");
}

std::int64_t LocalizeResult::count(NodeStatus wanted) const {
  return std::count(nodes.begin(), nodes.end(), wanted);
}

LocalizeResult localize(const RangeNetwork& network, const LocalizeOptions& options) {
  options.validate();
  const auto start = std::chrono::steady_clock::now();
  detail::check(network);
  auto result = options.merge_repeats ? localize_merged(network, options)
                                      : Localization(network, options).run();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace isotherm::network
