#include <algorithm>
#include <chrono>
#include <cmath>

#include "distributed/resistance/multigrid_solver.hpp"
#include "isotherm/base/error.hpp"

namespace isotherm::spectral::distributed {
namespace detail {
namespace {

constexpr double kSolved = 1e-8;  // of a right-hand side: far below the error of projections
constexpr int kMostIterations = 1000;

/// What is known of an edge, on its way to the rank that read it.
struct Found {
  std::int64_t place = 0;
  double value = 0.0;
};

/// One sign an edge, by its place in the file, times `size`.
void fill_with_signs(const Graph::State& graph, std::uint64_t seed, double size, Vec y) {
  const LocalEntries entries(y);
  const std::uint64_t start = mixed(seed);
  for (std::size_t k = 0; k < graph.edges.size(); ++k) {
    const auto bits = mixed(start + static_cast<std::uint64_t>(graph.edges[k].place) + 1);
    entries[k] = bits >> 63 != 0 ? size : -size;
  }
}

std::vector<double> in_file_order(const Graph::State& graph, const std::vector<double>& values) {
  std::vector<Found> found;
  for (std::size_t k = 0; k < values.size(); ++k)
    found.push_back({graph.edges[k].place, values[k]});
  auto mine = exchange(graph.comm(), std::span<const Found>(found), [&](const Found& one) {
                return graph.places.owner(one.place);
              }).items;
  std::sort(mine.begin(), mine.end(),
            [](const Found& a, const Found& b) { return a.place < b.place; });
  std::vector<double> result;
  for (const auto& one : mine) result.push_back(one.value);
  return result;
}

std::int64_t solves_for(std::int64_t edges, const ProjectionOptions& options) {
  const double e = options.error;
  const double exponent = e * e / 4.0 - e * e * e / 6.0;
  const auto count = static_cast<double>(std::max<std::int64_t>(1, edges));
  return static_cast<std::int64_t>(std::ceil(std::log(2.0 * count / options.failure) / exponent));
}

}  // namespace
}  // namespace detail

ProjectedResistances project_resistances(const Graph& graph, const ProjectionOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  require_in_range("error", options.error, open(0, 1));
  require_in_range("failure", options.failure, open(0, 1));
  const auto& state = graph.state();
  ProjectedResistances result;
  result.solves = detail::solves_for(graph.edge_count(), options);
  const detail::LaplacianMatrix laplacian(state, LaplacianKind::combinatorial);
  detail::MultigridSolver solver(laplacian, detail::kMostIterations);
  const auto edges = detail::incidence(state);
  detail::VecHandle flows;
  detail::check(MatCreateVecs(edges.get(), nullptr, flows.out()));
  auto currents = detail::make_vector(state), potentials = detail::make_vector(state);
  std::vector<double> sums(state.edges.size(), 0.0);
  const detail::Steps steps(state.comm(), options.progress);
  const double size = 1.0 / std::sqrt(static_cast<double>(result.solves));
  for (std::int64_t k = 0; k < result.solves; ++k) {
    detail::fill_with_signs(state, detail::mixed(options.seed) + static_cast<std::uint64_t>(k),
                            size, flows.get());
    detail::check(MatMultTranspose(edges.get(), flows.get(), currents.get()));
    PetscReal norm = 0.0;
    detail::check(VecNorm(currents.get(), NORM_2, &norm));
    detail::check(VecSet(potentials.get(), 0.0));
    if (norm > 0.0) solver.solve(currents.get(), detail::kSolved * norm, potentials.get());
    detail::check(MatMult(edges.get(), potentials.get(), flows.get()));
    const detail::LocalEntries steps_of_edges(flows.get());
    for (std::size_t e = 0; e < sums.size(); ++e) sums[e] += steps_of_edges[e] * steps_of_edges[e];
    steps.done("projections", k + 1, result.solves);
  }
  for (std::size_t e = 0; e < sums.size(); ++e) sums[e] /= state.edges[e].weight;
  result.values = detail::in_file_order(state, sums);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace isotherm::spectral::distributed
