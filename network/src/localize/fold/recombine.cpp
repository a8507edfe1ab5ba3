#include "localize/fold/recombine.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "localize/constants.hpp"
#include "localize/refine/polish.hpp"

namespace isotherm::network::detail {
namespace {

// Connected nodes of those that `differ`.
std::vector<std::vector<Index>> connected_parts(const MapTask& task, const Placement& placement,
                                                std::vector<bool> differ) {
  std::vector<std::vector<Index>> parts;
  for (Index v = 0; v < task.problem.nodes; ++v) {
    if (!differ[v]) continue;
    std::vector<Index> part = {v};
    differ[v] = false;
    for (std::size_t k = 0; k < part.size(); ++k) {
      task.visit_neighbours(placement, part[k], [&](Index vertex, Index) {
        if (!differ[vertex]) return;
        differ[vertex] = false;
        part.push_back(vertex);
      });
    }
    std::sort(part.begin(), part.end());
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace

std::vector<PartMove> differing_parts(const MapTask& task, const Placement& placement,
                                      const Placement& other) {
  const RangeProblem& problem = task.problem;
  const Eigen::RowVectorXd apart = (placement.positions - other.positions).colwise().norm();
  std::set<std::vector<Index>> parts;
  for (double least = kApart * problem.typical_sigma; least < problem.typical_distance;
       least *= 2.0) {
    std::vector<bool> differ(problem.nodes, false);
    for (Index v = 0; v < problem.nodes; ++v) {
      differ[v] =
          placement.placed[v] && other.placed[v] && !problem.is_anchor[v] && apart[v] > least;
    }
    for (auto& part : connected_parts(task, placement, std::move(differ))) {
      parts.insert(std::move(part));
    }
  }
  std::vector<PartMove> moves;
  for (const auto& part : parts) moves.push_back({part, other.positions(Eigen::all, part)});
  return moves;
}

bool recombine(const MapTask& task, const Placement& other, Placement& placement) {
  constexpr int kMostRounds = 6;
  bool any = false;
  for (int round = 0; round < kMostRounds; ++round) {
    const auto evidence = learn_evidence(task, placement);
    const auto moves = differing_parts(task, placement, other);
    const auto moved = take_moves(task.problem, gains(task, evidence, placement, moves), placement);
    if (moved.empty()) break;
    any = true;
    polish(task, placement);
  }
  return any;
}

}  // namespace isotherm::network::detail
