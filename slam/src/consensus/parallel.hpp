#pragma once

#include <cstddef>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

namespace isotherm::slam::detail {

/// Runs body(workspace, index) for every index in [0, count) on `threads` threads
/// (0: all cores), each with a workspace of its own. The body's result must not
/// depend on what used the workspace before.
template <class MakeWorkspace, class Body>
void for_each_in_parallel(std::size_t count, int threads, MakeWorkspace make_workspace, Body body) {
  namespace tbb = oneapi::tbb;
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  tbb::enumerable_thread_specific<decltype(make_workspace())> workspaces(make_workspace);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 8), [&](const auto& range) {
      auto& workspace = workspaces.local();
      for (std::size_t index = range.begin(); index != range.end(); ++index) {
        body(workspace, index);
      }
    });
  });
}

}  // namespace isotherm::slam::detail
