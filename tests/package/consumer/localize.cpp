#include <isotherm/network.hpp>

int main(int, char** argv) {
  using namespace isotherm::network;
  auto network = read_ranges(argv[1]).network;    // CSV, PyFG and others
  set_anchors(network, read_positions(argv[2]));  // the nodes whose place is known
  const auto result = localize(network);          // places, and a verdict on every range
  write_positions(argv[3], network, result);
}
