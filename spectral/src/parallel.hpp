#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <string_view>
#include <thread>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

#include "isotherm/base/error.hpp"
#include "isotherm/base/progress.hpp"

namespace isotherm::spectral::detail {

/// Runs body(workspace, index) for every index in [0, count), `grain` of them
/// a task, on `threads` threads (0: all cores), each with its own workspace
/// from `make_workspace`. The body must give the same result whatever else has
/// used its workspace. Progress is reported from the calling thread only.
template <class MakeWorkspace, class Body>
void parallel_for(std::int64_t count, std::size_t grain, int threads,
                  const ProgressCallback& progress, std::string_view stage,
                  MakeWorkspace make_workspace, Body body) {
  namespace tbb = oneapi::tbb;
  using Range = tbb::blocked_range<std::int64_t>;
  const auto caller = std::this_thread::get_id();
  std::atomic<std::int64_t> done = 0;
  std::atomic<bool> cancelled = false;
  tbb::enumerable_thread_specific<decltype(make_workspace())> workspaces(make_workspace);

  const auto run = [&](const Range& range) {
    auto& workspace = workspaces.local();
    for (auto index = range.begin(); index != range.end() && !cancelled; ++index) {
      body(workspace, index);
    }
    done += static_cast<std::int64_t>(range.size());
    if (progress && std::this_thread::get_id() == caller) {
      const auto finished = static_cast<std::uint64_t>(done);
      if (!progress({stage, finished, static_cast<std::uint64_t>(count)})) cancelled = true;
    }
  };
  if (threads == 1 || count <= 1) {  // without the cost of an arena
    const auto step = static_cast<std::int64_t>(grain);
    for (std::int64_t begin = 0; begin < count && !cancelled; begin += step) {
      run(Range(begin, std::min(begin + step, count)));
    }
  } else {
    tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
    arena.execute(
        [&] { tbb::parallel_for(Range(0, count, grain), run, tbb::simple_partitioner()); });
  }
  if (cancelled) throw Cancelled();
}

}  // namespace isotherm::spectral::detail
