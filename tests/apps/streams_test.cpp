// Messages that cannot be written are dropped; results that cannot be written are errors.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run_command.hpp"

namespace {

using isotherm_test::CommandTest;
using isotherm_test::read_text;
using testing::HasSubstr;
using testing::StartsWith;

class Streams : public CommandTest {
 protected:
  void SetUp() override { run_ok("simulate city --poses 40 --loops 6 -o in.g2o -q"); }

  /// Runs a line of shell in the test's folder in which $isotherm is the command.
  int shell(const std::string& line) const {
    const int status = std::system(
        ("cd '" + folder.string() + "' && isotherm='" ISOTHERM_COMMAND "' && " + line).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
};

TEST_F(Streams, NoResultIsLostForAMessage) {
  const auto plain = run_ok("prune in.g2o -o -");
  const auto expect_unharmed = [&](const std::string& before, const std::string& after) {
    const auto line = [&](const std::string& arguments) {
      return before + "\"$isotherm\" " + arguments + " " + after;
    };
    EXPECT_EQ(shell(line("prune in.g2o -v -o out.g2o")), 0) << before << after;
    EXPECT_EQ(read_text(folder / "out.g2o"), plain) << before << after;
    std::filesystem::remove(folder / "out.g2o");
    EXPECT_EQ(shell(line("info nowhere")), 3) << before << after;
    EXPECT_EQ(shell(line("fly")), 2) << before << after;
  };
  expect_unharmed("", "2>&-");
  expect_unharmed("", "2>/dev/full");
  // A pipe that nobody reads.
  expect_unharmed("{ sleep 0.2; ", "2>&1 >/dev/null; echo $? >code; } | true; exit $(cat code)");
}

TEST_F(Streams, NoFileGetsTheNumberOfAClosedStream) {
  const auto plain = run_ok("prune in.g2o -o -");
  EXPECT_EQ(shell("\"$isotherm\" prune in.g2o -v -o out.g2o --json out.json <&- >&- 2>&-"), 0);
  EXPECT_EQ(read_text(folder / "out.g2o"), plain);
  EXPECT_THAT(read_text(folder / "out.json"), StartsWith("{"));
}

TEST_F(Streams, StdoutThatCannotBeWrittenIsAnError) {
  for (const std::string what :
       {"prune in.g2o -o - -q", "info in.g2o", "info in.g2o --json -", "eval ate in.g2o in.g2o"}) {
    EXPECT_EQ(shell("\"$isotherm\" " + what + " >/dev/full 2>err"), 3) << what;
    EXPECT_THAT(read_text(folder / "err"), HasSubstr("<stdout>: cannot be written")) << what;
    EXPECT_EQ(shell("\"$isotherm\" " + what + " >&- 2>err"), 3) << what;
  }
}

TEST_F(Streams, AFileSizeLimitIsAnErrorThatLeavesNothing) {
  EXPECT_EQ(shell("(ulimit -f 1; \"$isotherm\" simulate city --poses 500 -o big.g2o 2>err)"), 3);
  EXPECT_THAT(read_text(folder / "err"), HasSubstr("File too large"));
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    EXPECT_THAT(entry.path().filename().string(), testing::Not(StartsWith("big")));
  }
}

}  // namespace
