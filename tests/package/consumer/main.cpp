// An outside program: uses every layer, so that all private dependencies of the
// static libraries must be found and linked.
#include <isotherm/geometry/curves/polyline.hpp>
#include <isotherm/slam/prune/prune.hpp>
#include <isotherm/slam/simulate/simulate.hpp>
#include <isotherm/spectral/graph/weighted_graph.hpp>

int main() {
  using namespace isotherm;
  const spectral::WeightedGraph triangle(3, {{0, 1, 1.0}, {1, 2, 1.0}, {2, 0, 1.0}});
  const geometry::Polyline<2> line({{0.0, 0.0}, {3.0, 4.0}});
  const auto city = slam::simulate_city({.poses = 200, .measurements = {.loops = 50}});
  const auto result = slam::prune(city.graph, slam::edge_roles(city.graph));
  const bool ok = spectral::connected_components(triangle).count == 1 && line.length() == 5.0 &&
                  result.verdicts.size() == 50;
  return ok ? 0 : 1;
}
