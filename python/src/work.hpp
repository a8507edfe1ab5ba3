#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <nanobind/nanobind.h>

#include "isotherm/base/progress.hpp"

namespace isotherm::python {

namespace nb = nanobind;

/// A computation on a thread of its own, so that the one that asked for it can hear signals
/// even while a library below computes for long without looking up.
class Work {
 public:
  /// `owner` is kept for as long as the work runs: what the computation refers to.
  explicit Work(nb::object owner) : owner_(std::move(owner)) {}
  virtual ~Work() = default;
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  /// Tells `told(stage, done, total)`, unless it is None, of what the computation reports, on
  /// this thread. With the GIL.
  /// @throws what the computation throws; what a signal or `told` raises; Cancelled where
  ///   `told` returns False. In the last two cases the computation ends at its next report; if
  ///   that takes long, it is left behind, and the next Turn waits for it.
  static void carry_out(std::unique_ptr<Work>& work, nb::handle told);

  /// Waits for what was left behind. With the GIL, and by one thread at a time.
  static void await_left_behind();

 protected:
  virtual void compute(const ProgressCallback& progress) = 0;

 private:
  enum class State { computing, asking, done };

  void start(bool asks);
  void run() noexcept;
  bool ask(const Progress& progress);
  bool is_news(const Progress& progress);
  State state() const;
  State wait(std::chrono::milliseconds longest);
  void answer();
  void stop();
  bool hear(nb::handle told) const;
  static bool serve(Work& work, nb::handle told);
  static void stop_or_leave(std::unique_ptr<Work>& work);

  nb::object owner_;
  std::thread thread_;
  std::mutex mutex_;
  std::condition_variable changed_;
  // Below the mutex:
  std::optional<Progress> question_;
  bool stopped_ = false;
  bool done_ = false;
  std::exception_ptr thrown_;
  // Of the computing thread alone:
  bool asks_ = false;
  std::string stage_;
  std::chrono::steady_clock::time_point next_;
};

/// One computation at a time: the serial BLAS that CHOLMOD calls may not be called from two
/// threads at once. Other threads of Python run meanwhile; a progress function may call the
/// library again.
class Turn {
 public:
  /// Waits, without the GIL; raises in Python what a signal raises meanwhile.
  Turn();

 private:
  std::unique_lock<std::recursive_timed_mutex> lock_;
};

}  // namespace isotherm::python
