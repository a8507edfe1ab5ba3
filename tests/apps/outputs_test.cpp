// What the files that a run writes are called, and what is there after it failed.
#include <algorithm>
#include <filesystem>
#include <set>
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
using testing::StartsWith;

class Outputs : public CommandTest {
 protected:
  void SetUp() override {
    run_ok("simulate city --poses 40 --loops 6 -o in.g2o --ground-truth truth.g2o -q");
    run_ok("convert truth.g2o -o truth.tum -q");
    run_ok("simulate network --nodes 30 -o ranges.csv --anchor-file anchors.csv -q");
    write_text(folder / "graph.csv", "0,1,1\n1,2,1\n2,0,1\n2,3,1\n");
    for (const auto& entry : fs::directory_iterator(folder)) inputs_.insert(entry.path());
  }

  // What came to the folder since, but for the captured streams.
  std::string new_files() const {
    std::string names;
    for (const auto& entry : fs::directory_iterator(folder)) {
      const auto name = entry.path().filename().string();
      if (name.front() != '.' && !inputs_.contains(entry.path())) names += name + " ";
    }
    return names;
  }

  void expect_refused(const std::string& arguments, int code, const std::string& problem) const {
    const auto result = run(arguments);
    EXPECT_EQ(result.code, code) << arguments;
    EXPECT_THAT(result.err, HasSubstr(problem)) << arguments;
    EXPECT_EQ(new_files(), "") << arguments;
  }

 private:
  std::set<fs::path> inputs_;
};

TEST_F(Outputs, AreInTheFormatOfTheirName) {
  run_ok("optimize in.g2o -o x.tum -q");
  run_ok("optimize in.g2o -o x.tum.gz -q");
  run_ok("convert x.tum.gz --to tum -o again.tum -q");
  EXPECT_EQ(read_text(folder / "again.tum"), read_text(folder / "x.tum"));
  run_ok("embed graph.csv -o x.npy.gz -q");
  EXPECT_EQ(std::system(("cd '" + folder.string() + "' && zcat x.npy.gz > x.npy").c_str()), 0);
  EXPECT_THAT(read_text(folder / "x.npy"), StartsWith("\x93NUMPY"));
  run_ok("prune in.g2o --report x.json.gz -q");
  run_ok("report x.json.gz -o x.html.gz -q");
  EXPECT_EQ(read_text(folder / "x.html.gz").substr(0, 2), "\x1f\x8b");
}

TEST_F(Outputs, AreNotInAnotherFormatThanNamed) {
  expect_refused("prune in.g2o -o x.tum", 2, "--output: cannot write .tum as 'x.tum' says");
  expect_refused("prune in.g2o -o x.csv.gz", 2, "--output: cannot write .csv");
  expect_refused("prune in.g2o --json x.csv", 2, "--json");
  expect_refused("prune in.g2o --report x.svg", 2, "--report");
  expect_refused("prune in.g2o --svg x.html", 2, "--svg");
  expect_refused("prune in.g2o --verdicts x.json", 2, "--verdicts");
  expect_refused("optimize in.g2o -o x.kitti", 2, "--output");
  expect_refused("simulate city -o x.graph", 2, "--output");
  expect_refused("localize ranges.csv -o x.g2o", 2, "--output");
  expect_refused("convert in.g2o -o x.tum --to kitti", 2, "--output: cannot write .tum");
  expect_refused("convert in.g2o -o x.csv --to g2o", 2, "--output: cannot write .csv");
}

TEST_F(Outputs, HaveNamesThatDiffer) {
  expect_refused("prune in.g2o -o ''", 2, "--output: needs the name of a file");
  expect_refused("prune in.g2o --json ''", 2, "--json: needs the name of a file");
  expect_refused("prune in.g2o -o x --verdicts ./x", 2, "names the same file as --output");
  expect_refused("prune in.g2o -o - --json -", 2, "names the same file");
  expect_refused("follow in.g2o --map x --every 9 -o ./x", 2, "names the same file");
  expect_refused("follow in.g2o --state x --json x", 2, "names the same file");
  fs::create_symlink("x", folder / "link");
  EXPECT_THAT(run("prune in.g2o -o x --verdicts link").err, HasSubstr("names the same file"));
  run_ok("prune in.g2o -o link -q");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_THAT(read_text(folder / "x"), StartsWith("VERTEX_SE2"));
  run_ok("prune in.g2o -o /dev/null --verdicts /dev/null -q");
}

