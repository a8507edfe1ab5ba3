#pragma once

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

#include "distributed/graph/graph_state.hpp"

namespace isotherm::spectral::distributed::detail {

/// Values of edges, between the ranks that have these and the order of Graph::edges().
class FileOrder {
 public:
  explicit FileOrder(const Graph::State& graph) : graph_(graph) {
    for (const auto& edge : graph.edges) places_.push_back(edge.place);
    asked_ = exchange(graph.comm(), std::span<const std::int64_t>(places_), reader());
    order_.resize(asked_.items.size());
    std::iota(order_.begin(), order_.end(), 0);
    std::sort(order_.begin(), order_.end(),
              [this](std::size_t a, std::size_t b) { return asked_.items[a] < asked_.items[b]; });
  }

  /// Of this rank's edges in the order of the file.
  std::size_t count() const { return order_.size(); }

  /// From one value for each of `graph.edges`.
  template <class Value>
  std::vector<Value> to_file(const std::vector<Value>& values) const {
    const auto* first = values.data();
    const auto come =
        exchange(graph_.comm(), std::span<const Value>(values),
                 [&](const Value& value) { return reader()(places_[&value - first]); });
    std::vector<Value> result;
    for (const auto place : order_) result.push_back(come.items[place]);
    return result;
  }

  /// To one value for each of `graph.edges`.
  template <class Value>
  std::vector<Value> from_file(const std::vector<Value>& values) const {
    std::vector<Value> answers(values.size());
    for (std::size_t k = 0; k < values.size(); ++k) answers[order_[k]] = values[k];
    return reply<Value>(graph_.comm(), asked_, std::span<const Value>(answers),
                        std::span<const std::int64_t>(places_), reader());
  }

 private:
  struct Reader {
    const Blocks& places;
    int operator()(std::int64_t place) const { return places.owner(place); }
  };
  Reader reader() const { return {graph_.places}; }

  const Graph::State& graph_;
  std::vector<std::int64_t> places_;  // of this rank's edges
  Delivery<std::int64_t> asked_;      // of the edges that this rank read
  std::vector<std::size_t> order_;    // of these, by place
};

}  // namespace isotherm::spectral::distributed::detail
