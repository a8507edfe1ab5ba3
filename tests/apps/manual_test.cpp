// Shell completion and manual pages, which the command makes of its own parser.
#include <cstdlib>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run_command.hpp"

namespace {

using isotherm_test::read_text;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::vector<std::string> kManualVerbs = {
    "info",  "convert", "candidates", "simulate", "corrupt",  "densify", "prune",      "optimize",
    "label", "eval",    "edges",      "embed",    "localize", "report",  "completion", "manual"};

bool is_installed(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

class Manual : public isotherm_test::CommandTest {
 protected:
  /// What bash offers after these words, the last of which is being typed.
  std::vector<std::string> offered(const std::vector<std::string>& words) const {
    isotherm_test::write_text(file("script.bash"), run_ok("completion bash"));
    std::string line = "source script.bash; COMP_WORDS=(isotherm";
    for (const auto& word : words) line += " '" + word + "'";
    line += "); COMP_CWORD=" + std::to_string(words.size());
    line += R"(; _isotherm; printf '%s\n' "${COMPREPLY[@]}")";
    isotherm_test::write_text(file("ask.sh"), line);
    const auto command = "cd '" + folder.string() + "' && bash ask.sh > offered.txt";
    EXPECT_EQ(std::system(command.c_str()), 0);
    std::istringstream text(read_text(file("offered.txt")));
    std::vector<std::string> all;
    for (std::string word; std::getline(text, word);) {
      if (!word.empty()) all.push_back(word);
    }
    return all;
  }
};

TEST_F(Manual, BashCompletesVerbs) {
  const auto all = offered({""});
  for (const auto& verb : kManualVerbs) EXPECT_THAT(all, Contains(verb));
  EXPECT_THAT(offered({"pru"}), ElementsAre("prune"));
  EXPECT_THAT(offered({"simulate", "ci"}), ElementsAre("city"));
}

TEST_F(Manual, BashCompletesFlagsOfTheVerb) {
  EXPECT_THAT(offered({"prune", "--verd"}), ElementsAre("--verdicts"));
  EXPECT_THAT(offered({"info", "--verd"}), IsEmpty());
  EXPECT_THAT(offered({"simulate", "city", "--blo"}), ElementsAre("--block"));
  EXPECT_THAT(offered({"prune", "--no-calib"}), ElementsAre("--no-calibrate"));
}

TEST_F(Manual, BashCompletesChoices) {
  EXPECT_THAT(offered({"prune", "map.g2o", "--method", "conse"}), ElementsAre("consensus"));
  EXPECT_THAT(offered({"optimize", "--kernel", "gnc"}), ElementsAre("gnc", "gnc-gm"));
  EXPECT_THAT(offered({"completion", "f"}), ElementsAre("fish"));
}

TEST_F(Manual, BashLeavesFilesToItself) { EXPECT_THAT(offered({"info", "x"}), IsEmpty()); }

TEST_F(Manual, OtherShellsTakeTheirScripts) {
  isotherm_test::write_text(file("_isotherm"), run_ok("completion zsh"));
  isotherm_test::write_text(file("isotherm.fish"), run_ok("completion fish"));
  EXPECT_THAT(read_text(file("_isotherm")), HasSubstr("#compdef isotherm\n"));
  for (const std::string shell : {"zsh", "fish"}) {
    if (!is_installed(shell)) continue;
    const auto script = file(shell == "zsh" ? "_isotherm" : "isotherm.fish");
    EXPECT_EQ(std::system((shell + " -n '" + script + "'").c_str()), 0) << shell;
  }
}

TEST_F(Manual, EachVerbHasAPageWithItsFlags) {
  for (const auto& verb : kManualVerbs) {
    const auto page = run_ok("manual " + verb);
    EXPECT_THAT(page, HasSubstr("isotherm\\-" + verb + " \\- "));
    const auto help = run_ok(verb + " --help");
    const std::regex flag("--([a-z0-9]+(-[a-z0-9]+)*)");
    for (std::sregex_iterator found(help.begin(), help.end(), flag), end; found != end; ++found) {
      const auto name = std::regex_replace((*found)[1].str(), std::regex("-"), "\\-");
      EXPECT_THAT(page, HasSubstr("\\-\\-" + name)) << verb;
    }
  }
}

TEST_F(Manual, ThePageOfTheCommandNamesEveryVerb) {
  const auto page = run_ok("manual");
  for (const auto& verb : kManualVerbs)
    EXPECT_THAT(page, HasSubstr("isotherm\\-" + verb + "\\fR(1)"));
}

TEST_F(Manual, PagesAreSound) {
  if (!is_installed("groff")) GTEST_SKIP() << "no groff";
  for (const std::string verb : {"", "prune", "simulate", "edges"}) {
    isotherm_test::write_text(file("page.1"), run_ok("manual " + verb));
    const auto command = "groff -man -ww -Tutf8 '" + file("page.1") + "' 2>'" + file("warnings") +
                         "' >'" + file("text") + "'";
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_THAT(read_text(file("warnings")), IsEmpty()) << verb;
    EXPECT_THAT(read_text(file("text")), Not(IsEmpty()));
  }
}

TEST_F(Manual, WhatIsNotThereIsTold) {
  EXPECT_EQ(run("manual nothing").code, 2);
  EXPECT_EQ(run("completion csh").code, 2);
  EXPECT_EQ(run("completion").code, 2);
}

}  // namespace
