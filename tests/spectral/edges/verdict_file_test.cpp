#include "isotherm/spectral/edges/verdict_file.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "isotherm/base/error.hpp"

namespace isotherm::spectral {
namespace {

std::string scratch_file() {
  return (std::filesystem::temp_directory_path() /
          ("isotherm.verdicts." + std::to_string(getpid()) + ".csv"))
      .string();
}

std::string header_of(const std::string& path) {
  std::string header;
  std::getline(std::ifstream(path) >> std::ws, header);
  return header;
}

TEST(VerdictFile, RoundTripIsExact) {
  const auto path = scratch_file();
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
  EXPECT_EQ(header_of(path), "edge,from,to,verdict,score,threshold,stage");
  EXPECT_FALSE(state_probabilities(read));

  std::ofstream(path) << "edge,from,to,verdict,score,threshold,stage\n1,2,3,maybe,0,0,x\n";
  EXPECT_THROW(read_verdicts(path), ParseError);
  std::filesystem::remove(path);
  EXPECT_THROW(read_verdicts(path), FileError);
  EXPECT_THROW(write_verdicts("/nonexistent/folder/v.csv", verdicts), FileError);
}

TEST(VerdictFile, HasAColumnOfProbabilitiesWhereAnyIsStated) {
  const auto path = scratch_file();
  EdgeVerdicts verdicts = {{3, 1, 2, Verdict::prune, 9.0, 4.6, "rejected", 1e-300},
                           {4, 2, 3, Verdict::ambiguous, 0.0, 0.0, "self-edge"},
                           {5, 2, 4, Verdict::keep, -9.0, 4.6, "accepted", 1.0 / 3.0}};
  const auto names = [](std::uint64_t vertex) { return "v" + std::to_string(vertex); };
  for (const auto& used : {VertexNames(), VertexNames(names)}) {
    write_verdicts(path, verdicts, used);
    const std::string added = used ? ",from_name,to_name" : "";
    EXPECT_EQ(header_of(path), "edge,from,to,verdict,score,threshold,stage,probability" + added);
    const auto read = read_verdicts(path);
    ASSERT_EQ(read.size(), 3u);
    EXPECT_TRUE(state_probabilities(read));
    EXPECT_EQ(read[0].probability, 1e-300);
    EXPECT_TRUE(std::isnan(read[1].probability));
    EXPECT_EQ(read[2].probability, 1.0 / 3.0);
  }
  for (const std::string wrong : {"1.5", "-0.1", "nan", "likely"}) {
    std::ofstream(path) << "edge,from,to,verdict,score,threshold,stage,probability\n"
                        << "1,2,3,keep,0,0,x," << wrong << "\n";
    EXPECT_THROW(read_verdicts(path), ParseError) << wrong;
  }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace isotherm::spectral
