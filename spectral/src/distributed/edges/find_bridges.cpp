#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "distributed/graph/file_order.hpp"
#include "graph/bridges.hpp"

namespace isotherm::spectral::distributed {
namespace detail {
namespace {

/// What of the graph can decide over bridges beyond this rank: an edge stands for one between
/// ranks, or for a chain of this rank's bridges of which all are bridges or none is.
struct Link {
  std::int64_t from = 0;  // nodes, numbered over all ranks
  std::int64_t to = 0;
};

/// This rank's part: its two-edge-connected parts are nodes of a forest, whose edges are what looks
/// like a bridge from here.
class Forest {
 public:
  explicit Forest(const Graph::State& graph) : graph_(graph), bridge_(graph.edges.size(), false) {
    find_nodes();
    mark_portals();
    drop_leaves();
    link_chains();
  }

  /// Whether each of `graph.edges` is a bridge, given which of links() are.
  std::vector<bool> resolve(const std::vector<bool>& link_is_bridge) const {
    auto bridge = bridge_;
    for (std::size_t k = 0; k < links_.size(); ++k) {
      for (const auto edge : edges_of_link_[k]) bridge[edge] = link_is_bridge[k];
    }
    return bridge;
  }

  const std::vector<Link>& links() const { return links_; }

 private:
  struct Way {
    Index node = 0;
    std::size_t edge = 0;
  };

  bool is_local(const RowEdge& edge) const { return graph_.owns(edge.to); }
  Index local(Index row) const { return row - graph_.first_row(); }

  void find_nodes() {
    std::vector<WeightedEdge> edges;
    std::vector<std::size_t> number;
    for (std::size_t k = 0; k < graph_.edges.size(); ++k) {
      const auto& edge = graph_.edges[k];
      if (!is_local(edge)) continue;
      edges.push_back({local(edge.from), local(edge.to), 1.0});
      number.push_back(k);
    }
    const WeightedGraph inner(static_cast<Index>(graph_.row_count()), std::move(edges));
    const auto apart = spectral::detail::find_bridges(inner);
    auto together = apart;
    together.flip();
    const auto parts = connected_components(filter_edges(inner, together));
    node_of_ = parts.label;
    ways_.resize(static_cast<std::size_t>(parts.count));
    portal_.assign(ways_.size(), false);
    for (Index e = 0; e < inner.edge_count(); ++e) {
      if (!apart[e]) continue;
      const auto [from, to] = std::pair(node_of_[inner.edge(e).from], node_of_[inner.edge(e).to]);
      ways_[from].push_back({to, number[e]});
      ways_[to].push_back({from, number[e]});
    }
  }

  /// Nodes from which an edge leads to another rank, whichever rank has it.
  void mark_portals() {
    std::vector<Index> there;
    for (const auto& edge : graph_.edges) {
      if (is_local(edge)) continue;
      there.push_back(edge.to);
      portal_[node_of_[local(edge.from)]] = true;
    }
    const auto here = exchange(graph_.comm(), std::span<const Index>(there),
                               [&](Index row) { return graph_.rows.owner(row); });
    for (const Index row : here.items) portal_[node_of_[local(row)]] = true;
  }

  /// What hangs on one edge, and leads nowhere, hangs on a bridge.
  void drop_leaves() {
    std::vector<Index> leaves;
    degree_.reserve(ways_.size());
    for (std::size_t node = 0; node < ways_.size(); ++node) {
      degree_.push_back(ways_[node].size());
      if (is_leaf(static_cast<Index>(node))) leaves.push_back(static_cast<Index>(node));
    }
    while (!leaves.empty()) {
      const Index leaf = leaves.back();
      leaves.pop_back();
      for (const auto& [other, edge] : ways_[leaf]) {
        if (bridge_[edge]) continue;
        bridge_[edge] = true;
        --degree_[leaf];
        --degree_[other];
        if (is_leaf(other)) leaves.push_back(other);
      }
    }
  }
  bool is_leaf(Index node) const { return !portal_[node] && degree_[node] == 1; }
  bool is_kept(Index node) const { return portal_[node] || degree_[node] > 2; }

