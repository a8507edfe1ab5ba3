#include "localize/refine/determinacy.hpp"

#include <algorithm>

#include "isotherm/base/random.hpp"
#include "localize/refine/range_information.hpp"

namespace isotherm::network::detail {
namespace {

class Examination {
 public:
  Examination(const RangeProblem& problem, const std::vector<bool>& use, const Placement& placement)
      : problem_(problem), use_(use), placement_(placement) {
    statuses_.assign(problem.nodes, NodeStatus::not_placed);
    for (Index v = 0; v < problem.nodes; ++v) {
      if (placement.placed[v]) statuses_[v] = NodeStatus::localised;
      if (problem.is_anchor[v]) statuses_[v] = NodeStatus::anchor;
    }
  }

  std::vector<NodeStatus> run() {
    reject_disconnected();
    // What can move ...
    while (reject_sparse(problem_.dimension, NodeStatus::not_rigid) ||
           reject_floppy(NodeStatus::not_rigid)) {
    }
    // ... and what of the rest has several places.
    if (is_simplex()) return std::move(statuses_);
    reject_if_anchors_are_flat();
    reject_sparse(problem_.dimension + 1, NodeStatus::mirrored);
    drop_untested_ranges();
    while (reject_floppy(NodeStatus::mirrored) ||
           reject_sparse(problem_.dimension + 1, NodeStatus::mirrored)) {
    }
    return std::move(statuses_);
  }

 private:
  bool stands(Index node) const {
    return statuses_[node] == NodeStatus::localised || statuses_[node] == NodeStatus::anchor;
  }

  bool counts(std::size_t k) const {
    const auto& range = problem_.ranges[k];
    return use_[k] && stands(range.from) && stands(range.to);
  }

  Index standing() const {
    return static_cast<Index>(
        std::count_if(statuses_.begin(), statuses_.end(), [](NodeStatus status) {
          return status == NodeStatus::localised || status == NodeStatus::anchor;
        }));
  }

  // Nodes that no ranges lead to from an anchor; without anchors, from the largest part.
  void reject_disconnected() {
    std::vector<spectral::WeightedEdge> edges;
    for (std::size_t k = 0; k < problem_.ranges.size(); ++k) {
      if (counts(k)) edges.push_back({problem_.ranges[k].from, problem_.ranges[k].to, 1.0});
    }
    const auto components =
        spectral::connected_components(spectral::WeightedGraph(problem_.nodes, edges));
    std::vector<Index> size(components.count, 0);
    std::vector<bool> anchored(components.count, false);
    for (Index v = 0; v < problem_.nodes; ++v) {
      if (stands(v)) ++size[components.label[v]];
      if (problem_.is_anchor[v]) anchored[components.label[v]] = true;
    }
    if (!problem_.anchored() && components.count > 0) {
      anchored[std::max_element(size.begin(), size.end()) - size.begin()] = true;
    }
    for (Index v = 0; v < problem_.nodes; ++v) {
      if (!anchored[components.label[v]] && stands(v)) statuses_[v] = NodeStatus::not_connected;
    }
  }

  // Without anchors d + 1 nodes or fewer have one shape, if they are rigid.
  bool is_simplex() const { return !problem_.anchored() && standing() <= problem_.dimension + 1; }

  // Anchors in a line (plane, in space) leave the mirror image of all the rest.
  void reject_if_anchors_are_flat() {
    if (!problem_.anchored() || anchors_span_space(problem_, placement_)) return;
    for (auto& status : statuses_) {
      if (status == NodeStatus::localised) status = NodeStatus::mirrored;
    }
  }

  // Nodes with fewer than `enough` neighbours, and then those that hung on them.
  bool reject_sparse(int enough, NodeStatus status) {
    bool any = false;
    for (bool changed = true; changed;) {
      changed = false;
      const int needed = problem_.anchored() ? enough : std::min<int>(enough, standing() - 1);
      const auto degrees = neighbour_counts();
      for (Index v = 0; v < problem_.nodes; ++v) {
        if (statuses_[v] != NodeStatus::localised || degrees[v] >= needed) continue;
        statuses_[v] = status;
        any = changed = true;
      }
    }
    return any;
  }

  std::vector<int> neighbour_counts() const {
    std::vector<bool> pair_counted(problem_.pairs.size(), false);
    std::vector<int> degrees(problem_.nodes, 0);
    for (std::size_t k = 0; k < problem_.ranges.size(); ++k) {
      const auto pair = problem_.pair_of[k];
      if (!counts(k) || pair_counted[pair]) continue;
      pair_counted[pair] = true;
      ++degrees[problem_.ranges[k].from];
      ++degrees[problem_.ranges[k].to];
    }
    return degrees;
  }

  Placement standing_placement() const {
    Placement standing = placement_;
    for (Index v = 0; v < problem_.nodes; ++v) standing.placed[v] = stands(v);
    return standing;
  }

  bool reject_floppy(NodeStatus status) {
    const auto standing = standing_placement();
    const auto floppy = RangeInformation(problem_, use_, standing, true).floppy_nodes();
    bool any = false;
    for (Index v = 0; v < problem_.nodes; ++v) {
      if (!floppy[v] || statuses_[v] != NodeStatus::localised) continue;
      statuses_[v] = status;
      any = true;
    }
    return any;
  }

  // Ranges whose loss would leave a motion: what they hold can also be put elsewhere.
  void drop_untested_ranges() {
    const auto standing = standing_placement();
    const auto checks = RangeInformation(problem_, use_, standing, true).check_ranges();
    for (std::size_t k = 0; k < checks.size(); ++k) {
      const auto& range = problem_.ranges[k];
      if (problem_.is_anchor[range.from] && problem_.is_anchor[range.to]) continue;
      if (counts(k) && !checks[k].is_tested()) use_[k] = false;
    }
  }

  const RangeProblem& problem_;
  std::vector<bool> use_;
  const Placement& placement_;
  std::vector<NodeStatus> statuses_;
};

}  // namespace

std::vector<NodeStatus> determinacy(const RangeProblem& problem, const std::vector<bool>& use,
                                    const Placement& placement) {
  return Examination(problem, use, placement).run();
}

std::vector<NodeStatus> generic_determinacy(const RangeProblem& problem,
                                            const std::vector<bool>& use,
                                            const Placement& anchors) {
  Random random(1);
  Placement generic = anchors;
  const double side = std::max(problem.typical_distance, 1e-300);
  for (Index v = 0; v < problem.nodes; ++v) {
    if (problem.is_anchor[v]) continue;
    generic.placed[v] = true;
    for (int i = 0; i < problem.dimension; ++i) {
      generic.positions(i, v) = random.uniform(-side, side);
    }
  }
  return determinacy(problem, use, generic);
}

}  // namespace isotherm::network::detail
