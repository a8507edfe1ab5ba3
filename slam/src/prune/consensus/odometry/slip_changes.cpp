#include "prune/consensus/odometry/slip_changes.hpp"

#include <cmath>
#include <optional>

#include "isotherm/base/parallel.hpp"

namespace isotherm::slam::detail {
namespace {

using LogOdds = std::array<double, kSlipSizes>;

constexpr double kLeastDeterminant = 1e-12;  // less is rounding

// log N(r; M^-1 + D) - log N(r; M^-1), with M r the step's pull and M what of it is spare, all but
// for the scale (Woodbury).
template <class Pose>
double log_ratio(const StepError<Pose>& error, const typename Pose::Matrix& D, double scale) {
  using Matrix = typename Pose::Matrix;
  const Eigen::PartialPivLU<Matrix> with(Matrix::Identity() + error.spare * D);
  const double determinant = with.determinant();
  if (!(determinant > kLeastDeterminant)) return 0.0;
  return 0.5 * (error.pull.dot(D * with.solve(error.pull)) / scale - std::log(determinant));
}

// Whether no slip of an edge gains: the most that one can is half of what the step's error is
// against that which the rest of the graph allows.
template <class Pose>
bool explained(const StepError<Pose>& error, double scale, const LogOdds& log_odds) {
  const Eigen::LLT<typename Pose::Matrix> spare(error.spare);
  return spare.info() == Eigen::Success &&
         0.5 * error.pull.dot(spare.solve(error.pull)) / scale < -log_odds[1];
}

template <class Pose>
std::optional<SlipChange> best_change(const ContractedChain<Pose>& odometry, std::size_t k,
                                      const StepError<Pose>& error, double scale,
                                      const LogOdds& log_odds) {
  using Matrix = typename Pose::Matrix;
  const auto& [chain, shape, slips, bias, reduced] = odometry;
  const auto& step = reduced.steps[k];
  const Index first = reduced.vertex[step.a];
  const auto edges = static_cast<std::size_t>(reduced.vertex[step.b] - first);
  const bool any =
      !slips.empty() && any_slips(std::span(slips).subspan(static_cast<std::size_t>(first), edges));
  if (!any && explained(error, scale, log_odds)) return std::nullopt;
  std::optional<SlipChange> best;
  visit_edges(odometry, k, [&](Index vertex, const Matrix& carry, const Matrix& Sigma) {
    const auto of_slip = [&](std::uint8_t slip) {
      return slipped<Pose>(*odometry.chain[vertex], Sigma, slip, scale);
    };
    const std::uint8_t now = slip_of(odometry.slips, vertex);
    const auto as_now = of_slip(now);
    for (std::uint8_t slip = 0; slip < kSlipSizes; ++slip) {
      if (slip == now) continue;
      const auto other = of_slip(slip);
      const Matrix D = carry * (other.covariance - as_now.covariance) * carry.transpose();
      const double gain = log_ratio<Pose>(error, D, scale) + log_odds[slip] - log_odds[now] +
                          other.log_motion - as_now.log_motion;
      if (gain > (best ? best->gain : 0.0)) best = {vertex, slip, gain};
    }
  });
  return best;
}

// Of steps in a row each may explain the same.
std::vector<SlipChange> best_of_runs(const std::vector<std::optional<SlipChange>>& of_step) {
  std::vector<SlipChange> changes;
  bool begins = true;
  for (const auto& change : of_step) {
    if (change && begins) {
      changes.push_back(*change);
    } else if (change && change->gain > changes.back().gain) {
      changes.back() = *change;
    }
    begins = !change;
  }
  return changes;
}

}  // namespace

template <class Pose>
std::vector<SlipChange> slip_changes(const ContractedChain<Pose>& odometry, double scale,
                                     const std::array<double, kSlipSizes>& log_odds,
                                     std::span<const Belief<Pose>> residuals, int threads) {
  const auto& reduced = odometry.reduced;
  std::vector<std::optional<SlipChange>> of_step(reduced.contracted);
  parallel_for_each(of_step.size(), threads, [&](std::size_t k) {
    const auto& step = reduced.steps[k];
    const auto error = step_error<Pose>(step, residuals[k], scale);
    of_step[k] = best_change(odometry, k, error, scale, log_odds);
  });
  return best_of_runs(of_step);
}

template std::vector<SlipChange> slip_changes(const ContractedChain<Pose2>&, double,
                                              const std::array<double, kSlipSizes>&,
                                              std::span<const Belief<Pose2>>, int);
template std::vector<SlipChange> slip_changes(const ContractedChain<Pose3>&, double,
                                              const std::array<double, kSlipSizes>&,
                                              std::span<const Belief<Pose3>>, int);

}  // namespace isotherm::slam::detail
