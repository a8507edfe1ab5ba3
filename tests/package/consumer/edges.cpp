#include <isotherm/spectral.hpp>

int main(int, char** argv) {
  using namespace isotherm::spectral;
  const auto file = read_graph(argv[1]);        // from,to[,weight] rows, or MatrixMarket
  const auto result = judge_edges(file.graph);  // by what the others say of each edge
  const auto kept = apply_verdicts(file.graph, result.verdicts);
  write_edge_csv(argv[2], kept, file.ids);
}
