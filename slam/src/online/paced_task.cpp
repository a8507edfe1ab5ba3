#include "online/paced_task.hpp"

#include <utility>

#include "isotherm/base/error.hpp"

namespace isotherm::slam::detail {

PacedTask::PacedTask(std::function<void(const Pace&)> work)
    : thread_([this, work = std::move(work)] {
        go_.acquire();
        try {
          if (!cancelled_) work([this](double done) { hand_over(done); });
        } catch (...) {
          failure_ = std::current_exception();
        }
        done_ = true;
        paused_.release();
      }) {}

PacedTask::~PacedTask() {
  if (!done_) {
    cancelled_ = true;
    go_.release();
  }
  thread_.join();
}

bool PacedTask::run(double budget) {
  if (done_) return true;
  stop_at_ = spent_ + budget;
  go_.release();
  paused_.acquire();
  if (failure_) std::rethrow_exception(failure_);
  return done_;
}

void PacedTask::hand_over(double work) {
  spent_ += work;
  if (spent_ < stop_at_) return;
  paused_.release();
  go_.acquire();
  if (cancelled_) throw Cancelled();
}

}  // namespace isotherm::slam::detail
