#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <utility>

#include "isotherm/base/text_writer.hpp"
#include "isotherm/base/words.hpp"
#include "isotherm/spectral/graph/graph_file.hpp"

namespace isotherm::spectral {
namespace {

/// Of every edge, the earlier one that it repeats in the other direction; none if -1.
std::vector<Index> earlier_directions(std::span<const WeightedEdge> edges) {
  std::vector<Index> order(edges.size()), earlier(edges.size(), -1);
  std::iota(order.begin(), order.end(), 0);
  const auto ends = [&](Index e) { return std::minmax(edges[e].from, edges[e].to); };
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return std::tuple(ends(a), a) < std::tuple(ends(b), b); });
  std::vector<Index> waiting;  // edges of one direction without their other
  for (std::size_t k = 0; k < order.size(); ++k) {
    const Index edge = order[k];
    if (k > 0 && ends(order[k - 1]) != ends(edge)) waiting.clear();
    if (edges[edge].from == edges[edge].to) continue;
    if (waiting.empty() || edges[waiting.back()].from == edges[edge].from) {
      waiting.push_back(edge);
    } else {
      earlier[edge] = waiting.back();
      waiting.pop_back();
    }
  }
  return earlier;
}

}  // namespace

void merge_directions(GraphFile& file, const ReadOptions& options) {
  const auto edges = file.graph.edges();
  const auto earlier = earlier_directions(edges);
  const auto count = std::count_if(earlier.begin(), earlier.end(), [](Index e) { return e >= 0; });
  if (count == 0) return;
  std::vector<WeightedEdge> merged;
  std::vector<std::size_t> place(edges.size());
  for (std::size_t k = 0; k < edges.size(); ++k) {
    place[k] = merged.size();
    if (earlier[k] < 0) {
      merged.push_back(edges[k]);
      continue;
    }
    auto& weight = merged[place[earlier[k]]].weight;
    if (weight == edges[k].weight) continue;
    file.report.add_repair(
        options, {"edge with two weights",
                  {file.report.path, 0, 0},
                  std::to_string(file.ids[edges[k].from]) + ',' +
                      std::to_string(file.ids[edges[k].to]) + ',' + format_number(edges[k].weight),
                  "edge has another weight in the other direction; averaged"});
    weight = 0.5 * weight + 0.5 * edges[k].weight;
  }
  file.report.add_note({"edge in both directions",
                        {file.report.path, 0, 0},
                        "",
                        counted(count, "edge") + (count == 1 ? " stands" : " stand") +
                            " in both directions; counted once"});
  file.graph = WeightedGraph(file.graph.vertex_count(), std::move(merged));
}

}  // namespace isotherm::spectral
