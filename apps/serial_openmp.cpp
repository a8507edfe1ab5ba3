#include "serial_openmp.hpp"

#include <dlfcn.h>

namespace isotherm::apps {

// Looked up by name: which OpenMP a library was built with is not known when this is compiled.
void keep_openmp_serial() {
  using SetMaxActiveLevels = void (*)(int);
  void* const found = dlsym(RTLD_DEFAULT, "omp_set_max_active_levels");
  if (found != nullptr) reinterpret_cast<SetMaxActiveLevels>(found)(0);
}

}  // namespace isotherm::apps
