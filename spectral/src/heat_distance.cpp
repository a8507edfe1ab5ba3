#include "isotherm/spectral/heat_distance.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "heat_bracket.hpp"
#include "heat_plan.hpp"
#include "isotherm/spectral/laplacian.hpp"
#include "pair_pattern.hpp"
#include "parallel.hpp"
#include "rational_heat.hpp"

namespace isotherm::spectral {
namespace {

void check_scales(std::span<const double> scales) {
  for (std::size_t k = 0; k < scales.size(); ++k) {
    if (std::isfinite(scales[k]) && scales[k] >= 0.0) continue;
    throw InvalidArgument("scales[" + std::to_string(k) + "]", "must be finite and not negative");
  }
}

constexpr CertifiedValue kZero = {0.0, 0.0, 0.0};
constexpr CertifiedValue kUnknown = {1.0, 0.0, 2.0};  // nothing but what holds for every graph
constexpr double kAnalysisEntry = 300.0;  // nanoseconds an entry for ordering and analysis

/// What the rational method needs, made when first asked for.
class RationalEngine {
 public:
  RationalEngine(const SparseMatrix& laplacian, std::span<const VertexPair> pairs, double tolerance)
      : laplacian_(laplacian),
        pairs_(pairs.begin(), pairs.end()),
        approximation_(detail::rational_exponential_for(tolerance)) {
    for (auto& pair : pairs_) {
      if (pair.from == pair.to) pair = {-1, -1};
    }
  }

  const detail::RationalExponential& approximation() const { return approximation_; }

  const detail::SupernodalStructure& structure() {
    if (!structure_) {
      const SparseMatrix lower = laplacian_.triangularView<Eigen::Lower>();
      structure_ = detail::analyse(detail::with_pairs(lower, pairs_));
    }
    return *structure_;
  }

  detail::FrontQueries queries() { return detail::locate(structure(), pairs_); }

