#include "distributed/eigen/pairs.hpp"

#include <algorithm>

namespace isotherm::spectral::distributed::detail {
namespace {

constexpr std::uint64_t kSeed = 20170509;  // any start vectors do
constexpr double kRitzTolerance = 1e-13;   // on residuals, relative to the Ritz value
constexpr std::int64_t kSmallestBasis = 24;
constexpr std::int64_t kGuards = 4;  // vectors beside those wanted, whose convergence they speed

/// Where a C function finds the object that it is called for.
template <class Object, class Handle, class GetContext>
Object& context_of(Handle handle, GetContext get) {
  void* context = nullptr;
  get(handle, &context);
  return *static_cast<Object*>(context);
}

MatHandle shell(const Graph::State& graph, void* context,
                PetscErrorCode (*multiply)(Mat, Vec, Vec)) {
  const auto local = static_cast<PetscInt>(graph.row_count());
  const auto total = static_cast<PetscInt>(graph.rows.total());
  MatHandle matrix;
  check(MatCreateShell(graph.comm().handle, local, local, total, total, context, matrix.out()));
  check(MatShellSetOperation(matrix.get(), MATOP_MULT, reinterpret_cast<void (*)()>(multiply)));
  check(MatSetOption(matrix.get(), MAT_SYMMETRIC, PETSC_TRUE));
  return matrix;
}

std::vector<Vec> raw(const Vectors& vectors) {
  std::vector<Vec> result;
  for (const auto& vector : vectors) result.push_back(vector.get());
  return result;
}

/// Start vectors, none of which is in the null space.
Vectors starts(const NullSpace& null_space, const Graph::State& graph, std::int64_t count,
               std::uint64_t seed) {
  Vectors vectors;
  for (std::int64_t k = 0; k < count; ++k) {
    vectors.push_back(make_vector(graph));
    fill_at_random(graph, seed + static_cast<std::uint64_t>(k), vectors.back().get());
    null_space.remove(vectors.back().get());
  }
  return vectors;
}

/// A Laplacian whose null space has an eigenvalue above all others, and its preconditioner.
struct Lifted {
  const LaplacianMatrix& laplacian;
  const NullSpace& null_space;
  const Grounded& grounded;
  const Steps& steps;
  Bridge bridge = {};
  PcHandle multigrid = {};
  VecHandle work = {};
  std::int64_t products = 0;

  double lift() const { return 2.0 * std::max(laplacian.norm(), 1.0); }

  static PetscErrorCode multiply(Mat matrix, Vec x, Vec y) {
    auto& self = context_of<Lifted>(matrix, MatShellGetContext);
    return self.bridge.run([&] {
      self.steps.done("eigenpairs", ++self.products);
      check(MatMult(self.laplacian.get(), x, y));
      self.null_space.add(x, self.lift(), y);
    });
  }

