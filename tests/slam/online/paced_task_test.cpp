#include "online/paced_task.hpp"

#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"

namespace isotherm::slam::detail {
namespace {

TEST(PacedTask, DoesAsMuchAsItMayAtATime) {
  std::vector<int> done;
  PacedTask task([&done](const Pace& pace) {
    for (int k = 0; k < 6; ++k) {
      done.push_back(k);
      pace(1.0);
    }
  });
  EXPECT_TRUE(done.empty());
  EXPECT_FALSE(task.run(2.0));
  EXPECT_THAT(done, testing::ElementsAre(0, 1));
  EXPECT_FALSE(task.run(0.5));
  EXPECT_EQ(done.size(), 3U);
  EXPECT_TRUE(task.run(100.0));
  EXPECT_EQ(done.size(), 6U);
  EXPECT_EQ(task.spent(), 6.0);
  EXPECT_TRUE(task.run(1.0));
}

TEST(PacedTask, EndsWhereItStands) {
  bool cancelled = false;
  {
    PacedTask task([&cancelled](const Pace& pace) {
      try {
        while (true) pace(1.0);
      } catch (const Cancelled&) {
        cancelled = true;
        throw;
      }
    });
    EXPECT_FALSE(task.run(3.0));
  }
  EXPECT_TRUE(cancelled);
  const PacedTask never_run([](const Pace&) { FAIL(); });
}

TEST(PacedTask, HandsOnWhatIsThrown) {
  PacedTask task([](const Pace&) { throw std::runtime_error("out of luck"); });
  EXPECT_THROW(task.run(1.0), std::runtime_error);
}

}  // namespace
}  // namespace isotherm::slam::detail
