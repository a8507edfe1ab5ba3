#include "distributed/eigen/smallest_eigenpairs.hpp"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <optional>

#include "distributed/eigen/assessment.hpp"

namespace isotherm::spectral::distributed {
namespace detail {
namespace {

constexpr int kMaxRounds = 4;  // searches for eigenpairs that the iteration missed

/// What the ranks of this machine may take each, in bytes: half of what is free, in even shares.
double free_share(const Comm& comm) {
  double free = 0.0;
  std::ifstream file("/proc/meminfo");
  for (std::string name, rest; file >> name && std::getline(file, rest);) {
    if (name == "MemAvailable:") free = 1024.0 * std::stod(rest);
  }
  MPI_Comm machine = MPI_COMM_NULL;
  int ranks = 1;
  MPI_Comm_split_type(comm.handle, MPI_COMM_TYPE_SHARED, comm.rank, MPI_INFO_NULL, &machine);
  MPI_Comm_size(machine, &ranks);
  MPI_Comm_free(&machine);
  return least(comm, 0.5 * free / ranks);
}

/// What a factorisation may take on a rank, in bytes.
double budget(const Comm& comm, const SolverOptions& solver) {
  constexpr double kGibi = 1024.0 * 1024.0 * 1024.0;
  return solver.factor_memory > 0.0 ? solver.factor_memory * kGibi : free_share(comm);
}

/// What rank 0 needs to find an ordering alone: both triangles of the pattern, and as much again
/// to change while it eliminates, in integers of 32 bits.
double memory_of_ordering(const Graph::State& graph) {
  const auto entries = 2 * graph.edge_count + graph.rows.total();
  return 2.0 * sizeof(std::int32_t) * static_cast<double>(entries);
}

/// How many eigenvalues lie below `bound`.
std::int64_t count_below(const LaplacianMatrix& laplacian, double bound) {
  MatHandle shifted;
  check(MatDuplicate(laplacian.get(), MAT_COPY_VALUES, shifted.out()));
  check(MatShift(shifted.get(), -bound));
  check(MatSetOption(shifted.get(), MAT_SYMMETRIC, PETSC_TRUE));
  MumpsFactor factor(laplacian.graph().comm(), shifted.get(), MumpsFactor::For::counting);
  factor.factorise();
  return factor.negative_pivots();
}

/// A point just below the largest eigenvalue found, clear of its rounding.
double inertia_bound(const LaplacianMatrix& laplacian, const Pairs& pairs) {
  const double value = pairs.values.back();
  const double off = residual(laplacian, pairs.vectors.back().get(), value);
  return value - std::max({2.0 * off, 1e-7 * value, rounding(laplacian)});
}

struct Search {
  Pairs pairs;
  std::int64_t inertia_count = -1;
  bool complete = true;
};

/// Iterates, then counts, and looks again in the complement of what was found while the count says
/// that some are missing.
Search iterate(const LaplacianMatrix& laplacian, const NullSpace& null_space,
               const Grounded& grounded, const MumpsFactor& factor, Mat edges, std::int64_t count,
               const EigenOptions& options, const Steps& steps) {
  PseudoInversePairs inverse(null_space, grounded, factor, laplacian, steps);
  const auto components = laplacian.graph().components.count;
  Search search;
  std::int64_t missing = count;
  for (int round = 0; missing > 0 && round <= kMaxRounds; ++round) {
    auto more = inverse.find(std::min(missing, count), search.pairs.vectors, options.max_restarts);
    merge(laplacian, edges, search.pairs, std::move(more), count);
    missing = count - search.pairs.count();
    if (search.pairs.count() == 0 || !options.check_inertia) continue;
    const double bound = inertia_bound(laplacian, search.pairs);
    if (bound <= 0.0) continue;
    search.inertia_count = count_below(laplacian, bound);
    const auto missed = search.inertia_count - components - search.pairs.below(bound);
    search.complete = missed <= 0;
    missing = std::max(missing, missed);
  }
  return search;
}

/// By shift-invert if that is asked for or fits; nothing if it does not.
std::optional<Search> search_by_factor(const LaplacianMatrix& laplacian,
                                       const NullSpace& null_space, Mat edges, std::int64_t count,
                                       const EigenOptions& options, const SolverOptions& solver,
                                       const Steps& steps) {
  if (solver.eigen_solver == EigenSolver::lobpcg) return std::nullopt;
  const auto& graph = laplacian.graph();
  const bool by_size = solver.eigen_solver == EigenSolver::automatic;
  const double room = by_size ? budget(graph.comm(), solver) : 0.0;
  if (by_size && memory_of_ordering(graph) > room) return std::nullopt;
  const Grounded grounded(laplacian);
  MumpsFactor factor(graph.comm(), grounded.get(), MumpsFactor::For::solving);
  if (by_size && factor.expected_memory() > room) return std::nullopt;
  factor.factorise();
  return iterate(laplacian, null_space, grounded, factor, edges, count, options, steps);
}

}  // namespace

SolvedPairs solve_pairs(const Graph& graph, LaplacianKind kind, const EigenOptions& options,
                        const SolverOptions& solver) {
  options.validate();
  solver.validate();
  const auto start = std::chrono::steady_clock::now();
  const auto& state = graph.state();
  const LaplacianMatrix laplacian(state, kind);
  const NullSpace null_space(laplacian);
  const Steps steps(state.comm(), options.progress);
  const auto components = state.components.count;
  const auto nulls = options.null_vectors ? std::min<std::int64_t>(options.count, components) : 0;
  const auto wanted = std::min(options.count - nulls, state.rows.total() - components);

  SolvedPairs solved;
  auto& result = solved.eigen;
  result.kind = kind;
  result.norm = laplacian.norm();
  result.null_count = static_cast<Index>(nulls);
  result.method = EigenMethod::shift_invert;
  Search search;
  if (wanted > 0) {
    const auto edges = incidence(state);
    auto found =
        search_by_factor(laplacian, null_space, edges.get(), wanted, options, solver, steps);
    if (found) {
      search = std::move(*found);
    } else {
      solved.solver = EigenSolver::lobpcg;
      merge(laplacian, edges.get(), search.pairs,
            lobpcg_pairs(laplacian, null_space, wanted, options.tolerance, options.max_restarts,
                         steps),
            wanted);
    }
  }
  result.inertia_count = search.inertia_count;
  if (search.pairs.count() < wanted) result.status = EigenStatus::not_converged;
  if (!search.complete) result.status = EigenStatus::missed_pairs;
  assess(laplacian, null_space, search.pairs, options.tolerance, result);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return solved;
}

}  // namespace detail

void SolverOptions::validate() const { require_fields_in_range(*this); }

EigenDecomposition smallest_eigenpairs(const Graph& graph, LaplacianKind kind,
                                       const EigenOptions& options, const SolverOptions& solver) {
  return detail::solve_pairs(graph, kind, options, solver).eigen;
}

}  // namespace isotherm::spectral::distributed
