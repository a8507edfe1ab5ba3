#include "heat_bracket.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isotherm::spectral::detail {
namespace {

constexpr double kSquaredNorm = 2.0;  // of e_i - e_j

/// What rounding may have done to a quadrature value: the sum over the nodes,
/// and a displacement of the nodes by a few units in the last place of the norm.
double rounding_allowance(int steps, double scale, double norm) {
  constexpr double kUnit = std::numeric_limits<double>::epsilon();
  return kSquaredNorm * kUnit * (16.0 + steps + 16.0 * scale * norm);
}

double integrate_exponential(const QuadratureRule& rule, double scale) {
  double sum = 0.0;
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    sum += rule.weights[k] * std::exp(-scale * rule.nodes[k]);
  }
  return kSquaredNorm * sum;
}

/// A quadrature rule costs about this many matrix entries per squared step.
constexpr std::int64_t kRuleCost = 6;
constexpr int kFirstCheck = 3;

}  // namespace

bool HeatGoal::reached(const CertifiedValue& value, std::size_t scale) const {
  if (value.width() <= tolerance) return true;
  if (thresholds.empty()) return false;
  return value.lower > thresholds[scale] || value.upper <= thresholds[scale];
}

int HeatBracketer::run(VertexPair pair, const HeatGoal& goal, std::span<CertifiedValue> values) {
  std::fill(values.begin(), values.end(), CertifiedValue{1.0, 0.0, kSquaredNorm});
  lanczos_.start(pair.from, pair.to);
  work_ = 0;
  // Rules are recomputed when as much has been spent on steps since the last time.
  std::int64_t work_at_check = 0;
  int next_at_most = kFirstCheck;
  for (;;) {
    lanczos_.step();
    const std::int64_t steps = lanczos_.steps();
    const bool last = lanczos_.exhausted() || steps >= goal.max_steps;
    const bool worth = lanczos_.work() - work_at_check >= kRuleCost * steps * steps;
    if (!last && steps < kFirstCheck) continue;
    if (!last && !worth && steps < next_at_most) continue;
    work_at_check = lanczos_.work();
    next_at_most = static_cast<int>(steps + std::max<std::int64_t>(2, steps / 4));
    work_ += 2 * kRuleCost * steps * steps;
    if (tighten(goal, values) || last) break;
  }
  work_ += lanczos_.work();
  return lanczos_.steps();
}

/// Intersects the brackets with those of the current rules; true when all are
/// good enough.
bool HeatBracketer::tighten(const HeatGoal& goal, std::span<CertifiedValue> values) {
  const std::span diagonal(lanczos_.diagonal());
  const std::span off_diagonal(lanczos_.off_diagonal());
  gauss_quadrature(diagonal, off_diagonal.first(diagonal.size() - 1), gauss_);
  const bool has_upper = !lanczos_.exhausted() && radau_rule();

  bool all_reached = true;
  for (std::size_t k = 0; k < values.size(); ++k) {
    auto& bracket = values[k];
    if (goal.reached(bracket, k)) continue;
    const double allowance =
        rounding_allowance(lanczos_.steps(), goal.scales[k], lanczos_.norm_bound());
    const double below = integrate_exponential(gauss_, goal.scales[k]);
    bracket.lower = std::max(bracket.lower, below - allowance);
    if (lanczos_.exhausted()) {
      bracket.upper = std::min(bracket.upper, below + allowance);
    } else if (has_upper) {
      const double above = integrate_exponential(radau_, goal.scales[k]);
      bracket.upper = std::min(bracket.upper, above + allowance);
    }
    bracket.value = 0.5 * (bracket.lower + bracket.upper);
    all_reached = all_reached && goal.reached(bracket, k);
  }
  return all_reached;
}

/// The Lanczos matrix extended by one row so that 0 becomes a node: its last
/// entry is beta_m^2 / d_m with d_m the last pivot of T_m. False where rounding
/// has made T_m indefinite, and the rule would bound nothing.
bool HeatBracketer::radau_rule() {
  const auto& alpha = lanczos_.diagonal();
  const auto& beta = lanczos_.off_diagonal();
  double pivot = alpha[0];
  for (std::size_t k = 1; k < alpha.size(); ++k) {
    if (!(pivot > 0.0)) return false;
    pivot = alpha[k] - beta[k - 1] * beta[k - 1] / pivot;
  }
  if (!(pivot > 0.0)) return false;
  const double last = beta.back() * beta.back() / pivot;
  if (!std::isfinite(last)) return false;
  radau_diagonal_ = alpha;
  radau_diagonal_.push_back(last);
  gauss_quadrature(radau_diagonal_, beta, radau_);
  return true;
}

}  // namespace isotherm::spectral::detail
