#pragma once

#include <cstdint>
#include <optional>

#include "distributed/support/comm.hpp"

namespace isotherm::spectral::distributed::detail {

/// A symmetric factorisation by MUMPS. For its ordering rank 0 has the pattern of the whole matrix
/// for a while; where MUMPS was built for it, PETSc's option -mat_mumps_icntl_28 2 has all ranks
/// find one.
class MumpsFactor {
 public:
  enum class For { solving, counting };

  /// Analyses the pattern only; positive definite or not is what MAT_SPD says of the matrix.
  MumpsFactor(const Comm& comm, Mat matrix, For purpose);

  /// What MUMPS expects the rank that needs most to need, in bytes.
  double expected_memory() const;

  /// @throws NumericalError
  void factorise();

  void solve(Vec b, Vec x) const { check(MatSolve(factor_.get(), b, x)); }

  /// Pivots below 0: as many eigenvalues are. Only of a factor for counting.
  std::int64_t negative_pivots() const;

 private:
  void analyse(PetscInt spare);
  PetscInt infog(PetscInt number) const;

  const Comm& comm_;
  Mat matrix_;
  For purpose_;
  MatHandle factor_;
  MatFactorInfo info_ = {};
};

}  // namespace isotherm::spectral::distributed::detail
