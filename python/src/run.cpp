#include "run.hpp"

#include <mutex>

#include <dlfcn.h>
#include <nanobind/stl/string_view.h>

namespace isotherm::python {
namespace {

using namespace std::chrono_literals;

constexpr auto kBetweenNews = 50ms;

std::recursive_timed_mutex& turns() {
  static std::recursive_timed_mutex mutex;
  return mutex;
}

// Looked up by name: which OpenMP a library was built with is not known when this is compiled.
template <class Function>
Function* openmp(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

int openmp_levels() {
  static const auto get = openmp<int()>("omp_get_max_active_levels");
  return get != nullptr ? get() : 0;
}

void set_openmp_levels(int levels) {
  static const auto set = openmp<void(int)>("omp_set_max_active_levels");
  if (set != nullptr) set(levels);
}

}  // namespace

bool Listener::is_news(const Progress& progress) {
  const auto now = std::chrono::steady_clock::now();
  const bool ends = progress.total > 0 && progress.done == progress.total;
  if (progress.stage == stage_ && !ends && now < next_) return false;
  stage_ = progress.stage;
  next_ = now + kBetweenNews;
  return true;
}

bool Listener::hear(const Progress& progress) {
  if (!is_news(progress)) return true;
  const nb::gil_scoped_acquire gil;
  try {
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    if (told_.is_none()) return true;
    return !told_(progress.stage, progress.done, progress.total).is(nb::bool_(false));
  } catch (const nb::python_error&) {
    raised_ = std::current_exception();
    return false;
  }
}

namespace detail {

Turn::Turn() {
  while (!turns().try_lock_for(kBetweenNews)) {
    const nb::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
  }
  openmp_levels_ = openmp_levels();
  set_openmp_levels(0);
}

Turn::~Turn() {
  set_openmp_levels(openmp_levels_);
  turns().unlock();
}

}  // namespace detail
}  // namespace isotherm::python
