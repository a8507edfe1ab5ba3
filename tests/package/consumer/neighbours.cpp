#include <isotherm/geometry.hpp>
#include <isotherm/spectral.hpp>

int main(int, char** argv) {
  using namespace isotherm;
  const auto cloud = geometry::read_points(argv[1]);  // x,y[,z ...] rows
  const auto graph = geometry::nearest_neighbour_graph(cloud.points, 7);
  const auto result = spectral::judge_edges(graph);  // a rolled-up sheet has short circuits
  spectral::write_verdicts(argv[2], result.verdicts);
}
