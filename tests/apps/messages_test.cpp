// What the command says when it is misunderstood, and how it names things.
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include "isotherm_test/data.hpp"
#include "run_command.hpp"

namespace {

using isotherm_test::read_text;
using isotherm_test::write_text;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class Messages : public isotherm_test::CommandTest {
 protected:
  std::string error(const std::string& arguments, int code) const {
    const auto result = run(arguments);
    EXPECT_EQ(result.code, code) << arguments;
    return result.err;
  }
};

TEST_F(Messages, SuggestWhatWasMeant) {
  EXPECT_EQ(error("prun a.g2o", 2), "isotherm: there is no verb 'prun'; did you mean prune?\n");
  EXPECT_THAT(error("optimise a.g2o", 2), HasSubstr("did you mean optimize?"));
  EXPECT_THAT(error("eval atte a b", 2), HasSubstr("eval has no verb 'atte'; did you mean ate?"));
  EXPECT_THAT(error("fly", 2), HasSubstr("there is no verb 'fly' (see --help)"));
  EXPECT_THAT(error("edges a.csv --neighbors 5", 2),
              HasSubstr("edges has no flag --neighbors; did you mean --neighbours?"));
  EXPECT_THAT(error("prune a.g2o --verdict=v.csv", 2), HasSubstr("did you mean --verdicts?"));
  EXPECT_THAT(error("prune a.g2o --optimise", 2),
              HasSubstr("prune has no flag --optimise; did you mean the verb optimize?"));
  EXPECT_THAT(error("--prune a.g2o", 2), HasSubstr("did you mean the verb prune?"));
  EXPECT_THAT(error("prune a.g2o --fly", 2), HasSubstr("prune has no flag --fly (see --help)"));
  EXPECT_THAT(run_ok("help"), HasSubstr("prune"));
  EXPECT_EQ(run_ok("help prune"), run_ok("prune --help"));
}

TEST_F(Messages, CountInWordsThatFit) {
  write_text(folder / "both.csv", "0,1,1\n1,0,1\n1,2,1\n2,0,1\n");
  const auto edges = run("edges both.csv --method jaccard");
  EXPECT_THAT(edges.err, HasSubstr(": 1 edge stands in both directions; counted once\n"));
  EXPECT_THAT(edges.err, HasSubstr("jaccard: 3 edges, "));
  run_ok("simulate city --poses 30 --loops 5 --seed 1 -q -o a.g2o --ground-truth t.g2o");
  EXPECT_THAT(run_ok("eval rpe a.g2o t.g2o"), StartsWith("RPE over 1 pose: "));
  EXPECT_THAT(run_ok("eval rpe a.g2o t.g2o --delta 2"), StartsWith("RPE over 2 poses: "));
  EXPECT_THAT(run("densify a.g2o -o d.g2o --copies 1").err,
              HasSubstr("densified: 5 loops of the input, "));
}

TEST_F(Messages, KeysHaveLettersInRepairs) {
  // a0, a1 and c66, which has no line of its own.
  write_text(folder / "keys.g2o",
             "VERTEX_SE2 6989586621679009792 0 0 0\nVERTEX_SE2 6989586621679009793 1 0 0\n"
             "EDGE_SE2 6989586621679009792 6989586621679009793 1 0 0 1 0 0 1 0 1\n"
             "EDGE_SE2 6989586621679009793 7133701809754865730 1 0 0 1 0 0 1 0 1\n");
  const auto result = run("prune keys.g2o");
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.err, HasSubstr("placed by this edge (got 'c66')"));
  EXPECT_EQ(result.err.find("7133701809754865730"), std::string::npos) << result.err;
}

