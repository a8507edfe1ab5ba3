#include "isotherm/slam/graph/repeats.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>

#include "graph/reversed.hpp"

namespace isotherm::slam {
namespace {

// All that a constraint says, bit by bit: an order that a NaN cannot break.
template <class Pose>
struct Statement {
  static constexpr std::size_t kPoseNumbers = Pose::kDim == 2 ? 3 : 7;
  static constexpr std::size_t kNumbers = kPoseNumbers + Pose::kDof * Pose::kDof;

  Index from = 0;
  std::array<std::uint64_t, kNumbers> bits{};
  Index edge = 0;

  bool says_the_same(const Statement& other) const {
    return from == other.from && bits == other.bits;
  }
  bool operator<(const Statement& other) const {
    if (from != other.from) return from < other.from;
    if (bits != other.bits) return bits < other.bits;
    return edge < other.edge;
  }
};

std::array<double, 3> numbers_of(const Pose2& pose) {
  return {pose.translation().x(), pose.translation().y(), pose.angle()};
}

std::array<double, 7> numbers_of(const Pose3& pose) {
  const auto& t = pose.translation();
  const auto& q = pose.rotation();
  return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
}

template <class Pose>
Statement<Pose> statement(const Constraint<Pose>& constraint, Index edge) {
  Statement<Pose> made{constraint.from, {}, edge};
  // Adding zero makes one of the two zeros.
  const auto to_bits = [](double number) { return std::bit_cast<std::uint64_t>(number + 0.0); };
  const auto pose = numbers_of(constraint.T_from_to);
  const auto next = std::transform(pose.begin(), pose.end(), made.bits.begin(), to_bits);
  const auto& m = constraint.information;
  std::transform(m.data(), m.data() + m.size(), next, to_bits);
  return made;
}

template <class Pose>
class Finder {
 public:
  explicit Finder(const PoseGraph<Pose>& graph) : graph_(graph) {}

  std::vector<Repeat> run() {
    std::vector<Index> order(graph_.constraints.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [this](Index a, Index b) { return ends(a) < ends(b); });
    for (auto first = order.begin(); first != order.end();) {
      const auto last =
          std::find_if(first, order.end(), [&](Index k) { return ends(k) != ends(*first); });
      if (last - first > 1) compare({first, last});
      first = last;
    }
    std::sort(repeats_.begin(), repeats_.end(),
              [](const Repeat& a, const Repeat& b) { return a.edge < b.edge; });
    return std::move(repeats_);
  }

 private:
  std::pair<Index, Index> ends(Index k) const {
    return std::minmax(graph_.constraints[k].from, graph_.constraints[k].to);
  }

  // Among edges between the same two vertices.
  void compare(const std::vector<Index>& edges) {
    if (graph_.constraints[edges.front()].from == graph_.constraints[edges.front()].to) return;
    std::vector<Statement<Pose>> sorted;
    for (const Index k : edges) sorted.push_back(statement(graph_.constraints[k], k));
    std::sort(sorted.begin(), sorted.end());
    std::size_t first = 0;
    Index original = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      if (i == 0 || !sorted[i].says_the_same(sorted[first])) {
        first = i;
        original = std::min(sorted[i].edge, mirrored(sorted, sorted[i].edge));
      }
      if (original != sorted[i].edge) repeats_.push_back({sorted[i].edge, original});
    }
  }

  // The first that says the same from the other end; the edge itself if none does.
  Index mirrored(const std::vector<Statement<Pose>>& sorted, Index edge) const {
    const auto wanted = statement(detail::reversed(graph_.constraints[edge]), 0);
    const auto found = std::lower_bound(sorted.begin(), sorted.end(), wanted);
    return found != sorted.end() && found->says_the_same(wanted) ? found->edge : edge;
  }

  const PoseGraph<Pose>& graph_;
  std::vector<Repeat> repeats_;
};

}  // namespace

template <class Pose>
std::vector<Repeat> exact_repeats(const PoseGraph<Pose>& graph) {
  return Finder<Pose>(graph).run();
}

template std::vector<Repeat> exact_repeats(const PoseGraph<Pose2>&);
template std::vector<Repeat> exact_repeats(const PoseGraph<Pose3>&);

}  // namespace isotherm::slam
