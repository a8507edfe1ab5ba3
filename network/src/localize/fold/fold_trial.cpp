#include "localize/fold/fold_trial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "localize/refine/refine.hpp"

namespace isotherm::network::detail {
namespace {

// The part with its surroundings as a network of its own.
class Trial {
 public:
  Trial(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
        const Evidence& evidence, const Crowd& crowd, const Placement& placement, const Fold& fold)
      : problem_(problem),
        trusted_(trusted),
        gate_(gate),
        evidence_(evidence),
        crowd_(crowd),
        placement_(placement),
        fold_(fold) {
    gather_nodes();
    gather_pairs();
  }

  FoldOutcome run() {
    if (!others_span_space()) return {};
    const double before = cost();
    for (const Index v : fold_.part) {
      const auto k = place_of(v);
      local_.positions.col(k) = fold_.mirrored(local_.positions.col(k));
    }
    relax();
    FoldOutcome outcome;
    outcome.extra = cost() - before;
    const double apart = 4.0 * frame_.typical_sigma;
    std::vector<Eigen::Index> which;
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      if ((local_.positions.col(column) - placement_.positions.col(nodes_[k])).norm() <= apart) {
        continue;
      }
      which.push_back(column);
      outcome.moved.push_back(nodes_[k]);
    }
    outcome.positions = local_.positions(Eigen::all, which);
    return outcome;
  }

 private:
  Index place_of(Index node) const {
    const auto found = std::lower_bound(nodes_.begin(), nodes_.end(), node);
    return found != nodes_.end() && *found == node ? static_cast<Index>(found - nodes_.begin())
                                                   : -1;
  }

  bool is_free(Index node) const { return std::binary_search(free_.begin(), free_.end(), node); }

  void visit_neighbours(const std::vector<Index>& nodes, auto&& visit) const {
    for (const Index v : nodes) {
      for (const auto& [vertex, edge] : problem_.pair_graph.neighbours(v)) {
        if (trusted_[edge] && placement_.placed[vertex]) visit(vertex, edge);
      }
    }
  }

  static void make_set(std::vector<Index>& nodes) {
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }

  // The part and the neighbours that it is tied to are free; theirs are there, but stay. If
  // these do not span space nothing shows which of the two sides was mirrored.
  void gather_nodes() {
    free_ = fold_.part;
    visit_neighbours(fold_.part, [&](Index vertex, Index edge) {
      const bool fits = squared_deviation(placement_, problem_.pairs[edge]) <= gate_;
      if (fits && !problem_.is_anchor[vertex]) free_.push_back(vertex);
    });
    make_set(free_);
    if (!others_span_space()) free_ = fold_.part;
    nodes_ = free_;
    visit_neighbours(free_, [&](Index vertex, Index) { nodes_.push_back(vertex); });
    make_set(nodes_);
    frame_.dimension = problem_.dimension;
    frame_.nodes = static_cast<Index>(nodes_.size());
    for (const Index v : nodes_) frame_.is_anchor.push_back(!is_free(v));
    local_.positions = placement_.positions(Eigen::all, nodes_);
    local_.placed.assign(nodes_.size(), true);
    others_ = placement_.placed;
    for (const Index v : free_) others_[v] = false;
  }

  // Whether the nodes around the free ones do.
  bool others_span_space() const {
    std::vector<Index> others;
    visit_neighbours(free_, [&](Index vertex, Index) {
      if (!is_free(vertex)) others.push_back(vertex);
    });
    make_set(others);
    return span_space(problem_, placement_, others);
  }

  void gather_pairs() {
    std::vector<Index> edges;
    visit_neighbours(free_, [&](Index, Index edge) { edges.push_back(edge); });
    make_set(edges);
    for (const Index edge : edges) {
      auto pair = problem_.pairs[edge];
      pair.from = place_of(pair.from);
      pair.to = place_of(pair.to);
      pairs_.push_back(pair);
      frame_.sigmas.push_back(pair.sigma);
    }
    frame_.typical_sigma = lower_median(frame_.sigmas);
  }

  void relax() {
    constexpr std::array<double, 3> kWidths = {4.0, 2.0, 1.0};  // of the gate
    constexpr int kIterations = 10;
    for (const double factor : kWidths) {
      const double width = factor * std::sqrt(gate_);
      std::vector<Spring> springs;
      for (const auto& pair : pairs_) {
        springs.push_back({pair.from, pair.to, pair.distance, pair.sigma, width, width});
      }
      refine(frame_, springs, local_, {.max_iterations = kIterations});
    }
  }

  double cost() const {
    double sum = 0.0;
    for (const auto& pair : pairs_) {
      sum += evidence_.cost_of(pair.sigma)(deviation(local_, pair));
    }
    for (std::size_t a = 0; a < free_.size(); ++a) {
      const Point place = local_.positions.col(place_of(free_[a]));
      sum += crowd_.absence_cost(free_[a], place, others_);
      for (std::size_t b = a + 1; b < free_.size(); ++b) {
        const double distance = (local_.positions.col(place_of(free_[b])) - place).norm();
        if (distance >= evidence_.absence.reach() || has_range(problem_, free_[a], free_[b])) {
          continue;
        }
        sum += evidence_.absence.cost(distance);
      }
    }
    return sum;
  }

  const RangeProblem& problem_;
  const std::vector<bool>& trusted_;
  double gate_;
  const Evidence& evidence_;
  const Crowd& crowd_;
  const Placement& placement_;
  const Fold& fold_;
  std::vector<Index> free_;       // nodes that move
  std::vector<Index> nodes_;      // all
  std::vector<bool> others_;      // placed nodes that do not move
  RangeProblem frame_;            // of the nodes, those that stay for anchors
  Placement local_;               // of the same
  std::vector<RangePair> pairs_;  // between them, of nodes that move
};

}  // namespace

FoldOutcome try_fold(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
                     const Evidence& evidence, const Crowd& crowd, const Placement& placement,
                     const Fold& fold) {
  return Trial(problem, trusted, gate, evidence, crowd, placement, fold).run();
}

}  // namespace isotherm::network::detail
