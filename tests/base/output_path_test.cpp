#include "isotherm/base/output_path.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm_test/temporary.hpp"

namespace isotherm {
namespace {

namespace fs = std::filesystem;
using isotherm_test::TemporaryFolder;
using isotherm_test::write_file;

std::ptrdiff_t entries_of(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), {});
}

TEST(RequireWritable, LooksAheadAndCreatesNothing) {
  const TemporaryFolder folder;
  write_file(folder / "file", "x");
  require_writable("-");
  require_writable("/dev/null");
  require_writable(folder / "file");
  require_writable(folder / "new");
  EXPECT_THROW(require_writable(""), FileError);
  EXPECT_THROW(require_writable(folder.path().string()), FileError);
  EXPECT_THROW(require_writable(folder / "no/such/folder"), FileError);
  EXPECT_THROW(require_writable(folder / "file/below"), FileError);
  EXPECT_EQ(entries_of(folder.path()), 1);
}

TEST(OutputTarget, IsOneForAllNamesOfAFile) {
  const TemporaryFolder folder;
  const std::string name = folder / "new";
  EXPECT_EQ(output_target(folder / "./new"), output_target(name));
  EXPECT_EQ(output_target(folder / "no/../new"), output_target(name));
  fs::current_path(folder.path());
  EXPECT_EQ(output_target("new"), output_target(name));
  EXPECT_NE(output_target("old"), output_target(name));
  EXPECT_EQ(output_target("-"), "-");
  fs::current_path("/");
}

}  // namespace
}  // namespace isotherm
