#include "work.hpp"

#include <cstdio>
#include <cstdlib>
#include <vector>

#include <dlfcn.h>
#include <nanobind/stl/string_view.h>
#include <unistd.h>

#include "isotherm/base/error.hpp"

namespace isotherm::python {
namespace {

using namespace std::chrono_literals;

constexpr auto kBetweenChecks = 50ms;
// For a computation that was asked to stop, as the command has it.
constexpr auto kGrace = 1000ms;

// Looked up by name: which OpenMP a library was built with is not known when this is compiled.
template <class Function>
Function* openmp(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

// Keeps what runs on one thread there where libraries below would divide it.
class SerialOpenMp {
 public:
  SerialOpenMp() {
    static const auto get = openmp<int()>("omp_get_max_active_levels");
    if (get != nullptr) levels_ = get();
    set(0);
  }
  ~SerialOpenMp() { set(levels_); }
  SerialOpenMp(const SerialOpenMp&) = delete;
  SerialOpenMp& operator=(const SerialOpenMp&) = delete;

 private:
  static void set(int levels) {
    static const auto function = openmp<void(int)>("omp_set_max_active_levels");
    if (function != nullptr) function(levels);
  }
  int levels_ = 0;
};

void check_signals() {
  if (PyErr_CheckSignals() != 0) throw nb::python_error();
}

std::recursive_timed_mutex& turns() {
  static std::recursive_timed_mutex mutex;
  return mutex;
}

bool try_lock(std::unique_lock<std::recursive_timed_mutex>& lock) {
  const nb::gil_scoped_release released;
  return lock.try_lock_for(kBetweenChecks);
}

// Lives as long as the process: what is in it refers to objects of Python, which ends earlier.
std::vector<std::unique_ptr<Work>>& left_behind() {
  static auto& all = *new std::vector<std::unique_ptr<Work>>();
  return all;
}

// Libraries may not be torn down below a computation that uses them.
void end_without_tearing_down(int status, void*) {
  if (left_behind().empty()) return;
  std::fflush(nullptr);
  ::_exit(status);
}

void leave_behind(std::unique_ptr<Work> work) {
  [[maybe_unused]] static const int once = ::on_exit(end_without_tearing_down, nullptr);
  nb::set_leak_warnings(false);  // what the work refers to is still needed when Python ends
  left_behind().push_back(std::move(work));
}

}  // namespace

void Work::start(bool asks) {
  asks_ = asks;
  thread_ = std::thread([this] { run(); });
}

void Work::run() noexcept {
  std::exception_ptr thrown;
  try {
    const SerialOpenMp serial;
    compute([this](const Progress& progress) { return ask(progress); });
  } catch (...) {
    thrown = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  thrown_ = std::move(thrown);
  done_ = true;
  changed_.notify_all();
}

bool Work::is_news(const Progress& progress) {
  const auto now = std::chrono::steady_clock::now();
  const bool ends = progress.total > 0 && progress.done == progress.total;
  if (progress.stage == stage_ && !ends && now < next_) return false;
  stage_ = progress.stage;
  next_ = now + kBetweenChecks;
  return true;
}

bool Work::ask(const Progress& progress) {
  std::unique_lock lock(mutex_);
  if (stopped_ || !asks_ || !is_news(progress)) return !stopped_;
  question_ = progress;
  changed_.notify_all();
  changed_.wait(lock, [this] { return stopped_ || !question_; });
  return !stopped_;
}

Work::State Work::state() const {
  if (done_) return State::done;
  return question_ && !stopped_ ? State::asking : State::computing;
}

Work::State Work::wait(std::chrono::milliseconds longest) {
  const nb::gil_scoped_release released;
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, longest, [this] { return state() != State::computing; });
  return state();
}

void Work::answer() {
  const std::lock_guard lock(mutex_);
  question_.reset();
  changed_.notify_all();
}

void Work::stop() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
  changed_.notify_all();
}

// The computation waits for the answer meanwhile, and the question stays as it is.
bool Work::hear(nb::handle told) const {
  const Progress& question = question_.value();
  return !told(question.stage, question.done, question.total).is(nb::bool_(false));
}

// Until the end, or until `told` is against going on.
bool Work::serve(Work& work, nb::handle told) {
  for (State state = State::computing; state != State::done; state = work.wait(kBetweenChecks)) {
    check_signals();
    if (state != State::asking) continue;
    if (!work.hear(told)) return false;
    work.answer();
  }
  return true;
}

void Work::stop_or_leave(std::unique_ptr<Work>& work) {
  work->stop();
  if (work->wait(kGrace) == State::done) {
    work->thread_.join();
  } else {
    leave_behind(std::move(work));
  }
}

void Work::carry_out(std::unique_ptr<Work>& work, nb::handle told) {
  work->start(!told.is_none());
  bool served = false;
  try {
    served = serve(*work, told);
  } catch (...) {
    stop_or_leave(work);
    throw;
  }
  if (!served) {
    stop_or_leave(work);
    throw Cancelled();
  }
  work->thread_.join();
  if (work->thrown_) std::rethrow_exception(work->thrown_);
}

void Work::await_left_behind() {
  while (!left_behind().empty()) {
    Work& work = *left_behind().back();
    while (work.wait(kBetweenChecks) != State::done) check_signals();
    work.thread_.join();
    left_behind().pop_back();
  }
  nb::set_leak_warnings(true);
}

Turn::Turn() : lock_(turns(), std::defer_lock) {
  while (!try_lock(lock_)) check_signals();
  Work::await_left_behind();
}

}  // namespace isotherm::python
