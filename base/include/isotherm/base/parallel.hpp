#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "isotherm/base/progress.hpp"

namespace isotherm {

/// Runs body(index) for every index in [0, count) on `threads` threads (0: all cores;
/// never more than one a core, and one with a BLAS that does not serve several), in any order;
/// calls for different indices must not depend on each other. Progress is reported under the name
/// `stage`, from the calling thread only.
/// @throws InvalidArgument if threads < 0, Cancelled, and what the body throws.
void parallel_for(std::int64_t count, int threads, const ProgressCallback& progress,
                  std::string_view stage, const std::function<void(std::int64_t)>& body);

namespace detail {

/// How many calls parallel_by_slot may run at a time with `threads` (0: all cores).
std::size_t slot_count(int threads);

/// Runs body(slot, index) for every index in [0, count), `grain` of them a task. Calls that
/// run at the same time have different slots, all below slot_count(threads).
void parallel_by_slot(std::int64_t count, std::size_t grain, int threads,
                      const ProgressCallback& progress, std::string_view stage,
                      const std::function<void(std::size_t, std::int64_t)>& body);

}  // namespace detail

/// Runs body(workspace, index) for every index in [0, count), `grain` of them
/// a task, on `threads` threads (0: all cores), each with its own workspace
/// from `make_workspace`. The body must give the same result whatever else has
/// used its workspace. Progress is reported from the calling thread only.
template <class MakeWorkspace, class Body>
void parallel_for(std::int64_t count, std::size_t grain, int threads,
                  const ProgressCallback& progress, std::string_view stage,
                  MakeWorkspace make_workspace, Body body) {
  std::vector<std::optional<decltype(make_workspace())>> workspaces(detail::slot_count(threads));
  detail::parallel_by_slot(count, grain, threads, progress, stage,
                           [&](std::size_t slot, std::int64_t index) {
                             auto& workspace = workspaces[slot];
                             if (!workspace) workspace.emplace(make_workspace());
                             body(*workspace, index);
                           });
}

/// How many blocks parallel_in_blocks() cuts `count` into.
inline constexpr std::size_t kParallelBlock = 512;
constexpr std::size_t parallel_block_count(std::size_t count) {
  return (count + kParallelBlock - 1) / kParallelBlock;
}

/// Runs body(block, begin, end) for the ranges [begin, end) that [0, count) is cut into, the same
/// whatever the number of threads: for bodies so short that only many are worth a thread, and for
/// sums, of which each block has its own.
void parallel_in_blocks(std::size_t count, int threads,
                        const std::function<void(std::size_t, std::size_t, std::size_t)>& body);

/// Runs body(index) for every index in [0, count), a block of them a task.
void parallel_for_each(std::size_t count, int threads,
                       const std::function<void(std::size_t)>& body);

}  // namespace isotherm
