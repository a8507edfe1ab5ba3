#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace isotherm_test {

/// What a run of the command gave back.
struct CommandResult {
  int code = -1;
  std::string out;
  std::string err;
};

inline std::string read_text(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// A folder of its own for each test, removed afterwards.
class CommandTest : public testing::Test {
 protected:
  CommandTest() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = std::filesystem::temp_directory_path() /
             ("isotherm." + std::string(info->test_suite_name()) + "." + info->name() + "." +
              std::to_string(getpid()));
    std::filesystem::create_directories(folder);
  }
  ~CommandTest() override { std::filesystem::remove_all(folder); }

  std::string file(const std::string& name) const { return (folder / name).string(); }

  /// Runs `isotherm <arguments>`, a line of shell words, in the test's folder.
  CommandResult run(const std::string& arguments) const {
    const std::string line = "cd '" + folder.string() + "' && '" ISOTHERM_COMMAND "' " + arguments +
                             " >.stdout 2>.stderr";
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder / ".stdout"),
            read_text(folder / ".stderr")};
  }

  /// Runs and expects success; gives back stdout.
  std::string run_ok(const std::string& arguments) const {
    const auto result = run(arguments);
    EXPECT_EQ(result.code, 0) << arguments << "\n" << result.err;
    return result.out;
  }

  std::filesystem::path folder;
};

}  // namespace isotherm_test
