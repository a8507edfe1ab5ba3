#include <algorithm>
#include <numeric>
#include <utility>

#include "distributed/heat/heat_queries.hpp"

namespace isotherm::spectral::distributed::detail {
namespace {

using spectral::detail::HeatBracketer;
using spectral::detail::HeatGoal;

constexpr int kFirstReach = 8;  // steps; each time twice as many, so that most are not in vain
constexpr std::int64_t kSmallest = 1000;  // rows that any rank has room for

/// Rows within some steps of queries, in order of position, as the graph on one machine has them.
struct Ball {
  SparseMatrix laplacian;
  std::vector<Index> rows;    // sorted
  std::vector<Index> number;  // of each of these in `laplacian`

  Index of(Index row) const {
    return number[std::lower_bound(rows.begin(), rows.end(), row) - rows.begin()];
  }
};

/// Rows within some steps of others, and whether these are all that can be reached.
struct Around {
  IsHandle rows;
  bool all = false;
};

std::size_t size_of(IS set) {
  PetscInt size = 0;
  check(ISGetLocalSize(set, &size));
  return static_cast<std::size_t>(size);
}

/// Collective, whoever has rows to ask for. Ends early where no rank's rows grow any more but for
/// those with more than `budget` of them.
Around rows_around(const Graph::State& graph, const std::vector<Index>& rows, int reach,
                   std::size_t budget) {
  IS set = nullptr;
  check(ISCreateGeneral(PETSC_COMM_SELF, static_cast<PetscInt>(rows.size()), rows.data(),
                        PETSC_COPY_VALUES, &set));
  Around around;
  *around.rows.out() = set;
  check(ISSortRemoveDups(set));
  for (int left = reach; left > 0; left -= kFirstReach) {
    const auto before = size_of(set);
    check(PetscObjectReference(reinterpret_cast<PetscObject>(set)));
    check(MatIncreaseOverlap(graph.laplacian.get(), 1, &set, std::min(left, kFirstReach)));
    *around.rows.out() = set;
    around.all = size_of(set) == before;
    if (!any(graph.comm(), !around.all && size_of(set) <= budget)) break;
  }
  check(ISSort(set));
  return around;
}

std::vector<Index> indices(IS set) {
  PetscInt count = 0;
  const PetscInt* first = nullptr;
  check(ISGetLocalSize(set, &count));
  check(ISGetIndices(set, &first));
  std::vector<Index> result(first, first + count);
  check(ISRestoreIndices(set, &first));
  return result;
}

/// `matrix` with row and column k called number[k].
SparseMatrix renumbered(Mat matrix, const std::vector<Index>& number) {
  PetscInt count = 0;
  const PetscInt *starts = nullptr, *columns = nullptr;
  const double* values = nullptr;
  PetscBool done = PETSC_FALSE;
  check(MatGetRowIJ(matrix, 0, PETSC_FALSE, PETSC_FALSE, &count, &starts, &columns, &done));
  check(MatSeqAIJGetArrayRead(matrix, &values));
  std::vector<Index> old(number.size());
  for (std::size_t k = 0; k < number.size(); ++k) old[number[k]] = static_cast<Index>(k);
  SparseMatrix result(count, count);
  result.reserve(count > 0 ? starts[count] : 0);
  std::vector<std::pair<Index, double>> entries;
  for (Index column = 0; column < count; ++column) {
    entries.clear();
    for (PetscInt k = starts[old[column]]; k < starts[old[column] + 1]; ++k) {
      entries.emplace_back(number[columns[k]], values[k]);
    }
    std::sort(entries.begin(), entries.end());
    result.startVec(column);
    for (const auto& [row, value] : entries) result.insertBack(row, column) = value;
  }
  result.finalize();
  check(MatSeqAIJRestoreArrayRead(matrix, &values));
  check(MatRestoreRowIJ(matrix, 0, PETSC_FALSE, PETSC_FALSE, &count, &starts, &columns, &done));
  return result;
}

/// Collective, whoever has rows to ask for.
Ball bring(const Graph::State& graph, IS set) {
  Ball ball;
  ball.rows = indices(set);
  const auto positions =
      look_up(graph.comm(), graph.rows, std::span<const Index>(graph.position_of),
              std::span<const Index>(ball.rows));
  std::vector<Index> order(ball.rows.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return positions[a] < positions[b]; });
  ball.number.resize(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) ball.number[order[k]] = static_cast<Index>(k);
  Mat* parts = nullptr;
  check(MatCreateSubMatrices(graph.laplacian.get(), 1, &set, &set, MAT_INITIAL_MATRIX, &parts));
  ball.laplacian = renumbered(parts[0], ball.number);
  check(MatDestroySubMatrices(1, &parts));
  return ball;
}

/// The queries of one rank that are open, and how far is looked for them.
class Nearby {
 public:
  Nearby(const Graph::State& graph, const HeatGoal& goal, std::vector<HeatQuery>& queries)
      : graph_(graph), goal_(goal), queries_(queries) {
    open_.resize(queries.size());
    std::iota(open_.begin(), open_.end(), 0);
    const auto average = graph.rows.total() / graph.comm().size;
    budget_ = static_cast<std::size_t>(std::max(kSmallest, average));
    // What is next to each other reaches the same rows.
    std::sort(open_.begin(), open_.end(), [&](std::size_t a, std::size_t b) {
      return queries[a].rows.from < queries[b].rows.from;
    });
    batch_ = open_.size();
  }

