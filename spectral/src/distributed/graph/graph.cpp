#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "distributed/graph/build_graph.hpp"
#include "distributed/graph/file_order.hpp"
#include "graph/edge_rows.hpp"
#include "isotherm/base/error.hpp"

namespace isotherm::spectral::distributed {
namespace {

void check_edges(Index vertex_count, std::span<const WeightedEdge> edges) {
  if (vertex_count < 0) throw InvalidArgument("vertex_count", "must not be negative");
  for (const auto& [from, to, weight] : edges) {
    if (std::min(from, to) < 0 || std::max(from, to) >= vertex_count) {
      throw InvalidArgument("edges", "end outside [0, " + std::to_string(vertex_count) + ")");
    }
    if (!spectral::detail::usable_weight(weight)) {
      throw InvalidArgument("edges", "weight must be finite and positive");
    }
  }
}

}  // namespace

Graph::Graph(std::unique_ptr<State> state) : state_(std::move(state)) {}
Graph::~Graph() = default;
Graph::Graph(Graph&&) noexcept = default;
Graph& Graph::operator=(Graph&&) noexcept = default;

Graph Graph::read(const Session& session, const std::string& path, const GraphOptions& options) {
  auto part = detail::read_edge_part(session.state().comm, path, {.strict = options.strict});
  return Graph(detail::build_graph(session, std::move(part), detail::Twice::counts_once, options));
}

Graph Graph::from_edges(const Session& session, Index vertex_count,
                        std::span<const WeightedEdge> edges, const GraphOptions& options) {
  session.together([&] { check_edges(vertex_count, edges); });
  const auto& comm = session.state().comm;
  detail::EdgePart part;
  part.edges.assign(edges.begin(), edges.end());
  part.blocks = detail::Blocks(comm, vertex_count);
  for (auto v = part.blocks.begin(comm.rank); v < part.blocks.end(comm.rank); ++v) {
    part.ids.push_back(static_cast<std::uint64_t>(v));
  }
  return Graph(detail::build_graph(session, std::move(part), detail::Twice::counts_twice, options));
}

Index Graph::vertex_count() const noexcept { return static_cast<Index>(state_->blocks.total()); }
std::int64_t Graph::edge_count() const noexcept { return state_->edge_count; }
std::int64_t Graph::component_count() const noexcept { return state_->components.count; }
double Graph::cut() const noexcept { return state_->cut; }
const ReadReport& Graph::report() const noexcept { return state_->report; }
const Session& Graph::session() const noexcept { return *state_->session; }
std::span<const std::uint64_t> Graph::ids() const noexcept { return state_->ids; }

Index Graph::block_begin() const noexcept {
  return static_cast<Index>(state_->blocks.begin(state_->comm().rank));
}

std::vector<std::uint64_t> Graph::ids_of(std::span<const Index> positions) const {
  return detail::look_up(state_->comm(), state_->blocks, ids(), positions);
}

std::vector<Index> Graph::positions_of(std::span<const std::uint64_t> ids) const {
  const auto& comm = state_->comm();
  const auto& mine = state_->ids;
  const auto nothing = std::numeric_limits<std::uint64_t>::max();
  const auto firsts = detail::gather_all(comm, mine.empty() ? nothing : mine.front());
  const auto owner = [&](std::uint64_t id) {
    const auto above = std::upper_bound(firsts.begin(), firsts.end(), id) - firsts.begin();
    return std::max(0, static_cast<int>(above) - 1);
  };
  const auto asked = detail::exchange(comm, ids, owner);
  std::vector<Index> answers;
  for (const auto id : asked.items) {
    const auto place = std::lower_bound(mine.begin(), mine.end(), id);
    const bool known = place != mine.end() && *place == id;
    answers.push_back(known ? block_begin() + static_cast<Index>(place - mine.begin()) : -1);
  }
  const auto found = detail::reply<Index>(comm, asked, std::span<const Index>(answers), ids, owner);
  session().together([&] {
    const auto missing = std::find(found.begin(), found.end(), -1) - found.begin();
    if (missing == static_cast<std::ptrdiff_t>(found.size())) return;
    throw InvalidArgument("vertex", "the graph has none that is numbered " +
                                        std::to_string(ids[static_cast<std::size_t>(missing)]));
  });
  return found;
}

Graph Graph::filtered(const std::vector<bool>& keep) const {
  const detail::FileOrder order(*state_);
  session().together([&] {
    if (keep.size() != order.count()) {
      throw InvalidArgument("keep", "must have one entry per edge");
    }
  });
  const auto kept = order.from_file(std::vector<char>(keep.begin(), keep.end()));
  return Graph(detail::filter_edges(*state_, kept));
}

std::vector<FileOrderEdge> Graph::edges() const {
  const auto& comm = state_->comm();
  std::vector<Index> ends;
  for (const auto& edge : state_->edges) ends.insert(ends.end(), {edge.from, edge.to});
  ends = detail::look_up(comm, state_->rows, std::span<const Index>(state_->position_of),
                         std::span<const Index>(ends));
  std::vector<FileOrderEdge> placed;
  for (std::size_t k = 0; k < state_->edges.size(); ++k) {
    const auto& edge = state_->edges[k];
    placed.push_back({edge.place, ends[2 * k], ends[2 * k + 1], edge.weight});
  }
  auto mine =
      detail::exchange(comm, std::span<const FileOrderEdge>(placed),
                       [&](const FileOrderEdge& edge) { return state_->places.owner(edge.number); })
          .items;
  std::sort(mine.begin(), mine.end(),
            [](const FileOrderEdge& a, const FileOrderEdge& b) { return a.number < b.number; });
  auto number = detail::sum_before(comm, static_cast<std::int64_t>(mine.size()));
  for (auto& edge : mine) edge.number = number++;
  return mine;
}

}  // namespace isotherm::spectral::distributed
