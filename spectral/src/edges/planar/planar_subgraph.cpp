#include "edges/planar/planar_subgraph.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>
#include <utility>

#include "edges/planar/planarity.hpp"
#include "edges/planar/plane_map.hpp"
#include "isotherm/base/error.hpp"

namespace isotherm::spectral::detail {
namespace {

class PlanarSearch {
 public:
  PlanarSearch(const WeightedGraph& graph, std::span<const double> worth,
               std::span<const double> suspicion, const PlanarSubgraphOptions& options)
      : graph_(graph),
        worth_(worth),
        suspicion_(suspicion),
        options_(options),
        chosen_(graph.edges().size(), false) {
    for (Index e = 0; e < graph.edge_count(); ++e) {
      if (graph.edge(e).from != graph.edge(e).to) order_.push_back(e);
    }
    std::stable_sort(order_.begin(), order_.end(),
                     [suspicion](Index a, Index b) { return suspicion[a] < suspicion[b]; });
  }

  /// The first pass; false if the graph is not nearly planar.
  bool start() {
    if (!has_few_enough_edges(graph_, options_)) return false;
    const auto count = static_cast<double>(order_.size());
    return add(order_, chosen_, static_cast<std::size_t>(options_.most_left_out * count));
  }

  void improve() {
    bool better = true;
    for (int round = 0; round < options_.rounds && better; ++round) {
      better = false;
      for (const Index edge : select([this](Index e) { return is_worth_forcing(e); })) {
        if (may_go_on() && !chosen_[edge] && force(edge)) better = true;
      }
      for (const Index edge : in_the_way()) {
        if (may_go_on() && chosen_[edge] && replace(edge)) better = true;
      }
    }
  }

  PlanarSubgraph result() {
    // Changes may have made room far from where they were made.
    for (const Index edge : select([this](Index e) { return !chosen_[e]; })) {
      chosen_[edge] = true;
      if (!test(chosen_)) chosen_[edge] = false;
    }
    PlanarSubgraph result{chosen_, 0.0, work_};
    for (std::size_t e = 0; e < chosen_.size(); ++e) {
      if (chosen_[e]) result.worth += worth_[e];
    }
    return result;
  }

 private:
  static constexpr std::size_t kFarthest = 10;  // crossings of an edge that is forced in
  static constexpr std::size_t kMostLost = 4;   // edges that do not fit again after it

  /// What is known about the edges chosen at present.
  struct Drawing {
    PlaneMap map;
    std::vector<bool> nearly;  // edges left out that cross one edge at most
  };

  bool is_worth_forcing(Index edge) const {
    return !chosen_[edge] && worth_[edge] >= options_.least_forced;
  }

  template <class Condition>
  std::vector<Index> select(Condition condition) const {
    std::vector<Index> edges;
    std::copy_if(order_.begin(), order_.end(), std::back_inserter(edges), condition);
    return edges;
  }

  bool may_go_on() const {
    const Progress progress{"planar subgraph", static_cast<std::uint64_t>(work_),
                            static_cast<std::uint64_t>(options_.budget)};
    if (options_.progress && !options_.progress(progress)) throw Cancelled();
    return work_ <= options_.budget;
  }

  bool test(const std::vector<bool>& chosen) {
    work_ += static_cast<double>(graph_.edge_count());
    return is_planar(graph_, chosen);
  }

  /// Adds edges as far as they fit, in order, in batches that double after a success and
  /// halve after a failure; false if more than so many do not fit, or the budget is used up.
  bool add(std::span<const Index> edges, std::vector<bool>& chosen, std::size_t most_left_out) {
    std::size_t batch = edges.size(), left_out = 0;
    while (!edges.empty()) {
      if (!may_go_on()) return false;
      batch = std::min(batch, edges.size());
      for (const Index edge : edges.first(batch)) chosen[edge] = true;
      if (test(chosen)) {
        edges = edges.subspan(batch);
        batch *= 2;
        continue;
      }
      for (const Index edge : edges.first(batch)) chosen[edge] = false;
      if (batch > 1) {
        batch /= 2;
        continue;
      }
      if (++left_out > most_left_out) return false;
      edges = edges.subspan(1);
    }
    return true;
  }