  bool done() const { return open_.empty() && later_.empty(); }
  std::vector<std::size_t>& far() { return far_; }
  std::int64_t answered() const { return answered_; }

  /// Collective.
  void advance() {
    // All ranks grow what they ask for by as many steps.
    if (!any(graph_.comm(), !open_.empty())) look_further();
    batch_ = std::min(batch_, open_.size());
    auto around =
        graph_.comm().size == 1 ? everything() : rows_around(graph_, ends(), reach_, budget_);
    const auto size = size_of(around.rows.get());
    const bool fits = size <= budget_;
    if (!fits) {
      const PetscInt nothing = 0;
      check(ISCreateGeneral(PETSC_COMM_SELF, 0, &nothing, PETSC_COPY_VALUES, around.rows.out()));
    }
    const Ball ball = bring(graph_, around.rows.get());
    if (fits) {
      answer(ball, around.all ? goal_.max_steps : reach_);
    } else {
      ask_for_less(static_cast<double>(size));
    }
  }

 private:
  void look_further() {
    std::swap(open_, later_);
    batch_ = open_.size();
    reach_ = std::min(2 * reach_, goal_.max_steps);
  }

  // One rank has all that can be reached.
  Around everything() const {
    Around all;
    all.all = true;
    check(ISCreateStride(PETSC_COMM_SELF,
                         open_.empty() ? 0 : static_cast<PetscInt>(graph_.rows.total()), 0, 1,
                         all.rows.out()));
    return all;
  }

  std::vector<Index> ends() const {
    std::vector<Index> rows;
    for (std::size_t k = 0; k < batch_; ++k) {
      const auto& pair = queries_[open_[open_.size() - 1 - k]].rows;
      rows.insert(rows.end(), {pair.from, pair.to});
    }
    return rows;
  }

  void answer(const Ball& ball, int most_steps) {
    HeatBracketer bracketer(ball.laplacian, goal_.tolerance);
    HeatGoal goal = goal_;
    goal.max_steps = most_steps;
    for (std::size_t k = 0; k < batch_; ++k) {
      auto& query = queries_[open_.back()];
      query.steps =
          bracketer.run({ball.of(query.rows.from), ball.of(query.rows.to)}, goal, query.values);
      // A run that ended only because it may go no further would end elsewhere on one machine.
      const bool cut_short = query.steps >= most_steps && most_steps < goal_.max_steps;
      if (cut_short) later_.push_back(open_.back());
      if (!cut_short) ++answered_;
      open_.pop_back();
    }
    batch_ *= 2;
    hopeless_ = 1;
  }

  /// Fewer pairs next time, about as many as there is room for. Where one alone is too many it
  /// reaches too far, and so do its neighbours as it seems: twice as many each time in a row.
  void ask_for_less(double size) {
    if (batch_ > 1) {
      const double share = static_cast<double>(budget_) / size;
      const auto fitting = static_cast<std::size_t>(share * static_cast<double>(batch_));
      batch_ = std::clamp<std::size_t>(fitting, 1, batch_ / 2);
      return;
    }
    for (std::size_t k = 0; k < hopeless_ && !open_.empty(); ++k) {
      far_.push_back(open_.back());
      open_.pop_back();
    }
    hopeless_ *= 2;
  }

  const Graph::State& graph_;
  const HeatGoal& goal_;
  std::vector<HeatQuery>& queries_;
  std::vector<std::size_t> open_, later_, far_;  // places of queries; the last are next
  std::size_t batch_ = 0;                        // so many of the open ones at once
  std::size_t hopeless_ = 1;                     // pairs to give up if one is too many
  std::size_t budget_ = 0;                       // rows
  int reach_ = kFirstReach;
  std::int64_t answered_ = 0;
};

}  // namespace

std::vector<std::size_t> answer_nearby(const Graph::State& graph, const HeatGoal& goal,
                                       const Steps& steps, std::vector<HeatQuery>& queries) {
  const auto& comm = graph.comm();
  const auto total = sum(comm, static_cast<std::int64_t>(queries.size()));
  Nearby nearby(graph, goal, queries);
  while (any(comm, !nearby.done())) {
    nearby.advance();
    steps.done("heat distances", sum(comm, nearby.answered()), total);
  }
  return std::move(nearby.far());
}

}  // namespace isotherm::spectral::distributed::detail
