#include "distributed/support/petsc.hpp"

#include <string>

#include "isotherm/base/error.hpp"

namespace isotherm::spectral::distributed::detail {
namespace {

std::string& last_message() {
  static std::string message;
  return message;
}

PetscErrorCode keep_message(MPI_Comm, int, const char* function, const char*, PetscErrorCode code,
                            PetscErrorType type, const char* message, void*) {
  if (type == PETSC_ERROR_INITIAL) {
    last_message() = std::string(function != nullptr ? function : "PETSc") + ": " +
                     (message != nullptr ? message : "failed");
  }
  return code;
}

}  // namespace

void keep_petsc_messages() { PetscPushErrorHandler(keep_message, nullptr); }

void check(PetscErrorCode code) {
  if (code == 0) return;
  const char* general = nullptr;
  PetscErrorMessage(code, &general, nullptr);
  std::string problem = std::exchange(last_message(), {});
  if (problem.empty()) problem = general != nullptr ? general : "failed";
  throw NumericalError("petsc", problem);
}

}  // namespace isotherm::spectral::distributed::detail
