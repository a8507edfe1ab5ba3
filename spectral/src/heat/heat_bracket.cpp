#include "heat/heat_bracket.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace isotherm::spectral::detail {
namespace {

/// What rounding in the Lanczos process may have done: a displacement of the
/// spectrum by a few units in the last place of the norm.
double lanczos_rounding(int steps, double scale, double norm) {
  constexpr double kUnit = std::numeric_limits<double>::epsilon();
  return kUnit * (16.0 + steps + 16.0 * scale * norm);
}

/// The table's approximation that takes no more than a hundredth of the tolerance.
const RationalExponential& approximation_for(double tolerance) {
  for (const auto& rational : kRationalExponentials) {
    if (4.0 * kLargestNorm * rational.error <= 0.01 * tolerance) return rational;
  }
  return kRationalExponentials.back();
}

/// Evaluating a rule costs about this many matrix entries a step.
constexpr std::int64_t kRuleCost = 10;
constexpr int kFirstCheck = 3;

}  // namespace

bool HeatGoal::reached(const CertifiedValue& value, std::size_t scale) const {
  if (value.width() <= tolerance) return true;
  if (thresholds.empty()) return false;
  return value.lower > thresholds[scale] || value.upper <= thresholds[scale];
}

HeatBracketer::HeatBracketer(const SparseMatrix& laplacian, double tolerance)
    : lanczos_(laplacian), exponential_(approximation_for(tolerance)) {}

int HeatBracketer::run(const HeatTarget& target, const HeatGoal& goal,
                       std::span<CertifiedValue> values) {
  squared_norm_ = target.squared_norm();
  std::fill(values.begin(), values.end(), CertifiedValue{0.5 * squared_norm_, 0.0, squared_norm_});
  order_.resize(values.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::stable_sort(order_.begin(), order_.end(), [&goal](std::size_t a, std::size_t b) {
    return goal.scales[a] > goal.scales[b];
  });
  lanczos_.start(target);
  radau_diagonal_.clear();
  rule_work_ = 0;
  work_at_.assign(values.size(), 0);
  // Rules are evaluated when as much has been spent on steps since the last
  // time; in small components, where steps cost little, as their number grows.
  std::int64_t checked_at = 0;
  int next_check = kFirstCheck;
  for (;;) {
    lanczos_.step();
    const int steps = lanczos_.steps();
    const bool last = lanczos_.exhausted() || steps >= goal.max_steps ||
                      lanczos_.work() + rule_work_ >= goal.max_work;
    const bool worth = steps >= kFirstCheck && lanczos_.work() - checked_at >= kRuleCost * steps;
    if (!last && !worth && steps < next_check) continue;
    checked_at = lanczos_.work();
    next_check = steps + std::max(2, steps / 3);
    extend_to_radau();
    if (settled_all(goal, values) || last) break;
  }
  for (std::size_t s = 0; s < values.size(); ++s) {
    if (!goal.reached(values[s], s)) tighten(goal.scales[s], values[s]);
  }
  return lanczos_.steps();
}

/// Brings brackets up to date and says whether all that are required are good
/// enough, or as good as rounding lets them become. The larger the scale the
/// later it is settled, so that one that is not makes looking at smaller ones
/// pointless, unless thresholds decide or every scale is watched.
bool HeatBracketer::settled_all(const HeatGoal& goal, std::span<CertifiedValue> values) {
  constexpr double kSaturated = 2.2;  // two allowances, and a little between the rules
  const bool look_at_all = goal.watch_every_scale || !goal.thresholds.empty();
  bool all = true;
  for (const std::size_t s : order_) {
    if (!goal.required(s) || goal.reached(values[s], s)) continue;
    tighten(goal.scales[s], values[s]);
    work_at_[s] = lanczos_.work() + rule_work_;
    const bool settled =
        goal.reached(values[s], s) || values[s].width() <= kSaturated * allowance(goal.scales[s]);
    all = all && settled;
    if (!all && !look_at_all) return false;
  }
  return all;
}

/// What evaluating a rule, and rounding before it, may have cost.
double HeatBracketer::allowance(double scale) const {
  const double norm = lanczos_.norm_bound();
  return squared_norm_ *
         (exponential_.error_bound(scale, norm) + lanczos_rounding(lanczos_.steps(), scale, norm));
}

/// Intersects a bracket with the one of the current rules.
void HeatBracketer::tighten(double scale, CertifiedValue& bracket) {
  const std::span off_diagonal(lanczos_.off_diagonal());
  const double below = squared_norm_ * exponential_(lanczos_.diagonal(), off_diagonal, scale);
  rule_work_ += kRuleCost * lanczos_.steps();
  bracket.lower = std::max(bracket.lower, below - allowance(scale));
  if (lanczos_.exhausted()) {
    bracket.upper = std::min(bracket.upper, below + allowance(scale));
  } else if (!radau_diagonal_.empty()) {
    const double above = squared_norm_ * exponential_(radau_diagonal_, off_diagonal, scale);
    rule_work_ += kRuleCost * lanczos_.steps();
    bracket.upper = std::min(bracket.upper, above + allowance(scale));
  }
  bracket.value = 0.5 * (bracket.lower + bracket.upper);
}

/// The Lanczos matrix extended by one row so that 0 becomes a node: its last
/// entry is beta_m^2 / d_m with d_m the last pivot of T_m. Where rounding has
/// made T_m indefinite there is no such rule, and an earlier one stands.
void HeatBracketer::extend_to_radau() {
  const auto& alpha = lanczos_.diagonal();
  const auto& beta = lanczos_.off_diagonal();
  double pivot = alpha[0];
  for (std::size_t k = 1; k < alpha.size(); ++k) {
    if (!(pivot > 0.0)) return;
    pivot = alpha[k] - beta[k - 1] * beta[k - 1] / pivot;
  }
  if (!(pivot > 0.0)) return;
  const double last = beta.back() * beta.back() / pivot;
  if (!std::isfinite(last)) return;
  radau_diagonal_ = alpha;
  radau_diagonal_.push_back(last);
}

}  // namespace isotherm::spectral::detail
