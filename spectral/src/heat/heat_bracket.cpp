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

HeatRules::HeatRules(double tolerance) : exponential_(approximation_for(tolerance)) {}

void HeatRules::start(double squared_norm) {
  squared_norm_ = squared_norm;
  radau_diagonal_.clear();
}

double HeatRules::allowance(const LanczosMatrix& matrix, double scale) const {
  const double norm = matrix.norm_bound;
  return squared_norm_ *
         (exponential_.error_bound(scale, norm) + lanczos_rounding(matrix.steps(), scale, norm));
}

bool HeatRules::settled(const LanczosMatrix& matrix, const HeatGoal& goal, std::size_t scale,
                        const CertifiedValue& bracket) const {
  constexpr double kSaturated = 2.2;  // two allowances, and a little between the rules
  return goal.reached(bracket, scale) ||
         bracket.width() <= kSaturated * allowance(matrix, goal.scales[scale]);
}

int HeatRules::tighten(const LanczosMatrix& matrix, double scale, CertifiedValue& bracket) const {
  const double below = squared_norm_ * exponential_(matrix.diagonal, matrix.off_diagonal, scale);
  const double allowed = allowance(matrix, scale);
  int rules = 1;
  bracket.lower = std::max(bracket.lower, below - allowed);
  if (matrix.exhausted) {
    bracket.upper = std::min(bracket.upper, below + allowed);
  } else if (!radau_diagonal_.empty()) {
    const double above = squared_norm_ * exponential_(radau_diagonal_, matrix.off_diagonal, scale);
    ++rules;
    bracket.upper = std::min(bracket.upper, above + allowed);
  }
  bracket.value = 0.5 * (bracket.lower + bracket.upper);
  return rules;
}

/// The last entry is beta_m^2 / d_m with d_m the last pivot of T_m. Where rounding has
/// made T_m indefinite there is no such rule.
void HeatRules::extend_to_radau(const LanczosMatrix& matrix) {
  const auto alpha = matrix.diagonal;
  const auto beta = matrix.off_diagonal;
  double pivot = alpha[0];
  for (std::size_t k = 1; k < alpha.size(); ++k) {
    if (!(pivot > 0.0)) return;
    pivot = alpha[k] - beta[k - 1] * beta[k - 1] / pivot;
  }
  if (!(pivot > 0.0)) return;
  const double last = beta.back() * beta.back() / pivot;
  if (!std::isfinite(last)) return;
  radau_diagonal_.assign(alpha.begin(), alpha.end());
  radau_diagonal_.push_back(last);
}

HeatBracketer::HeatBracketer(const SparseMatrix& laplacian, double tolerance)
    : lanczos_(laplacian), rules_(tolerance) {}

LanczosMatrix HeatBracketer::matrix() const {
  return {lanczos_.diagonal(), lanczos_.off_diagonal(), lanczos_.norm_bound(),
          lanczos_.exhausted()};
}

int HeatBracketer::run(const HeatTarget& target, const HeatGoal& goal,
                       std::span<CertifiedValue> values) {
  const double norm = target.squared_norm();
  std::fill(values.begin(), values.end(), CertifiedValue{0.5 * norm, 0.0, norm});
  order_.resize(values.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::stable_sort(order_.begin(), order_.end(), [&goal](std::size_t a, std::size_t b) {
    return goal.scales[a] > goal.scales[b];
  });
  lanczos_.start(target);
  rules_.start(norm);
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
    rules_.extend_to_radau(matrix());
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
  const bool look_at_all = goal.watch_every_scale || !goal.thresholds.empty();
  bool all = true;
  for (const std::size_t s : order_) {
    if (!goal.required(s) || goal.reached(values[s], s)) continue;
    tighten(goal.scales[s], values[s]);
    work_at_[s] = lanczos_.work() + rule_work_;
    all = all && rules_.settled(matrix(), goal, s, values[s]);
    if (!all && !look_at_all) return false;
  }
  return all;
}

void HeatBracketer::tighten(double scale, CertifiedValue& bracket) {
  rule_work_ += rules_.tighten(matrix(), scale, bracket) * kRuleCost * lanczos_.steps();
}

}  // namespace isotherm::spectral::detail
