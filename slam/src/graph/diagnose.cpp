#include "isotherm/slam/graph/diagnose.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "graph/doubtful_measurements.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/base/words.hpp"

namespace isotherm::slam {
namespace {

// How the order of ids, and that of the file, go with edges.
struct Order {
  Index pairs = 0;    // neighbours in the order of ids, of one robot
  Index joined = 0;   // of these, by odometry
  Index bridged = 0;  // of these, by odometry that leads past another pose
  Index robots = 0;
  Index chained = 0;  // edges that start where the one before ends
};

template <class Pose>
Order order_of(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  Order order;
  std::set<std::uint64_t> robots;
  std::vector<Index> pairs;  // by the first one
  for (Index v = 0; v < graph.vertex_count(); ++v) {
    robots.insert(graph.robot(v));
    if (v > 0 && graph.robot(v) == graph.robot(v - 1)) pairs.push_back(v - 1);
  }
  order.pairs = static_cast<Index>(pairs.size());
  order.robots = static_cast<Index>(robots.size());
  std::vector<bool> joined(graph.ids.size(), false);
  const auto join_over = [&](Index span) {  // as edge_roles() has it
    for (const Index k : roles.odometry) {
      const auto [from, to] = std::minmax(graph.constraints[k].from, graph.constraints[k].to);
      if (to - from == span) joined[joined[from] ? to - 1 : from] = true;
    }
    return static_cast<Index>(
        std::ranges::count_if(pairs, [&](Index first) { return joined[first]; }));
  };
  const Index by_step = join_over(1);
  order.joined = join_over(2);
  order.bridged = order.joined - by_step;
  for (std::size_t k = 1; k < graph.constraints.size(); ++k) {
    if (graph.constraints[k].from == graph.constraints[k - 1].to) ++order.chained;
  }
  return order;
}

template <class Pose>
void doubt_order(const PoseGraph<Pose>& graph, const EdgeRoles& roles, std::vector<Doubt>& doubts) {
  const Order order = order_of(graph, roles);
  if (order.bridged > 0) {
    const std::string edges = counted(static_cast<std::uint64_t>(order.bridged), "edge");
    doubts.push_back({"bridged odometry",
                      "where no edge joins poses with neighbouring ids, odometry "
                      "is taken to lead past one pose (" +
                          edges + "; name it with --trusted otherwise)"});
  }
  const Index missing = order.pairs - order.joined;
  if (missing == 0 || graph.constraints.empty()) return;
  const std::string measured = "no edge joins " + std::to_string(missing) + " of " +
                               counted(static_cast<std::uint64_t>(order.pairs), "pair") +
                               " of poses with neighbouring ids";
  if (2 * order.joined >= order.pairs) {
    doubts.push_back({"broken odometry", measured + ": odometry is broken there, and loops over "
                                                    "the gaps can lean on nothing else"});
  } else if (2 * order.chained >= order.pairs) {
    doubts.push_back({"ids without order",
                      measured + ", but " + std::to_string(order.chained) +
                          " edges start where the one before ends: number the poses in order "
                          "of time, or name odometry with --trusted"});
  } else {
    doubts.push_back({"no odometry", measured + ": odometry is missing, or ids are not in order "
                                                "of time; without it loops are judged by each "
                                                "other alone (name it with --trusted)"});
  }
}

template <class Pose>
void doubt_information(const PoseGraph<Pose>& graph, std::vector<Doubt>& doubts) {
  using Matrix = typename Pose::Matrix;
  const auto& edges = graph.constraints;
  if (edges.size() < 2) return;
  const Matrix& first = edges.front().information;
  const auto zeros = static_cast<std::uint64_t>(std::count_if(
      edges.begin(), edges.end(), [](const auto& edge) { return edge.information.isZero(0.0); }));
  if (zeros > 0) {
    doubts.push_back({"zero information", counted(zeros, "edge states", "edges state") +
                                              " zero information, of " +
                                              std::to_string(edges.size()) +
                                              ": nothing can be told from how well they fit"});
  }
  const bool same = std::all_of(edges.begin(), edges.end(),
                                [&](const auto& edge) { return edge.information == first; });
  if (!same || zeros > 0) return;
  if (first == Matrix::Identity()) {
    doubts.push_back({"identity information",
                      "all edges state the identity as information, 1 m and 1 rad of deviation: "
                      "was it estimated? Verdicts are as good as it is"});
    return;
  }
  const auto deviation = [&](int axis) {
    return format_number(std::round(1e4 / std::sqrt(first(axis, axis))) / 1e4);
  };
  doubts.push_back(
      {"identical information", "all edges state the same information, deviations of " +
                                    deviation(0) + " m and " + deviation(Pose::kDof - 1) +
                                    " rad: loops count as exact as odometry"});
}

}  // namespace

template <class Pose>
std::vector<Doubt> diagnose(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  auto doubts = detail::doubt_measurements(graph, roles);
  doubt_order(graph, roles, doubts);
  doubt_information(graph, doubts);
  return doubts;
}

template std::vector<Doubt> diagnose(const PoseGraph<Pose2>&, const EdgeRoles&);
template std::vector<Doubt> diagnose(const PoseGraph<Pose3>&, const EdgeRoles&);

}  // namespace isotherm::slam
