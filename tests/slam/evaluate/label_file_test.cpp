#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/evaluate/labels.hpp"

namespace isotherm::slam {
namespace {

TEST(LabelFile, RoundTripAndErrors) {
  const auto path = (std::filesystem::temp_directory_path() /
                     ("isotherm.labels." + std::to_string(getpid()) + ".csv"))
                        .string();
  const VertexId big = VertexId{1} << 63;
  write_labels(
      path, {{7, 1, big, Label::correct}, {8, 2, 3, Label::incorrect}, {9, 4, 5, Label::ignore}});
  const auto labels = read_labels(path);
  ASSERT_EQ(labels.size(), 3u);
  EXPECT_EQ(labels[0].edge, 7);
  EXPECT_EQ(labels[0].to, big);
  EXPECT_EQ(labels[1].label, Label::incorrect);
  EXPECT_EQ(count(labels, Label::ignore), 1);

  std::ofstream(path) << "edge,from,to,label\n0,1,2,corect\n";
  try {
    read_labels(path);
    FAIL();
  } catch (const ParseError& error) {
    EXPECT_EQ(error.line(), 2u);
    EXPECT_EQ(error.token(), "corect");
  }
  std::ofstream(path) << "edge,from,to,label\n";
  EXPECT_TRUE(read_labels(path).empty());
  std::filesystem::remove(path);
  EXPECT_THROW(read_labels(path), FileError);
}

}  // namespace
}  // namespace isotherm::slam
