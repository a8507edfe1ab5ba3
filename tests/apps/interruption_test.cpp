// Signals end a run within moments, whatever it is doing, and nothing half-written stays.
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run_command.hpp"

namespace {

namespace fs = std::filesystem;
using isotherm_test::CommandTest;
using isotherm_test::read_text;
using isotherm_test::write_text;
using testing::HasSubstr;

constexpr int kInterrupted = 130;

class Interruption : public CommandTest {
 protected:
  void SetUp() override {
    write_text(folder / "out", "old");
    EXPECT_EQ(std::system(("mkfifo '" + file("endless") + "'").c_str()), 0);
  }

  // Runs until a signal comes after 0.3 s; five seconds later it would be killed, with
  // another code. Standard input never ends.
  int run_until(const std::string& signal, const std::string& arguments) const {
    const std::string line = "cd '" + folder.string() + "' && timeout --preserve-status -s " +
                             signal + " -k 5 0.3 '" ISOTHERM_COMMAND "' " + arguments +
                             " <>endless >.stdout 2>.stderr";
    const int status = std::system(line.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  void expect_untouched(const std::string& what) const {
    EXPECT_EQ(read_text(folder / "out"), "old") << what;
    EXPECT_EQ(read_text(folder / ".stderr"), "isotherm: interrupted; nothing was written\n")
        << what;
    for (const auto& entry : fs::directory_iterator(folder)) {
      EXPECT_THAT(entry.path().filename().string(), testing::Not(HasSubstr(".part"))) << what;
    }
  }
};

TEST_F(Interruption, IsHeededWhileReading) {
  for (const std::string verb :
       {"info -", "convert - -o out --to g2o", "corrupt - --count 1 -o out", "report - -o out",
        "prune - -o out", "edges - -o out"}) {
    EXPECT_EQ(run_until("INT", verb), kInterrupted) << verb;
    expect_untouched(verb);
  }
}

TEST_F(Interruption, IsHeededWhileComputing) {
  for (const std::string signal : {"INT", "TERM", "HUP"}) {
    EXPECT_EQ(run_until(signal, "simulate city --poses 3000000 -o out -q"), kInterrupted) << signal;
    expect_untouched(signal);
  }
}

TEST_F(Interruption, ASecondSignalEndsAtOnce) {
  const std::string line = "cd '" + folder.string() +
                           "' && { timeout --preserve-status -k 5 9 '" ISOTHERM_COMMAND
                           "' info - <>endless 2>.stderr & sleep 0.2; kill -INT $!; kill -INT $!; "
                           "wait $!; }";
  const int status = std::system(line.c_str());
  EXPECT_EQ(WEXITSTATUS(status), kInterrupted);
  expect_untouched("twice");
}

}  // namespace
