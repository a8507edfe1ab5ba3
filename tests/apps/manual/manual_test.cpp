// Manual pages, which the command makes of its own parser.
#include <cstdlib>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run_command.hpp"

namespace {

using isotherm_test::read_text;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::vector<std::string> kManualVerbs = {
    "info",  "convert", "candidates", "simulate", "corrupt",  "densify", "prune",      "optimize",
    "label", "eval",    "edges",      "embed",    "localize", "report",  "completion", "manual"};

bool is_installed(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

using Manual = isotherm_test::CommandTest;

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

TEST_F(Manual, WhatIsNotThereIsTold) { EXPECT_EQ(run("manual nothing").code, 2); }

}  // namespace
