#pragma once

#include <utility>

// The C++ bindings that MPI itself withdrew.
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <slepceps.h>

/// PETSc's objects with owners, and its errors as exceptions.
namespace isotherm::spectral::distributed::detail {

/// @throws NumericalError with what PETSc says where `code` is none of success
void check(PetscErrorCode code);

/// From here on PETSc keeps what it has to say of an error for check().
void keep_petsc_messages();

/// An object of PETSc's that ends with its owner.
template <class Object, PetscErrorCode (*destroy)(Object*)>
class Handle {
 public:
  Handle() = default;
  ~Handle() { reset(); }
  Handle(Handle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }

  Object get() const noexcept { return object_; }
  explicit operator bool() const noexcept { return object_ != nullptr; }

  /// For functions that make the object.
  Object* out() noexcept {
    reset();
    return &object_;
  }
  void reset() noexcept {
    if (object_ != nullptr) destroy(&object_);
    object_ = nullptr;
  }

 private:
  Object object_ = nullptr;
};

using VecHandle = Handle<Vec, VecDestroy>;
using MatHandle = Handle<Mat, MatDestroy>;
using KspHandle = Handle<KSP, KSPDestroy>;
using PcHandle = Handle<PC, PCDestroy>;
using EpsHandle = Handle<EPS, EPSDestroy>;
using IsHandle = Handle<IS, ISDestroy>;
using PartitioningHandle = Handle<MatPartitioning, MatPartitioningDestroy>;

/// The entries of a vector that this rank has, for as long as this lives.
class LocalEntries {
 public:
  explicit LocalEntries(Vec vector) : vector_(vector) { check(VecGetArray(vector, &entries_)); }
  ~LocalEntries() { VecRestoreArray(vector_, &entries_); }
  LocalEntries(const LocalEntries&) = delete;
  LocalEntries& operator=(const LocalEntries&) = delete;

  double& operator[](std::size_t k) const noexcept { return entries_[k]; }

 private:
  Vec vector_;
  PetscScalar* entries_ = nullptr;
};

}  // namespace isotherm::spectral::distributed::detail
