#include "edges/planar/planarity.hpp"

#include <algorithm>
#include <utility>

namespace isotherm::spectral::detail {
namespace {

constexpr Index kNone = -1;

/// A range of back edges, linked from high to low by LeftRightTest::below_.
struct Interval {
  Index low = kNone;
  Index high = kNone;

  bool empty() const { return high == kNone; }
};

/// Back edges that have to pass on different sides.
struct ConflictPair {
  Interval left, right;
};

/// The left-right test; names follow Brandes where he has one.
class LeftRightTest {
 public:
  LeftRightTest(const WeightedGraph& graph, const std::vector<bool>& chosen)
      : graph_(graph),
        chosen_(chosen),
        vertices_(graph.vertex_count()),
        edges_(graph.edges().size()) {
    Index places = 0;
    for (Index vertex = 0; vertex < graph.vertex_count(); ++vertex) {
      vertices_[vertex].begin = vertices_[vertex].end = places;
      places += static_cast<Index>(graph.neighbours(vertex).size());
    }
    outgoing_.resize(static_cast<std::size_t>(places));
    for (Index vertex = 0; vertex < graph.vertex_count(); ++vertex) {
      if (vertices_[vertex].height == kNone && !graph.neighbours(vertex).empty()) orient(vertex);
    }
    order_outgoing();
  }

  bool run() {
    return std::all_of(roots_.begin(), roots_.end(), [this](Index root) { return test(root); });
  }

  /// To be called once, after a run that said yes.
  PlanarEmbedding embedding() {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (edges_[e].source != kNone) edges_[e].nesting *= resolve_side(static_cast<Index>(e));
    }
    order_outgoing();
    PlanarEmbedding drawing;
    drawing.clockwise.assign(2 * edges_.size(), PlanarEmbedding::kNone);
    before_.assign(2 * edges_.size(), PlanarEmbedding::kNone);
    for (const Index root : roots_) draw(root, drawing);
    return drawing;
  }

 private:
  struct Vertex {
    Index height = kNone;               // in the search tree
    Index parent = kNone;               // the tree edge that leads here
    Index begin = 0, end = 0;           // its places in outgoing_
    Index next = 0;                     // how many edges the search has done
    Index left = kNone, right = kNone;  // half-edges next to which back edges arrive
  };
  struct Edge {
    Index source = kNone;  // where the search went through it from
    Index lowpoint = 0;    // lowest height that it returns to
    Index second = 0;      // the lowest but one
    Index nesting = 0;     // order around the source, from the outside in
    Index lowest = kNone;  // back edge that returns to the low point
    Index below = kNone;   // back edge relative to which the side is given
    int side = 1;
    Index bottom = 0;  // height of the stack when the edge was entered
  };

  Index target(Index edge) const {
    const auto& ends = graph_.edge(edge);
    return edges_[edge].source == ends.from ? ends.to : ends.from;
  }
  bool is_tree(Index edge) const { return vertices_[target(edge)].parent == edge; }

  HalfEdge leaving(Index edge) const {
    return 2 * edge + (graph_.edge(edge).from == edges_[edge].source ? 0 : 1);
  }

  // First search: directs the edges, and finds where each returns to.
  void orient(Index root) {
    roots_.push_back(root);
    vertices_[root].height = 0;
    path_.assign(1, root);
    while (!path_.empty()) {
      const Index v = path_.back();
      const auto near = graph_.neighbours(v);
      if (vertices_[v].next == static_cast<Index>(near.size())) {
        path_.pop_back();
        const Index parent = vertices_[v].parent;
        if (parent != kNone) close(parent);
        continue;
      }
      const auto [w, e] = near[vertices_[v].next++];
      if (w == v || !chosen_[e] || edges_[e].source != kNone) continue;
      edges_[e].source = v;
      outgoing_[vertices_[v].end++] = e;
      edges_[e].lowpoint = edges_[e].second = vertices_[v].height;
      if (vertices_[w].height == kNone) {
        vertices_[w].parent = e;
        vertices_[w].height = vertices_[v].height + 1;
        path_.push_back(w);
      } else {
        edges_[e].lowpoint = vertices_[w].height;
        close(e);
      }
    }
  }

