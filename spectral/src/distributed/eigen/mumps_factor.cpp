#include "distributed/eigen/mumps_factor.hpp"

#include <string>

#include "isotherm/base/error.hpp"

namespace isotherm::spectral::distributed::detail {
namespace {

// Below so many rows rank 0 orders a matrix alone, which needs its pattern in one place.
constexpr PetscInt kOrderedByOne = 100'000;

// Numbers of MUMPS's controls, by its manual.
constexpr PetscInt kRootNode = 13, kSpareRoom = 14, kNullPivots = 24, kAnalysis = 28,
                   kParallelOrdering = 29;
constexpr PetscInt kExpectedMegabytes = 16;  // among its INFOG: of the rank that needs most

// Of its errors: those for which its manual says to give it more room.
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
  PetscInt rows = 0;
  check(MatGetSize(matrix_, &rows, nullptr));
  if (comm_.size > 1 && rows > kOrderedByOne) {
    check(MatMumpsSetIcntl(factor_.get(), kAnalysis, 2));
    check(MatMumpsSetIcntl(factor_.get(), kParallelOrdering, 1));  // PT-Scotch
  }
  check(MatCholeskyFactorSymbolic(factor_.get(), matrix_, nullptr, &info_));
}

double MumpsFactor::expected_memory() const {
  PetscInt megabytes = 0;
  check(MatMumpsGetInfog(factor_.get(), kExpectedMegabytes, &megabytes));
  return 1e6 * static_cast<double>(megabytes);
}

void MumpsFactor::factorise() {
  for (PetscInt spare = kSpare;;) {
    check(MatCholeskyFactorNumeric(factor_.get(), matrix_, &info_));
    MatFactorError error = MAT_FACTOR_NOERROR;
    check(MatFactorGetError(factor_.get(), &error));
    if (error == MAT_FACTOR_NOERROR) return;
    PetscInt code = 0, detail = 0;
    check(MatMumpsGetInfog(factor_.get(), 1, &code));
    check(MatMumpsGetInfog(factor_.get(), 2, &detail));
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
