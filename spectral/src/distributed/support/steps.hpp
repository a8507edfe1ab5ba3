#pragma once

#include <cstdint>
#include <exception>
#include <string_view>

#include "distributed/support/comm.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/progress.hpp"

namespace isotherm::spectral::distributed::detail {

/// Says how far a computation is, and ends it on all ranks where it is to end on one.
class Steps {
 public:
  Steps(const Comm& comm, const ProgressCallback& progress) : comm_(comm), progress_(progress) {}

  /// Collective. @throws Cancelled on every rank
  void done(std::string_view stage, std::int64_t count, std::int64_t total = 0) const {
    if (!progress_) return;
    const Progress now{stage, static_cast<std::uint64_t>(count), static_cast<std::uint64_t>(total)};
    if (any(comm_, !progress_(now))) throw Cancelled();
  }

 private:
  const Comm& comm_;
  const ProgressCallback& progress_;
};

/// Brings exceptions through PETSc, which knows none: what a callback throws is kept, and PETSc
/// told to stop.
class Bridge {
 public:
  template <class Work>
  PetscErrorCode run(Work work) noexcept {
    try {
      work();
      return 0;
    } catch (...) {
      error_ = std::current_exception();
      return PETSC_ERR_USER;
    }
  }

  /// In place of check(), for what calls run(). @throws what was kept
  void check(PetscErrorCode code) {
    if (code != 0 && error_) std::rethrow_exception(std::exchange(error_, nullptr));
    detail::check(code);
  }

 private:
  std::exception_ptr error_;
};

}  // namespace isotherm::spectral::distributed::detail
