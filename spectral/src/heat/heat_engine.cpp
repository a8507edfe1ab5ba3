#include "heat/heat_engine.hpp"

#include <algorithm>
#include <cmath>

#include "heat/rational_heat.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/parallel.hpp"
#include "sparse/pair_pattern.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr double kAnalysisEntry = 300.0;  // nanoseconds an entry for ordering and analysis

bool all_of(const std::vector<bool>& flags) {
  return std::find(flags.begin(), flags.end(), false) == flags.end();
}

bool any_open(const HeatTable& table, const HeatGoal& goal, std::size_t scale) {
  const std::size_t scale_count = goal.scales.size();
  for (std::size_t k = scale; k < table.values.size(); k += scale_count) {
    if (!goal.reached(table.values[k], scale)) return true;
  }
  return false;
}

/// Whether a value is still open at `scale` that would not be if its bracket were narrower by
/// `saved`, times the squared norm of its vector.
bool any_within_reach(std::span<const HeatTarget> targets, const HeatTable& table,
                      const HeatGoal& goal, std::size_t scale, double saved) {
  const std::size_t scale_count = goal.scales.size();
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const CertifiedValue& value = table.values[k * scale_count + scale];
    if (goal.reached(value, scale)) continue;
    if (value.width() - saved * targets[k].squared_norm() <= goal.tolerance) return true;
  }
  return false;
}

/// What both brackets allow. Both hold, so they meet; should rounding have been
/// worse than allowed for, the proven one stands.
CertifiedValue intersection(const CertifiedValue& proven, const CertifiedValue& other) {
  CertifiedValue both;
  both.lower = std::max(proven.lower, other.lower);
  both.upper = std::min(proven.upper, other.upper);
  if (both.lower > both.upper) return proven;
  both.value = std::clamp(other.value, both.lower, both.upper);
  return both;
}

/// Before anything is computed: trivial targets are 0, others in [0, |x|^2].
HeatTable blank_table(std::span<const HeatTarget> targets, std::size_t scale_count) {
  HeatTable table;
  table.steps.assign(targets.size(), 0);
  for (const auto& target : targets) {
    const double norm = target.trivial() ? 0.0 : target.squared_norm();
    table.values.insert(table.values.end(), scale_count, CertifiedValue{0.5 * norm, 0.0, norm});
    table.methods.insert(table.methods.end(), scale_count,
                         target.trivial() ? HeatMethod::exact : HeatMethod::lanczos);
  }
  return table;
}

/// The matrix rows a target asks about, its own end first; none if it is trivial.
VertexPair rows_of(const HeatTarget& target) {
  if (target.trivial()) return {kNoVertex, kNoVertex};
  if (!target.excluded.any()) return {target.from, target.to};
  const bool forward = target.from == target.excluded.from;
  return {target.from, forward ? target.excluded.to : target.excluded.from};
}

}  // namespace

void check_scales(std::span<const double> scales) {
  for (std::size_t k = 0; k < scales.size(); ++k) {
    if (std::isfinite(scales[k]) && scales[k] >= 0.0) continue;
    throw InvalidArgument("scales[" + std::to_string(k) + "]", "must be finite and not negative");
  }
}

/// What the rational method needs, made when first asked for.
class HeatEngine::Rational {
 public:
  Rational(const SparseMatrix& laplacian, std::span<const HeatTarget> targets, double tolerance)
      : laplacian_(laplacian), approximation_(rational_exponential_for(tolerance)) {
    rows_.reserve(targets.size());
    for (const auto& target : targets) rows_.push_back(rows_of(target));
  }

  const RationalExponential& approximation() const { return approximation_; }

  const FrontalMatrix& matrix() {
    if (!matrix_) {
      const SparseMatrix lower = laplacian_.triangularView<Eigen::Lower>();
      matrix_ = analyse(with_pairs(lower, rows_));
    }
    return *matrix_;
  }

  FrontQueries queries() { return locate(matrix().tree, rows_); }

 private:
  const SparseMatrix& laplacian_;
  std::vector<VertexPair> rows_;
  const RationalExponential& approximation_;
  std::optional<FrontalMatrix> matrix_;
};