  // All that an edge leads to is known: its nesting depth, and what it means for the
  // edge before it.
  void close(Index e) {
    Edge& edge = edges_[e];
    const Vertex& source = vertices_[edge.source];
    edge.nesting = 2 * edge.lowpoint + (edge.second < source.height ? 1 : 0);
    if (source.parent == kNone) return;
    Edge& before = edges_[source.parent];
    if (edge.lowpoint < before.lowpoint) {
      before.second = std::min(before.lowpoint, edge.second);
      before.lowpoint = edge.lowpoint;
    } else if (edge.lowpoint > before.lowpoint) {
      before.second = std::min(before.second, edge.lowpoint);
    } else {
      before.second = std::min(before.second, edge.second);
    }
  }

  void order_outgoing() {
    for (auto& vertex : vertices_) {
      vertex.next = 0;
      if (vertex.end - vertex.begin < 2) continue;
      const auto first = outgoing_.begin() + vertex.begin;
      const auto last = outgoing_.begin() + vertex.end;
      std::sort(first, last, [this](Index a, Index b) {
        return std::pair(edges_[a].nesting, a) < std::pair(edges_[b].nesting, b);
      });
    }
  }

  // Second search: collects which back edges have to be on the same or different sides.
  bool test(Index root) {
    path_.assign(1, root);
    while (!path_.empty()) {
      const Index v = path_.back();
      Vertex& vertex = vertices_[v];
      if (vertex.begin + vertex.next == vertex.end) {
        path_.pop_back();
        if (vertex.parent == kNone) continue;
        trim_back_edges(vertex.parent);
        if (!leave(vertex.parent)) return false;
        continue;
      }
      const Index e = outgoing_[vertex.begin + vertex.next];
      edges_[e].bottom = static_cast<Index>(stack_.size());
      if (is_tree(e)) {
        path_.push_back(target(e));
        continue;
      }
      edges_[e].lowest = e;
      stack_.push_back({{}, {e, e}});
      if (!leave(e)) return false;
    }
    return true;
  }

  // The edge and all that it leads to is done: merges its return edges into those of
  // its source, whose next edge is then due.
  bool leave(Index e) {
    Vertex& source = vertices_[edges_[e].source];
    const bool first = source.next++ == 0;
    if (edges_[e].lowpoint >= source.height) return true;
    if (!first) return add_constraints(e, source.parent);
    edges_[source.parent].lowest = edges_[e].lowest;
    return true;
  }

  bool conflicting(const Interval& interval, Index e) const {
    return !interval.empty() && edges_[interval.high].lowpoint > edges_[e].lowpoint;
  }

  // Puts an interval below another.
  void append(Interval& upper, const Interval& lower) {
    if (upper.empty()) {
      upper.high = lower.high;
    } else {
      edges_[upper.low].below = lower.high;
    }
    upper.low = lower.low;
  }

  bool add_constraints(Index e, Index parent) {
    ConflictPair merged;
    // Return edges of e go to one side.
    while (static_cast<Index>(stack_.size()) > edges_[e].bottom) {
      ConflictPair top = pop();
      if (!top.left.empty()) std::swap(top.left, top.right);
      if (!top.left.empty()) return false;
      if (edges_[top.right.low].lowpoint > edges_[parent].lowpoint) {
        append(merged.right, top.right);
      } else {
        edges_[top.right.low].below = edges_[parent].lowest;
      }
    }
    // Those of earlier edges that return below e's go to the other.
    while (!stack_.empty() &&
           (conflicting(stack_.back().left, e) || conflicting(stack_.back().right, e))) {
      ConflictPair top = pop();
      if (conflicting(top.right, e)) std::swap(top.left, top.right);
      if (conflicting(top.right, e)) return false;
      if (!top.right.empty()) append(merged.right, top.right);
      append(merged.left, top.left);
    }
    if (!merged.left.empty() || !merged.right.empty()) stack_.push_back(merged);
    return true;
  }

  ConflictPair pop() {
    const ConflictPair top = stack_.back();
    stack_.pop_back();
    return top;
  }

  Index lowest_return(const ConflictPair& pair) const {
    if (pair.left.empty()) return edges_[pair.right.low].lowpoint;
    if (pair.right.empty()) return edges_[pair.left.low].lowpoint;
    return std::min(edges_[pair.left.low].lowpoint, edges_[pair.right.low].lowpoint);
  }

