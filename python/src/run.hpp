#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <string>
#include <utility>

#include <nanobind/nanobind.h>

#include "isotherm/base/error.hpp"
#include "isotherm/base/run_context.hpp"

namespace isotherm::python {

namespace nb = nanobind;

/// How a call is to run, besides what it computes: the keywords that all long calls have.
struct RunKeywords {
  int threads = 0;
  std::uint64_t seed = 0;
  nb::object progress = nb::none();
};

/// Hears what a computation reports: passes it on to Python, and stops the computation where
/// Python has a signal to handle (Ctrl-C), or the function that is told raises or returns False.
class Listener {
 public:
  explicit Listener(nb::object told) : told_(std::move(told)) {}

  /// Called without the GIL.
  bool hear(const Progress& progress);

  /// Raises in Python what ended the computation, if anything did. With the GIL.
  void raise() const {
    if (raised_) std::rethrow_exception(raised_);
  }

 private:
  bool is_news(const Progress& progress);

  nb::object told_;
  std::exception_ptr raised_;
  std::string stage_;
  std::chrono::steady_clock::time_point next_;
};

namespace detail {

/// One computation at a time, and all of it on one thread where libraries below would divide it.
///
/// The serial BLAS that CHOLMOD calls may not be called from two threads at once. Other
/// threads of Python run meanwhile; a progress function may call the library again.
class Turn {
 public:
  /// Waits, without the GIL; raises in Python what a signal raises meanwhile.
  Turn();
  ~Turn();
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  int openmp_levels_ = 0;
};

}  // namespace detail

/// Gives what body(context) gives, run without the GIL.
template <class Body>
auto without_gil(const RunKeywords& keywords, Body&& body) {
  Listener listener(keywords.progress);
  const RunContext context{
      keywords.threads, [&listener](const Progress& progress) { return listener.hear(progress); },
      keywords.seed};
  try {
    const nb::gil_scoped_release released;
    const detail::Turn turn;
    return std::forward<Body>(body)(context);
  } catch (const Cancelled&) {
    listener.raise();
    throw;
  }
}

}  // namespace isotherm::python
