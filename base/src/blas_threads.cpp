#include "isotherm/base/blas_threads.hpp"

#include <dlfcn.h>

namespace isotherm::detail {
namespace {

// A function of the BLAS that is loaded, if it has one of that name.
template <class Function>
Function* find(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

bool prepare() {
  if (auto* const use = find<void(int)>("openblas_set_num_threads")) use(1);
  constexpr int kSequential = 0;  // of OpenBLAS's cblas.h
  auto* const kind = find<int()>("openblas_get_parallel");
  return kind == nullptr || kind() != kSequential;
}

}  // namespace

bool blas_serves_threads() {
  static const bool serves = prepare();
  return serves;
}

}  // namespace isotherm::detail
