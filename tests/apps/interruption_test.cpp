// Signals end a run within moments, whatever it is doing, and nothing half-written stays.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

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

// 80,000 loops between the same few places, in which every two can be compared.
TEST_F(Interruption, IsHeededAmongManyLoopsOfOnePlace) {
  std::string text;
  const std::string information = " 0 0 400 0 0 400 0 10000\n";
  for (int v = 0; v + 1 < 2000; ++v) {
    text += "EDGE_SE2 " + std::to_string(v) + " " + std::to_string(v + 1) + " 1" + information;
  }
  for (int k = 0; k < 80000; ++k) {
    const int from = k % 3;
    const int to = 1500 + k % 5;
    text += "EDGE_SE2 " + std::to_string(from) + " " + std::to_string(to) + " " +
            std::to_string(to - from + 1e-6 * k) + information;
  }
  write_text(folder / "many.g2o", text);
  EXPECT_EQ(run_until("INT", "prune many.g2o -o out -q"), kInterrupted);
  expect_untouched("prune");
}

// Whether the process has a handler of its own, for which a busy machine takes its time.
bool heeds_interrupts(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (!line.starts_with("SigCgt:")) continue;
    return (std::stoull(line.substr(7), nullptr, 16) >> (SIGINT - 1) & 1) != 0;
  }
  return false;
}

TEST_F(Interruption, ASecondSignalEndsAtOnce) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const int endless = open(file("endless").c_str(), O_RDWR);
    const int messages = open(file(".stderr").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(endless, STDIN_FILENO);
    dup2(messages, STDERR_FILENO);
    execl(ISOTHERM_COMMAND, "isotherm", "info", "-", static_cast<char*>(nullptr));
    _exit(127);
  }
  using namespace std::chrono_literals;
  for (int k = 0; k < 1000 && !heeds_interrupts(child); ++k) std::this_thread::sleep_for(10ms);
  kill(child, SIGINT);
  kill(child, SIGINT);
  int status = 0;
  for (int k = 0; k < 500 && waitpid(child, &status, WNOHANG) == 0; ++k) {
    std::this_thread::sleep_for(10ms);
    if (k == 499) kill(child, SIGKILL);
  }
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), kInterrupted);
  expect_untouched("twice");
}

// Between the naming of its files and the end of the process.
TEST_F(Interruption, ComesTooLateOnceOutputsAreThere) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    execl(ISOTHERM_COMMAND, "isotherm", "simulate", "city", "--poses", "100000", "-q", "-o",
          file("late").c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  int status = 0;
  bool ended = false;
  while (!ended && !fs::exists(folder / "late")) ended = waitpid(child, &status, WNOHANG) == child;
  if (!ended) {
    kill(child, SIGINT);
    kill(child, SIGINT);
    waitpid(child, &status, 0);
  }
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
