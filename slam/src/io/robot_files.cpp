#include "io/robot_files.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

#include "graph/find_root.hpp"

namespace isotherm::slam::detail {
namespace {

// Vertices without a line belong to the file that joins them to the next number, to their
// neighbour in order, or else to the first that names them.
template <class Pose>
void complete_owners(const PoseGraph<Pose>& graph, const std::vector<std::size_t>& ends_of_files,
                     std::vector<std::uint32_t>& owners) {
  const auto next_number = [&](Index a, Index b) { return graph.ids[b] - graph.ids[a] == 1; };
  const auto neighbours = [](Index a, Index b) { return b - a == 1; };
  const auto any = [](Index, Index) { return true; };
  const auto claim = [&](const auto& counts) {
    for (Index k = 0; k < graph.constraint_count(); ++k) {
      const auto [first, second] =
          std::minmax({graph.constraints[k].from, graph.constraints[k].to});
      if (!counts(first, second)) continue;
      for (const Index end : {first, second}) {
        if (owners[end] == kNoFile) owners[end] = file_of(k, ends_of_files);
      }
    }
  };
  claim(next_number);
  claim(neighbours);
  claim(any);
}

}  // namespace

std::uint32_t file_of(Index constraint, const std::vector<std::size_t>& ends_of_files) {
  const auto end = std::upper_bound(ends_of_files.begin(), ends_of_files.end(),
                                    static_cast<std::size_t>(constraint));
  return static_cast<std::uint32_t>(end - ends_of_files.begin());
}

template <class Pose>
void tell_robots_apart(PoseGraph<Pose>& graph, std::vector<std::uint32_t> owners,
                       const std::vector<std::size_t>& ends_of_files) {
  const bool lettered = !graph.ids.empty() && graph.ids.back() >> 56 != 0;
  if (ends_of_files.empty() || lettered) return;
  complete_owners(graph, ends_of_files, owners);
  std::vector<Index> robot_of_file(ends_of_files.size() + 1);
  std::iota(robot_of_file.begin(), robot_of_file.end(), 0);
  for (const auto& constraint : graph.constraints) {
    const auto [first, second] = std::minmax({constraint.from, constraint.to});
    if (graph.ids[second] - graph.ids[first] != 1) continue;
    const Index a = find_root(robot_of_file, static_cast<Index>(owners[first]));
    const Index b = find_root(robot_of_file, static_cast<Index>(owners[second]));
    robot_of_file[std::max(a, b)] = std::min(a, b);
  }
  for (const auto owner : owners) {
    graph.robots.push_back(find_root(robot_of_file, static_cast<Index>(owner)));
  }
  const auto& robots = graph.robots;
  if (std::adjacent_find(robots.begin(), robots.end(), std::not_equal_to<>()) == robots.end()) {
    graph.robots.clear();
  }
}

template void tell_robots_apart(PoseGraph<Pose2>&, std::vector<std::uint32_t>,
                                const std::vector<std::size_t>&);
template void tell_robots_apart(PoseGraph<Pose3>&, std::vector<std::uint32_t>,
                                const std::vector<std::size_t>&);

}  // namespace isotherm::slam::detail
