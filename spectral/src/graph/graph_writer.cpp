#include <algorithm>
#include <utility>

#include "isotherm/base/text_writer.hpp"
#include "isotherm/spectral/graph/graph_file.hpp"

namespace isotherm::spectral {

void write_edge_csv(const std::string& path, const WeightedGraph& graph,
                    const std::vector<std::uint64_t>& ids) {
  if (ids.size() != static_cast<std::size_t>(graph.vertex_count())) {
    throw InvalidArgument("ids", "must have one entry a vertex");
  }
  OutputFile file(path);
  file.write("from,to,weight\n");
  std::string row;
  for (const auto& edge : graph.edges()) {
    row.clear();
    append_number(row, ids[edge.from]);
    row += ',';
    append_number(row, ids[edge.to]);
    row += ',';
    append_number(row, edge.weight);
    row += '\n';
    file.write(row);
  }
  file.commit();
}

void write_matrix_market(const std::string& path, const WeightedGraph& graph) {
  std::vector<std::pair<std::pair<Index, Index>, double>> entries;  // (column, row), by columns
  for (const auto& edge : graph.edges()) {
    if (edge.from == edge.to) continue;
    entries.push_back({std::minmax(edge.from, edge.to), edge.weight});
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::size_t count = 0;
  for (const auto& entry : entries) {
    if (count > 0 && entries[count - 1].first == entry.first) {
      entries[count - 1].second += entry.second;
    } else {
      entries[count++] = entry;
    }
  }
  entries.resize(count);

  OutputFile file(path);
  const std::string size = std::to_string(graph.vertex_count());
  file.write("%%MatrixMarket matrix coordinate real symmetric\n" + size + " " + size + " " +
             std::to_string(count) + "\n");
  std::string row;
  for (const auto& [ends, weight] : entries) {
    row.clear();
    append_number(row, ends.second + 1);
    row += ' ';
    append_number(row, ends.first + 1);
    row += ' ';
    append_number(row, weight);
    row += '\n';
    file.write(row);
  }
  file.commit();
}

}  // namespace isotherm::spectral
