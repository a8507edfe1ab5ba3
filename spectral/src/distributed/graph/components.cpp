#include "distributed/graph/components.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "distributed/graph/graph_state.hpp"

namespace isotherm::spectral::distributed::detail {
namespace {

constexpr Index kNone = -1;

class Joined {
 public:
  explicit Joined(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  Index root(Index k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }
  void join(Index a, Index b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<Index> parent_;
};

/// An edge that leads to another rank, as the rank of either end sees it.
struct Crossing {
  Index here = 0;
  Index there = 0;
};

std::vector<Crossing> crossings(const Comm& comm, const Blocks& rows,
                                std::span<const RowEdge> edges) {
  const auto begin = rows.begin(comm.rank), end = rows.end(comm.rank);
  std::vector<Crossing> mine, others;
  for (const auto& edge : edges) {
    if (edge.to >= begin && edge.to < end) continue;
    mine.push_back({edge.from, edge.to});
    others.push_back({edge.to, edge.from});
  }
  const auto come = exchange(comm, std::span<const Crossing>(others),
                             [&](const Crossing& crossing) { return rows.owner(crossing.here); });
  mine.insert(mine.end(), come.items.begin(), come.items.end());
  return mine;
}

/// Components of what this rank has, with their smallest positions.
void find_local(const Comm& comm, const Blocks& rows, std::span<const RowEdge> edges,
                std::span<const Index> position_of, Components& found) {
  const auto begin = static_cast<Index>(rows.begin(comm.rank));
  const auto count = static_cast<Index>(position_of.size());
  Joined joined(position_of.size());
  for (const auto& edge : edges) {
    const Index to = edge.to - begin;
    if (to >= 0 && to < count) joined.join(edge.from - begin, to);
  }
  found.of_row.assign(position_of.size(), kNone);
  for (Index row = 0; row < count; ++row) {
    auto& number = found.of_row[joined.root(row)];
    if (number == kNone) {
      number = static_cast<Index>(found.label.size());
      found.label.push_back(std::numeric_limits<Index>::max());
    }
    found.of_row[row] = number;
    found.label[number] = std::min(found.label[number], position_of[row]);
  }
}

/// Lets labels spread until none becomes smaller.
void spread(const Comm& comm, const Blocks& rows, std::span<const Crossing> ways,
            Components& found) {
  const Index begin = static_cast<Index>(rows.begin(comm.rank));
  std::vector<Index> there;
  for (const auto& way : ways) there.push_back(way.there);
  std::sort(there.begin(), there.end());
  there.erase(std::unique(there.begin(), there.end()), there.end());
  const auto owner = [&](Index row) { return rows.owner(row); };
  const auto asked = exchange(comm, std::span<const Index>(there), owner);
  for (bool changed = true; any(comm, changed);) {
    changed = false;
    std::vector<Index> answers;
    answers.reserve(asked.items.size());
    for (const Index row : asked.items) answers.push_back(found.label[found.of_row[row - begin]]);
    const auto labels = reply<Index>(comm, asked, std::span<const Index>(answers),
                                     std::span<const Index>(there), owner);
    for (const auto& way : ways) {
      const auto place = std::lower_bound(there.begin(), there.end(), way.there) - there.begin();
      auto& label = found.label[found.of_row[way.here - begin]];
      changed = changed || labels[place] < label;
      label = std::min(label, labels[place]);
    }
  }
}

/// Gives each component that lies on several ranks a slot.
void number_shared(const Comm& comm, const Blocks& rows, std::span<const Crossing> ways,
                   Components& found) {
  const Index begin = static_cast<Index>(rows.begin(comm.rank));
  std::vector<Index> shared;
  for (const auto& way : ways) shared.push_back(found.label[found.of_row[way.here - begin]]);
  std::sort(shared.begin(), shared.end());
  shared.erase(std::unique(shared.begin(), shared.end()), shared.end());
  shared = concatenate(comm, shared);
  std::sort(shared.begin(), shared.end());
  shared.erase(std::unique(shared.begin(), shared.end()), shared.end());
  found.slot_count = shared.size();
  for (const Index label : found.label) {
    const auto place = std::lower_bound(shared.begin(), shared.end(), label);
    const bool is_shared = place != shared.end() && *place == label;
    found.slot.push_back(is_shared ? static_cast<Index>(place - shared.begin()) : kNone);
  }
}

}  // namespace

void Components::add_up(const Comm& comm, std::span<double> sums) const {
  std::vector<double> shared(slot_count, 0.0);
  for (std::size_t k = 0; k < slot.size(); ++k) {
    if (slot[k] != kNone) shared[slot[k]] += sums[k];
  }
  sum_each(comm, shared);
  for (std::size_t k = 0; k < slot.size(); ++k) {
    if (slot[k] != kNone) sums[k] = shared[slot[k]];
  }
}

void Components::take_largest(const Comm& comm, std::span<double> values) const {
  std::vector<double> shared(slot_count, -std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < slot.size(); ++k) {
    if (slot[k] != kNone) shared[slot[k]] = std::max(shared[slot[k]], values[k]);
  }
  MPI_Allreduce(MPI_IN_PLACE, shared.data(), static_cast<int>(shared.size()), MPI_DOUBLE, MPI_MAX,
                comm.handle);
  for (std::size_t k = 0; k < slot.size(); ++k) {
    if (slot[k] != kNone) values[k] = shared[slot[k]];
  }
}

Components find_components(const Comm& comm, const Blocks& rows, std::span<const RowEdge> edges,
                           std::span<const Index> position_of) {
  Components found;
  find_local(comm, rows, edges, position_of, found);
  const std::vector<Index> own = found.label;
  const auto ways = crossings(comm, rows, edges);
  spread(comm, rows, ways, found);
  number_shared(comm, rows, ways, found);
  // Only one part of a component has its smallest position.
  std::int64_t firsts = 0;
  for (std::size_t k = 0; k < own.size(); ++k) {
    found.first.push_back(own[k] == found.label[k]);
    if (found.first.back()) ++firsts;
  }
  found.count = sum(comm, firsts);
  return found;
}

}  // namespace isotherm::spectral::distributed::detail
