#include "graph/gauge.hpp"

#include <numeric>

#include "graph/find_root.hpp"

namespace isotherm::slam::detail {
namespace {

// Joins under the smaller root, so that a root is its component's first vertex.
void join(std::vector<Index>& parent, Index a, Index b) {
  a = find_root(parent, a);
  b = find_root(parent, b);
  if (a < b) {
    parent[b] = a;
  } else {
    parent[a] = b;
  }
}

}  // namespace

template <class Pose>
Gauge fix_gauge(const PoseGraph<Pose>& graph) {
  const auto n = static_cast<std::size_t>(graph.vertex_count());
  std::vector<Index> parent(n);
  std::iota(parent.begin(), parent.end(), 0);
  for (const auto& constraint : graph.constraints) {
    if (!constraint.information.isZero(0.0)) join(parent, constraint.from, constraint.to);
  }

  Gauge gauge;
  gauge.component.resize(n);
  for (Index v = 0; v < graph.vertex_count(); ++v) {
    const Index root = find_root(parent, v);
    gauge.component[v] = root == v ? gauge.component_count++ : gauge.component[root];
  }

  std::vector<bool> is_held(n, false);
  std::vector<bool> component_held(static_cast<std::size_t>(gauge.component_count), false);
  for (const Index v : graph.fixed) {
    is_held[v] = true;
    component_held[gauge.component[v]] = true;
  }
  gauge.variable.assign(n, -1);
  for (Index v = 0; v < graph.vertex_count(); ++v) {
    if (!component_held[gauge.component[v]]) {
      is_held[v] = true;
      component_held[gauge.component[v]] = true;
    }
    if (is_held[v]) {
      gauge.held.push_back(v);
    } else {
      gauge.variable[v] = gauge.variable_count++;
    }
  }
  return gauge;
}

template Gauge fix_gauge(const PoseGraph<Pose2>&);
template Gauge fix_gauge(const PoseGraph<Pose3>&);

}  // namespace isotherm::slam::detail
