#include "heat/heat_plan.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <numeric>

namespace isotherm::spectral::detail {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLanczosEntry = 1.3;  // nanoseconds a matrix entry, measured
constexpr std::size_t kPilotTargets = 16;

std::string seconds_text(double nanoseconds) {
  if (nanoseconds == kInfinity) return "more than that";
  char text[32];
  std::snprintf(text, sizeof text, "%.2g s", 1e-9 * nanoseconds);
  return text;
}

}  // namespace

std::vector<double> lanczos_costs(HeatBracketer& bracketer, std::span<const HeatTarget> targets,
                                  const HeatGoal& goal, double budget) {
  std::vector<double> costs(goal.scales.size(), 0.0);
  std::vector<CertifiedValue> values(goal.scales.size());
  HeatGoal pilot = goal;
  pilot.watch_every_scale = true;
  pilot.max_work = static_cast<std::int64_t>(std::min(1e15, budget / kLanczosEntry));
  const std::size_t stride = std::max<std::size_t>(1, targets.size() / kPilotTargets);
  std::size_t sampled = 0;
  for (std::size_t k = stride / 2; k < targets.size(); k += stride) {
    if (targets[k].trivial()) continue;
    bracketer.run(targets[k], pilot, values);
    ++sampled;
    for (std::size_t s = 0; s < costs.size(); ++s) {
      const bool reached = goal.reached(values[s], s);
      costs[s] += reached ? kLanczosEntry * static_cast<double>(bracketer.work_at(s)) : kInfinity;
    }
  }
  for (double& cost : costs) cost /= static_cast<double>(std::max<std::size_t>(1, sampled));
  return costs;
}

HeatPlan plan(std::span<const double> scales, std::span<const double> lanczos,
              std::size_t target_count, double rational, double setup) {
  std::vector<std::size_t> order(scales.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return scales[a] < scales[b]; });

  const auto targets = static_cast<double>(target_count);
  double best = kInfinity;
  std::size_t split = 0;  // scales before it in `order` go to Lanczos
  double run = 0.0;       // cost of the Lanczos run that reaches them
  for (std::size_t count = 0; count <= order.size(); ++count) {
    if (count > 0) run = std::max(run, targets * lanczos[order[count - 1]]);
    const auto rest = static_cast<double>(order.size() - count);
    const double cost = run + (rest > 0 ? setup + rest * rational : 0.0);
    if (cost < best) {
      best = cost;
      split = count;
    }
  }

  HeatPlan result{std::vector<bool>(scales.size(), false), std::vector<std::string>(scales.size())};
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool by_rational = k >= split;
    result.rational[order[k]] = by_rational;
    result.reasons[order[k]] =
        by_rational ? "rational: estimated " + seconds_text(rational) + " in all, local Lanczos " +
                          seconds_text(targets * lanczos[order[k]])
                    : "local Lanczos: estimated " + seconds_text(targets * lanczos[order[k]]) +
                          " in all, rational " + seconds_text(setup + rational);
  }
  return result;
}

}  // namespace isotherm::spectral::detail
