#include "localize/fold/fold_axes.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>

#include "localize/constants.hpp"

namespace isotherm::network::detail {
namespace {

constexpr std::size_t kLeast = 3;

// A trusted pair of placed nodes, as one of them sees it.
struct PairTie {
  Index vertex = 0;  // the other
  double distance = 0.0;
  double sigma = 1.0;
  RangeCost cost_by_residual;
  double squared = 0.0;  // distance of their places
  double cost = 0.0;     // as things stand
  // Squared distances beyond which the tie is broken.
  double least = 0.0;
  double most = 0.0;

  // What it costs that the ends are this far from each other.
  double cost_at(double length) const { return cost_by_residual((length - distance) / sigma); }
};

// The ties of all nodes, side by side: a search goes over them again and again.
class PairTies {
 public:
  PairTies(const MapTask& task, const Evidence& evidence, const Placement& placement) {
    for (Index v = 0; v < task.problem.nodes; ++v) {
      places_.emplace_back(placement.positions.col(v));
      first_.push_back(ties_.size());
      if (!placement.placed[v]) continue;
      task.visit_neighbours(placement, v, [&](Index vertex, Index edge) {
        const auto& pair = task.problem.pairs[edge];
        const Eigen::Vector2d arm = placement.positions.col(v) - placement.positions.col(vertex);
        PairTie tie{vertex, pair.distance, pair.sigma, evidence.cost_of(pair.sigma),
                    arm.squaredNorm()};
        tie.cost = tie.cost_at(std::sqrt(tie.squared));
        limit(tie);
        ties_.push_back(tie);
      });
    }
    first_.push_back(ties_.size());
  }

  std::span<const PairTie> of(Index node) const {
    return std::span(ties_).subspan(first_[node], first_[node + 1] - first_[node]);
  }

  const Eigen::Vector2d& place(Index node) const { return places_[node]; }

 private:
  // A broken one costs more than before by half of what a range that does not fit does.
  static void limit(PairTie& tie) {
    const auto& cost = tie.cost_by_residual;
    const double broken = tie.cost + kBroken * cost.anything;
    const double apart = tie.distance + tie.sigma * cost.apart_at(broken);
    const double close = tie.distance - tie.sigma * cost.close_at(broken);
    tie.most = apart * apart;
    tie.least = close > 0.0 ? close * close : -1.0;
  }

  std::vector<Eigen::Vector2d> places_;
  std::vector<std::size_t> first_;  // node -> its first tie
  std::vector<PairTie> ties_;
};

// The folds in lines through one node after the other.
class AxisSearch {
 public:
  AxisSearch(const RangeProblem& problem, const PairTies& ties, double most_cost,
             const Placement& placement)
      : problem_(problem),
        ties_(ties),
        most_cost_(most_cost),
        most_(largest_part(problem, placement)),
        known_(problem.nodes, 0),
        part_of_(problem.nodes, 0),
        strings_(problem.nodes, {0, 0}) {}

  void add_folds_through(Index node, std::vector<Fold>& found) {
    for (const auto& tie : ties_.of(node)) {
      if (tie.vertex < node || !(tie.squared > 0.0)) continue;
      through_ = ties_.place(node);
      const Eigen::Vector2d along = ties_.place(tie.vertex) - through_;
      normal_ = Eigen::Vector2d(-along.y(), along.x()).normalized();
      ++axis_number_;
      for (const Index end : {node, tie.vertex}) add_folds_beside(end, found);
    }
  }

 private:
  // Parts that begin next to a node of the axis.
  void add_folds_beside(Index end, std::vector<Fold>& found) {
    for (const auto& to_first : ties_.of(end)) {
      const Index first = to_first.vertex;
      if (!can_turn(first) || is_known(first)) continue;
      const double height_of_first = height(first);
      for (const auto& to_second : ties_.of(first)) {
        const Index second = to_second.vertex;
        if (!can_turn(second) || is_known(second)) continue;
        if (!breaks(to_second, height_of_first)) continue;
        std::vector<Index> part = {first, second};
        const bool whole = grow(part);
        if (part.size() < kLeast) {  // joined by a false range, perhaps
          for (const Index v : part) known_[v] = 0;
          continue;
        }
        if (whole) add_fold(std::move(part), found);
        break;
      }
    }
  }

  bool can_turn(Index node) const { return !problem_.is_anchor[node]; }

  bool is_known(Index node) const { return known_[node] == axis_number_; }

  void add(Index node) {
    known_[node] = axis_number_;
    part_of_[node] = part_number_;
  }

  // From two nodes; false if it comes to a part that was large or is known, to too many nodes, or
  // if ties to anchors, which do not turn, cost too much.
  bool grow(std::vector<Index>& part) {
    ++part_number_;
    for (const Index v : part) add(v);
    double cost = 0.0;
    for (std::size_t k = 0; k < part.size(); ++k) {
      const double turned = height(part[k]);
      for (const auto& tie : ties_.of(part[k])) {
        if (part_of_[tie.vertex] == part_number_ || !breaks(tie, turned)) continue;
        if (!can_turn(tie.vertex)) {
          cost += extra_cost(tie, turned);
          if (cost > most_cost_) return false;
          continue;
        }
        auto& [number, count] = strings_[tie.vertex];
        if (number != part_number_) count = 0;
        number = part_number_;
        if (++count < 2) continue;
        if (is_known(tie.vertex)) return false;
        add(tie.vertex);
        part.push_back(tie.vertex);
        if (static_cast<Index>(part.size()) > most_) return false;
      }
    }
    return true;
  }

