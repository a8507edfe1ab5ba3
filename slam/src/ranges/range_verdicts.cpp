#include "ranges/range_verdicts.hpp"

#include <cmath>
#include <utility>

#include "isotherm/spectral/sparse/block_covariance.hpp"

namespace isotherm::slam::detail {
namespace {

using spectral::EdgeVerdict;
using spectral::Verdict;

void judge_range(const RangeModel& model, const network::LeftOutRange& range, double doubt,
                 EdgeVerdict& verdict) {
  const auto loss = network::range_loss(model, range.error, range.variance);
  const double correct = loss.probability[network::kCorrect];
  verdict.probability = correct;
  verdict.score = range.error * range.error / range.variance;
  verdict.stage = name_of(loss);
  verdict.verdict = correct > 1.0 - doubt ? Verdict::keep
                    : correct < doubt     ? Verdict::prune
                                          : Verdict::ambiguous;
}

}  // namespace

template <class Pose>
spectral::EdgeVerdicts range_verdicts(const KnownWorld<Pose>& world,
                                      const RangeProblem<Pose>& problem,
                                      const RangeEstimate<Pose>& at, const FitSummary& summary,
                                      double doubt) {
  spectral::EdgeVerdicts verdicts;
  const auto& ranges = world.graph.ranges;
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    EdgeVerdict verdict;
    verdict.edge = static_cast<std::int64_t>(k);
    verdict.from = static_cast<std::uint64_t>(ranges[k].from);
    verdict.to = static_cast<std::uint64_t>(ranges[k].to);
    verdict.verdict = Verdict::ambiguous;
    verdict.stage = "no position";
    verdict.probability = at.model.share[network::kCorrect];
    verdicts.push_back(std::move(verdict));
  }
  for (std::size_t k = 0; k < problem.terms.size(); ++k) {
    const auto& term = problem.terms[k];
    const double error = range_error(term, at);
    const double noise = std::pow(at.model.sigma(term.sigma), 2);
    const auto without = network::left_out(network::range_loss(at.model, error, noise), error,
                                           noise, summary.variances[k], summary.curvatures[k]);
    auto& verdict = verdicts[term.range];
    if (without.checked) {
      judge_range(at.model, without, doubt, verdict);
    } else {
      verdict.stage = "unchecked";
    }
  }
  return verdicts;
}

template <class Pose>
std::vector<Eigen::MatrixXd> position_covariances(const RangeProblem<Pose>& problem,
                                                  const RangeEstimate<Pose>& at, Index nodes) {
  std::vector<Eigen::MatrixXd> result(static_cast<std::size_t>(nodes));
  RangeEquations<Pose> equations(problem, spectral::FactorForm::supernodal);
  equations.linearise(at);
  if (!equations.log_determinant()) return result;
  const auto own = equations.own_covariances();
  for (Index v = 0; v < nodes; ++v) {
    const Index variable = problem.gauge.variable[v];
    if (variable < 0) continue;
    const auto rotation = at.poses[v].rotation_matrix();
    result[v] = rotation * own[variable].template topLeftCorner<Pose::kDim, Pose::kDim>() *
                rotation.transpose();
  }
  return result;
}

template spectral::EdgeVerdicts range_verdicts(const KnownWorld<Pose2>&, const RangeProblem<Pose2>&,
                                               const RangeEstimate<Pose2>&, const FitSummary&,
                                               double);
template spectral::EdgeVerdicts range_verdicts(const KnownWorld<Pose3>&, const RangeProblem<Pose3>&,
                                               const RangeEstimate<Pose3>&, const FitSummary&,
                                               double);
template std::vector<Eigen::MatrixXd> position_covariances(const RangeProblem<Pose2>&,
                                                           const RangeEstimate<Pose2>&, Index);
template std::vector<Eigen::MatrixXd> position_covariances(const RangeProblem<Pose3>&,
                                                           const RangeEstimate<Pose3>&, Index);

}  // namespace isotherm::slam::detail
