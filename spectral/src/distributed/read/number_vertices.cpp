#include <algorithm>
#include <limits>
#include <utility>

#include "distributed/read/edge_part.hpp"
#include "isotherm/base/error.hpp"

namespace isotherm::spectral::distributed::detail {
namespace {

using spectral::detail::FileEdge;
using Ids = std::vector<std::uint64_t>;

// Of a sample from each rank, so many a rank: shares are then even to about a tenth.
constexpr std::size_t kSamples = 100;

void sort_unique(Ids& ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

/// Where the shares of ranks 1, 2, ... begin, so that they are about even.
Ids splitters(const Comm& comm, const Ids& ids) {
  Ids sample;
  const std::size_t count = std::min(ids.size(), kSamples * static_cast<std::size_t>(comm.size));
  for (std::size_t k = 0; k < count; ++k) sample.push_back(ids[k * ids.size() / count]);
  sample = concatenate(comm, sample);
  sort_unique(sample);
  Ids starts;
  for (int rank = 1; rank < comm.size && !sample.empty(); ++rank) {
    starts.push_back(sample[sample.size() * static_cast<std::size_t>(rank) /
                            static_cast<std::size_t>(comm.size)]);
  }
  return starts;
}

/// `numbers`, which are those of the positions from `begin` on, to the owners of these positions.
Ids to_blocks(const Comm& comm, const Blocks& blocks, const Ids& numbers, std::int64_t begin) {
  const auto* first = numbers.data();
  const auto owner = [&](const std::uint64_t& id) { return blocks.owner(begin + (&id - first)); };
  return exchange(comm, std::span<const std::uint64_t>(numbers), owner).items;
}

}  // namespace

EdgePart number_vertices(const Comm& comm, std::vector<FileEdge> edges, Ids others,
                         const std::string& path) {
  Ids mine = std::move(others);
  mine.reserve(mine.size() + 2 * edges.size());
  for (const auto& edge : edges) {
    mine.push_back(edge.from);
    mine.push_back(edge.to);
  }
  sort_unique(mine);
  mine.shrink_to_fit();
  const Ids starts = splitters(comm, mine);
  const auto owner = [&](std::uint64_t id) {
    return static_cast<int>(std::upper_bound(starts.begin(), starts.end(), id) - starts.begin());
  };
  const auto asked = exchange(comm, std::span<const std::uint64_t>(mine), owner);
  Ids share = asked.items;
  sort_unique(share);

  EdgePart part;
  const auto begin = sum_before(comm, static_cast<std::int64_t>(share.size()));
  const auto total = sum(comm, static_cast<std::int64_t>(share.size()));
  if (total > std::numeric_limits<Index>::max() - 1) {
    throw ParseError({path, 0, 0}, "", "too many vertices: " + std::to_string(total));
  }
  std::vector<Index> answers;
  answers.reserve(asked.items.size());
  for (const auto id : asked.items) {
    const auto place = std::lower_bound(share.begin(), share.end(), id) - share.begin();
    answers.push_back(static_cast<Index>(begin + place));
  }
  const auto positions = reply<Index>(comm, asked, std::span<const Index>(answers),
                                      std::span<const std::uint64_t>(mine), owner);
  part.blocks = Blocks(comm, total);
  part.ids = to_blocks(comm, part.blocks, share, begin);
  const auto position = [&](std::uint64_t id) {
    return positions[std::lower_bound(mine.begin(), mine.end(), id) - mine.begin()];
  };
  part.edges.reserve(edges.size());
  for (const auto& edge : edges) {
    part.edges.push_back({position(edge.from), position(edge.to), edge.weight});
  }
  return part;
}

}  // namespace isotherm::spectral::distributed::detail
