#pragma once

#include <array>
#include <concepts>
#include <cstdint>

#include <Eigen/Core>

#include "isotherm/base/options.hpp"
#include "isotherm/base/progress.hpp"
#include "isotherm/base/range.hpp"
#include "isotherm/spectral/graph/laplacian.hpp"

namespace isotherm::spectral {

enum class EigenMethod {
  automatic,     ///< dense up to `dense_limit` vertices
  dense,         ///< LAPACK-style tridiagonalisation; O(n^3), all pairs
  shift_invert,  ///< Spectra's Lanczos on the pseudo-inverse, one sparse factorisation
};

constexpr std::array<EnumName<EigenMethod>, 3> enum_names(EigenMethod) {
  return {{{EigenMethod::automatic, "automatic"},
           {EigenMethod::dense, "dense"},
           {EigenMethod::shift_invert, "shift-invert"}}};
}

struct EigenOptions {
  /// Number of smallest eigenpairs, null ones included; >= 1. Fewer come back
  /// if the graph has fewer vertices, or some have not converged.
  Index count = 10;
  /// Give the null pairs, one a component, and count them; without them memory does not grow
  /// with the components. Only heat's embedding and kernel need them.
  bool null_vectors = true;
  /// More than a third of the pairs that are not null is always found by the dense solver.
  EigenMethod method = EigenMethod::automatic;
  /// `automatic` is dense up to this many vertices.
  Index dense_limit = 600;
  /// Largest residual |L u - lambda u| accepted as converged, as a part of the
  /// Laplacian's norm bound; > 0.
  double tolerance = 1e-10;
  /// Count the eigenvalues below the largest one found by the inertia of a
  /// factorisation (Sylvester's law), and look again for any that are missing. Else look until
  /// nothing smaller turns up, which proves nothing.
  bool check_inertia = true;
  /// Most restarts of the iteration; >= 1.
  int max_restarts = 300;
  ProgressCallback progress = {};

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, EigenOptions>
void visit_fields(Options& options, Visitor&& visitor) {
  visitor("count", options.count, "number of smallest eigenpairs, null ones included",
          closed(1, 1e9));
  visitor("null_vectors", options.null_vectors, "give the null eigenvectors, and count them");
  visitor("eigen_solver", options.method, "how eigenpairs are computed");
  visitor("dense_limit", options.dense_limit, "vertices up to which the dense solver is used",
          closed(0, 1e5));
  visitor("eigen_tolerance", options.tolerance, "largest residual, relative to the norm",
          open(0, 1));
  visitor("check_inertia", options.check_inertia, "verify that no eigenvalue was missed");
  visitor("max_restarts", options.max_restarts, "most restarts of the eigensolver", closed(1, 1e6));
}

enum class EigenStatus {
  converged,
  /// Pairs are missing, a residual exceeds the tolerance, or a value that is not null
  /// exceeds its bound no more: weights over too many decades. See `residuals`, `bounds`.
  not_converged,
  missed_pairs,  ///< the inertia count found more eigenvalues than the iteration
};

/// The smallest eigenpairs of a Laplacian, in ascending order, with how good
/// they are. Signs are fixed: the entry of largest magnitude of a vector (the
/// first of equals) is positive.
struct EigenDecomposition {
  Eigen::VectorXd values;      ///< k
  Eigen::MatrixXd vectors;     ///< n x k, orthonormal columns
  Eigen::VectorXd residuals;   ///< |L u - lambda u| of each pair
  Eigen::VectorXd bounds;      ///< how far each value may be from an eigenvalue of the graph
  double orthogonality = 0.0;  ///< largest entry of |U'U - I|
  double norm = 0.0;           ///< bound on |L| that tolerances refer to
  Index null_count = 0;        ///< leading pairs with eigenvalue 0: at most one a component
  LaplacianKind kind = LaplacianKind::combinatorial;
  EigenMethod method = EigenMethod::dense;
  EigenStatus status = EigenStatus::converged;
  /// Eigenvalues below a point just below values[k - 1], by the inertia count;
  /// -1 where it was not asked for.
  std::int64_t inertia_count = -1;
  double seconds = 0.0;

  Index count() const noexcept { return static_cast<Index>(values.size()); }
  Index size() const noexcept { return static_cast<Index>(vectors.rows()); }
};

/// The `options.count` smallest eigenpairs.
///
/// The null space is never iterated for: it is known from the components
/// (docs/concepts/laplacian-embedding.md). Dense: O(n^3)
/// time, O(n^2) memory. Shift-invert: one factorisation of the grounded
/// Laplacian, a solve a step, O(nk) memory.
/// @throws InvalidArgument for options out of range; NumericalError if the
///   factorisation breaks down; Cancelled.
EigenDecomposition smallest_eigenpairs(const Laplacian& laplacian,
                                       const EigenOptions& options = {});

}  // namespace isotherm::spectral