  void add_fold(std::vector<Index> part, std::vector<Fold>& found) const {
    std::sort(part.begin(), part.end());
    const double cost = cost_of(part);
    if (cost > most_cost_) return;
    found.push_back({std::move(part), through_, normal_, cost});
  }

  // All nodes of the part that was grown last.
  double cost_of(const std::vector<Index>& part) const {
    double cost = 0.0;
    for (const Index v : part) {
      for (const auto& tie : ties_.of(v)) {
        if (part_of_[tie.vertex] != part_number_) cost += extra_cost(tie, height(v));
      }
    }
    return cost;
  }

  // Squared distance of the ends of a tie if the one at a height is mirrored, the other not.
  double mirrored(const PairTie& tie, double turned) const {
    return std::max(0.0, tie.squared + 4.0 * turned * height(tie.vertex));
  }

  double extra_cost(const PairTie& tie, double turned) const {
    return tie.cost_at(std::sqrt(mirrored(tie, turned))) - tie.cost;
  }

  bool breaks(const PairTie& tie, double turned) const {
    const double squared = mirrored(tie, turned);
    return squared > tie.most || squared < tie.least;
  }

  // Above the axis.
  double height(Index node) const { return normal_.dot(ties_.place(node) - through_); }

  const RangeProblem& problem_;
  const PairTies& ties_;
  double most_cost_;         // of a part
  Index most_;               // nodes of a part
  Eigen::Vector2d through_;  // the axis
  Eigen::Vector2d normal_;
  int axis_number_ = 0;
  int part_number_ = 0;
  std::vector<int> known_;                    // the last axis at which the node was in a part
  std::vector<int> part_of_;                  // the last part that the node was in
  std::vector<std::pair<int, int>> strings_;  // a part, and by how many pairs it holds the node
};

// Whether most nodes of either part are in both.
bool are_alike(const std::vector<Index>& a, const std::vector<Index>& b) {
  const double least = kAlike * static_cast<double>(std::max(a.size(), b.size()));
  if (static_cast<double>(std::min(a.size(), b.size())) < least) return false;
  std::vector<Index> both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return static_cast<double>(both.size()) >= least;
}

// Each part in one line, and of parts that are alike a few: they differ by what is near the line.
// Given the cheapest first.
std::vector<Fold> cheapest_of_alike(std::vector<Fold> folds) {
  constexpr int kMostAlike = 2;
  std::vector<Fold> kept;
  std::unordered_map<Index, std::vector<std::size_t>> kept_with;  // node -> places in `kept`
  for (auto& fold : folds) {
    std::set<std::size_t> rivals;
    for (const Index v : fold.part) rivals.insert(kept_with[v].begin(), kept_with[v].end());
    int alike = 0;
    bool known = false;
    for (const auto k : rivals) {
      known = known || kept[k].part == fold.part;
      alike += are_alike(kept[k].part, fold.part) ? 1 : 0;
    }
    if (known || alike >= kMostAlike) continue;
    for (const Index v : fold.part) kept_with[v].push_back(kept.size());
    kept.push_back(std::move(fold));
  }
  return kept;
}

}  // namespace

Point Fold::mirrored(const Point& point) const {
  return point - 2.0 * normal.dot(point - through) * normal;
}

PartMove Fold::move(const Placement& placement) const {
  PartMove result{part, placement.positions(Eigen::all, part)};
  for (auto place : result.positions.colwise()) place = mirrored(place).eval();
  return result;
}

std::vector<Fold> find_folds(const MapTask& task, const Evidence& evidence,
                             const Placement& placement, const std::vector<bool>& among) {
  constexpr Index kBlock = 64;  // nodes that share the memory of a search
  const RangeProblem& problem = task.problem;
  if (problem.dimension != 2) return {};
  const Index blocks = (problem.nodes + kBlock - 1) / kBlock;
  const PairTies ties(task, evidence, placement);
  const double most_cost = kMostBroken * evidence.cost_of(problem.typical_sigma).anything;
  std::vector<std::vector<Fold>> found(blocks);
  task.in_parallel(blocks, "folds", [&](std::int64_t block) {
    AxisSearch search(problem, ties, most_cost, placement);
    const auto first = static_cast<Index>(block) * kBlock;
    for (Index v = first; v < std::min(problem.nodes, first + kBlock); ++v) {
      if (among[v]) search.add_folds_through(v, found[block]);
    }
  });
  std::vector<Fold> folds;
  for (auto& some : found) std::move(some.begin(), some.end(), std::back_inserter(folds));
  std::stable_sort(folds.begin(), folds.end(),
                   [](const Fold& a, const Fold& b) { return a.cost < b.cost; });
  return cheapest_of_alike(std::move(folds));
}

}  // namespace isotherm::network::detail
