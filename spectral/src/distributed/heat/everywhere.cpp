#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "distributed/heat/heat_queries.hpp"

namespace isotherm::spectral::distributed::detail {
namespace {

using spectral::detail::HeatGoal;
using spectral::detail::HeatRules;
using spectral::detail::LanczosMatrix;

constexpr std::size_t kColumns = 8;  // vectors at once: a cache line of each row
constexpr int kFirstCheck = 3;
/// A residual this small against the norm is rounding: the space is exhausted.
constexpr double kBreakdown = 4.0 * std::numeric_limits<double>::epsilon();

/// A query that all ranks know.
struct Task {
  VertexPair rows;
  std::int32_t rank = 0;  // that asks
  std::int32_t place = 0;
};

/// A column's Lanczos process, the same on every rank but for its vectors.
struct Run {
  Run(const Task& of, const HeatGoal& goal)
      : task(of), rules(goal.tolerance), values(goal.scales.size(), {0.5 * kNorm, 0.0, kNorm}) {
    rules.start(kNorm);
  }

  static constexpr double kNorm = spectral::detail::kLargestNorm;
  Task task;
  HeatRules rules;
  std::vector<double> diagonal, off_diagonal;
  std::vector<CertifiedValue> values;
  bool exhausted = false;
  int next_check = kFirstCheck;
};

/// A block of vectors of the graph's rows, by columns.
class Block {
 public:
  Block(const Graph::State& graph, std::size_t columns) : rows_(graph.row_count()) {
    check(MatCreateDense(graph.comm().handle, static_cast<PetscInt>(rows_), PETSC_DECIDE,
                         static_cast<PetscInt>(graph.rows.total()), static_cast<PetscInt>(columns),
                         nullptr, matrix_.out()));
    check(MatAssemblyBegin(matrix_.get(), MAT_FINAL_ASSEMBLY));
    check(MatAssemblyEnd(matrix_.get(), MAT_FINAL_ASSEMBLY));
  }
  Mat get() const { return matrix_.get(); }
  Mat* out() { return matrix_.out(); }

 private:
  std::size_t rows_;
  MatHandle matrix_;
};

/// The entries of a block, for as long as this lives.
class Columns {
 public:
  explicit Columns(Mat block) : block_(block) {
    check(MatDenseGetArray(block, &entries_));
    check(MatDenseGetLDA(block, &stride_));
  }
  ~Columns() { MatDenseRestoreArray(block_, &entries_); }
  Columns(const Columns&) = delete;
  Columns& operator=(const Columns&) = delete;
  double* operator[](std::size_t k) const {
    return entries_ + static_cast<std::size_t>(stride_) * k;
  }

 private:
  Mat block_;
  double* entries_ = nullptr;
  PetscInt stride_ = 0;
};

class Everywhere {
 public:
  Everywhere(const Graph::State& graph, const HeatGoal& goal, std::vector<Task> tasks)
      : graph_(graph),
        goal_(goal),
        tasks_(std::move(tasks)),
        runs_(std::min(kColumns, tasks_.size())),
        previous_(graph, runs_.size()),
        current_(graph, runs_.size()) {
    check(MatMatMult(graph.laplacian.get(), current_.get(), MAT_INITIAL_MATRIX, PETSC_DEFAULT,
                     next_.out()));
    for (std::size_t k = 0; k < runs_.size(); ++k) begin(k);
  }

  bool done() const {
    return std::none_of(runs_.begin(), runs_.end(), [](const auto& run) { return run; });
  }
  std::int64_t finished() const { return finished_; }

  /// One step of every column. Calls take(run) for those that are done.
  template <class Take>
  void step(Take take) {
    check(MatMatMult(graph_.laplacian.get(), current_.get(), MAT_REUSE_MATRIX, PETSC_DEFAULT,
                     next_.out_again()));
    recur();
    for (std::size_t k = 0; k < runs_.size(); ++k) {
      if (!runs_[k] || !settled(*runs_[k])) continue;
      take(*runs_[k]);
      ++finished_;
      begin(k);
    }
  }

 private:
  /// The product of two blocks, which PETSc fills again in place.
  struct Product {
    MatHandle matrix;
    Mat again = nullptr;
    Mat* out() { return matrix.out(); }
    Mat* out_again() {
      again = matrix.get();
      return &again;
    }
  };