 private:
  const SparseMatrix& laplacian_;
  std::vector<VertexPair> pairs_;
  const detail::RationalExponential& approximation_;
  std::optional<detail::SupernodalStructure> structure_;
};

bool all_of(const std::vector<bool>& flags) {
  return std::find(flags.begin(), flags.end(), false) == flags.end();
}

bool any_open(const HeatDistanceResult& result, const detail::HeatGoal& goal, std::size_t scale) {
  for (std::size_t k = 0; k < result.pairs.size(); ++k) {
    if (!goal.reached(result.at(k, scale), scale)) return true;
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

void summarise(HeatDistanceResult& result, const detail::HeatGoal& goal) {
  for (std::size_t k = 0; k < result.values.size(); ++k) {
    const auto& value = result.values[k];
    result.widest = std::max(result.widest, value.width());
    if (!goal.reached(value, k % result.scales.size())) ++result.unconverged;
  }
}

}  // namespace

void HeatDistanceOptions::validate() const {
  if (!(tolerance > 0.0)) throw InvalidArgument("tolerance", "must be positive");
  if (max_steps < 1) throw InvalidArgument("max_steps", "must be at least 1");
  if (threads < 0) throw InvalidArgument("threads", "must not be negative");
  if (method == HeatMethod::exact) throw InvalidArgument("method", "is not a method to choose");
}

std::vector<VertexPair> edge_pairs(const WeightedGraph& graph) {
  std::vector<VertexPair> pairs;
  pairs.reserve(graph.edges().size());
  for (const auto& edge : graph.edges()) pairs.push_back({edge.from, edge.to});
  return pairs;
}

std::vector<double> HeatDistanceResult::column(std::size_t scale) const {
  std::vector<double> column(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) column[k] = at(k, scale).value;
  return column;
}

struct HeatDistance::Impl {
  SparseMatrix laplacian;
  HeatDistanceOptions options;

  detail::HeatPlan choose(const HeatDistanceResult& result, const detail::HeatGoal& goal,
                          RationalEngine& engine) const;
  void run_lanczos(HeatDistanceResult& result, const detail::HeatGoal& goal) const;
  void run_rational(HeatDistanceResult& result, const detail::HeatGoal& goal,
                    std::span<const std::size_t> scales, RationalEngine& engine) const;
};

detail::HeatPlan HeatDistance::Impl::choose(const HeatDistanceResult& result,
                                            const detail::HeatGoal& goal,
                                            RationalEngine& engine) const {
  const auto scale_count = result.scales.size();
  if (options.method != HeatMethod::automatic) {
    return {std::vector<bool>(scale_count, options.method == HeatMethod::rational),
            std::vector<std::string>(scale_count, "asked for")};
  }
  // Without a factorisation to compare with, a run is worth this much before
  // it is worth analysing the matrix.
  const auto pair_count = static_cast<double>(result.pairs.size());
  const double setup = kAnalysisEntry * static_cast<double>(laplacian.nonZeros());
  detail::HeatBracketer pilot(laplacian, options.tolerance);
  auto costs = detail::lanczos_costs(pilot, result.pairs, goal, setup / pair_count);
  if (pair_count * *std::max_element(costs.begin(), costs.end()) <= setup) {
    return {std::vector<bool>(scale_count, false),
            std::vector<std::string>(
                scale_count, "local Lanczos: cheaper than analysing the matrix for the other")};
  }
  const double rational = detail::rational_cost(engine.structure(), engine.approximation());
  const double everything = setup + static_cast<double>(scale_count) * rational;
  costs = detail::lanczos_costs(pilot, result.pairs, goal, 2.0 * everything / pair_count);
  return detail::plan(result.scales, costs, result.pairs.size(), rational, 0.0);
}

void HeatDistance::Impl::run_lanczos(HeatDistanceResult& result,
                                     const detail::HeatGoal& goal) const {
  constexpr std::size_t kGrain = 8;
  const auto scale_count = result.scales.size();
  const std::span values(result.values);
  detail::parallel_for(
      static_cast<std::int64_t>(result.pairs.size()), kGrain, options.threads, options.progress,
      "heat distances", [this] { return detail::HeatBracketer(laplacian, options.tolerance); },
      [&](detail::HeatBracketer& bracketer, std::int64_t k) {
        const auto row = static_cast<std::size_t>(k);
        const auto pair = result.pairs[row];
        if (pair.from == pair.to) return;
        result.steps[row] =
            bracketer.run(pair, goal, values.subspan(row * scale_count, scale_count));
      });
}

/// Brings every pair that `goal` does not accept yet at the given scales there,
/// narrowing the brackets that Lanczos left.
void HeatDistance::Impl::run_rational(HeatDistanceResult& result, const detail::HeatGoal& goal,
                                      std::span<const std::size_t> scales,
                                      RationalEngine& engine) const {
  if (scales.empty()) return;
  const auto pair_count = result.pairs.size();
  const auto scale_count = result.scales.size();
  std::vector<double> times;
  for (const std::size_t s : scales) times.push_back(result.scales[s]);
  std::vector<CertifiedValue> values(pair_count * scales.size());
  detail::rational_heat_distances(engine.structure(), engine.queries(), engine.approximation(),
                                  times, options.threads, options.progress, values);
  for (std::size_t k = 0; k < pair_count; ++k) {
    if (result.pairs[k].from == result.pairs[k].to) continue;
    for (std::size_t s = 0; s < scales.size(); ++s) {
      const std::size_t index = k * scale_count + scales[s];
      if (goal.reached(result.values[index], scales[s])) continue;
      result.values[index] = intersection(result.values[index], values[s * pair_count + k]);
      result.methods[index] = HeatMethod::rational;
    }
  }
}

HeatDistance::HeatDistance(const WeightedGraph& graph, HeatDistanceOptions options)
    : impl_(std::make_unique<Impl>()) {
  options.validate();
  impl_->laplacian = Laplacian(graph).matrix();
  impl_->options = std::move(options);
}

HeatDistance::~HeatDistance() = default;
HeatDistance::HeatDistance(HeatDistance&&) noexcept = default;
HeatDistance& HeatDistance::operator=(HeatDistance&&) noexcept = default;

HeatDistanceResult HeatDistance::evaluate(std::span<const VertexPair> pairs,
                                          std::span<const double> scales) const {
  return evaluate(pairs, scales, {});
}

HeatDistanceResult HeatDistance::evaluate(std::span<const VertexPair> pairs,
                                          std::span<const double> scales,
                                          std::span<const double> thresholds) const {
  const auto start = std::chrono::steady_clock::now();
  detail::check_pairs(pairs, static_cast<Index>(impl_->laplacian.rows()));
  check_scales(scales);
  if (!thresholds.empty() && thresholds.size() != scales.size()) {
    throw InvalidArgument("thresholds", "must have one entry per scale");
  }
  HeatDistanceResult result;
  result.pairs.assign(pairs.begin(), pairs.end());
  result.scales.assign(scales.begin(), scales.end());
  result.steps.assign(pairs.size(), 0);
  result.reasons.assign(scales.size(), "no pairs");
  for (const auto& pair : pairs) {
    const bool trivial = pair.from == pair.to;
    result.values.insert(result.values.end(), scales.size(), trivial ? kZero : kUnknown);
    result.methods.insert(result.methods.end(), scales.size(),
                          trivial ? HeatMethod::exact : HeatMethod::lanczos);
  }
  if (result.values.empty()) return result;

  detail::HeatGoal goal{result.scales, impl_->options.tolerance, thresholds,
                        impl_->options.max_steps};
  RationalEngine engine(impl_->laplacian, result.pairs, impl_->options.tolerance);
  const auto plan = impl_->choose(result, goal, engine);
  result.reasons = plan.reasons;
  goal.optional = plan.rational;
  if (!all_of(plan.rational)) impl_->run_lanczos(result, goal);

  std::vector<std::size_t> rational_scales;
  for (std::size_t s = 0; s < scales.size(); ++s) {
    const bool failed = impl_->options.method == HeatMethod::automatic && any_open(result, goal, s);
    if (plan.rational[s] || failed) rational_scales.push_back(s);
    if (failed && !plan.rational[s]) {
      result.reasons[s] += "; pairs that it did not bracket in max_steps went to rational";
    }
  }
  impl_->run_rational(result, goal, rational_scales, engine);
  summarise(result, goal);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

HeatDistanceResult heat_distances(const WeightedGraph& graph, std::span<const VertexPair> pairs,
                                  std::span<const double> scales,
                                  const HeatDistanceOptions& options) {
  return HeatDistance(graph, options).evaluate(pairs, scales);
}

}  // namespace isotherm::spectral
