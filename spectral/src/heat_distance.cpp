#include "isotherm/spectral/heat_distance.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "heat_bracket.hpp"
#include "isotherm/spectral/laplacian.hpp"
#include "pair_pattern.hpp"
#include "parallel.hpp"

namespace isotherm::spectral {
namespace {

void check_scales(std::span<const double> scales) {
  for (std::size_t k = 0; k < scales.size(); ++k) {
    if (std::isfinite(scales[k]) && scales[k] >= 0.0) continue;
    throw InvalidArgument("scales[" + std::to_string(k) + "]", "must be finite and not negative");
  }
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

  void run_lanczos(HeatDistanceResult& result, const detail::HeatGoal& goal) const {
    const auto scale_count = result.scales.size();
    const std::span values(result.values);
    const auto workspace = [this] { return detail::HeatBracketer(laplacian); };
    const auto body = [&](detail::HeatBracketer& bracketer, std::int64_t k) {
      const auto row = static_cast<std::size_t>(k);
      const auto pair = result.pairs[row];
      if (pair.from == pair.to) {
        std::fill_n(result.methods.begin() + k * scale_count, scale_count, HeatMethod::exact);
        return;
      }
      result.steps[row] = bracketer.run(pair, goal, values.subspan(row * scale_count, scale_count));
    };
    detail::parallel_for(static_cast<std::int64_t>(result.pairs.size()), options.threads,
                         options.progress, "heat distances", workspace, body);
  }
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
  check_scales(scales);
  if (!thresholds.empty() && thresholds.size() != scales.size()) {
    throw InvalidArgument("thresholds", "must have one entry per scale");
  }
  HeatDistanceResult result;
  result.pairs.assign(pairs.begin(), pairs.end());
  result.scales.assign(scales.begin(), scales.end());
  result.values.resize(pairs.size() * scales.size());
  result.methods.assign(result.values.size(), HeatMethod::lanczos);
  result.steps.assign(pairs.size(), 0);
  result.reasons.assign(scales.size(), "the only method");

  const detail::HeatGoal goal{result.scales, impl_->options.tolerance, thresholds,
                              impl_->options.max_steps};
  impl_->run_lanczos(result, goal);
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