  void begin(std::size_t k) {
    runs_[k].reset();
    const Columns current(current_.get()), previous(previous_.get());
    std::fill_n(current[k], graph_.row_count(), 0.0);
    std::fill_n(previous[k], graph_.row_count(), 0.0);
    if (next_task_ == tasks_.size()) return;
    const auto& task = tasks_[next_task_++];
    const double root_half = std::sqrt(0.5);
    if (graph_.owns(task.rows.from)) current[k][task.rows.from - graph_.first_row()] = root_half;
    if (graph_.owns(task.rows.to)) current[k][task.rows.to - graph_.first_row()] = -root_half;
    runs_[k].emplace(task, goal_);
  }

  /// The three-term recurrence, after the product.
  void recur() {
    const auto rows = graph_.row_count();
    const Columns next(next_.matrix.get()), current(current_.get()), previous(previous_.get());
    std::vector<double> alpha(runs_.size(), 0.0), beta(runs_.size(), 0.0);
    for (std::size_t k = 0; k < runs_.size(); ++k) {
      if (!runs_[k]) continue;
      const auto& before = runs_[k]->off_diagonal;
      const double last = before.empty() ? 0.0 : before.back();
      for (std::size_t r = 0; r < rows; ++r) {
        next[k][r] -= last * previous[k][r];
        alpha[k] += next[k][r] * current[k][r];
      }
    }
    sum_each(graph_.comm(), alpha);
    for (std::size_t k = 0; k < runs_.size(); ++k) {
      if (!runs_[k]) continue;
      for (std::size_t r = 0; r < rows; ++r) {
        next[k][r] -= alpha[k] * current[k][r];
        beta[k] += next[k][r] * next[k][r];
      }
    }
    sum_each(graph_.comm(), beta);
    for (std::size_t k = 0; k < runs_.size(); ++k) {
      if (!runs_[k]) continue;
      auto& run = *runs_[k];
      const double norm = std::sqrt(beta[k]);
      run.diagonal.push_back(alpha[k]);
      run.off_diagonal.push_back(norm);
      run.exhausted = norm <= kBreakdown * graph_.norm_bound;
      if (run.exhausted) continue;
      for (std::size_t r = 0; r < rows; ++r) {
        previous[k][r] = current[k][r];
        current[k][r] = next[k][r] / norm;
      }
    }
  }

  /// Whether a run is done; brings its brackets up to date now and then.
  bool settled(Run& run) const {
    const LanczosMatrix matrix{run.diagonal, run.off_diagonal, graph_.norm_bound, run.exhausted};
    const bool last = run.exhausted || matrix.steps() >= goal_.max_steps;
    if (!last && matrix.steps() < run.next_check) return false;
    run.next_check = matrix.steps() + std::max(2, matrix.steps() / 3);
    run.rules.extend_to_radau(matrix);
    bool all = true;
    for (std::size_t s = 0; s < goal_.scales.size(); ++s) {
      if (!goal_.reached(run.values[s], s)) {
        run.rules.tighten(matrix, goal_.scales[s], run.values[s]);
      }
      all = all && run.rules.settled(matrix, goal_, s, run.values[s]);
    }
    return all || last;
  }

  const Graph::State& graph_;
  const HeatGoal& goal_;
  std::vector<Task> tasks_;
  std::vector<std::optional<Run>> runs_;  // one a column, while there is something to do
  Block previous_, current_;
  Product next_;
  std::size_t next_task_ = 0;
  std::int64_t finished_ = 0;
};

}  // namespace

void answer_everywhere(const Graph::State& graph, const HeatGoal& goal, const Steps& steps,
                       const std::vector<std::size_t>& which, std::vector<HeatQuery>& queries) {
  const auto& comm = graph.comm();
  std::vector<Task> tasks;
  for (const auto place : which) {
    tasks.push_back({queries[place].rows, comm.rank, static_cast<std::int32_t>(place)});
  }
  tasks = concatenate(comm, tasks);
  if (tasks.empty()) return;
  const auto total = static_cast<std::int64_t>(tasks.size());
  Everywhere everywhere(graph, goal, std::move(tasks));
  while (!everywhere.done()) {
    everywhere.step([&](const Run& run) {
      if (run.task.rank != comm.rank) return;
      auto& query = queries[static_cast<std::size_t>(run.task.place)];
      query.values = run.values;
      query.steps = static_cast<std::int32_t>(run.diagonal.size());
    });
    steps.done("heat distances", everywhere.finished(), total);
  }
}

}  // namespace isotherm::spectral::distributed::detail
