#include <isotherm/slam.hpp>

int main(int, char** argv) {
  using namespace isotherm::slam;
  const auto file = read_pose_graph(argv[1]);       // g2o or TORO, plane or space
  const auto map = prune_and_optimize(file);        // decides on every loop, finds the poses
  write_g2o(argv[2], map.pruned);                   // without the false loops
  write_verdicts(argv[3], map.decisions.verdicts);  // why, a row a loop
}
