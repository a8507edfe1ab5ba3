// Completion in the real shells, from scripts that the command makes of its own parser.
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run_command.hpp"

namespace {

using isotherm_test::read_text;
using isotherm_test::write_text;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;

using Words = std::vector<std::string>;

// Completes the line in the file `typed`, by the script in this folder.
constexpr const char* kAskBash = R"sh(
source ./isotherm.bash
read -r -a COMP_WORDS < typed
if [[ $(< typed) == *' ' ]]; then COMP_WORDS+=(''); fi
COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
_isotherm
printf '%s\n' "${COMPREPLY[@]}" > offered
)sh";

constexpr const char* kAskFish = R"sh(
source ./isotherm.fish
complete -C (cat typed) | string split -f 1 \t > offered
true
)sh";

// Only a shell at a terminal completes: one is started on a pseudo-terminal, told to write down
// what its completion adds, and given the line, a tabulator and an end of line, which ends it.
constexpr const char* kAskZsh = R"sh(
zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell 'fpath=($PWD $fpath); autoload -Uz compinit; compinit -u -D'
zpty -w shell 'isotherm() { exit }'
zpty -w shell 'compadd() {
  if [[ ${@[1,(i)(-|--)]} != *-(O|A|D)\ * ]]; then
    local -a offered; builtin compadd -O offered "$@"; print -l -- $offered >> offered
  fi
  builtin compadd "$@"
}'
zpty -w shell 'print rea""dy'
while zpty -r shell line && [[ $line != *ready* ]]; do :; done
zpty -w shell "$(< typed)"$'\t'
while zpty -r shell line; do :; done
exit 0
)sh";

struct ShellCase {
  const char* shell;
  const char* script;  // its name, as the shell wants it
  const char* ask;
  const char* run;  // what runs the program `ask`
};

void PrintTo(const ShellCase& shell, std::ostream* out) { *out << shell.shell; }

class Completion : public isotherm_test::CommandTest,
                   public testing::WithParamInterface<ShellCase> {
 protected:
  void SetUp() override {
    const auto& shell = GetParam();
    const std::string looks = "command -v " + std::string(shell.shell) + " >/dev/null 2>&1";
    if (std::system(looks.c_str()) != 0) GTEST_SKIP() << shell.shell << " is not installed";
    write_text(folder / shell.script, run_ok("completion " + std::string(shell.shell)));
    write_text(folder / "ask", shell.ask);
  }

  /// What the shell offers where this was typed, which names no file.
  Words offered(const std::string& typed) const {
    write_text(folder / "typed", "isotherm " + typed);
    write_text(folder / "offered", "");
    const auto command =
        "cd '" + folder.string() + "' && HOME=. timeout 60 " + GetParam().run + " >.said 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << read_text(folder / ".said");
    std::istringstream text(read_text(folder / "offered"));
    Words words;
    for (std::string word; std::getline(text, word);) {
      if (!word.empty()) words.push_back(word);
    }
    return words;
  }
};

TEST_P(Completion, OffersVerbs) {
  const auto all = offered("");
  for (const char* verb : {"info", "prune", "optimize", "simulate", "completion"}) {
    EXPECT_THAT(all, Contains(verb));
  }
  EXPECT_THAT(offered("pru"), ElementsAre("prune"));
  EXPECT_THAT(offered("simulate ci"), ElementsAre("city"));
}

TEST_P(Completion, OffersFlagsOfTheVerb) {
  EXPECT_THAT(offered("prune --verd"), ElementsAre("--verdicts"));
  EXPECT_THAT(offered("info --verd"), IsEmpty());
  EXPECT_THAT(offered("simulate city --blo"), ElementsAre("--block"));
  EXPECT_THAT(offered("prune --no-calib"), ElementsAre("--no-calibrate"));
}

TEST_P(Completion, OffersChoices) {
  EXPECT_THAT(offered("prune map.g2o --method lap"), ElementsAre("lap-line"));
  EXPECT_THAT(offered("optimize --kernel gnc"), ElementsAre("gnc", "gnc-gm"));
  EXPECT_THAT(offered("completion f"), ElementsAre("fish"));
}

TEST_P(Completion, LeavesFilesToTheShell) { EXPECT_THAT(offered("info no-such"), IsEmpty()); }

INSTANTIATE_TEST_SUITE_P(Shells, Completion,
                         testing::Values(ShellCase{"bash", "isotherm.bash", kAskBash, "bash ask"},
                                         ShellCase{"zsh", "_isotherm", kAskZsh, "zsh -f ask"},
                                         ShellCase{"fish", "isotherm.fish", kAskFish,
                                                   "fish --no-config ask"}),
                         testing::PrintToStringParamName());

using CompletionVerb = isotherm_test::CommandTest;

TEST_F(CompletionVerb, KnowsItsShells) {
  EXPECT_EQ(run("completion csh").code, 2);
  EXPECT_EQ(run("completion").code, 2);
}

}  // namespace
