#include "localize/firm/firmness.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "localize/constants.hpp"
#include "localize/evidence/crowd.hpp"
#include "localize/evidence/star.hpp"
#include "localize/fold/fold_axes.hpp"
#include "localize/fold/part_move.hpp"

namespace isotherm::network::detail {
namespace {

using Nodes = std::vector<Index>;

class Firmness {
 public:
  Firmness(const MapTask& task, const Placement& placement)
      : task_(task),
        problem_(task.problem),
        evidence_(learn_evidence(task, placement)),
        crowd_(problem_, placement, evidence_.absence),
        clear_(-2.0 * std::log(task.options.mirror_chance)),
        placed_(placement.placed),
        firm_(placement) {}

  std::vector<bool> run() {
    // Without anchors a simplex may be mirrored as it is.
    if (!problem_.anchored() && placed_count(firm_) <= problem_.dimension + 1) return placed_;
    std::vector<bool> changed(problem_.nodes, true);
    std::vector<bool> lines(problem_.nodes, true);
    do {
      release_nodes(std::move(changed));
      changed = release_folding_parts(lines);
      lines = within_steps(problem_, std::exchange(released_, {}), kRegionSteps, task_.trusted);
    } while (std::find(changed.begin(), changed.end(), true) != changed.end());
    return firm_.placed;
  }

 private:
  // Takes out what has a second place among the firm ones, of the nodes whose surroundings have
  // `changed` and then of those that hung on them.
  void release_nodes(std::vector<bool> changed) {
    for (;;) {
      Nodes asked;
      for (Index v = 0; v < problem_.nodes; ++v) {
        if (changed[v] && firm_.placed[v] && !problem_.is_anchor[v]) asked.push_back(v);
      }
      std::vector<char> has_one(asked.size(), 0);
      task_.in_parallel(asked.size(), "determinacy",
                        [&](std::int64_t k) { has_one[k] = has_one_place(asked[k]) ? 1 : 0; });
      changed.assign(problem_.nodes, false);
      bool any = false;
      for (std::size_t k = 0; k < asked.size(); ++k) {
        if (has_one[k] != 0) continue;
        release(asked[k], changed);
        any = true;
      }
      if (!any) return;
    }
  }

  void release(Index node, std::vector<bool>& changed) {
    firm_.placed[node] = false;
    released_.push_back(node);
    for (const auto& neighbour : problem_.pair_graph.neighbours(node)) {
      changed[neighbour.vertex] = true;
    }
  }

  // Takes out what is elsewhere in a mirror image, in one of these lines, of a part that fits
  // nearly as well. The nodes around it.
  std::vector<bool> release_folding_parts(const std::vector<bool>& lines) {
    std::vector<bool> changed(problem_.nodes, false);
    const Crowd crowd(problem_, firm_, evidence_.absence);
    for (const auto& fold : find_folds(task_, evidence_, firm_, lines)) {
      const bool is_whole =
          std::all_of(fold.part.begin(), fold.part.end(), [&](Index v) { return firm_.placed[v]; });
      if (!is_whole) continue;
      const auto outcome = try_move(task_, evidence_, crowd, firm_, fold.move(firm_));
      if (outcome.extra >= clear_) continue;
      for (const Index v : outcome.moved) release(v, changed);
    }
    return changed;
  }

  // Whether the node's place among the firm ones is clearly the best.
  bool has_one_place(Index node) const {
    auto around = star(problem_, evidence_, firm_, node, task_.trusted);
    if (static_cast<int>(around.arms.size()) <= problem_.dimension) return false;
    const Point place = firm_.positions.col(node);
    // It, or these, lie on the wrong side of a fold.
    if (crowd_.absence_cost(node, place, placed_) > clear_) return false;
    crowd_.add_strangers(around, node, firm_.placed);
    const auto found = multilaterate(around);
    if (!found || found->margin() < clear_) return false;
    return around.cost(place) - found->cost < clear_;
  }

  const MapTask& task_;
  const RangeProblem& problem_;
  Evidence evidence_;
  Crowd crowd_;
  double clear_;
  std::vector<bool> placed_;
  Placement firm_;
  Nodes released_;  // since the last search for folds
};

}  // namespace

std::vector<bool> firm_nodes(const MapTask& task, const Placement& placement) {
  return Firmness(task, placement).run();
}

}  // namespace isotherm::network::detail