  static PetscErrorCode precondition(PC shell, Vec x, Vec y) {
    auto& self = context_of<Lifted>(shell, PCShellGetContext);
    return self.bridge.run([&] {
      check(VecCopy(x, self.work.get()));
      self.null_space.remove(self.work.get());
      self.grounded.ground(self.work.get());
      check(PCApply(self.multigrid.get(), self.work.get(), y));
      self.grounded.ground(y);
      self.null_space.remove(y);
    });
  }
};

void set_preconditioner(EPS solver, Lifted& lifted) {
  const auto& comm = lifted.laplacian.graph().comm();
  lifted.work = make_vector(lifted.laplacian.graph());
  check(PCCreate(comm.handle, lifted.multigrid.out()));
  check(PCSetOperators(lifted.multigrid.get(), lifted.grounded.get(), lifted.grounded.get()));
  use_multigrid(lifted.multigrid.get());
  check(PCSetUp(lifted.multigrid.get()));
  ST transform = nullptr;
  KSP inner = nullptr;
  PC shell = nullptr;
  check(EPSGetST(solver, &transform));
  check(STSetType(transform, STPRECOND));
  check(STGetKSP(transform, &inner));
  check(KSPSetType(inner, KSPPREONLY));
  check(KSPGetPC(inner, &shell));
  check(PCSetType(shell, PCSHELL));
  check(PCShellSetContext(shell, &lifted));
  check(PCShellSetApply(shell, Lifted::precondition));
}

}  // namespace

void use_multigrid(PC preconditioner) {
  check(PCSetOptionsPrefix(preconditioner, "amg_"));
#ifdef PETSC_HAVE_HYPRE
  check(PCSetType(preconditioner, PCHYPRE));
  check(PCHYPRESetType(preconditioner, "boomeramg"));
#else
  check(PCSetType(preconditioner, PCGAMG));
#endif
  check(PCSetFromOptions(preconditioner));
}

Vectors converged_vectors(const Graph::State& graph, EPS solver, std::int64_t count) {
  PetscInt converged = 0;
  check(EPSGetConverged(solver, &converged));
  Vectors vectors;
  for (PetscInt k = 0; k < std::min<std::int64_t>(converged, count); ++k) {
    vectors.push_back(make_vector(graph));
    check(EPSGetEigenvector(solver, k, vectors.back().get(), nullptr));
  }
  return vectors;
}

PseudoInversePairs::PseudoInversePairs(const NullSpace& null_space, const Grounded& grounded,
                                       const MumpsFactor& factor, const LaplacianMatrix& laplacian,
                                       const Steps& steps)
    : null_space_(null_space),
      grounded_(grounded),
      factor_(factor),
      laplacian_(laplacian),
      steps_(steps),
      work_(make_vector(laplacian.graph())) {}

PetscErrorCode PseudoInversePairs::multiply(Mat matrix, Vec x, Vec y) {
  auto& self = context_of<PseudoInversePairs>(matrix, MatShellGetContext);
  return self.bridge_.run([&] { self.apply(x, y); });
}

void PseudoInversePairs::apply(Vec x, Vec y) {
  steps_.done("eigenpairs", ++solves_);
  check(VecCopy(x, work_.get()));
  null_space_.remove(work_.get());
  grounded_.ground(work_.get());
  factor_.solve(work_.get(), y);
  grounded_.ground(y);
  null_space_.remove(y);
}

Vectors PseudoInversePairs::find(std::int64_t count, const Vectors& found, int max_restarts) {
  const auto& graph = laplacian_.graph();
  const auto rest =
      graph.rows.total() - graph.components.count - static_cast<std::int64_t>(found.size());
  count = std::min(count, rest);
  if (count <= 0) return {};
  const auto matrix = shell(graph, this, multiply);
  EpsHandle solver;
  check(EPSCreate(graph.comm().handle, solver.out()));
  check(EPSSetOperators(solver.get(), matrix.get(), nullptr));
  check(EPSSetProblemType(solver.get(), EPS_HEP));
  check(EPSSetType(solver.get(), EPSKRYLOVSCHUR));
  check(EPSSetWhichEigenpairs(solver.get(), EPS_LARGEST_REAL));
  // The null space leaves room for one more.
  const auto basis = std::max(count + 1, std::min(rest, std::max(2 * count + 2, kSmallestBasis)));
  check(EPSSetDimensions(solver.get(), static_cast<PetscInt>(count), static_cast<PetscInt>(basis),
                         PETSC_DEFAULT));
  check(EPSSetTolerances(solver.get(), kRitzTolerance, max_restarts));
  const auto first = starts(null_space_, graph, 1, kSeed + found.size());
  auto start = raw(first);
  auto locked = raw(found);
  check(EPSSetInitialSpace(solver.get(), 1, start.data()));
  if (!locked.empty()) {
    check(EPSSetDeflationSpace(solver.get(), static_cast<PetscInt>(locked.size()), locked.data()));
  }
  check(EPSSetFromOptions(solver.get()));
  bridge_.check(EPSSolve(solver.get()));
  return converged_vectors(graph, solver.get(), count);
}

Vectors lobpcg_pairs(const LaplacianMatrix& laplacian, const NullSpace& null_space,
                     std::int64_t count, double tolerance, int max_iterations, const Steps& steps) {
  const auto& graph = laplacian.graph();
  const auto rest = graph.rows.total() - graph.components.count;
  count = std::min(count, rest);
  if (count <= 0) return {};
  const Grounded grounded(laplacian);
  Lifted lifted{laplacian, null_space, grounded, steps};
  const auto matrix = shell(graph, &lifted, Lifted::multiply);
  EpsHandle solver;
  check(EPSCreate(graph.comm().handle, solver.out()));
  check(EPSSetOperators(solver.get(), matrix.get(), nullptr));
  check(EPSSetProblemType(solver.get(), EPS_HEP));
  check(EPSSetType(solver.get(), EPSLOBPCG));
  check(EPSSetWhichEigenpairs(solver.get(), EPS_SMALLEST_REAL));
  const auto block = std::min(rest, count + kGuards);
  check(EPSLOBPCGSetBlockSize(solver.get(), static_cast<PetscInt>(block)));
  check(EPSSetDimensions(solver.get(), static_cast<PetscInt>(count), PETSC_DEFAULT, PETSC_DEFAULT));
  check(EPSSetConvergenceTest(solver.get(), EPS_CONV_ABS));
  check(EPSSetTolerances(solver.get(), tolerance * laplacian.norm(), max_iterations));
  set_preconditioner(solver.get(), lifted);
  const auto first = starts(null_space, graph, block, kSeed);
  auto start = raw(first);
  check(EPSSetInitialSpace(solver.get(), static_cast<PetscInt>(start.size()), start.data()));
  check(EPSSetFromOptions(solver.get()));
  lifted.bridge.check(EPSSolve(solver.get()));
  return converged_vectors(graph, solver.get(), count);
}

}  // namespace isotherm::spectral::distributed::detail
