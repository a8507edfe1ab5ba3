#include <algorithm>
#include <numeric>

#include "distributed/graph/build_graph.hpp"

namespace isotherm::spectral::distributed::detail {
namespace {

// Below so many vertices a rank, there is more to say about parts than there is to compute.
constexpr std::int64_t kSmallPart = 1000;

using Step = VertexPair;  // from a position of this rank's block

std::vector<Step> steps_of(const Comm& comm, const Blocks& positions,
                           std::span<const PlacedEdge> edges) {
  std::vector<Step> both;
  both.reserve(2 * edges.size());
  for (const auto& edge : edges) {
    if (edge.from == edge.to) continue;
    both.push_back({edge.from, edge.to});
    both.push_back({edge.to, edge.from});
  }
  auto steps = exchange(comm, std::span<const Step>(both), [&](const Step& step) {
                 return positions.owner(step.from);
               }).items;
  std::sort(steps.begin(), steps.end(), [](const Step& a, const Step& b) {
    return std::pair(a.from, a.to) < std::pair(b.from, b.to);
  });
  const auto same = [](const Step& a, const Step& b) { return a.from == b.from && a.to == b.to; };
  steps.erase(std::unique(steps.begin(), steps.end(), same), steps.end());
  return steps;
}

MatHandle adjacency(const Comm& comm, const Blocks& positions, std::span<const Step> steps) {
  const auto begin = static_cast<Index>(positions.begin(comm.rank));
  const auto count = static_cast<PetscInt>(positions.end(comm.rank) - begin);
  // The matrix takes both arrays.
  PetscInt *starts = nullptr, *columns = nullptr;
  check(PetscMalloc1(count + 1, &starts));
  check(PetscMalloc1(std::max<std::size_t>(steps.size(), 1), &columns));
  std::fill_n(starts, count + 1, 0);
  for (std::size_t k = 0; k < steps.size(); ++k) {
    ++starts[steps[k].from - begin + 1];
    columns[k] = steps[k].to;
  }
  std::partial_sum(starts, starts + count + 1, starts);
  MatHandle matrix;
  check(MatCreateMPIAdj(comm.handle, count, static_cast<PetscInt>(positions.total()), starts,
                        columns, nullptr, matrix.out()));
  return matrix;
}

std::vector<Index> scotch(const Comm& comm, const Blocks& positions,
                          std::span<const PlacedEdge> edges) {
  const auto steps = steps_of(comm, positions, edges);
  const auto matrix = adjacency(comm, positions, steps);
  PartitioningHandle partitioning;
  check(MatPartitioningCreate(comm.handle, partitioning.out()));
  check(MatPartitioningSetAdjacency(partitioning.get(), matrix.get()));
  check(MatPartitioningSetType(partitioning.get(), MATPARTITIONINGPTSCOTCH));
  check(MatPartitioningSetFromOptions(partitioning.get()));
  IsHandle owners, numbers;
  check(MatPartitioningApply(partitioning.get(), owners.out()));
  check(ISPartitioningToNumbering(owners.get(), numbers.out()));
  const PetscInt* first = nullptr;
  PetscInt count = 0;
  check(ISGetLocalSize(numbers.get(), &count));
  check(ISGetIndices(numbers.get(), &first));
  std::vector<Index> rows(first, first + count);
  std::vector<PetscInt> sizes(comm.size, 0);
  check(ISRestoreIndices(numbers.get(), &first));
  check(ISPartitioningCount(owners.get(), comm.size, sizes.data()));
  rows.push_back(sizes[comm.rank]);
  return rows;
}

}  // namespace

Rows partition(const Comm& comm, const Blocks& positions, std::span<const PlacedEdge> edges,
               Partitioner partitioner) {
  const bool small = positions.total() < kSmallPart * comm.size;
  Rows rows;
  if (comm.size == 1 || small || partitioner == Partitioner::none) {
    rows.of_block.resize(
        static_cast<std::size_t>(positions.end(comm.rank) - positions.begin(comm.rank)));
    std::iota(rows.of_block.begin(), rows.of_block.end(),
              static_cast<Index>(positions.begin(comm.rank)));
    rows.blocks = positions;
    return rows;
  }
  rows.of_block = scotch(comm, positions, edges);
  const Index mine = rows.of_block.back();
  rows.of_block.pop_back();
  rows.blocks = Blocks::of_sizes(comm, mine);
  return rows;
}

}  // namespace isotherm::spectral::distributed::detail