HeatTable HeatEngine::evaluate(std::span<const HeatTarget> targets, std::span<const double> scales,
                               std::span<const double> thresholds) const {
  HeatTable table = blank_table(targets, scales.size());
  table.plan = {std::vector<bool>(scales.size(), false),
                std::vector<std::string>(scales.size(), "nothing to compute")};
  if (table.values.empty()) return table;

  HeatGoal goal{scales, options_.tolerance, thresholds, options_.max_steps};
  Rational rational(laplacian_, targets, options_.tolerance);
  table.plan = choose(targets, goal, rational);
  goal.optional = table.plan.rational;
  if (!all_of(table.plan.rational)) run_lanczos(targets, goal, table);

  std::vector<std::size_t> rational_scales;
  const bool may_switch = options_.method == HeatMethod::automatic;
  for (std::size_t s = 0; s < scales.size(); ++s) {
    if (table.plan.rational[s]) {
      rational_scales.push_back(s);
    } else if (may_switch && any_open(table, goal, s)) {
      rational_scales.push_back(s);
      table.plan.reasons[s] += "; rational where that did not suffice";
    }
  }
  run_rational(targets, goal, rational_scales, rational, table);
  return table;
}

HeatPlan HeatEngine::choose(std::span<const HeatTarget> targets, const HeatGoal& goal,
                            Rational& rational) const {
  const auto scale_count = goal.scales.size();
  if (options_.method != HeatMethod::automatic) {
    return {std::vector<bool>(scale_count, options_.method == HeatMethod::rational),
            std::vector<std::string>(scale_count, "asked for")};
  }
  // Until the matrix is analysed, a run is compared with the cost of doing that.
  const auto target_count = static_cast<double>(targets.size());
  const double setup = kAnalysisEntry * static_cast<double>(laplacian_.nonZeros());
  HeatBracketer pilot(laplacian_, options_.tolerance);
  auto costs = lanczos_costs(pilot, targets, goal, setup / target_count);
  if (target_count * *std::max_element(costs.begin(), costs.end()) <= setup) {
    return {std::vector<bool>(scale_count, false),
            std::vector<std::string>(
                scale_count, "local Lanczos: cheaper than analysing the matrix for the other")};
  }
  const double one_scale = rational_cost(rational.matrix(), rational.approximation());
  const double everything = setup + static_cast<double>(scale_count) * one_scale;
  costs = lanczos_costs(pilot, targets, goal, 2.0 * everything / target_count);
  return detail::plan(goal.scales, costs, targets.size(), one_scale, 0.0);
}

void HeatEngine::run_lanczos(std::span<const HeatTarget> targets, const HeatGoal& goal,
                             HeatTable& table) const {
  constexpr std::size_t kGrain = 8;
  const auto scale_count = goal.scales.size();
  const std::span values(table.values);
  parallel_for(
      static_cast<std::int64_t>(targets.size()), kGrain, options_.threads, options_.progress,
      "heat distances", [this] { return HeatBracketer(laplacian_, options_.tolerance); },
      [&](HeatBracketer& bracketer, std::int64_t k) {
        const auto row = static_cast<std::size_t>(k);
        if (targets[row].trivial()) return;
        table.steps[row] =
            bracketer.run(targets[row], goal, values.subspan(row * scale_count, scale_count));
      });
}

/// Brings every target that `goal` does not accept yet at the given scales
/// there, narrowing the brackets that Lanczos left. The approximation is chosen before it is
/// known how much of the tolerance rounding takes: where that turns out to be more than was
/// left for it, the next one leaves more.
void HeatEngine::run_rational(std::span<const HeatTarget> targets, const HeatGoal& goal,
                              std::span<const std::size_t> scales, Rational& rational,
                              HeatTable& table) const {
  std::vector<std::size_t> left(scales.begin(), scales.end());
  const RationalExponential* approximation = &rational.approximation();
  while (!left.empty()) {
    narrow(targets, goal, left, *approximation, rational, table);
    const RationalExponential& finer = finer_than(*approximation);
    const double saved = 2.0 * (approximation->error - finer.error);
    std::erase_if(left, [&](std::size_t scale) {
      return !any_within_reach(targets, table, goal, scale, saved);
    });
    approximation = &finer;
  }
}

void HeatEngine::narrow(std::span<const HeatTarget> targets, const HeatGoal& goal,
                        std::span<const std::size_t> scales,
                        const RationalExponential& approximation, Rational& rational,
                        HeatTable& table) const {
  const auto scale_count = goal.scales.size();
  std::vector<double> times;
  for (const std::size_t s : scales) times.push_back(goal.scales[s]);
  std::vector<CertifiedValue> values(targets.size() * scales.size());
  rational_heat(rational.matrix(), rational.queries(), targets, approximation, times,
                options_.threads, options_.progress, values);
  for (std::size_t k = 0; k < targets.size(); ++k) {
    if (targets[k].trivial()) continue;
    for (std::size_t s = 0; s < scales.size(); ++s) {
      const std::size_t index = k * scale_count + scales[s];
      if (goal.reached(table.values[index], scales[s])) continue;
      table.values[index] = intersection(table.values[index], values[s * targets.size() + k]);
      table.methods[index] = HeatMethod::rational;
    }
  }
}

}  // namespace isotherm::spectral::detail
