#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include <nanobind/nanobind.h>

#include "isotherm/base/run_context.hpp"
#include "work.hpp"

namespace isotherm::python {

/// How a call is to run, besides what it computes: the keywords that all long calls have.
struct RunKeywords {
  int threads = 0;
  std::uint64_t seed = 0;
  nb::object progress = nb::none();
};

namespace detail {

template <class Body>
class WorkOf final : public Work {
 public:
  using Result = std::invoke_result_t<Body&, const RunContext&>;

  WorkOf(const RunKeywords& keywords, nb::object owner, Body body)
      : Work(std::move(owner)),
        context_{keywords.threads, {}, keywords.seed},
        body_(std::move(body)) {}

  Result take() { return std::move(*result_); }

 private:
  void compute(const ProgressCallback& progress) override {
    context_.progress = progress;
    result_.emplace(body_(context_));
  }

  RunContext context_;
  Body body_;
  std::optional<Result> result_;
};

}  // namespace detail

/// Gives what body(context) gives, run without the GIL, and so that Ctrl-C ends the call.
///
/// `owner` is the object of Python, or None, whose parts the body refers to. Whatever else the
/// body uses is its own: it may run on for a while after the call was interrupted.
template <class Body>
auto without_gil(const RunKeywords& keywords, nb::object owner, Body body) {
  using Own = detail::WorkOf<Body>;
  const Turn turn;
  std::unique_ptr<Work> work = std::make_unique<Own>(keywords, std::move(owner), std::move(body));
  Work::carry_out(work, keywords.progress);
  return static_cast<Own&>(*work).take();
}

}  // namespace isotherm::python
