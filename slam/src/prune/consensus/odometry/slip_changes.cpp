#include "prune/consensus/odometry/slip_changes.hpp"

#include <cmath>
#include <optional>

#include "isotherm/base/parallel.hpp"

namespace isotherm::slam::detail {
namespace {

using LogOdds = std::array<double, kSlipSizes>;

/// A step's error as one of its edges has it, along axes in which that is independent.
template <class Pose>
struct EdgeError {
  using Tangent = typename Pose::Tangent;
  using Matrix = typename Pose::Matrix;

  // With u = M r the step's pull and L L' the edge's covariance at the step's end, L' u and L' M L.
  EdgeError(const StepError<Pose>& step, const Matrix& carry, const Matrix& Sigma, double scale) {
    const Matrix L = carry * Matrix(Eigen::LLT<Matrix>(Sigma).matrixL());
    const Eigen::SelfAdjointEigenSolver<Matrix> axes(L.transpose() * step.spare * L);
    spare = axes.eigenvalues().cwiseMax(0.0).cwiseMin(1.0);
    pull = axes.eigenvectors().transpose() * L.transpose() * step.pull / std::sqrt(scale);
  }

  // log N(r; M^-1 + D) - log N(r; M^-1) of D = (factor - 1) L L' (Woodbury).
  double gain(double factor) const {
    const auto det = 1.0 + (factor - 1.0) * spare.array();
    return 0.5 * ((factor - 1.0) * pull.array().square() / det - det.log()).sum();
  }

  Tangent spare;
  Tangent pull;
};

// The size other than `now` that gains most of an edge, where that is more than `best` does.
template <class Pose>
void take_better(const EdgeError<Pose>& edge, const LogOdds& log_odds, Index vertex,
                 std::uint8_t now, std::optional<SlipChange>& best) {
  for (std::uint8_t slip = 0; slip < kSlipSizes; ++slip) {
    if (slip == now) continue;
    const double gain =
        edge.gain(slip_factor(slip) / slip_factor(now)) + log_odds[slip] - log_odds[now];
    if (gain > (best ? best->gain : 0.0)) best = {vertex, slip, gain};
  }
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
  const bool slipped =
      !slips.empty() && any_slips(std::span(slips).subspan(static_cast<std::size_t>(first), edges));
  if (!slipped && explained(error, scale, log_odds)) return std::nullopt;
  std::optional<SlipChange> best;
  visit_edges(odometry, k, [&](Index vertex, const Matrix& carry, const Matrix& Sigma) {
    const EdgeError<Pose> edge(error, carry, Sigma, scale);
    take_better(edge, log_odds, vertex, slip_of(odometry.slips, vertex), best);
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
