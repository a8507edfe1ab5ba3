// Every file in tests/data/bad gives the exit code and the message that
// expected.tsv states: on stderr where it is refused, in the output where it is
// repaired.
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm_test/data.hpp"
#include "run_command.hpp"

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

struct Expected {
  std::string file;
  std::string flags;
  int exit = 0;
  std::string message;
};

fs::path bad_folder() { return isotherm_test::shipped_data("bad"); }

std::vector<Expected> expected_rows() {
  std::ifstream table(bad_folder() / "expected.tsv");
  std::vector<Expected> rows;
  std::string line;
  std::getline(table, line);  // names of columns
  while (std::getline(table, line)) {
    std::istringstream fields(line);
    Expected row;
    std::string exit;
    std::getline(fields, row.file, '\t');
    std::getline(fields, row.flags, '\t');
    std::getline(fields, exit, '\t');
    std::getline(fields, row.message);
    row.exit = std::stoi(exit);
    rows.push_back(row);
  }
  return rows;
}

class BadFiles : public isotherm_test::CommandTest {};

TEST_F(BadFiles, GiveTheirMessageAndExitCode) {
  for (const auto& row : expected_rows()) {
    const auto path = (bad_folder() / row.file).string();
    const auto result = run("info '" + path + "' " + row.flags + " --json out.json");
    EXPECT_EQ(result.code, row.exit) << row.file << ": " << result.err;
    if (row.exit == 0) {
      EXPECT_THAT(result.out, HasSubstr(row.message)) << row.file;
      continue;
    }
    std::string message = row.message;
    message.replace(message.find(row.file), row.file.size(), path);
    EXPECT_EQ(result.err, message + "\n");
    EXPECT_EQ(result.out, "") << row.file;
  }
}

TEST_F(BadFiles, AllStandInTheTable) {
  std::set<std::string> listed = {"expected.tsv"};
  for (const auto& row : expected_rows()) listed.insert(row.file);
  EXPECT_GE(listed.size(), 60u);
  for (const auto& entry : fs::directory_iterator(bad_folder())) {
    EXPECT_EQ(listed.count(entry.path().filename().string()), 1u) << entry.path();
  }
}

}  // namespace
