#include "sparse/find_supernodes.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "isotherm/base/error.hpp"
#include "sparse/cholmod_factor.hpp"

namespace isotherm::spectral::detail {
namespace {

struct Run {
  Index first = 0;           // column
  Index end = 0;             // column
  std::vector<Index> rows;   // below the own columns, ascending; the first is in the parent
  std::int64_t entries = 0;  // of L, without what joining has added

  Index width() const { return end - first; }
  std::int64_t places() const {
    const std::int64_t columns = width();
    return columns * (columns + 1) / 2 + columns * static_cast<std::int64_t>(rows.size());
  }
  bool is_child_of(Index begin_column, Index end_column) const {
    return !rows.empty() && rows.front() >= begin_column && rows.front() < end_column;
  }
};

// Rows of the matrix below the diagonal, by column, both in order of elimination.
std::vector<std::vector<Index>> rows_below(const LowerTriangle& pattern,
                                           std::span<const Index> order) {
  std::vector<Index> position_of(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) position_of[order[k]] = static_cast<Index>(k);
  std::vector<std::vector<Index>> below(order.size());
  for (std::size_t column = 0; column < order.size(); ++column) {
    for (Index at = pattern.starts[column]; at < pattern.starts[column + 1]; ++at) {
      const auto [low, high] = std::minmax(position_of[column], position_of[pattern.rows[at]]);
      if (low < high) below[low].push_back(high);
    }
  }
  return below;
}

// Columns with exactly the same rows below them.
std::vector<Run> exact_runs(std::vector<std::vector<Index>> below) {
  std::vector<Run> runs;
  std::vector<std::vector<std::size_t>> children(below.size());  // runs, by parent column
  for (Index column = 0; column < static_cast<Index>(below.size()); ++column) {
    std::vector<Index> rows = std::move(below[column]);
    const auto add = [&](const Run& child) {
      rows.insert(rows.end(), child.rows.begin() + 1, child.rows.end());
    };
    for (const std::size_t child : children[column]) add(runs[child]);
    const bool below_last = !runs.empty() && runs.back().is_child_of(column, column + 1);
    if (below_last) add(runs.back());
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    const auto entries = static_cast<std::int64_t>(rows.size()) + 1;
    if (below_last && runs.back().rows.size() == rows.size() + 1) {
      runs.back().end = column + 1;
      runs.back().rows = std::move(rows);
      runs.back().entries += entries;
      continue;
    }
    if (!runs.empty() && !runs.back().rows.empty() && !below_last) {
      children[runs.back().rows.front()].push_back(runs.size() - 1);
    }
    runs.push_back({column, column + 1, std::move(rows), entries});
  }
  return runs;
}

// Whether a block with zeros takes less time than two without.
bool worth_joining(const Run& joined) {
  const double zeros =
      1.0 - static_cast<double>(joined.entries) / static_cast<double>(joined.places());
  if (joined.width() <= 8) return zeros < 0.5;
  if (joined.width() <= 32) return zeros < 0.15;
  return zeros < 0.05;
}

// In postorder a run's last child is the one right before it.
std::vector<Run> join(std::vector<Run> runs) {
  std::vector<Run> joined;
  for (Run& run : runs) {
    while (!joined.empty() && joined.back().is_child_of(run.first, run.end)) {
      Run both{joined.back().first, run.end, {}, joined.back().entries + run.entries};
      both.rows.swap(run.rows);
      const bool worth = worth_joining(both);
      if (!worth) {
        both.rows.swap(run.rows);
        break;
      }
      joined.pop_back();
      run = std::move(both);
    }
    joined.push_back(std::move(run));
  }
  return joined;
}

}  // namespace

SupernodeLayout find_supernodes(const LowerTriangle& pattern, std::span<const Index> order) {
  SupernodeLayout layout{{0}, {0}, {}, {0}};
  std::int64_t values = 0;
  for (const Run& run : join(exact_runs(rows_below(pattern, order)))) {
    for (Index column = run.first; column < run.end; ++column) layout.rows.push_back(column);
    layout.rows.insert(layout.rows.end(), run.rows.begin(), run.rows.end());
    values += run.width() * (run.width() + static_cast<std::int64_t>(run.rows.size()));
    if (values > std::numeric_limits<Index>::max()) {
      throw NumericalError("factorisation", "more entries than 32-bit indices can count");
    }
    layout.first_column.push_back(run.end);
    layout.row_start.push_back(static_cast<Index>(layout.rows.size()));
    layout.value_start.push_back(static_cast<Index>(values));
  }
  return layout;
}

}  // namespace isotherm::spectral::detail
