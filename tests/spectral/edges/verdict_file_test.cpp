#include "isotherm/spectral/edges/verdict_file.hpp"

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "isotherm/base/error.hpp"

namespace isotherm::spectral {
namespace {

TEST(VerdictFile, RoundTripIsExact) {
  const auto path = (std::filesystem::temp_directory_path() /
                     ("isotherm.verdicts." + std::to_string(getpid()) + ".csv"))
                        .string();
  const double infinity = std::numeric_limits<double>::infinity();
  const EdgeVerdicts verdicts = {
      {3, 1, std::uint64_t{1} << 63, Verdict::prune, 0.1 + 0.2, 1.0, "t=100"},
      {4, 2, 3, Verdict::ambiguous, infinity, infinity, "induction"},
      {5, 2, 4, Verdict::keep, 1e-300, 2.0, ""}};
  write_verdicts(path, verdicts);
  const auto read = read_verdicts(path);
  ASSERT_EQ(read.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(read[k].edge, verdicts[k].edge);
    EXPECT_EQ(read[k].from, verdicts[k].from);
    EXPECT_EQ(read[k].to, verdicts[k].to);
    EXPECT_EQ(read[k].verdict, verdicts[k].verdict);
    EXPECT_EQ(read[k].score, verdicts[k].score);
    EXPECT_EQ(read[k].threshold, verdicts[k].threshold);
    EXPECT_EQ(read[k].stage, verdicts[k].stage);
  }
  EXPECT_EQ(count(read, Verdict::ambiguous), 1);

  std::ofstream(path) << "edge,from,to,verdict,score,threshold,stage\n1,2,3,maybe,0,0,x\n";
  EXPECT_THROW(read_verdicts(path), ParseError);
  std::filesystem::remove(path);
  EXPECT_THROW(read_verdicts(path), FileError);
  EXPECT_THROW(write_verdicts("/nonexistent/folder/v.csv", verdicts), FileError);
}

}  // namespace
}  // namespace isotherm::spectral
