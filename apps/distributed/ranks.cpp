#include "distributed/ranks.hpp"

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/base/words.hpp"

namespace isotherm::apps {

distributed::Graph read_on_ranks(const distributed::Session& session, const std::string& path,
                                 const CommonFlags& flags,
                                 const distributed::GraphOptions& options) {
  auto graph = distributed::Graph::read(session, path, options);
  for (const auto& [kind, count] : graph.report().repairs) {
    warn(flags, fmt::format("{}: {} ({})", path, kind, count));
  }
  for (const auto& [kind, count] : graph.report().notes) {
    warn(flags, fmt::format("{}: {} ({})", path, kind, count));
  }
  detail_line(flags, fmt::format("{}, {}, {} on {}; {:.2g} % of edges between ranks",
                                 counted(graph.vertex_count(), "vertex", "vertices"),
                                 counted(graph.edge_count(), "edge"),
                                 counted(graph.component_count(), "component"),
                                 counted(session.size(), "rank"), 100.0 * graph.cut()));
  return graph;
}

Json graph_json(const distributed::Graph& graph) {
  return {{"vertices", graph.vertex_count()},
          {"edges", graph.edge_count()},
          {"components", graph.component_count()},
          {"ranks", graph.session().size()},
          {"cut", graph.cut()},
          {"peak_megabytes_of_a_rank", graph.session().peak_memory() / 1'000'000}};
}

void write_json_of(const distributed::Session& session, const std::string& path, const Json& json) {
  session.together([&] {
    if (session.rank() == 0) write_json(path, json);
  });
}

}  // namespace isotherm::apps
