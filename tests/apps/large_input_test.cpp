// Input that is large, or repeats itself, takes the time and memory of what it holds.
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "run_command.hpp"

namespace {

// What each took when time or memory grew with the square was twice as much and more; now it is
// a hundredth.
constexpr double kMostSeconds = 30.0;
constexpr long kMostKilobytes = 1'000'000;

class LargeInput : public isotherm_test::CommandTest {
 protected:
  void expect_frugal(const std::string& arguments) const {
    const auto begin = std::chrono::steady_clock::now();
    const auto result = run(arguments);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    EXPECT_EQ(result.code, 0) << arguments << "\n" << result.err;
    EXPECT_LT(took.count(), kMostSeconds) << arguments;
    rusage usage = {};
    ASSERT_EQ(getrusage(RUSAGE_CHILDREN, &usage), 0);
    EXPECT_LT(usage.ru_maxrss, kMostKilobytes) << arguments;
  }

  // Odometry along a line, then this loop so many times.
  void write_loops(const std::string& loop, int copies) const {
    std::ofstream out(folder / "map.g2o");
    for (int v = 0; v + 1 < 2000; ++v) {
      out << "EDGE_SE2 " << v << " " << v + 1 << " 1 0 0 400 0 0 400 0 10000\n";
    }
    for (int k = 0; k < copies; ++k) out << loop << "\n";
  }
};

TEST_F(LargeInput, FiftyThousandPartsAreNoMatrixOfPartsAndVertices) {
  std::ofstream out(folder / "parts.csv");
  for (int k = 0; k < 50'000; ++k) out << 2 * k << "," << 2 * k + 1 << "\n";
  out.close();
  expect_frugal("embed parts.csv -o rows.npy");
}

TEST_F(LargeInput, AStarHasNoPairsOfLeavesToCompare) {
  std::ofstream out(folder / "star.csv");
  for (int leaf = 1; leaf <= 100'000; ++leaf) out << "0," << leaf << "\n";
  out.close();
  expect_frugal("edges star.csv --method jaccard -o kept.csv");
}

TEST_F(LargeInput, ALoopThatIsRepeatedIsOneLoop) {
  write_loops("EDGE_SE2 0 1500 1500 0 0 400 0 0 400 0 10000", 80'000);
  expect_frugal("prune map.g2o -o pruned.g2o");
}

TEST_F(LargeInput, CommentsAreNotKeptWithoutEnd) {
  const std::string write = "cd '" + folder.string() +
                            "' && { echo 'EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1'; yes '# " +
                            std::string(300, 'x') + "' | head -n 1000000; } | gzip -1 > map.g2o.gz";
  ASSERT_EQ(std::system(write.c_str()), 0);
  expect_frugal("info map.g2o.gz");
}

}  // namespace
