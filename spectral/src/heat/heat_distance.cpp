#include "isotherm/spectral/heat/heat_distance.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
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
  result.widest = 0.0;
  for (std::size_t k = 0; k < result.values.size(); ++k) {
    const auto& value = result.values[k];
    result.widest = std::max(result.widest, value.width());
    if (!goal.reached(value, k % result.scales.size())) ++result.unconverged;
  }
}

constexpr Index kUnreachable = std::numeric_limits<Index>::max();

/// Number of edges to the nearest of `sources`.
std::vector<Index> hops_from(const SparseMatrix& laplacian, const std::vector<Index>& sources) {
  std::vector<Index> hops(laplacian.rows(), kUnreachable);
  std::vector<Index> queue;
  for (const Index vertex : sources) {
    if (hops[vertex] == 0) continue;
    hops[vertex] = 0;
    queue.push_back(vertex);
  }
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const Index vertex = queue[head];
    for (SparseMatrix::InnerIterator entry(laplacian, vertex); entry; ++entry) {
      const auto neighbour = static_cast<Index>(entry.row());
      if (hops[neighbour] != kUnreachable) continue;
      hops[neighbour] = hops[vertex] + 1;
      queue.push_back(neighbour);
    }
  }
  return hops;
}

}  // namespace

void HeatDistanceOptions::validate() const {
  if (!(tolerance > 0.0)) throw InvalidArgument("tolerance", "must be positive");
  if (max_steps < 1) throw InvalidArgument("max_steps", "must be at least 1");
  if (threads < 0) throw InvalidArgument("threads", "must not be negative");
  if (method == HeatMethod::exact) throw InvalidArgument("method", "is not a method to choose");
}

std::vector<double> HeatDistanceResult::column(std::size_t scale) const {
  std::vector<double> column(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) column[k] = at(k, scale).value;
  return column;
}

struct HeatDistance::Impl {
  WeightedGraph graph;
  std::vector<bool> present;  // per edge of the graph
  SparseMatrix laplacian;     // of the edges that are present
  HeatDistanceOptions options;

  std::vector<std::size_t> touched_pairs(const HeatDistanceResult& result,
                                         const std::vector<Index>& ends) const;
};

/// The pairs whose evaluation looked at a vertex of `ends`: within m - 1 hops
/// for a run of m Lanczos steps, anywhere in its component for other methods.
std::vector<std::size_t> HeatDistance::Impl::touched_pairs(const HeatDistanceResult& result,
                                                           const std::vector<Index>& ends) const {
  const auto hops = hops_from(laplacian, ends);
  const auto scale_count = result.scales.size();
  std::vector<std::size_t> touched;
  for (std::size_t k = 0; k < result.pairs.size(); ++k) {
    const auto [from, to] = result.pairs[k];
    const auto begin = result.methods.begin() + static_cast<std::ptrdiff_t>(k * scale_count);
    const auto end = begin + static_cast<std::ptrdiff_t>(scale_count);
    const bool local = std::find(begin, end, HeatMethod::rational) == end;
    const Index nearest = std::min(hops[from], hops[to]);
    const Index reach = local ? result.steps[k] - 1 : kUnreachable - 1;
    if (from != to && nearest <= reach) touched.push_back(k);
  }
  return touched;
}

HeatDistance::HeatDistance(const WeightedGraph& graph, HeatDistanceOptions options)
    : impl_(std::make_unique<Impl>()) {
  options.validate();
  impl_->graph = graph;
  impl_->present.assign(graph.edges().size(), true);
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
  result.by_rational = std::move(table.plan.rational);
  summarise(result, impl_->options.tolerance);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

std::int64_t HeatDistance::remove_edges(std::span<const Index> edges, HeatDistanceResult& result) {
  const auto start = std::chrono::steady_clock::now();
  const Index edge_count = impl_->graph.edge_count();
  for (const Index edge : edges) {
    if (edge < 0 || edge >= edge_count) throw InvalidArgument("edges", "no such edge");
  }
  std::vector<Index> ends;
  for (const Index edge : edges) {
    if (!impl_->present[edge]) continue;
    impl_->present[edge] = false;
    ends.push_back(impl_->graph.edge(edge).from);
    ends.push_back(impl_->graph.edge(edge).to);
  }
  const auto touched = impl_->touched_pairs(result, ends);
  impl_->laplacian = Laplacian(filter_edges(impl_->graph, impl_->present)).matrix();

  std::vector<VertexPair> pairs;
  for (const std::size_t k : touched) pairs.push_back(result.pairs[k]);
  const detail::HeatEngine engine(impl_->laplacian, impl_->options);
  const auto table = engine.evaluate(targets_of(pairs), result.scales, result.thresholds,
                                     detail::HeatPlan{result.by_rational, result.reasons});
  const auto scale_count = static_cast<std::ptrdiff_t>(result.scales.size());
  for (std::size_t k = 0; k < touched.size(); ++k) {
    const auto source = static_cast<std::ptrdiff_t>(k) * scale_count;
    const auto target = static_cast<std::ptrdiff_t>(touched[k]) * scale_count;
    std::copy_n(table.values.begin() + source, scale_count, result.values.begin() + target);
    std::copy_n(table.methods.begin() + source, scale_count, result.methods.begin() + target);
    result.steps[touched[k]] = table.steps[k];
  }
  summarise(result, impl_->options.tolerance);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return static_cast<std::int64_t>(touched.size());
}

HeatDistanceResult heat_distances(const WeightedGraph& graph, std::span<const VertexPair> pairs,
                                  std::span<const double> scales,
                                  const HeatDistanceOptions& options) {
  return HeatDistance(graph, options).evaluate(pairs, scales);
}

}  // namespace isotherm::spectral
