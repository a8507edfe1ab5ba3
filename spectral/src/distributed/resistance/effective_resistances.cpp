#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "distributed/eigen/smallest_eigenpairs.hpp"
#include "distributed/resistance/multigrid_solver.hpp"
#include "isotherm/base/error.hpp"
#include "sparse/pair_pattern.hpp"

namespace isotherm::spectral::distributed {
namespace detail {
namespace {

constexpr double kUnit = std::numeric_limits<double>::epsilon();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMostRounds = 6;  // that a solve is taken up again for a narrower bracket

/// A pair that all ranks know, by rows.
struct Query {
  VertexPair rows;
  Index from_component = 0;  // label
  Index to_component = 0;
  double least = 0.0;  // that the resistance is for sure: of a vertex against all others
};

/// A lower bound of the smallest eigenvalue that is not null.
struct Gap {
  double value = 0.0;
  bool proven = false;
};

Gap spectral_gap(const Graph& graph, const ResistanceOptions& options) {
  if (graph.vertex_count() == graph.component_count()) return {kInfinity, true};
  EigenOptions eigen;
  eigen.count = 1;
  eigen.null_vectors = false;
  eigen.tolerance = 1e-8;
  eigen.progress = options.progress;
  const auto found = solve_pairs(graph, LaplacianKind::combinatorial, eigen, options.solver).eigen;
  if (found.count() == 0) return {};
  constexpr double kInertiaMargin = 1e-6;  // more than the count stays below the value
  const double value = (1.0 - kInertiaMargin) * found.values[0] - 2.0 * found.bounds[0];
  const bool counted = found.inertia_count >= 0 && found.status == EigenStatus::converged;
  return {std::max(0.0, value), counted};
}

class Brackets {
 public:
  Brackets(const Graph::State& graph, double gap, const ResistanceOptions& options)
      : graph_(graph),
        laplacian_(graph, LaplacianKind::combinatorial),
        solver_(laplacian_, options.max_iterations),
        incidence_(incidence(graph)),
        gap_(gap),
        tolerance_(options.tolerance),
        currents_(make_vector(graph)),
        potentials_(make_vector(graph)),
        residual_(make_vector(graph)) {
    check(MatCreateVecs(incidence_.get(), nullptr, flows_.out()));
    const auto most_edges = most(graph.comm(), static_cast<std::int64_t>(graph.edges.size()));
    summation_ = kUnit * static_cast<double>(most_edges + graph.comm().size);
  }

  CertifiedValue bracket(const Query& query) {
    set_currents(query.rows);
    check(VecSet(potentials_.get(), 0.0));
    CertifiedValue best{0.0, query.least, kInfinity};
    double absolute = std::sqrt(tolerance_ * gap_ * query.least);
    for (int round = 0; round < kMostRounds; ++round) {
      solver_.solve(currents_.get(), absolute, potentials_.get());
      const auto now = bracket_of_potentials(query.rows);
      best.lower = std::max(best.lower, now.lower);
      best.upper = std::min(best.upper, now.upper);
      if (best.width() <= tolerance_ * best.lower) break;
      absolute *= 0.1;
    }
    best.value = 0.5 * (best.lower + best.upper);
    return best;
  }

 private:
  void set_currents(const VertexPair& rows) {
    check(VecSet(currents_.get(), 0.0));
    const LocalEntries entries(currents_.get());
    if (graph_.owns(rows.from)) entries[rows.from - graph_.first_row()] = 1.0;
    if (graph_.owns(rows.to)) entries[rows.to - graph_.first_row()] = -1.0;
  }

  /// Potentials at both ends, on every rank.
  std::pair<double, double> ends(const VertexPair& rows) const {
    std::vector<double> values = {0.0, 0.0};
    const LocalEntries entries(potentials_.get());
    if (graph_.owns(rows.from)) values[0] = entries[rows.from - graph_.first_row()];
    if (graph_.owns(rows.to)) values[1] = entries[rows.to - graph_.first_row()];
    sum_each(graph_.comm(), values);
    return {values[0], values[1]};
  }