TEST_F(Outputs, AreCheckedBeforeTheWork) {
  const std::string all = "prune in.g2o -o o.g2o --verdicts o.csv --report o.html ";
  expect_refused(all + "--json no/such/o.json", 3, "no/such/o.json: cannot be written");
  expect_refused(all + "--svg .", 3, ".: cannot be written: Is a directory");
  expect_refused(all + "--json in.g2o/o.json", 3, "in.g2o/o.json: cannot be written");
  expect_refused(all + "--json /dev/full", 3, "/dev/full: cannot be written");
  expect_refused(all + "--ground-truth nowhere", 3, "nowhere: cannot be opened");
  expect_refused(all + "--ground-truth graph.csv", 3, "graph.csv");
  expect_refused(all + "--ground-truth truth.g2o --timestamps x", 2, "timestamps: have no use");
  expect_refused(all + "--ground-truth truth.tum --timestamps nowhere", 3, "nowhere");
  expect_refused(all + "--trusted nowhere", 3, "nowhere: cannot be opened");
  const std::string network = "localize ranges.csv -o o.csv --report o.html ";
  expect_refused(network + "--ground-truth nowhere", 3, "nowhere: cannot be opened");
  expect_refused(network + "--ground-truth graph.csv", 3, "graph.csv");
  expect_refused(network + "--anchors nowhere", 3, "nowhere: cannot be opened");
  expect_refused("simulate city -o o.g2o --ground-truth no/such/t.g2o", 3, "no/such/t.g2o");
  expect_refused("simulate network -o o.csv --labels no/such/l.csv", 3, "no/such/l.csv");
  expect_refused("corrupt in.g2o --count 3 -o o.g2o --labels no/such/l.csv", 3, "no/such/l.csv");
  expect_refused("corrupt in.g2o --count 3 -o o.g2o --ground-truth nowhere", 3, "nowhere");
  expect_refused("edges graph.csv -o o.csv --verdicts v.csv --json no/such/j.json", 3, "no/such");
}

TEST_F(Outputs, StayAsTheyWereWhereARunFails) {
  write_text(folder / "o.g2o", "old");
  EXPECT_EQ(run("prune in.g2o -o o.g2o --verdicts v.csv --json /dev/full").code, 3);
  EXPECT_EQ(read_text(folder / "o.g2o"), "old");
  EXPECT_EQ(new_files(), "o.g2o ");
}

TEST_F(Outputs, TruthWithoutAUseIsRefused) {
  expect_refused("prune in.g2o -o o.g2o --ground-truth truth.g2o", 2, "--report or --svg");
  expect_refused("prune in.g2o -o o.g2o --report o.html --timestamps x", 2, "--ground-truth");
  expect_refused("localize ranges.csv -o o.csv --ground-truth anchors.csv", 2, "--report or --svg");
}

TEST_F(Outputs, OfConvertSayWhatIsLost) {
  write_text(folder / "fixed.g2o",
             "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nFIX 0\n# a comment\n"
             "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n");
  const auto toro = run("convert fixed.g2o -o x.graph");
  EXPECT_EQ(toro.code, 0);
  EXPECT_THAT(toro.err, HasSubstr("the marks of fixed vertices are lost (1)"));
  EXPECT_THAT(toro.err, HasSubstr("comments and unknown records are lost (1)"));
  EXPECT_THAT(run("convert fixed.g2o -o y.g2o").err, testing::Not(HasSubstr("lost")));
  EXPECT_THAT(run("convert graph.csv -o x.mtx --json -").out,
              HasSubstr("numbered from 1 in ascending order: 0 is now 1"));
  write_text(folder / "from_one.csv", "1,2,1\n2,3,1\n");
  EXPECT_THAT(run("convert from_one.csv -o y.mtx").err, testing::Not(HasSubstr("numbered")));
}

}  // namespace
