#include "isotherm/base/blas_threads.hpp"

#include <dlfcn.h>

namespace isotherm::detail {
namespace {

// A function of the libraries that are loaded, if one has it.
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

SequentialOpenMp::SequentialOpenMp() {
  static auto* const levels = find<int()>("omp_get_max_active_levels");
  if (levels != nullptr) levels_ = levels();
  allow(0);
}

SequentialOpenMp::~SequentialOpenMp() { allow(levels_); }

void SequentialOpenMp::allow(int levels) {
  static auto* const set = find<void(int)>("omp_set_max_active_levels");
  if (set != nullptr) set(levels);
}

}  // namespace isotherm::detail