  /// Those of the more suspicious half of the chosen edges that edges left out would cross,
  /// the most suspicious first.
  std::vector<Index> in_the_way() {
    std::vector<bool> crossed(chosen_.size(), false);
    for (const Index e : select([this](Index edge) { return !chosen_[edge]; })) {
      for (const Index across :
           drawing().map.crossed_edges(graph_.edge(e).from, graph_.edge(e).to)) {
        crossed[across] = true;
      }
    }
    const auto chosen = select([this](Index e) { return chosen_[e]; });
    std::vector<Index> found;
    for (std::size_t k = chosen.size(); k > chosen.size() / 2; --k) {
      if (crossed[chosen[k - 1]]) found.push_back(chosen[k - 1]);
    }
    return found;
  }

  Drawing& drawing() {
    if (!drawing_) {
      drawing_ = std::make_unique<Drawing>(Drawing{PlaneMap(graph_, chosen_), {}});
      drawing_->nearly.assign(chosen_.size(), false);
      for (const Index e : select([this](Index edge) { return !chosen_[edge]; })) {
        drawing_->nearly[e] = crossings(drawing_->map, e) <= 1;
      }
    }
    return *drawing_;
  }

  int crossings(PlaneMap& map, Index edge) const {
    return map.crossings(graph_.edge(edge).from, graph_.edge(edge).to, 1);
  }

  /// Adds what fits of the edges left out that have come closer to fitting.
  void refill(std::vector<bool>& other) {
    PlaneMap map(graph_, other);
    const auto is_candidate = [&](Index e) {
      if (other[e] || chosen_[e]) return false;
      const int now = crossings(map, e);
      return now == 0 || (now == 1 && !drawing().nearly[e]);
    };
    const auto candidates = select(is_candidate);
    add(candidates, other, candidates.size());
  }

  bool force(Index edge) {
    auto& map = drawing().map;
    const auto crossed = map.crossed_edges(graph_.edge(edge).from, graph_.edge(edge).to);
    if (crossed.size() > kFarthest) return false;
    auto other = chosen_;
    for (const Index across : crossed) take_out_around(across, map, other);
    if (crossed.empty()) {
      for (const Index end : {graph_.edge(edge).from, graph_.edge(edge).to}) {
        for (const auto& near : graph_.neighbours(end)) {
          if (chosen_[near.edge]) take_out_around(near.edge, map, other);
        }
      }
    }
    other[edge] = true;
    if (!test(other)) return false;
    const auto again = select([&](Index e) { return chosen_[e] && !other[e]; });
    if (!add(again, other, kMostLost)) return false;
    refill(other);
    return take_over(std::move(other));
  }

  static void take_out_around(Index edge, const PlaneMap& map, std::vector<bool>& other) {
    for (const HalfEdge side : {2 * edge, 2 * edge + 1}) {
      for (const HalfEdge half : map.face_beside(side)) other[half / 2] = false;
    }
  }

  bool replace(Index edge) {
    auto other = chosen_;
    other[edge] = false;
    refill(other);
    return take_over(std::move(other));
  }

  bool take_over(std::vector<bool>&& other) {
    constexpr double kRounding = 1e-9;
    double gain = 0.0, relief = 0.0;
    for (std::size_t e = 0; e < other.size(); ++e) {
      if (other[e] == chosen_[e]) continue;
      gain += other[e] ? worth_[e] : -worth_[e];
      relief += other[e] ? -suspicion_[e] : suspicion_[e];
    }
    if (gain < -kRounding || (gain < kRounding && relief < kRounding)) return false;
    chosen_ = std::move(other);
    drawing_.reset();
    return true;
  }

  const WeightedGraph& graph_;
  std::span<const double> worth_;
  std::span<const double> suspicion_;
  const PlanarSubgraphOptions& options_;
  std::vector<bool> chosen_;
  std::vector<Index> order_;  // by suspicion
  std::unique_ptr<Drawing> drawing_;
  double work_ = 0.0;
};

}  // namespace

bool has_few_enough_edges(const WeightedGraph& graph, const PlanarSubgraphOptions& options) {
  double edges = 0.0, vertices = 0.0;
  for (const auto& [from, to, weight] : graph.edges()) edges += from == to ? 0.0 : 1.0;
  for (Index v = 0; v < graph.vertex_count(); ++v) {
    if (!graph.neighbours(v).empty()) vertices += 1.0;
  }
  return (1.0 - options.most_left_out) * edges <= 3.0 * vertices;
}

PlanarSubgraph find_planar_subgraph(const WeightedGraph& graph, std::span<const double> worth,
                                    std::span<const double> suspicion,
                                    const PlanarSubgraphOptions& options) {
  PlanarSearch search(graph, worth, suspicion, options);
  if (!search.start()) return {};
  search.improve();
  return search.result();
}

}  // namespace isotherm::spectral::detail
