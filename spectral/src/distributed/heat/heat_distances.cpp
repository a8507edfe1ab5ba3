#include <algorithm>
#include <chrono>
#include <utility>

#include "distributed/heat/heat_queries.hpp"
#include "heat/heat_engine.hpp"
#include "sparse/pair_pattern.hpp"

namespace isotherm::spectral::distributed {
namespace {

using detail::HeatQuery;
using spectral::detail::HeatGoal;

/// Pairs on their way to the rank of their first row and back.
class Journey {
  auto owner() const {
    return [this](const VertexPair& pair) { return graph_.rows.owner(pair.from); };
  }

 public:
  Journey(const Graph::State& graph, std::span<const VertexPair> pairs) : graph_(graph) {
    std::vector<Index> ends;
    for (const auto& pair : pairs) ends.insert(ends.end(), {pair.from, pair.to});
    ends = detail::look_up(graph.comm(), graph.blocks, std::span<const Index>(graph.row_of),
                           std::span<const Index>(ends));
    for (std::size_t k = 0; k < pairs.size(); ++k) rows_.push_back({ends[2 * k], ends[2 * k + 1]});
    asked_ = detail::exchange(graph.comm(), std::span<const VertexPair>(rows_), owner());
  }

  std::span<const VertexPair> here() const { return asked_.items; }

  /// What was asked for, from what was found for here().
  template <class Answer>
  std::vector<Answer> back(const std::vector<Answer>& answers) const {
    return detail::reply<Answer>(graph_.comm(), asked_, std::span<const Answer>(answers),
                                 std::span<const VertexPair>(rows_), owner());
  }

 private:
  const Graph::State& graph_;
  std::vector<VertexPair> rows_;
  detail::Delivery<VertexPair> asked_;
};

void deliver(const Journey& journey, const std::vector<HeatQuery>& queries,
             HeatDistanceResult& result) {
  std::vector<CertifiedValue> values(queries.size());
  for (std::size_t s = 0; s < result.scales.size(); ++s) {
    for (std::size_t k = 0; k < queries.size(); ++k) values[k] = queries[k].values[s];
    const auto mine = journey.back(values);
    for (std::size_t k = 0; k < mine.size(); ++k) {
      result.values[k * result.scales.size() + s] = mine[k];
    }
  }
  std::vector<std::int32_t> steps;
  for (const auto& query : queries) steps.push_back(query.steps);
  result.steps = journey.back(steps);
}

void summarise(const detail::Comm& comm, const HeatGoal& goal, HeatDistanceResult& result) {
  for (std::size_t k = 0; k < result.values.size(); ++k) {
    const auto& value = result.values[k];
    result.widest = std::max(result.widest, value.width());
    if (!goal.reached(value, k % result.scales.size())) ++result.unconverged;
    if (!is_precise(value)) ++result.imprecise;
  }
  result.widest = detail::most(comm, result.widest);
  result.unconverged = detail::sum(comm, result.unconverged);
  result.imprecise = detail::sum(comm, result.imprecise);
}

}  // namespace

HeatDistanceResult heat_distances(const Graph& graph, std::span<const VertexPair> pairs,
                                  std::span<const double> scales,
                                  const HeatDistanceOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const auto& state = graph.state();
  const auto& comm = state.comm();
  detail::together(comm, [&] {
    options.validate();
    spectral::detail::check_pairs(pairs, graph.vertex_count());
    spectral::detail::check_scales(scales);
  });
  HeatDistanceResult result;
  result.pairs.assign(pairs.begin(), pairs.end());
  result.scales.assign(scales.begin(), scales.end());
  result.values.resize(pairs.size() * scales.size());
  result.reasons.assign(scales.size(), "Lanczos: nothing is factorised over ranks");
  for (const auto& pair : pairs) {
    const bool same = pair.from == pair.to;
    result.methods.insert(result.methods.end(), scales.size(),
                          same ? HeatMethod::exact : HeatMethod::lanczos);
  }

  const HeatGoal goal{result.scales, options.tolerance, {}, options.max_steps};
  const Journey journey(state, pairs);
  std::vector<HeatQuery> queries;
  std::vector<std::size_t> places;  // of queries among those here
  for (std::size_t k = 0; k < journey.here().size(); ++k) {
    const auto& rows = journey.here()[k];
    if (rows.from == rows.to) continue;
    queries.push_back({rows, std::vector<CertifiedValue>(scales.size()), 0});
    places.push_back(k);
  }
  if (!scales.empty()) {
    const detail::Steps steps(comm, options.progress);
    const auto far = detail::answer_nearby(state, goal, steps, queries);
    detail::answer_everywhere(state, goal, steps, far, queries);
  }
  std::vector<HeatQuery> all(journey.here().size(),
                             {{}, std::vector<CertifiedValue>(scales.size()), 0});
  for (std::size_t k = 0; k < queries.size(); ++k) all[places[k]] = std::move(queries[k]);
  deliver(journey, all, result);
  summarise(comm, goal, result);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace isotherm::spectral::distributed
