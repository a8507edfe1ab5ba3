#include "isotherm/spectral/sparse/laplacian_solver.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "isotherm/base/error.hpp"
#include "sparse/cholmod_factor.hpp"
#include "sparse/laplacian/grounded_laplacian.hpp"

namespace isotherm::spectral {
namespace {

/// The combinatorial grounded matrix that belongs to a Laplacian of any kind:
/// D^(1/2) N D^(1/2) = L for the normalised one.
detail::GroundedLaplacian grounded_combinatorial(const Laplacian& laplacian,
                                                 const Eigen::VectorXd& root_degree) {
  auto grounded = detail::ground(laplacian);
  if (laplacian.kind() == LaplacianKind::combinatorial) return grounded;
  for (Index column = 0; column < grounded.lower.outerSize(); ++column) {
    for (SparseMatrix::InnerIterator entry(grounded.lower, column); entry; ++entry) {
      entry.valueRef() *=
          root_degree[grounded.vertex_of[column]] * root_degree[grounded.vertex_of[entry.row()]];
    }
  }
  return grounded;
}

/// The factor of a grounded matrix. Where rounding has left nothing of a pivot, the diagonal is
/// raised by as much as rounding may have taken from it.
detail::CholmodFactor factor_of(SparseMatrix& lower) {
  try {
    return {lower, detail::FactorKind::known_definite};
  } catch (const NumericalError&) {
    constexpr double kRaised = 1.0 + 16.0 * std::numeric_limits<double>::epsilon();
    for (Index column = 0; column < lower.outerSize(); ++column) {
      lower.coeffRef(column, column) *= kRaised;
    }
    return {lower, detail::FactorKind::known_definite};
  }
}

}  // namespace

struct LaplacianSolver::Impl {
  SparseMatrix null_space;
  Eigen::VectorXd scaling;  // 1, or D^(1/2) for the normalised kind
  detail::GroundedLaplacian grounded;
  std::optional<detail::CholmodFactor> factor;  // nothing to factorise without edges
  Eigen::VectorXd reduced;
};

LaplacianSolver::LaplacianSolver(const Laplacian& laplacian) : impl_(std::make_unique<Impl>()) {
  impl_->null_space = laplacian.null_space();
  impl_->scaling = Eigen::VectorXd::Ones(laplacian.size());
  if (laplacian.kind() == LaplacianKind::normalised)
    impl_->scaling = laplacian.degrees().cwiseSqrt();
  impl_->grounded = grounded_combinatorial(laplacian, impl_->scaling);
  if (impl_->grounded.lower.rows() > 0) {
    impl_->factor.emplace(factor_of(impl_->grounded.lower));
  }
  impl_->reduced.resize(impl_->grounded.lower.rows());
}

LaplacianSolver::~LaplacianSolver() = default;
LaplacianSolver::LaplacianSolver(LaplacianSolver&&) noexcept = default;
LaplacianSolver& LaplacianSolver::operator=(LaplacianSolver&&) noexcept = default;

void LaplacianSolver::remove_null_space(Eigen::Ref<Eigen::VectorXd> x) const {
  // The columns of the basis have disjoint supports.
  const auto& basis = impl_->null_space;
  for (Index column = 0; column < basis.outerSize(); ++column) {
    double part = 0.0;
    for (SparseMatrix::InnerIterator entry(basis, column); entry; ++entry) {
      part += entry.value() * x[entry.row()];
    }
    for (SparseMatrix::InnerIterator entry(basis, column); entry; ++entry) {
      x[entry.row()] -= part * entry.value();
    }
  }
}

Eigen::VectorXd LaplacianSolver::solve(const Eigen::Ref<const Eigen::VectorXd>& b) {
  if (b.size() != impl_->scaling.size()) {
    throw InvalidArgument("b", "must have " + std::to_string(impl_->scaling.size()) + " entries");
  }
  Eigen::VectorXd x = b;
  if (!impl_->factor) return Eigen::VectorXd::Zero(b.size());
  remove_null_space(x);
  const auto& vertex_of = impl_->grounded.vertex_of;
  auto& reduced = impl_->reduced;
  for (Index row = 0; row < reduced.size(); ++row) {
    reduced[row] = impl_->scaling[vertex_of[row]] * x[vertex_of[row]];
  }
  impl_->factor->solve(reduced.data(), reduced.data());
  x.setZero();
  for (Index row = 0; row < reduced.size(); ++row) {
    x[vertex_of[row]] = impl_->scaling[vertex_of[row]] * reduced[row];
  }
  remove_null_space(x);
  return x;
}

}  // namespace isotherm::spectral
