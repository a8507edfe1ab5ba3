#include "isotherm/base/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <thread>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

#include "isotherm/base/blas_threads.hpp"
#include "isotherm/base/error.hpp"

namespace isotherm {
namespace detail {

namespace tbb = oneapi::tbb;
using Range = tbb::blocked_range<std::int64_t>;

// More threads than the machine runs at once would only make TBB complain, and bodies may call the
// BLAS.
int usable(int threads) {
  if (!blas_serves_threads()) return 1;
  return threads > 0 ? std::min(threads, tbb::info::default_concurrency())
                     : tbb::task_arena::automatic;
}

std::size_t slot_count(int threads) {
  const tbb::task_arena arena(usable(threads));
  return static_cast<std::size_t>(arena.max_concurrency());
}

void parallel_by_slot(std::int64_t count, std::size_t grain, int threads,
                      const ProgressCallback& progress, std::string_view stage,
                      const std::function<void(std::size_t, std::int64_t)>& body) {
  const auto caller = std::this_thread::get_id();
  std::atomic<std::int64_t> done = 0;
  std::atomic<bool> cancelled = false;

  const auto run = [&](std::size_t slot, const Range& range) {
    for (auto index = range.begin(); index != range.end() && !cancelled; ++index) {
      body(slot, index);
    }
    done += static_cast<std::int64_t>(range.size());
    if (progress && std::this_thread::get_id() == caller) {
      const auto finished = static_cast<std::uint64_t>(done);
      if (!progress({stage, finished, static_cast<std::uint64_t>(count)})) cancelled = true;
    }
  };
  if (usable(threads) == 1 || count <= 1) {  // without the cost of an arena
    const auto step = static_cast<std::int64_t>(grain);
    for (std::int64_t begin = 0; begin < count && !cancelled; begin += step) {
      run(0, Range(begin, std::min(begin + step, count)));
    }
  } else {
    const auto in_slot = [&run](const Range& range) {
      run(static_cast<std::size_t>(tbb::this_task_arena::current_thread_index()), range);
    };
    tbb::task_arena arena(usable(threads));
    arena.execute(
        [&] { tbb::parallel_for(Range(0, count, grain), in_slot, tbb::simple_partitioner()); });
  }
  if (cancelled) throw Cancelled();
}

}  // namespace detail

void parallel_for(std::int64_t count, int threads, const ProgressCallback& progress,
                  std::string_view stage, const std::function<void(std::int64_t)>& body) {
  if (threads < 0) throw InvalidArgument("threads", "must not be negative");
  const auto grain = static_cast<std::size_t>(std::max<std::int64_t>(1, count / 256));
  detail::parallel_by_slot(count, grain, threads, progress, stage,
                           [&body](std::size_t, std::int64_t index) { body(index); });
}

void parallel_in_blocks(std::size_t count, int threads,
                        const std::function<void(std::size_t, std::size_t, std::size_t)>& body) {
  const auto blocks = static_cast<std::int64_t>(parallel_block_count(count));
  parallel_for(blocks, threads, {}, "blocks", [&](std::int64_t index) {
    const auto block = static_cast<std::size_t>(index);
    const std::size_t begin = block * kParallelBlock;
    body(block, begin, std::min(begin + kParallelBlock, count));
  });
}

void parallel_for_each(std::size_t count, int threads,
                       const std::function<void(std::size_t)>& body) {
  parallel_in_blocks(count, threads, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t index = begin; index < end; ++index) body(index);
  });
}

}  // namespace isotherm
