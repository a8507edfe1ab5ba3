#include "isotherm/base/text_writer.hpp"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm_test/temporary.hpp"

namespace isotherm {
namespace {

namespace fs = std::filesystem;
using isotherm_test::read_file;
using isotherm_test::TemporaryFolder;
using isotherm_test::write_file;

std::ptrdiff_t entries(const TemporaryFolder& folder) {
  return std::distance(fs::directory_iterator(folder.path()), {});
}

TEST(OutputFile, AppearsWithCommit) {
  const TemporaryFolder folder;
  OutputFile file(folder / "a");
  file.write("text\n");
  EXPECT_FALSE(fs::exists(folder / "a"));
  file.commit();
  EXPECT_EQ(read_file(folder / "a"), "text\n");
  EXPECT_EQ(entries(folder), 1);
}

TEST(OutputFile, WithoutCommitLeavesWhatWasThere) {
  const TemporaryFolder folder;
  write_file(folder / "a", "old");
  {
    OutputFile file(folder / "a");
    file.write(std::string(1'000'000, 'x'));
  }
  EXPECT_EQ(read_file(folder / "a"), "old");
  EXPECT_EQ(entries(folder), 1);
}

TEST(OutputFile, ReplacesTheFileALinkPointsTo) {
  const TemporaryFolder folder;
  write_file(folder / "real", "old");
  fs::create_symlink("real", folder / "link");
  OutputFile file(folder / "link");
  file.write("new");
  file.commit();
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(read_file(folder / "real"), "new");
}

TEST(OutputFile, WritesDevicesDirectly) {
  OutputFile file("/dev/null");
  file.write("x");
  file.commit();
  EXPECT_FALSE(fs::is_regular_file("/dev/null"));
}

TEST(OutputFile, NamesWhatItCannotWrite) {
  const TemporaryFolder folder;
  EXPECT_THROW(OutputFile(folder / "no/such/folder"), FileError);
  EXPECT_THROW(OutputFile(folder.path().string()), FileError);
  EXPECT_THROW(OutputFile(""), FileError);
  OutputFile full("/dev/full");
  full.write("x");
  EXPECT_THROW(full.commit(), FileError);
}

}  // namespace
}  // namespace isotherm
