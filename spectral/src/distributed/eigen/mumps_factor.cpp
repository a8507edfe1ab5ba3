#include "distributed/eigen/mumps_factor.hpp"

#include <string>

#include "isotherm/base/error.hpp"

namespace isotherm::spectral::distributed::detail {
namespace {

// Numbers of MUMPS's controls, by its manual.
constexpr PetscInt kRootNode = 13, kSpareRoom = 14, kNullPivots = 24, kAnalysis = 28;
constexpr PetscInt kOnRank0 = 1;
constexpr PetscInt kExpectedMegabytes = 16;  // among its INFOG: of the rank that needs most

// Of its errors, those for which its manual says to give it more room.
constexpr PetscInt kIntegersTooSmall = -8, kNumbersTooSmall = -9;
// Delayed pivots take more room than the analysis foresees: so many per cent.
constexpr PetscInt kSpare = 50, kMostSpare = 3200;

}  // namespace

MumpsFactor::MumpsFactor(const Comm& comm, Mat matrix, For purpose)
    : comm_(comm), matrix_(matrix), purpose_(purpose) {
  check(MatFactorInfoInitialize(&info_));
  analyse(kSpare);
}

void MumpsFactor::analyse(PetscInt spare) {
  check(MatGetFactor(matrix_, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, factor_.out()));
  check(MatMumpsSetIcntl(factor_.get(), kSpareRoom, spare));
  if (purpose_ == For::counting) {
    // ScaLAPACK, which the root would else be left to, counts no negative pivots.
    check(MatMumpsSetIcntl(factor_.get(), kRootNode, 1));
    check(MatMumpsSetIcntl(factor_.get(), kNullPivots, 1));
  }
  // Asked for an ordering that all ranks find together, a MUMPS that was built without one, as
  // Debian's is, says so on stdout, which is for results.
  PetscBool chosen = PETSC_FALSE;
  check(PetscOptionsHasName(nullptr, nullptr, "-mat_mumps_icntl_28", &chosen));
  if (chosen == PETSC_FALSE) check(MatMumpsSetIcntl(factor_.get(), kAnalysis, kOnRank0));
  check(MatCholeskyFactorSymbolic(factor_.get(), matrix_, nullptr, &info_));
}

PetscInt MumpsFactor::infog(PetscInt number) const {
  PetscInt value = 0;
  check(MatMumpsGetInfog(factor_.get(), number, &value));
  return value;
}

double MumpsFactor::expected_memory() const {
  return 1e6 * static_cast<double>(infog(kExpectedMegabytes));
}

void MumpsFactor::factorise() {
  for (PetscInt spare = kSpare;;) {
    check(MatCholeskyFactorNumeric(factor_.get(), matrix_, &info_));
    MatFactorError error = MAT_FACTOR_NOERROR;
    check(MatFactorGetError(factor_.get(), &error));
    if (error == MAT_FACTOR_NOERROR) return;
    const PetscInt code = infog(1), detail = infog(2);
    const bool too_small = code == kIntegersTooSmall || code == kNumbersTooSmall;
    if (!too_small || spare >= kMostSpare) {
      throw NumericalError("factorisation", "MUMPS ended with INFOG(1) = " + std::to_string(code) +
                                                ", INFOG(2) = " + std::to_string(detail));
    }
    analyse(spare *= 4);
  }
}

std::int64_t MumpsFactor::negative_pivots() const {
  PetscInt negative = 0, zero = 0, positive = 0;
  check(MatGetInertia(factor_.get(), &negative, &zero, &positive));
  return negative;
}

}  // namespace isotherm::spectral::distributed::detail