TEST_F(Messages, HelpSaysWhenToTakeWhichMethod) {
  // Every choice of the option has a row of its own below a heading.
  const auto expect_table = [this](const std::string& verb, const std::string& option) {
    const auto help = run_ok(verb + " --help");
    auto choices = help.substr(help.find("  " + option + " ") + option.size() + 3);
    // A list that is too long for its line goes on in the next.
    for (auto at = choices.find("|\n"); at != choices.npos && at < 120;) {
      const auto next = choices.find_first_not_of(" \n", at + 1);
      choices.erase(at + 1, next - at - 1);
      at = choices.find("|\n");
    }
    std::istringstream names(choices.substr(0, choices.find_first_of(" \n")));
    int count = 0;
    for (std::string name; std::getline(names, name, '|'); ++count) {
      EXPECT_THAT(help, HasSubstr("\n  " + name + " ")) << verb << " " << name;
    }
    EXPECT_GT(count, 2) << verb;
  };
  expect_table("prune", "--method");
  expect_table("edges", "--method");
  expect_table("embed", "--method");
  expect_table("optimize", "--kernel");
}

TEST_F(Messages, NameWhatTheFileIs) {
  write_text(folder / "names.g2o", "VERTEX_SE2 a0 0 0 0\nEDGE_SE2 a0 a1 1 0 0 1 0 0 1 0 1\n");
  EXPECT_THAT(error("prune names.g2o", 3), HasSubstr("expected a vertex id, an integer"));
  write_text(folder / "s.csv", "from;to;weight\n0;1;2\n");
  EXPECT_THAT(error("edges s.csv", 3), HasSubstr("semicolons"));
  EXPECT_THAT(error("info s.csv", 3), HasSubstr("fields are separated by semicolons"));
  write_text(folder / "p.csv", "id,x,y\n0,1,2\n");
  EXPECT_THAT(error("edges p.csv", 3), HasSubstr("joins points by --neighbours or --radius"));
  write_text(folder / "b.csv", "1.5 2 3\n2 3 4\n");
  EXPECT_THAT(error("edges b.csv --radius 2", 3),
              HasSubstr("fields are separated by blanks; expected commas"));
}

TEST_F(Messages, PointsKeepTheirNumbersAndArraysAreRead) {
  write_text(folder / "p.csv", "id,x,y\n12,0,0\n10,1,0\n11,2,0\n");
  const auto verdicts = run_ok("edges p.csv --radius 1 --method jaccard -q --verdicts -");
  EXPECT_THAT(verdicts, HasSubstr("\n0,10,11,"));
  EXPECT_THAT(verdicts, HasSubstr("\n1,10,12,"));
  std::string strip = "from,to\n";
  for (int v = 0; v < 30; ++v) {
    for (const int step : {1, 2})
      strip += std::to_string(v) + "," + std::to_string(v + step) + "\n";
  }
  write_text(folder / "strip.csv", strip);
  run_ok("embed strip.csv -q -o rows.npy");
  EXPECT_THAT(run("edges rows.npy --neighbours 3 --method jaccard").err, HasSubstr(" edges, "));
  write_text(folder / "twice.csv", "0,1\n1,0\n1,2\n2,1\n");
  EXPECT_THAT(run("edges twice.csv --method jaccard").err, HasSubstr("2 edges, "));
}

// GTSAM's keys, and names in ranges.
TEST_F(Messages, VerdictsKeepNames) {
  const auto key = [](int k) { return std::to_string(std::uint64_t{97} << 56 | k); };
  const std::string tail = " 0 0 100 0 0 100 0 1000\n";
  std::string graph;
  for (int k = 0; k < 20; ++k) {
    graph += "EDGE_SE2 " + key(k) + " " + key(k + 1) + " 1" + tail;
  }
  graph += "EDGE_SE2 " + key(3) + " " + key(17) + " 14" + tail;
  write_text(folder / "keys.g2o", graph);
  run_ok("prune keys.g2o -q --verdicts verdicts.csv --report report.json");
  EXPECT_THAT(read_text(folder / "verdicts.csv"),
              HasSubstr(",stage,probability,from_name,to_name\n"));
  EXPECT_THAT(read_text(folder / "verdicts.csv"), HasSubstr(",a3,a17\n"));
  EXPECT_THAT(read_text(folder / "report.json"), HasSubstr("\"a17\""));

  std::string ranges = "from,to,range\n";
  for (const char* pair :
       {"hall,yard", "yard,roof", "roof,hall", "hall,gate", "gate,yard", "roof,gate"}) {
    ranges += std::string(pair) + ",1\n";
  }
  write_text(folder / "ranges.csv", ranges);
  run("localize ranges.csv -q --verdicts nodes.csv");
  EXPECT_THAT(read_text(folder / "nodes.csv"), HasSubstr(",from_name,to_name\n"));
  EXPECT_THAT(read_text(folder / "nodes.csv"), HasSubstr(",hall,yard\n"));
}

