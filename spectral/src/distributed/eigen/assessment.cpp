#include "distributed/eigen/assessment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace isotherm::spectral::distributed::detail {
namespace {

/// x in place of D^(1/2) x, for the normalised kind.
void undo_scaling(const LaplacianMatrix& laplacian, Vec x) {
  if (laplacian.kind() == LaplacianKind::combinatorial) return;
  const LocalEntries entries(x);
  for (std::size_t k = 0; k < laplacian.graph().row_count(); ++k) {
    entries[k] /= laplacian.null_entry(k);
  }
}

/// The Rayleigh quotient of a unit vector as a sum over edges: no term is negative, so that small
/// ones do not drown in large degrees.
double energy(const LaplacianMatrix& laplacian, Mat incidence, Vec vector) {
  auto x = make_vector(laplacian.graph());
  check(VecCopy(vector, x.get()));
  undo_scaling(laplacian, x.get());
  VecHandle steps;
  check(MatCreateVecs(incidence, nullptr, steps.out()));
  check(MatMult(incidence, x.get(), steps.get()));
  PetscReal norm = 0.0;
  check(VecNorm(steps.get(), NORM_2, &norm));
  return norm * norm;
}

void fix_sign(const Graph::State& graph, Vec vector) {
  PetscReal largest = 0.0;
  check(VecNorm(vector, NORM_INFINITY, &largest));
  const LocalEntries entries(vector);
  struct {
    int position = std::numeric_limits<int>::max();
    int negative = 0;
  } mine, first;
  for (std::size_t k = 0; k < graph.row_count(); ++k) {
    if (std::abs(entries[k]) < (1.0 - 1e-6) * largest) continue;
    if (graph.position_of[k] > mine.position) continue;
    mine = {graph.position_of[k], entries[k] < 0.0 ? 1 : 0};
  }
  MPI_Allreduce(&mine, &first, 1, MPI_2INT, MPI_MINLOC, graph.comm().handle);
  if (first.negative == 0) return;
  for (std::size_t k = 0; k < graph.row_count(); ++k) entries[k] = -entries[k];
}

std::vector<double> local_values(const Graph::State& graph, Vec vector) {
  const double* first = nullptr;
  check(VecGetArrayRead(vector, &first));
  std::vector<double> values(first, first + graph.row_count());
  check(VecRestoreArrayRead(vector, &first));
  return values;
}

/// The null vectors of the components that come first, on this rank's block.
void add_null_vectors(const NullSpace& null_space, const Graph::State& graph,
                      EigenDecomposition& result) {
  if (result.null_count == 0) return;
  const auto numbers = component_numbers(graph);
  for (Index column = 0; column < result.null_count; ++column) {
    std::vector<double> entries(graph.row_count(), 0.0);
    for (std::size_t k = 0; k < graph.row_count(); ++k) {
      if (numbers[graph.components.of_row[k]] == column) entries[k] = null_space.entry(k);
    }
    const auto block = in_block(graph, entries);
    std::copy(block.begin(), block.end(), result.vectors.col(column).begin());
  }
}

double orthogonality(const Vectors& vectors) {
  double largest = 0.0;
  std::vector<Vec> before;
  for (const auto& vector : vectors) {
    before.push_back(vector.get());
    std::vector<double> products(before.size());
    check(VecMDot(vector.get(), static_cast<PetscInt>(before.size()), before.data(),
                  products.data()));
    products.back() -= 1.0;
    for (const double product : products) largest = std::max(largest, std::abs(product));
  }
  return largest;
}

}  // namespace

std::int64_t Pairs::below(double bound) const {
  return std::count_if(values.begin(), values.end(), [=](double value) { return value < bound; });
}

void merge(const LaplacianMatrix& laplacian, Mat incidence, Pairs& pairs, Vectors more,
           std::int64_t count) {
  for (auto& vector : more) {
    check(VecNormalize(vector.get(), nullptr));
    pairs.values.push_back(energy(laplacian, incidence, vector.get()));
    pairs.vectors.push_back(std::move(vector));
  }
  std::vector<std::size_t> order(pairs.values.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return pairs.values[a] < pairs.values[b]; });
  order.resize(std::min<std::size_t>(order.size(), static_cast<std::size_t>(count)));
  Pairs sorted;
  for (const auto k : order) {
    sorted.values.push_back(pairs.values[k]);
    sorted.vectors.push_back(std::move(pairs.vectors[k]));
  }
  pairs = std::move(sorted);
}

double residual(const LaplacianMatrix& laplacian, Vec vector, double value) {
  auto product = make_vector(laplacian.graph());
  check(MatMult(laplacian.get(), vector, product.get()));
  check(VecAXPY(product.get(), -value, vector));
  PetscReal norm = 0.0;
  check(VecNorm(product.get(), NORM_2, &norm));
  return norm;
}

double rounding(const LaplacianMatrix& laplacian) {
  return 32.0 * std::numeric_limits<double>::epsilon() * laplacian.norm();
}

void assess(const LaplacianMatrix& laplacian, const NullSpace& null_space, Pairs& pairs,
            double tolerance, EigenDecomposition& result) {
  const auto& graph = laplacian.graph();
  const Index nulls = result.null_count;
  const auto count = nulls + static_cast<Index>(pairs.count());
  result.values = Eigen::VectorXd::Zero(count);
  result.residuals = result.bounds = result.values;
  result.vectors.resize(static_cast<Eigen::Index>(graph.ids.size()), count);
  add_null_vectors(null_space, graph, result);
  for (Index k = nulls; k < count; ++k) {
    const auto place = static_cast<std::size_t>(k - nulls);
    const Vec vector = pairs.vectors[place].get();
    fix_sign(graph, vector);
    result.values[k] = pairs.values[place];
    result.residuals[k] = residual(laplacian, vector, pairs.values[place]);
    result.bounds[k] = result.residuals[k] + rounding(laplacian);
    const bool close = result.residuals[k] <= tolerance * result.norm;
    if (!close || result.values[k] <= result.bounds[k]) result.status = EigenStatus::not_converged;
    const auto block = in_block(graph, local_values(graph, vector));
    std::copy(block.begin(), block.end(), result.vectors.col(k).begin());
  }
  result.orthogonality = orthogonality(pairs.vectors);
}

}  // namespace isotherm::spectral::distributed::detail