  /// Links between nodes that are kept, and those to other ranks.
  void link_chains() {
    base_ = sum_before(graph_.comm(), static_cast<std::int64_t>(ways_.size()));
    std::vector<bool> done(graph_.edges.size(), false);
    for (std::size_t node = 0; node < ways_.size(); ++node) {
      if (!is_kept(static_cast<Index>(node))) continue;
      for (const auto& way : ways_[node]) {
        if (!bridge_[way.edge] && !done[way.edge]) follow(static_cast<Index>(node), way, done);
      }
    }
    std::vector<std::int64_t> keys;
    for (const Index node : node_of_) keys.push_back(base_ + node);
    std::vector<Index> there;
    std::vector<std::size_t> edges;
    for (std::size_t k = 0; k < graph_.edges.size(); ++k) {
      if (is_local(graph_.edges[k])) continue;
      there.push_back(graph_.edges[k].to);
      edges.push_back(k);
    }
    const auto other = look_up(graph_.comm(), graph_.rows, std::span<const std::int64_t>(keys),
                               std::span<const Index>(there));
    for (std::size_t k = 0; k < edges.size(); ++k) {
      links_.push_back({keys[local(graph_.edges[edges[k]].from)], other[k]});
      edges_of_link_.push_back({edges[k]});
    }
  }

  void follow(Index start, Way way, std::vector<bool>& done) {
    std::vector<std::size_t> edges = {way.edge};
    done[way.edge] = true;
    while (!is_kept(way.node)) {
      const auto next =
          std::find_if(ways_[way.node].begin(), ways_[way.node].end(),
                       [&](const Way& on) { return !bridge_[on.edge] && !done[on.edge]; });
      way = *next;
      done[way.edge] = true;
      edges.push_back(way.edge);
    }
    links_.push_back({base_ + start, base_ + way.node});
    edges_of_link_.push_back(std::move(edges));
  }

  const Graph::State& graph_;
  std::vector<bool> bridge_;    // of graph.edges: for sure
  std::vector<Index> node_of_;  // of rows
  std::vector<std::vector<Way>> ways_;
  std::vector<bool> portal_;
  std::vector<std::size_t> degree_;
  std::int64_t base_ = 0;  // of the numbers of this rank's nodes
  std::vector<Link> links_;
  std::vector<std::vector<std::size_t>> edges_of_link_;
};

/// Whether each link is a bridge of what all links make: as many as there are edges between ranks.
std::vector<bool> bridges_among(const std::vector<Link>& links) {
  std::map<std::int64_t, Index> number;
  std::vector<WeightedEdge> edges;
  const auto of = [&](std::int64_t node) {
    return number.try_emplace(node, static_cast<Index>(number.size())).first->second;
  };
  for (const auto& [from, to] : links) {
    const Index start = of(from), end = of(to);
    edges.push_back({start, end, 1.0});
  }
  return spectral::detail::find_bridges({static_cast<Index>(number.size()), std::move(edges)});
}

}  // namespace
}  // namespace detail

std::vector<bool> find_bridges(const Graph& graph) {
  const auto& state = graph.state();
  const detail::Forest forest(state);
  const auto& mine = forest.links();
  const auto all = detail::bridges_among(detail::concatenate(state.comm(), mine));
  const auto first = detail::sum_before(state.comm(), static_cast<std::int64_t>(mine.size()));
  const auto bridges = forest.resolve(
      {all.begin() + first, all.begin() + first + static_cast<std::int64_t>(mine.size())});
  const std::vector<char> values(bridges.begin(), bridges.end());
  const auto in_order = detail::FileOrder(state).to_file(values);
  return {in_order.begin(), in_order.end()};
}

}  // namespace isotherm::spectral::distributed