// On a terminal, what is said starts on a line of its own.
TEST_F(Messages, LinesDoNotRunIntoTheProgressLine) {
  run_ok("simulate city --poses 4000 --loops 2000 --seed 3 -q -o city.g2o");
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
  ASSERT_GE(child, 0);
  if (child == 0) {
    execl(ISOTHERM_COMMAND, "isotherm", "prune", file("city.g2o").c_str(), "--method", "sc",
          static_cast<char*>(nullptr));
    _exit(127);
  }
  std::string shown;
  char part[4096];
  for (ssize_t count; (count = read(terminal, part, sizeof part)) > 0;) shown.append(part, count);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0) << shown;
  const auto summary = shown.find("sc: 2000 loops");
  ASSERT_NE(summary, std::string::npos) << shown;
  const auto before = shown.substr(0, summary);
  const bool own_line = before.empty() || before.ends_with("\n") || before.ends_with("\r\033[K");
  EXPECT_TRUE(own_line) << before.substr(before.size() - std::min<std::size_t>(80, before.size()));
}

// What place recognition gives, as a graph to be judged.
class Candidates : public isotherm_test::CommandTest {};

TEST_F(Candidates, ListAndTrajectoryMakeAPoseGraph) {
  std::string path;
  for (int k = 0; k < 60; ++k) {  // two laps of a square
    const int side = k % 24;
    const double x = side < 6 ? side : side < 12 ? 6 : side < 18 ? 18 - side : 0;
    const double y = side < 6 ? 0 : side < 12 ? side - 6 : side < 18 ? 6 : 24 - side;
    path += std::to_string(k) + " " + std::to_string(x) + " " + std::to_string(y) + " 0\n";
  }
  write_text(folder / "path.txt", path);
  write_text(folder / "list.txt", "30 6 18 29\n40 16 5\n50 26 2\n");
  const auto made = run("candidates list.txt --odometry path.txt -o graph.g2o --top 2");
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("60 poses, 59 edges of odometry, 6 candidates (1 left out"));
  const auto pruned = run("prune graph.g2o --verdicts verdicts.csv");
  EXPECT_THAT(pruned.err, HasSubstr("6 loops"));
  write_text(folder / "known.csv", "from,to,x,y,theta\n30,6,0,0,0\n");
  EXPECT_THAT(run_ok("candidates known.csv --odometry graph.g2o -q -o -"),
              HasSubstr("EDGE_SE2 30 6 0 0 0 100 0 0 100 0 2500\n"));
  const auto unknown = run("candidates list.txt --odometry known.csv -o graph.g2o");
  EXPECT_EQ(unknown.code, 3);
}

TEST_F(Candidates, ListOfACollection) {
  ISOTHERM_REAL_DATA_OR_SKIP(path, "paper/kitti");
  const auto made = run("candidates '" + (path / "ssc_top25_07.txt").string() + "' --odometry '" +
                        (path / "kitti_07.g2o").string() + "' -o graph.g2o --top 1");
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("1101 poses, 1100 edges of odometry, 122 candidates (2928"));
}

}  // namespace
