#include "localize/firm/hinge_parts.hpp"

#include <algorithm>
#include <unordered_set>
#include <utility>

namespace isotherm::network::detail {
namespace {

constexpr std::size_t kLeast = 3;
constexpr std::size_t kMost = 200;

class PartSearch {
 public:
  PartSearch(const RangeProblem& problem, const std::vector<bool>& trusted,
             const std::vector<bool>& placed, Index hinge)
      : problem_(problem), trusted_(trusted), placed_(placed), blocked_{hinge} {
    border_ = neighbours(hinge);
    blocked_.insert(border_.begin(), border_.end());
  }

  std::vector<std::vector<Index>> run() {
    std::vector<std::vector<Index>> parts;
    for (const Index node : border_) {
      for (const Index start : neighbours(node)) {
        if (blocked_.contains(start) || known_.contains(start)) continue;
        auto part = explore(start);
        if (part.size() < kLeast) continue;
        std::sort(part.begin(), part.end());
        parts.push_back(std::move(part));
      }
    }
    return parts;
  }

 private:
  std::vector<Index> neighbours(Index node) const {
    std::vector<Index> found;
    for (const auto& [vertex, edge] : problem_.pair_graph.neighbours(node)) {
      if (trusted_[edge] && placed_[vertex]) found.push_back(vertex);
    }
    return found;
  }

  // The part with this node; nothing if it is, or belongs to, a large one.
  std::vector<Index> explore(Index start) {
    std::vector<Index> part = {start};
    std::unordered_set<Index> inside = {start};
    bool large = false;
    for (std::size_t k = 0; k < part.size() && !large; ++k) {
      for (const Index vertex : neighbours(part[k])) {
        if (blocked_.contains(vertex) || !inside.insert(vertex).second) continue;
        // Of small ones all nodes are known, so that none is met again.
        large = large || known_.contains(vertex);
        part.push_back(vertex);
      }
      large = large || part.size() > kMost;
    }
    known_.insert(part.begin(), part.end());
    return large ? std::vector<Index>{} : part;
  }

  const RangeProblem& problem_;
  const std::vector<bool>& trusted_;
  const std::vector<bool>& placed_;
  std::unordered_set<Index> blocked_;  // the hinge and its neighbours
  std::unordered_set<Index> known_;    // nodes of parts explored before
  std::vector<Index> border_;
};

}  // namespace

std::vector<std::vector<Index>> parts_behind(const RangeProblem& problem,
                                             const std::vector<bool>& trusted,
                                             const std::vector<bool>& placed, Index hinge) {
  return PartSearch(problem, trusted, placed, hinge).run();
}

}  // namespace isotherm::network::detail
