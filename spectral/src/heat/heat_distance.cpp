#include "isotherm/spectral/heat/heat_distance.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "heat/heat_engine.hpp"
#include "isotherm/spectral/graph/laplacian.hpp"
#include "sparse/pair_pattern.hpp"

namespace isotherm::spectral {
namespace {

using detail::HeatTarget;

std::vector<HeatTarget> targets_of(std::span<const VertexPair> pairs) {
  std::vector<HeatTarget> targets;
  targets.reserve(pairs.size());
  for (const auto& pair : pairs) targets.push_back({pair.from, pair.to});
  return targets;
}

void summarise(HeatDistanceResult& result, double tolerance) {
  const detail::HeatGoal goal{result.scales, tolerance, result.thresholds};
  result.unconverged = 0;
  result.imprecise = 0;
  result.widest = 0.0;
  for (std::size_t k = 0; k < result.values.size(); ++k) {
    const auto& value = result.values[k];
    result.widest = std::max(result.widest, value.width());
    if (!goal.reached(value, k % result.scales.size())) ++result.unconverged;
    if (!is_precise(value)) ++result.imprecise;
  }
}

}  // namespace

std::string words_of_imprecise(std::int64_t imprecise, std::int64_t all, std::string_view what) {
  return std::to_string(imprecise) + " of " + std::to_string(all) + ' ' + std::string(what) +
         " have bounds wider than 1e-6 relative";
}

void HeatDistanceOptions::validate() const {
  require_fields_in_range(*this);
  if (threads < 0) throw InvalidArgument("threads", "must not be negative");
  if (method == HeatMethod::exact) throw InvalidArgument("method", "is not a method to choose");
}

std::vector<double> HeatDistanceResult::column(std::size_t scale) const {
  std::vector<double> column(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) column[k] = at(k, scale).value;
  return column;
}

struct HeatDistance::Impl {
  SparseMatrix laplacian;
  HeatDistanceOptions options;
};

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
  detail::check_scales(scales);
  if (!thresholds.empty() && thresholds.size() != scales.size()) {
    throw InvalidArgument("thresholds", "must have one entry per scale");
  }
  HeatDistanceResult result;
  result.pairs.assign(pairs.begin(), pairs.end());
  result.scales.assign(scales.begin(), scales.end());
  result.thresholds.assign(thresholds.begin(), thresholds.end());
  const detail::HeatEngine engine(impl_->laplacian, impl_->options);
  auto table = engine.evaluate(targets_of(pairs), scales, thresholds);
  result.values = std::move(table.values);
  result.methods = std::move(table.methods);
  result.steps = std::move(table.steps);
  result.reasons = std::move(table.plan.reasons);
  summarise(result, impl_->options.tolerance);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

HeatDistanceResult heat_distances(const WeightedGraph& graph, std::span<const VertexPair> pairs,
                                  std::span<const double> scales,
                                  const HeatDistanceOptions& options) {
  return HeatDistance(graph, options).evaluate(pairs, scales);
}

}  // namespace isotherm::spectral
