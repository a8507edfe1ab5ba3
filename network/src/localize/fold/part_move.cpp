#include "localize/fold/part_move.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "localize/constants.hpp"
#include "localize/problem/point_grid.hpp"
#include "localize/refine/refine.hpp"

namespace isotherm::network::detail {
namespace {

// The part with its surroundings as a network of its own.
class Trial {
 public:
  Trial(const MapTask& task, const Evidence& evidence, const Crowd& crowd,
        const Placement& placement, const PartMove& move)
      : task_(task),
        problem_(task.problem),
        evidence_(evidence),
        crowd_(crowd),
        placement_(placement),
        move_(move) {
    gather_nodes();
    gather_pairs();
  }

  MoveOutcome run() {
    if (!others_span_space()) return {};
    const double before = cost();
    for (std::size_t k = 0; k < move_.part.size(); ++k) {
      local_.positions.col(place_of(move_.part[k])) =
          move_.positions.col(static_cast<Eigen::Index>(k));
    }
    relax();
    MoveOutcome outcome;
    outcome.extra = cost() - before;
    const double apart = kApart * frame_.typical_sigma;
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
    for (const Index v : nodes) task_.visit_neighbours(placement_, v, visit);
  }

  static void make_set(std::vector<Index>& nodes) {
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }

  // The part and the neighbours that it is tied to are free; theirs are there, but stay. If
  // these do not span space nothing shows which of the two sides was mirrored.
  void gather_nodes() {
    free_ = move_.part;
    visit_neighbours(move_.part, [&](Index vertex, Index edge) {
      const bool fits = task_.fits(placement_, problem_.pairs[edge]);
      if (fits && !problem_.is_anchor[vertex]) free_.push_back(vertex);
    });
    make_set(free_);
    if (!others_span_space()) free_ = move_.part;
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
    constexpr double kStill = 1e-3;  // the next stage goes on from here
    std::vector<Spring> springs;
    for (const auto& pair : pairs_) {
      springs.push_back({pair.from, pair.to, pair.distance, pair.sigma});
    }
    for (const double factor : kWidths) {
      for (auto& spring : springs) {
        spring.width_apart = spring.width_close = factor * std::sqrt(task_.gate);
      }
      refine(frame_, springs, local_, {.max_iterations = kIterations, .still = kStill});
    }
    add_absent(springs);
    refine_likelihood(frame_, springs, evidence_, kIterations, local_);
  }

  void add_absent(std::vector<Spring>& springs) const {
    const double reach = evidence_.absence.reach();
    if (!(reach > 0.0)) return;
    const auto wanted = [&](Index a, Index b) {
      return !(frame_.is_anchor[a] && frame_.is_anchor[b]) &&
             !has_range(problem_, nodes_[a], nodes_[b]);
    };
    for (const auto& [a, b] : near_pairs(local_.positions, reach, wanted)) {
      springs.push_back({.from = a, .to = b, .couples = false, .absent = true});
    }
  }

  double cost() const {
    double sum = 0.0;
    for (const auto& pair : pairs_) {
      sum += evidence_.cost_of(pair.sigma)(deviation(local_, pair));
    }
    const double reach = evidence_.absence.reach();
    if (!(reach > 0.0)) return sum;
    PointGrid before(reach);  // those that have had their turn
    for (const Index v : free_) {
      const Point place = local_.positions.col(place_of(v));
      sum += crowd_.absence_cost(v, place, others_);
      before.visit_near(place, reach, [&](Index other, const Point& position) {
        if (has_range(problem_, v, other)) return;
        sum += evidence_.absence.cost(distance_between(position, place));
      });
      before.insert(v, place);
    }
    return sum;
  }

  const MapTask& task_;
  const RangeProblem& problem_;
  const Evidence& evidence_;
  const Crowd& crowd_;
  const Placement& placement_;
  const PartMove& move_;
  std::vector<Index> free_;       // nodes that move
  std::vector<Index> nodes_;      // all
  std::vector<bool> others_;      // placed nodes that do not move
  RangeProblem frame_;            // of the nodes, those that stay for anchors
  Placement local_;               // of the same
  std::vector<RangePair> pairs_;  // between them, of nodes that move
};

}  // namespace

Index largest_part(const RangeProblem& problem, const Placement& placement) {
  return problem.anchored() ? kLargestPart : std::min(kLargestPart, placed_count(placement) / 2);
}

MoveOutcome try_move(const MapTask& task, const Evidence& evidence, const Crowd& crowd,
                     const Placement& placement, const PartMove& move) {
  return Trial(task, evidence, crowd, placement, move).run();
}

std::vector<MoveOutcome> gains(const MapTask& task, const Evidence& evidence,
                               const Placement& placement, const std::vector<PartMove>& moves) {
  const Crowd crowd(task.problem, placement, evidence.absence);
  std::vector<MoveOutcome> outcomes(moves.size());
  task.in_parallel(moves.size(), "parts", [&](std::int64_t k) {
    outcomes[k] = try_move(task, evidence, crowd, placement, moves[k]);
  });
  std::erase_if(outcomes, [](const MoveOutcome& outcome) {
    return outcome.extra >= -kBetter || outcome.moved.empty();
  });
  std::stable_sort(outcomes.begin(), outcomes.end(),
                   [](const MoveOutcome& a, const MoveOutcome& b) { return a.extra < b.extra; });
  return outcomes;
}

std::vector<Index> take_moves(const RangeProblem& problem, const std::vector<MoveOutcome>& moves,
                              Placement& placement) {
  std::vector<bool> touched(problem.nodes, false);
  std::vector<Index> moved;
  for (const auto& move : moves) {
    const bool overlaps =
        std::any_of(move.moved.begin(), move.moved.end(), [&](Index v) { return touched[v]; });
    if (overlaps) continue;
    moved.insert(moved.end(), move.moved.begin(), move.moved.end());
    for (std::size_t k = 0; k < move.moved.size(); ++k) {
      const Index v = move.moved[k];
      placement.positions.col(v) = move.positions.col(static_cast<Eigen::Index>(k));
      touched[v] = true;
      for (const auto& neighbour : problem.pair_graph.neighbours(v)) {
        touched[neighbour.vertex] = true;
      }
    }
  }
  return moved;
}

}  // namespace isotherm::network::detail
