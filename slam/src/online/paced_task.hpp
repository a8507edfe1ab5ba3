#pragma once

#include <exception>
#include <functional>
#include <semaphore>
#include <thread>

#include "prune/consensus/estimate/pace.hpp"

namespace isotherm::slam::detail {

/// A computation that is done in pieces, each in the time of a call to run(). It has a thread of
/// its own, for its stack: that runs only while run() waits for it, so that what comes out
/// does not depend on time, and nothing is shared between threads at once.
class PacedTask {
 public:
  explicit PacedTask(std::function<void(const Pace&)> work);
  /// Ends the computation where it stands, by Cancelled.
  ~PacedTask();
  PacedTask(const PacedTask&) = delete;
  PacedTask& operator=(const PacedTask&) = delete;

  /// Goes on until more work than `budget` is done; true where all is done.
  /// @throws what the computation throws
  bool run(double budget);

  /// Work done so far.
  double spent() const noexcept { return spent_; }

 private:
  void hand_over(double work);

  double spent_ = 0.0;
  double stop_at_ = 0.0;
  bool cancelled_ = false;
  bool done_ = false;
  std::exception_ptr failure_;
  std::binary_semaphore go_{0};
  std::binary_semaphore paused_{0};
  std::thread thread_;
};

}  // namespace isotherm::slam::detail