  // Return edges that end at the source of a tree edge constrain nothing before it.
  void trim_back_edges(Index e) {
    const Index u = edges_[e].source;
    while (!stack_.empty() && lowest_return(stack_.back()) == vertices_[u].height) {
      const ConflictPair top = pop();
      if (!top.left.empty()) edges_[top.left.low].side = -1;
    }
    if (!stack_.empty()) {
      ConflictPair top = pop();
      trim(top.left, top.right, u);
      trim(top.right, top.left, u);
      stack_.push_back(top);
    }
    if (edges_[e].lowpoint >= vertices_[u].height || stack_.empty()) return;
    const Index left = stack_.back().left.high;
    const Index right = stack_.back().right.high;
    const bool by_left =
        left != kNone && (right == kNone || edges_[left].lowpoint > edges_[right].lowpoint);
    edges_[e].below = by_left ? left : right;
  }

  void trim(Interval& interval, const Interval& other, Index u) {
    while (interval.high != kNone && target(interval.high) == u) {
      interval.high = edges_[interval.high].below;
    }
    if (interval.high != kNone || interval.low == kNone) return;
    edges_[interval.low].below = other.low;
    edges_[interval.low].side = -1;
    interval.low = kNone;
  }

  // Sides are given relative to each other: follows the links to an edge whose side is
  // final, and settles all on the way.
  int resolve_side(Index e) {
    path_.assign(1, e);
    while (edges_[path_.back()].below != kNone) path_.push_back(edges_[path_.back()].below);
    int side = 1;
    for (auto link = path_.rbegin(); link != path_.rend(); ++link) {
      edges_[*link].side *= side;
      side = edges_[*link].side;
      edges_[*link].below = kNone;
    }
    return side;
  }

  // Third search: puts the arriving half-edges between the leaving ones.
  void draw(Index root, PlanarEmbedding& drawing) {
    begin(root, PlanarEmbedding::kNone, drawing);
    path_.assign(1, root);
    while (!path_.empty()) {
      Vertex& vertex = vertices_[path_.back()];
      if (vertex.begin + vertex.next == vertex.end) {
        path_.pop_back();
        continue;
      }
      const Index e = outgoing_[vertex.begin + vertex.next++];
      const Index w = target(e);
      if (is_tree(e)) {
        const HalfEdge back = opposite(leaving(e));
        drawing.clockwise[back] = before_[back] = back;
        begin(w, back, drawing);
        vertex.left = vertex.right = leaving(e);
        path_.push_back(w);
      } else if (edges_[e].side == 1) {
        insert_after(vertices_[w].right, opposite(leaving(e)), drawing);
      } else {
        insert_after(before_[vertices_[w].left], opposite(leaving(e)), drawing);
        vertices_[w].left = opposite(leaving(e));
      }
    }
  }

  // The half-edge to the parent, then those that leave, in their order.
  void begin(Index v, HalfEdge first, PlanarEmbedding& drawing) {
    HalfEdge last = first;
    for (Index k = vertices_[v].begin; k < vertices_[v].end; ++k) {
      const HalfEdge half = leaving(outgoing_[k]);
      if (last == PlanarEmbedding::kNone) {
        drawing.clockwise[half] = before_[half] = half;
      } else {
        insert_after(last, half, drawing);
      }
      last = half;
    }
  }

  void insert_after(HalfEdge place, HalfEdge half, PlanarEmbedding& drawing) {
    const HalfEdge after = drawing.clockwise[place];
    drawing.clockwise[place] = before_[after] = half;
    drawing.clockwise[half] = after;
    before_[half] = place;
  }

  const WeightedGraph& graph_;
  const std::vector<bool>& chosen_;
  std::vector<Vertex> vertices_;
  std::vector<Edge> edges_;
  std::vector<Index> outgoing_;  // edges by source, in the order they are searched
  std::vector<Index> roots_;
  std::vector<ConflictPair> stack_;
  std::vector<Index> path_;
  std::vector<HalfEdge> before_;  // the one that `clockwise` leads here from
};

}  // namespace

bool is_planar(const WeightedGraph& graph, const std::vector<bool>& chosen) {
  return LeftRightTest(graph, chosen).run();
}

std::optional<PlanarEmbedding> embed_in_plane(const WeightedGraph& graph,
                                              const std::vector<bool>& chosen) {
  LeftRightTest test(graph, chosen);
  if (!test.run()) return std::nullopt;
  return test.embedding();
}

}  // namespace isotherm::spectral::detail
