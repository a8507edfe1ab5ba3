// What was written by hand where a library has the same, beside that library: planarity (Boost),
// points nearer than another and points near a growing set (nanoflann). Prints the table of
// docs/results/libraries.md.
// usage: library_speed GRAPH      (an edge list: Minnesota's roads)
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boyer_myrvold_planar_test.hpp>
#include <nanoflann.hpp>

#include "edges/planar/planarity.hpp"
#include "graph/point_tree.hpp"
#include "isotherm/base/random.hpp"
#include "isotherm/spectral/graph/graph_file.hpp"
#include "localize/problem/point_grid.hpp"

namespace {

using namespace isotherm;
using spectral::Index;
using spectral::WeightedGraph;

/// Milliseconds, the best of five.
template <class Run>
double milliseconds(const Run& run) {
  double best = 1e300;
  for (int k = 0; k < 5; ++k) {
    const auto start = std::chrono::steady_clock::now();
    run();
    const std::chrono::duration<double, std::milli> taken =
        std::chrono::steady_clock::now() - start;
    best = std::min(best, taken.count());
  }
  return best;
}

void print_row(const std::string& what, const std::string& library, double ours, double theirs,
               bool same) {
  std::printf("| %s | %s | %.3f | %.3f | %.1f | %s |\n", what.c_str(), library.c_str(), ours,
              theirs, theirs / ours, same ? "yes" : "NO");
}

using BoostGraph =
    boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, boost::no_property,
                          boost::property<boost::edge_index_t, int>>;

bool is_planar_by_boost(const WeightedGraph& graph, const std::vector<bool>& chosen) {
  BoostGraph other(graph.vertex_count());
  int count = 0;
  for (Index e = 0; e < graph.edge_count(); ++e) {
    if (chosen[e]) boost::add_edge(graph.edge(e).from, graph.edge(e).to, count++, other);
  }
  return boost::boyer_myrvold_planarity_test(other);
}

/// With a twentieth as many edges between any two vertices, in random order.
WeightedGraph with_shortcuts(const WeightedGraph& graph, Random& random) {
  std::vector<spectral::WeightedEdge> edges(graph.edges().begin(), graph.edges().end());
  const auto vertex = [&] { return static_cast<Index>(random.index(graph.vertex_count())); };
  while (edges.size() < graph.edges().size() * 21 / 20) {
    const Index from = vertex(), to = vertex();
    if (from != to) edges.push_back({from, to, 1.0});
  }
  for (std::size_t k = edges.size(); k > 1; --k) std::swap(edges[k - 1], edges[random.index(k)]);
  return {graph.vertex_count(), std::move(edges)};
}

void compare_planarity(const std::string& path) {
  Random random(1);
  const auto graph = with_shortcuts(spectral::read_graph(path).graph, random);
  std::vector<bool> chosen(graph.edges().size(), false);
  for (std::size_t e = 0; e < chosen.size(); ++e) {  // as many as fit
    chosen[e] = true;
    chosen[e] = spectral::detail::is_planar(graph, chosen);
  }
  const auto compare = [&](const std::string& what, const std::vector<bool>& edges) {
    bool ours = false, theirs = false;
    const double own = milliseconds([&] { ours = spectral::detail::is_planar(graph, edges); });
    const double boost = milliseconds([&] { theirs = is_planar_by_boost(graph, edges); });
    print_row(what, "Boost.Graph", own, boost, ours == theirs);
  };
  compare("planarity: Minnesota with 5 % added edges, no",
          std::vector<bool>(graph.edges().size(), true));
  compare("planarity: as many of them as fit, yes", chosen);
}

/// The first points of a set, as nanoflann reads them.
struct Columns {
  const Eigen::MatrixXd& points;
  std::size_t count;

  std::size_t kdtree_get_point_count() const { return count; }
  double kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return points(static_cast<Eigen::Index>(axis), static_cast<Eigen::Index>(index));
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Metric = nanoflann::L2_Simple_Adaptor<double, Columns>;

/// Calls add(squared distance) for points nearer than a radius, none of which is kept.
template <class Add>
struct Nearer {
  using DistanceType = double;
  using IndexType = Index;
  double squared;
  const Add& add;

