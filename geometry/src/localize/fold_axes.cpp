#include "localize/fold_axes.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <unordered_map>
#include <utility>

#include "isotherm/base/parallel.hpp"

namespace isotherm::geometry::detail {
namespace {

constexpr std::size_t kLeast = 3;
constexpr Index kMost = 200;
// Most that a fold may cost before anything gives way, in ranges that do not fit.
constexpr double kMostBroken = 10.0;
// What breaks a pair, of the limit of a range that does not fit.
constexpr double kBroken = 0.5;

// The folds in lines through one node after the other.
class Search {
 public:
  Search(const RangeProblem& problem, const std::vector<bool>& trusted, const Limits& limits,
         const Placement& placement)
      : problem_(problem),
        trusted_(trusted),
        limits_(limits),
        placement_(placement),
        breaking_(kBroken * limits.least()),
        // Without anchors a part is what turns beside the rest, which is larger.
        most_(problem.anchored() ? kMost : std::min(kMost, placed_count(placement) / 2)),
        known_(problem.nodes, 0),
        part_of_(problem.nodes, 0),
        strings_(problem.nodes, {0, 0}) {}

  void add_folds_through(Index node, std::vector<Fold>& found) {
    for (const auto& [vertex, edge] : problem_.pair_graph.neighbours(node)) {
      if (vertex < node || !trusted_[edge] || !placement_.placed[vertex]) continue;
      through_ = placement_.positions.col(node);
      const Eigen::Vector2d along = placement_.positions.col(vertex) - through_;
      if (!(along.norm() > 0.0)) continue;
      normal_ = Eigen::Vector2d(-along.y(), along.x()).normalized();
      ++axis_number_;
      for (const Index end : {node, vertex}) add_folds_beside(end, found);
    }
  }

 private:
  // Parts that begin next to a node of the axis.
  void add_folds_beside(Index end, std::vector<Fold>& found) {
    for (const auto& [first, edge] : problem_.pair_graph.neighbours(end)) {
      if (!trusted_[edge] || !can_turn(first) || is_known(first)) continue;
      for (const auto& [second, other] : problem_.pair_graph.neighbours(first)) {
        if (!can_turn(second) || is_known(second) || !(extra(first, second, other) > breaking_)) {
          continue;
        }
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

  bool can_turn(Index node) const { return placement_.placed[node] && !problem_.is_anchor[node]; }

  bool is_known(Index node) const { return known_[node] == axis_number_; }

  void add(Index node) {
    known_[node] = axis_number_;
    part_of_[node] = part_number_;
  }

  // From two nodes; false if it comes to an anchor, which does not turn, to a part that was large
  // or is known, or to too many nodes.
  bool grow(std::vector<Index>& part) {
    ++part_number_;
    for (const Index v : part) add(v);
    for (std::size_t k = 0; k < part.size(); ++k) {
      for (const auto& [vertex, edge] : problem_.pair_graph.neighbours(part[k])) {
        if (!placement_.placed[vertex] || part_of_[vertex] == part_number_) continue;
        if (!(extra(part[k], vertex, edge) > breaking_)) continue;
        auto& [number, count] = strings_[vertex];
        if (number != part_number_) count = 0;
        number = part_number_;
        if (++count < 2) continue;
        if (problem_.is_anchor[vertex] || is_known(vertex)) return false;
        add(vertex);
        part.push_back(vertex);
        if (static_cast<Index>(part.size()) > most_) return false;
      }
    }
    return true;
  }

  void add_fold(std::vector<Index> part, std::vector<Fold>& found) const {
    std::sort(part.begin(), part.end());
    const double cost = cost_of(part);
    if (cost > kMostBroken * limits_.least()) return;
    found.push_back({std::move(part), through_, normal_, cost});
  }

  double cost_of(const std::vector<Index>& part) const {
    double cost = 0.0;
    for (const Index v : part) {
      for (const auto& [vertex, edge] : problem_.pair_graph.neighbours(v)) {
        if (!placement_.placed[vertex]) continue;
        if (std::binary_search(part.begin(), part.end(), vertex)) continue;
        cost += extra(v, vertex, edge);
      }
    }
    return cost;
  }

  // By how much a pair fits worse if one of its ends is mirrored and the other is not.
  double extra(Index turned, Index other, Index edge) const {
    if (!trusted_[edge]) return 0.0;
    const auto& pair = problem_.pairs[edge];
    const Eigen::Vector2d arm = placement_.positions.col(turned) - placement_.positions.col(other);
    const double squared = arm.squaredNorm();
    const double mirrored = std::max(0.0, squared + 4.0 * height(turned) * height(other));
    return cost_of(pair, std::sqrt(mirrored)) - cost_of(pair, std::sqrt(squared));
  }

  // Above the axis.
  double height(Index node) const { return normal_.dot(placement_.positions.col(node) - through_); }

  double cost_of(const RangePair& pair, double length) const {
    const double r = (length - pair.distance) / pair.sigma;
    return std::min(r * r, limits_(r));
  }

  const RangeProblem& problem_;
  const std::vector<bool>& trusted_;
  const Limits& limits_;
  const Placement& placement_;
  double breaking_;          // what a fold must cost a pair to break it
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
  constexpr double kMostly = 0.8;
  const double least = kMostly * static_cast<double>(std::max(a.size(), b.size()));
  if (static_cast<double>(std::min(a.size(), b.size())) < least) return false;
  std::vector<Index> both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return static_cast<double>(both.size()) >= least;
}

// Each part in one line, and of parts that are alike a few: they differ by what is near the line.
// Given the cheapest first.
std::vector<Fold> cheapest_of_alike(std::vector<Fold> folds) {
  constexpr int kMostAlike = 5;
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

std::vector<Fold> find_folds(const RangeProblem& problem, const std::vector<bool>& trusted,
                             const Limits& limits, const LocalizeOptions& options,
                             const Placement& placement) {
  constexpr Index kBlock = 64;  // nodes that share the memory of a search
  if (problem.dimension != 2) return {};
  const Index blocks = (problem.nodes + kBlock - 1) / kBlock;
  std::vector<std::vector<Fold>> found(blocks);
  parallel_for(blocks, options.threads, options.progress, "folds", [&](std::int64_t block) {
    Search search(problem, trusted, limits, placement);
    const auto first = static_cast<Index>(block) * kBlock;
    for (Index v = first; v < std::min(problem.nodes, first + kBlock); ++v) {
      if (placement.placed[v]) search.add_folds_through(v, found[block]);
    }
  });
  std::vector<Fold> folds;
  for (auto& some : found) std::move(some.begin(), some.end(), std::back_inserter(folds));
  std::stable_sort(folds.begin(), folds.end(),
                   [](const Fold& a, const Fold& b) { return a.cost < b.cost; });
  return cheapest_of_alike(std::move(folds));
}

}  // namespace isotherm::geometry::detail
