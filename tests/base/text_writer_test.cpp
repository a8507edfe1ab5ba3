#include "isotherm/base/text_writer.hpp"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/base/output_path.hpp"
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

TEST(OutputFile, DoesNotReplaceALinkThatLeadsBackToItself) {
  const TemporaryFolder folder;
  fs::create_symlink("second", folder / "first");
  fs::create_symlink("first", folder / "second");
  EXPECT_THROW(require_writable(folder / "first"), FileError);
  EXPECT_THROW(OutputFile(folder / "first"), FileError);
  EXPECT_TRUE(fs::is_symlink(folder / "first"));
}

TEST(OutputFile, MakesTheFileADanglingLinkPointsTo) {
  const TemporaryFolder folder;
  fs::create_symlink("second", folder / "first");
  fs::create_symlink("real", folder / "second");
  EXPECT_EQ(output_target(folder / "first"), output_target(folder / "./real"));
  OutputFile file(folder / "first");
  file.write("new");
  file.commit();
  EXPECT_TRUE(fs::is_symlink(folder / "first"));
  EXPECT_TRUE(fs::is_symlink(folder / "second"));
  EXPECT_EQ(read_file(folder / "real"), "new");
  EXPECT_EQ(entries(folder), 3);
}

TEST(OutputFile, KeepsThePermissionsOfTheFileItReplaces) {
  const TemporaryFolder folder;
  write_file(folder / "a", "old");
  const auto own = fs::perms::owner_read | fs::perms::owner_write;
  fs::permissions(folder / "a", own);
  OutputFile file(folder / "a");
  file.write("new");
  file.commit();
  EXPECT_EQ(fs::status(folder / "a").permissions(), own);
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
