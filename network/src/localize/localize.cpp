#include "isotherm/network/localize/localize.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/base/statistics.hpp"
#include "localize/firm/firmness.hpp"
#include "localize/problem/range_problem.hpp"
#include "localize/problem/repeats.hpp"
#include "localize/refine/determinacy.hpp"
#include "localize/refine/range_information.hpp"
#include "localize/refine/robust_refine.hpp"
#include "localize/start/initial_placement.hpp"

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
    trusted_ = detail::trusted_pairs(problem_, options_);
    placement_ = detail::place_initially(problem_, anchors_, trusted_, gate_, options_);
    if (options_.method == LocalizeMethod::robust) {
      use_ = detail::ranges_within(problem_, placement_, gate_);
      // Where the noise is not known what is firm depends on it.
      if (!noise_is_given()) decide();
      leave_out_undetermined();
    } else {
      use_ = between_placed();
      fit();
    }
    judge();
    explain_the_rest();
    return finish();
  }

 private:
  std::vector<bool> between_placed() const {
    return detail::ranges_within(problem_, placement_, std::numeric_limits<double>::infinity());
  }

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

  // Least squares on the kept ranges and leave-one-out tests of all, in turn until
  // the kept ranges stay the same.
  void decide() {
    constexpr int kMostRounds = 10;
    std::vector<bool> returned(use_.size(), false);
    for (int round = 0; round < kMostRounds; ++round) {
      ++result_.rounds;
      fit();
      checks_ = detail::RangeInformation(problem_, use_, placement_).check_ranges();
      const bool noise_changed = update_noise();
      bool changed = false;
      for (std::size_t k = 0; k < use_.size(); ++k) {
        const bool keep = checks_[k].checked && (keeps_untested(k) || fits(k));
        // Late rounds only remove, so that they end, and a range comes back once: some fit only
        // as long as they are left out.
        if (keep == use_[k] || (keep && (returned[k] || round > kMostRounds / 2))) continue;
        use_[k] = keep;
        returned[k] = returned[k] || keep;
        changed = true;
      }
      if (!changed && !noise_changed) return;
    }
  }

  bool noise_is_given() const {
    const auto& given = problem_.sigma_given;
    return std::find(given.begin(), given.end(), false) == given.end();
  }

  // A range that was left out has to be likely where it is predicted, not only possible: of
  // a node that hardly anything else holds any length would be.
  bool fits(std::size_t k) const {
    const auto& check = checks_[k];
    if (use_[k]) return check.chi2 <= gate_;
    return check.chi2 - std::log(check.redundancy) <= gate_ && is_predicted(k);
  }

  // Whether the other ranges say how long one is, as far as that can be said with derivatives:
  // a node that may be elsewhere altogether is pulled there by the wrong range.
  bool is_predicted(std::size_t k) const {
    constexpr double kOfLength = 0.25;
    const double deviation = problem_.sigmas[k] * std::sqrt(1.0 / checks_[k].redundancy - 1.0);
    return deviation <= kOfLength * problem_.ranges[k].distance;
  }

  bool keeps_untested(std::size_t k) const { return use_[k] && !checks_[k].is_tested(); }

  // Scales the standard deviations so that the median deviation of the kept ranges
  // is that of normal noise. True if that changed much.
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
      for (std::size_t k = 0; k < checks_.size(); ++k) {
        if (problem_.sigma_given[k] == given) checks_[k].chi2 /= factor * factor;
      }
      changed = changed || std::abs(std::log(factor)) > 0.05;
    }
    problem_.typical_sigma = detail::lower_median(problem_.sigmas);
    return changed;
  }

  double noise_factor(bool given) const {
    constexpr double kMedianOfNormal = 0.6745;
    std::vector<double> deviations;
    double largest = 0.0;
    for (std::size_t k = 0; k < checks_.size(); ++k) {
      if (problem_.sigma_given[k] != given) continue;
      largest = std::max(largest, problem_.sigmas[k]);
      if (use_[k] && checks_[k].is_tested()) {
        deviations.push_back(std::abs(checks_[k].deviation));
      }
    }
    // A given one is corrected only on better evidence than one that has to be found.
    const std::size_t enough = given ? 10 : 3;
    if (deviations.size() < enough) return 1.0;
    const double factor = detail::lower_median(std::move(deviations)) / kMedianOfNormal;
    return std::max(factor, finest_noise(given) / largest);
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
    const auto statuses = detail::determinacy(problem_, use_, placement_);
    const auto firm = detail::firm_nodes(problem_, trusted_, gate_, options_, placement_);
    bool any = false;
    for (Index v = 0; v < problem_.nodes; ++v) {
      if (!placement_.placed[v] || problem_.is_anchor[v]) continue;
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

  void judge() {
    checks_ = detail::RangeInformation(problem_, use_, placement_).check_ranges();
    const bool robust = options_.method == LocalizeMethod::robust;
    for (std::size_t k = 0; k < problem_.ranges.size(); ++k) {
      EdgeVerdict verdict;
      verdict.edge = static_cast<std::int64_t>(k);
      verdict.from = static_cast<std::uint64_t>(problem_.ranges[k].from);
      verdict.to = static_cast<std::uint64_t>(problem_.ranges[k].to);
      verdict.score = checks_[k].chi2;
      verdict.threshold = robust ? gate_ : std::numeric_limits<double>::infinity();
      if (!checks_[k].checked) {
        verdict.verdict = trusted_[problem_.pair_of[k]] ? Verdict::ambiguous : Verdict::prune;
        verdict.stage = trusted_[problem_.pair_of[k]] ? "no position" : "heat";
      } else if (!checks_[k].is_tested()) {
        verdict.verdict = Verdict::ambiguous;
        verdict.stage = "unchecked";
      } else {
        verdict.verdict = use_[k] ? Verdict::keep : Verdict::prune;
        verdict.stage = robust ? "leave-one-out" : "least-squares";
      }
      result_.verdicts.push_back(std::move(verdict));
    }
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
    result_.covariances = detail::RangeInformation(problem_, use_, placement_).covariances();
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
      const double length =
          (placement_.positions.col(range.from) - placement_.positions.col(range.to)).norm();
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
