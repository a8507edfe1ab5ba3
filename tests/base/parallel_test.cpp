#include "isotherm/base/parallel.hpp"

#include <cstddef>
#include <numeric>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"

namespace isotherm {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnce) {
  for (const int threads : {0, 1, 3}) {
    std::vector<int> visits(1000, 0);
    parallel_for(1000, threads, {}, "test", [&](std::int64_t k) { ++visits[k]; });
    EXPECT_THAT(visits, testing::Each(1));
  }
  parallel_for(0, 1, {}, "test", [](std::int64_t) { FAIL(); });
}

TEST(ParallelInBlocks, CutsAlikeWhateverTheThreads) {
  for (const std::size_t count : {0U, 1U, 512U, 1025U}) {
    for (const int threads : {0, 1, 3}) {
      std::vector<int> visits(count, 0);
      std::vector<std::size_t> lengths(parallel_block_count(count), 0);
      parallel_in_blocks(count, threads,
                         [&](std::size_t block, std::size_t begin, std::size_t end) {
                           EXPECT_EQ(begin, block * kParallelBlock);
                           lengths[block] = end - begin;
                           for (std::size_t k = begin; k < end; ++k) ++visits[k];
                         });
      EXPECT_THAT(visits, testing::Each(1));
      EXPECT_EQ(std::accumulate(lengths.begin(), lengths.end(), std::size_t{0}), count);
      EXPECT_THAT(lengths, testing::Each(testing::Gt(0U)));
      parallel_for_each(count, threads, [&](std::size_t k) { ++visits[k]; });
      EXPECT_THAT(visits, testing::Each(2));
    }
  }
}

TEST(ParallelFor, CancelsWhenProgressSaysSo) {
  const auto stop = [](const Progress& progress) {
    EXPECT_EQ(progress.stage, "test");
    EXPECT_EQ(progress.total, 5000U);
    return false;
  };
  EXPECT_THROW(parallel_for(5000, 1, stop, "test", [](std::int64_t) {}), Cancelled);
}

TEST(ParallelFor, PassesOnWhatTheBodyThrows) {
  const auto fail = [](std::int64_t) { throw NumericalError("test", "always"); };
  EXPECT_THROW(parallel_for(10, 2, {}, "test", fail), NumericalError);
  EXPECT_THROW(parallel_for(10, -1, {}, "test", [](std::int64_t) {}), InvalidArgument);
}

}  // namespace
}  // namespace isotherm
