#include "isotherm/base/output_group.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm_test/temporary.hpp"

namespace isotherm {
namespace {

namespace fs = std::filesystem;
using isotherm_test::read_file;
using isotherm_test::TemporaryFolder;
using isotherm_test::write_file;

void write_whole(const std::string& path, const std::string& text) {
  OutputFile file(path);
  file.write(text);
  file.commit();
}

TEST(OutputGroup, FilesAppearTogether) {
  const TemporaryFolder folder;
  OutputGroup group;
  write_whole(folder / "a", "1");
  write_whole(folder / "b.gz", "2");
  EXPECT_FALSE(fs::exists(folder / "a"));
  group.commit();
  EXPECT_TRUE(outputs_in_place()) << "from now on nobody may say that nothing was written";
  EXPECT_EQ(read_file(folder / "a"), "1");
  EXPECT_TRUE(fs::exists(folder / "b.gz"));
}

TEST(OutputGroup, WithoutCommitNothingChanges) {
  const TemporaryFolder folder;
  write_file(folder / "a", "old");
  {
    const OutputGroup group;
    write_whole(folder / "a", "new");
    write_whole(folder / "b", "new");
    OutputFile full("/dev/full");
    full.write("x");
    EXPECT_THROW(full.commit(), FileError);
  }
  EXPECT_EQ(read_file(folder / "a"), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
  write_whole(folder / "b", "alone");
  EXPECT_EQ(read_file(folder / "b"), "alone");
}

}  // namespace
}  // namespace isotherm
