#include "ranges/fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/spectral/sparse/damped_step.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr double kFirstDamping = 1e-10;  // below the stiffness of any direction of a long chain
constexpr double kMostDamping = 1e12;
constexpr double kNoGain = 1e-3;     // nats: what nobody can tell apart
constexpr double kSameScale = 1e-2;  // of the log of a scale
constexpr int kMostRounds = 40;

template <class Pose>
class Fit {
 public:
  Fit(const RangeProblem<Pose>& problem, const FitOptions& options, RangeEstimate<Pose>& at)
      : problem_(problem), options_(options), at_(at), equations_(problem) {}

  FitSummary run() {
    for (int round = 0; round < kMostRounds; ++round) {
      const bool settled = settle();
      const bool same = assess();
      summary_.converged = settled && same;
      if (summary_.converged || summary_.iterations >= options_.max_iterations) break;
    }
    summary_.cost = equations_.cost(at_);
    return std::move(summary_);
  }

  // What a damped step asks for.
  std::optional<double> move(double damping) {
    before_ = at_;
    const auto promised = equations_.move(damping, scale_, at_);
    if (!promised) at_ = before_;
    return promised;
  }
  double cost() const { return equations_.cost(at_); }
  void take_back() { at_ = std::move(before_); }

 private:
  // Steps and parameters by turns until neither gains anything.
  bool settle() {
    spectral::GainDamping damping{kFirstDamping};
    bool linear = false;
    while (summary_.iterations < options_.max_iterations) {
      report();
      ++summary_.iterations;
      if (!linear) {
        equations_.linearise(at_);
        scale_ = equations_.damping_scale();
        cost_ = equations_.cost(at_);
      }
      const auto trial = spectral::try_damped_step(*this, damping.value, cost_);
      linear = !trial.lower;
      if (!trial.lower) {
        if (trial.solved && trial.promised < kNoGain) return true;
        damping.follow(-1.0);
        if (damping.value > kMostDamping) return true;
        continue;
      }
      damping.follow((cost_ - trial.cost) / trial.promised);
      damping.value = std::max(damping.value, kFirstDamping);
      learn_ranges();
      if (trial.promised < kNoGain && cost_ - equations_.cost(at_) < kNoGain) return true;
    }
    return false;
  }

  network::RangeStatistics statistics() const {
    network::RangeStatistics statistics;
    for (const auto& term : problem_.terms) {
      const double sigma = at_.model.sigma(term.sigma);
      statistics.add(range_moments(at_.model, range_error(term, at_), sigma * sigma));
    }
    return statistics;
  }

  // How accurate ranges are can only be told where it is known how far poses follow each range;
  // that they are less accurate than believed shows before.
  void learn_ranges() {
    const auto found = statistics();
    learn_kinds(found, problem_.typical_excess, at_.model.sigma(typical_sigma()), problem_.too_long,
                at_.model);
    at_.model.scale =
        std::max(at_.model.scale, network::most_likely_scale(found, 0.0, at_.model.scale));
  }

  // The excess to begin with is between it and the longest range.
  double typical_sigma() const {
    return problem_.typical_excess * problem_.typical_excess / problem_.longest;
  }

  // How far everything is known here. True if that changes no scale.
  bool assess() {
    RangeEquations<Pose> equations(problem_, spectral::FactorForm::supernodal);
    equations.linearise(at_);
    const auto log_determinant = equations.log_determinant();
    summary_.curvatures = equations.curvatures();
    if (!log_determinant) {
      summary_.evidence = -std::numeric_limits<double>::infinity();
      summary_.variances.assign(problem_.terms.size(), 0.0);
      return true;
    }
    summary_.evidence = -equations.cost(at_) - 0.5 * *log_determinant;
    summary_.variances = equations.prediction_variances(at_);
    const double fitted = equations.fitted(summary_.variances);
    const double odometry = network::most_likely_variance(equations.steps_chi2(at_),
                                                          equations.steps_redundancy(fitted));
    const double before = std::exchange(
        at_.model.scale, network::most_likely_scale(statistics(), fitted, at_.model.scale));
    const double change = std::log(std::exchange(at_.model.odometry, odometry) / odometry);
    return std::abs(change) <= kSameScale &&
           std::abs(std::log(before / at_.model.scale)) <= kSameScale;
  }

  void report() const {
    if (!options_.progress) return;
    if (!options_.progress({"ranges and odometry", static_cast<std::uint64_t>(summary_.iterations),
                            static_cast<std::uint64_t>(options_.max_iterations)})) {
      throw Cancelled();
    }
  }

  const RangeProblem<Pose>& problem_;
  const FitOptions& options_;
  RangeEstimate<Pose>& at_;
  RangeEstimate<Pose> before_;
  RangeEquations<Pose> equations_;
  Eigen::VectorXd scale_;
  double cost_ = 0.0;
  FitSummary summary_;
};

}  // namespace

template <class Pose>
FitSummary fit(const RangeProblem<Pose>& problem, const FitOptions& options,
               RangeEstimate<Pose>& at) {
  return Fit<Pose>(problem, options, at).run();
}

template FitSummary fit(const RangeProblem<Pose2>&, const FitOptions&, RangeEstimate<Pose2>&);
template FitSummary fit(const RangeProblem<Pose3>&, const FitOptions&, RangeEstimate<Pose3>&);

}  // namespace isotherm::slam::detail
