#include "localize/evidence/relocate.hpp"

#include <optional>

#include "localize/constants.hpp"
#include "localize/evidence/crowd.hpp"
#include "localize/evidence/star.hpp"

namespace isotherm::network::detail {
namespace {

class Relocation {
 public:
  Relocation(const MapTask& task, const Evidence& evidence, Placement& placement)
      : problem_(task.problem),
        gate_(task.gate),
        evidence_(evidence),
        placement_(placement),
        crowd_(task.problem, placement, evidence.absence) {}

  // Whether another place may be better.
  bool is_suspect(Index node) const {
    if (problem_.is_anchor[node]) return false;
    const auto ranges = star(problem_, evidence_, placement_, node);
    if (static_cast<int>(ranges.arms.size()) <= problem_.dimension) return false;
    if (!placement_.placed[node]) return true;
    const Point place = placement_.positions.col(node);
    return ranges.agreeing(place, gate_) < static_cast<int>(ranges.arms.size()) ||
           crowd_.absence_cost(node, place, placement_.placed) > kBetter;
  }

  std::optional<Multilateration> look(Index node) const {
    return multilaterate(surroundings(node));
  }

  // Neighbours may have moved in the meantime: both places are judged anew.
  bool move(Index node, const Multilateration& found) {
    const auto around = surroundings(node);
    const double cost = around.cost(found.position);
    if (placement_.placed[node]) {
      if (around.cost(placement_.positions.col(node)) - cost < kBetter) return false;
    } else {
      if (found.rival_cost - cost < kBetter) return false;
      if (around.agreeing(found.position, gate_) <= problem_.dimension) return false;
    }
    placement_.positions.col(node) = found.position;
    placement_.placed[node] = true;
    return true;
  }

 private:
  Star surroundings(Index node) const {
    auto around = star(problem_, evidence_, placement_, node);
    crowd_.add_strangers(around, node, placement_.placed);
    return around;
  }

  const RangeProblem& problem_;
  double gate_;
  const Evidence& evidence_;
  Placement& placement_;
  Crowd crowd_;
};

}  // namespace

std::vector<Index> relocate(const MapTask& task, const Evidence& evidence,
                            const std::vector<bool>& among, Placement& placement) {
  Relocation relocation(task, evidence, placement);
  std::vector<Index> suspects;
  for (Index v = 0; v < task.problem.nodes; ++v) {
    if (among[v] && relocation.is_suspect(v)) suspects.push_back(v);
  }
  std::vector<std::optional<Multilateration>> found(suspects.size());
  task.in_parallel(suspects.size(), "multilateration",
                   [&](std::int64_t k) { found[k] = relocation.look(suspects[k]); });
  std::vector<Index> moved;
  for (std::size_t k = 0; k < suspects.size(); ++k) {
    if (found[k] && relocation.move(suspects[k], *found[k])) moved.push_back(suspects[k]);
  }
  return moved;
}

}  // namespace isotherm::network::detail