  bool addPoint(double distance, Index) {
    if (distance < squared) add(distance);
    return true;
  }
  double worstDist() const { return squared; }
  bool full() const { return true; }
  std::size_t size() const { return 0; }
};

template <class Tree, class Add>
void for_nearer(const Tree& tree, const Eigen::VectorXd& place, double squared, const Add& add) {
  Nearer<Add> found{squared, add};
  tree.findNeighbors(found, place.data(), nanoflann::SearchParams());
}

Eigen::MatrixXd random_points(int dimension, Index count) {
  Random random(2);
  Eigen::MatrixXd points(dimension, count);
  for (double& x : points.reshaped()) x = random.uniform();
  return points;
}

void compare_counts(Index count) {
  constexpr int kPairs = 2000;
  const auto points = random_points(2, count);
  Random random(3);
  std::vector<std::pair<Index, Index>> pairs;
  for (int k = 0; k < kPairs; ++k) {
    pairs.emplace_back(random.index(count), random.index(count));
    if (pairs.back().first == pairs.back().second) pairs.pop_back();
  }
  long ours = 0, theirs = 0;
  const double own = milliseconds([&] {
    ours = 0;
    const spectral::detail::PointTree tree(points);
    for (const auto& [point, other] : pairs) ours += tree.count_nearer(point, other);
  });
  const double nanoflann = milliseconds([&] {
    theirs = -static_cast<long>(pairs.size());  // each point counts itself
    const Columns columns{points, static_cast<std::size_t>(count)};
    const nanoflann::KDTreeSingleIndexAdaptor<Metric, Columns, -1, Index> tree(2, columns);
    for (const auto& [point, other] : pairs) {
      const double squared = (points.col(point) - points.col(other)).squaredNorm();
      for_nearer(tree, points.col(point), squared, [&](double) { ++theirs; });
    }
  });
  print_row("points nearer than another: " + std::to_string(count) + " points, " +
                std::to_string(pairs.size()) + " pairs",
            "nanoflann", own, nanoflann, ours == theirs);
}

/// Five looks around for every point that is put in, as the localiser places nodes.
void compare_growth(int dimension, Index count) {
  constexpr int kLooks = 5;
  const auto points = random_points(dimension, count);
  const double radius = std::pow(4.0 / count, 1.0 / dimension);
  const auto look = [&](Index v, const auto& see) {
    for (int k = 0; k < kLooks; ++k) see(Eigen::VectorXd(points.col((v + 7 * k) % count)));
  };
  long ours = 0, theirs = 0;
  const double own = milliseconds([&] {
    ours = 0;
    network::detail::PointGrid grid(radius);
    for (Index v = 0; v < count; ++v) {
      grid.insert(v, points.col(v));
      look(v, [&](const Eigen::VectorXd& place) {
        grid.visit_near(place, radius, [&](Index, const network::detail::Point& other) {
          if ((place - other).squaredNorm() < radius * radius) ++ours;
        });
      });
    }
  });
  const double nanoflann = milliseconds([&] {
    theirs = 0;
    Columns columns{points, 0};
    nanoflann::KDTreeSingleIndexDynamicAdaptor<Metric, Columns, -1, Index> tree(dimension, columns);
    for (Index v = 0; v < count; ++v) {
      ++columns.count;
      tree.addPoints(v, v);
      look(v, [&](const Eigen::VectorXd& place) {
        for_nearer(tree, place, radius * radius, [&](double) { ++theirs; });
      });
    }
  });
  print_row("points near a growing set: " + std::to_string(count) + " in " +
                std::to_string(dimension) + "-D",
            "nanoflann", own, nanoflann, ours == theirs);
}

}  // namespace

int main(int count, char** values) {
  if (count != 2) {
    std::fprintf(stderr, "usage: library_speed GRAPH\n");
    return 2;
  }
  std::printf("| what | library | ours, ms | library, ms | ratio | same answers |\n");
  std::printf("| --- | --- | --- | --- | --- | --- |\n");
  compare_planarity(values[1]);
  for (const Index points : {2'000, 20'000, 100'000}) compare_counts(points);
  for (const int dimension : {2, 3}) {
    for (const Index points : {1'000, 10'000}) compare_growth(dimension, points);
  }
}