  /// 2 b'x - x'Lx = R - r'L^+ r, where r = b - Lx, and r'L^+ r <= |r|^2 / gap.
  CertifiedValue bracket_of_potentials(const VertexPair& rows) {
    const auto [from, to] = ends(rows);
    PetscReal flow = 0.0, size = 0.0, rest = 0.0;
    check(MatMult(incidence_.get(), potentials_.get(), flows_.get()));
    check(VecNorm(flows_.get(), NORM_2, &flow));
    check(VecNorm(potentials_.get(), NORM_2, &size));
    check(MatMult(laplacian_.get(), potentials_.get(), residual_.get()));
    check(VecAYPX(residual_.get(), -1.0, currents_.get()));
    check(VecNorm(residual_.get(), NORM_2, &rest));
    const double energy = flow * flow;
    const double rounding = 4.0 * kUnit * (std::abs(from) + std::abs(to)) +
                            4.0 * kUnit * flow * std::sqrt(laplacian_.norm()) * size +
                            summation_ * energy;
    const double lost = rest + 8.0 * kUnit * laplacian_.norm() * size;
    const double least = 2.0 * (from - to) - energy;
    return {least, least - rounding, least + rounding + lost * lost / gap_};
  }

  const Graph::State& graph_;
  LaplacianMatrix laplacian_;
  MultigridSolver solver_;
  MatHandle incidence_;
  double gap_;
  double tolerance_;
  double summation_ = 0.0;  // relative error of a sum over all edges
  VecHandle currents_, potentials_, residual_, flows_;
};

/// The pairs of all ranks.
std::vector<Query> queries_of(const Graph::State& graph, std::span<const VertexPair> pairs) {
  const auto& comm = graph.comm();
  std::vector<Index> ends;
  for (const auto& pair : pairs) ends.insert(ends.end(), {pair.from, pair.to});
  ends = look_up(comm, graph.blocks, std::span<const Index>(graph.row_of),
                 std::span<const Index>(ends));
  std::vector<Index> labels;
  for (const Index component : graph.components.of_row) {
    labels.push_back(graph.components.label[component]);
  }
  const std::span<const Index> rows(ends);
  const auto component = look_up(comm, graph.rows, std::span<const Index>(labels), rows);
  const auto degree = look_up(comm, graph.rows, std::span<const double>(graph.degrees), rows);
  std::vector<Query> queries;
  for (std::size_t k = 0; k < ends.size(); k += 2) {
    queries.push_back({{ends[k], ends[k + 1]},
                       component[k],
                       component[k + 1],
                       1.0 / std::min(degree[k], degree[k + 1])});
  }
  return concatenate(comm, queries);
}

}  // namespace
}  // namespace detail

ResistanceResult effective_resistances(const Graph& graph, std::span<const VertexPair> pairs,
                                       const ResistanceOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const auto& state = graph.state();
  const auto& comm = state.comm();
  detail::together(comm, [&] {
    require_in_range("tolerance", options.tolerance, open(0, 1));
    require_in_range("max_iterations", options.max_iterations, closed(1, 1e6));
    spectral::detail::check_pairs(pairs, graph.vertex_count());
  });
  const auto queries = detail::queries_of(state, pairs);
  const auto first = detail::sum_before(comm, static_cast<std::int64_t>(pairs.size()));
  const auto gap = detail::spectral_gap(graph, options);
  ResistanceResult result;
  result.smallest_eigenvalue = gap.value;
  result.proven = gap.proven;
  detail::Brackets brackets(state, gap.value, options);
  const detail::Steps steps(comm, options.progress);
  const auto total = static_cast<std::int64_t>(queries.size());
  for (std::int64_t k = 0; k < total; ++k) {
    const auto& query = queries[static_cast<std::size_t>(k)];
    CertifiedValue value;
    if (query.from_component != query.to_component) {
      value = {detail::kInfinity, detail::kInfinity, detail::kInfinity};
    } else if (query.rows.from != query.rows.to) {
      value = brackets.bracket(query);
      if (!(value.width() <= options.tolerance * value.lower)) ++result.unconverged;
    }
    const auto place = k - first;
    if (place >= 0 && place < static_cast<std::int64_t>(pairs.size())) {
      result.values.push_back(value);
    }
    steps.done("resistances", k + 1, total);
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace isotherm::spectral::distributed
