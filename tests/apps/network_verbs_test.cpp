// The verbs on sensor networks.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"
#include "run_command.hpp"

namespace {

using isotherm_test::CommandTest;
using isotherm_test::read_text;
using isotherm_test::write_text;
using testing::HasSubstr;
using testing::StartsWith;

using NetworkVerbs = CommandTest;

/// The number behind `"key": ` in a JSON text.
double number_at(const std::string& json, const std::string& key) {
  const auto place = json.find("\"" + key + "\": ");
  return place == std::string::npos ? -1.0 : std::stod(json.substr(place + key.size() + 4));
}

TEST_F(NetworkVerbs, SimulateLocalizeAndEvaluate) {
  for (const std::string dimension : {"2", "3"}) {
    run_ok(
        "simulate network --nodes 120 --degree 25 --noise 0.02 --false-fraction 0.1 --dimension " +
        dimension +
        " -o ranges.csv --anchor-file anchors.csv --ground-truth truth.csv"
        " --labels labels.csv --seed 4");
    run_ok(
        "localize ranges.csv --anchors anchors.csv -o positions.csv --verdicts verdicts.csv"
        " --json result.json");
    const auto json = read_text(folder / "result.json");
    for (const char* key : {"isotherm.localize/1", "\"candidates\"", "\"pruned\"", "\"nodes\"",
                            "\"localised\"", "\"converged\"", "\"options\""}) {
      EXPECT_THAT(json, HasSubstr(key));
    }
    const auto errors =
        run_ok("eval positions positions.csv truth.csv --leave-out anchors.csv --json -");
    EXPECT_LT(number_at(errors, "median"), 0.02) << errors;
    EXPECT_GT(number_at(errors, "nodes"), 90);
    const auto loops = run_ok("eval loops verdicts.csv labels.csv --json -");
    EXPECT_GT(number_at(loops, "recall"), 0.9);
    EXPECT_GT(number_at(loops, "precision"), 0.9);
  }
}

TEST_F(NetworkVerbs, WithoutAnchorsPositionsAreAligned) {
  run_ok(
      "simulate network --nodes 60 --degree 20 --noise 0.01 -o ranges.csv"
      " --ground-truth truth.csv");
  const auto said = run("localize ranges.csv -o positions.csv").err;
  EXPECT_THAT(said, HasSubstr("up to an isometry"));
  EXPECT_LT(number_at(run_ok("eval positions positions.csv truth.csv --align --json -"), "rmsd"),
            0.01);
}

TEST_F(NetworkVerbs, NodesWithoutAPlaceSaySo) {
  // A square of anchors, a node they fix, and one that hangs on a single range.
  write_text(folder / "anchors.csv", "node,x,y\na,0,0\nb,1,0\nc,0,1\nd,1,1\n");
  write_text(folder / "ranges.csv",
             "from,to,range,sigma\na,p,0.5,0.01\nb,p,0.5,0.01\nc,p,1.118,0.01\n"
             "d,p,1.118,0.01\np,q,1,0.01\n");
  const auto text = run_ok("localize ranges.csv --anchors anchors.csv -o - --verdicts v.csv");
  EXPECT_THAT(text, StartsWith("node,x,y,status,sigma,cxx,cxy,cyy\na,0,0,anchor,0,0,0,0\np,0."));
  EXPECT_THAT(text, HasSubstr("\nq,nan,nan,not-rigid,nan,nan,nan,nan\n"));
  EXPECT_THAT(read_text(folder / "v.csv"), HasSubstr("4,1,5,ambiguous,0,"));
  const auto strict = run("localize ranges.csv --anchors anchors.csv --strict -o -");
  EXPECT_EQ(strict.code, 0) << strict.err;
}

TEST_F(NetworkVerbs, NoNodeLocalisedIsAFailure) {
  write_text(folder / "ranges.csv", "from,to,range,sigma\na,b,1,0.1\nb,c,1,0.1\nc,d,1,0.1\n");
  const auto chain = run("localize ranges.csv -o out.csv");
  EXPECT_EQ(chain.code, 4);
  EXPECT_THAT(chain.err, HasSubstr("no node could be localised (4 nodes, "));
  EXPECT_THAT(chain.err, HasSubstr("what would help: ranges from each node to 3 others"));
  // Nothing was asked for where all nodes are anchors.
  write_text(folder / "ranges.csv", "from,to,range\na,b,1\n");
  write_text(folder / "anchors.csv", "node,x,y\na,0,0\nb,1,0\n");
  EXPECT_EQ(run("localize ranges.csv --anchors anchors.csv -o out.csv").code, 0);
}

TEST_F(NetworkVerbs, ANameWithLeadingZerosStaysAName) {
  write_text(folder / "ranges.csv",
             "from,to,range,sigma\n007,8,1,0.01\n8,9,1,0.01\n007,9,1,0.01\n");
  run_ok("localize ranges.csv -o p.csv --verdicts v.csv");
  EXPECT_THAT(read_text(folder / "v.csv"), HasSubstr(",007,8\n"));
}

TEST_F(NetworkVerbs, AnAnchorInAWrongPlaceIsReported) {
  run_ok(
      "simulate network --nodes 40 --degree 20 --anchors 8 --noise 0.01 -o ranges.csv"
      " --anchor-file anchors.csv --seed 2");
  const auto right = run("localize ranges.csv --anchors anchors.csv -o p.csv");
  EXPECT_THAT(right.err, testing::Not(HasSubstr("contradict"))) << right.err;
  auto text = read_text(folder / "anchors.csv");
  const auto first = text.find('\n') + 1;
  const auto name = text.substr(first, text.find(',', first) - first);
  text.replace(first, text.find('\n', first) - first, name + ",0.5,0.5");
  write_text(folder / "anchors.csv", text);
  const auto moved = run("localize ranges.csv --anchors anchors.csv -o p.csv");
  EXPECT_THAT(moved.err, HasSubstr("warning: anchor " + name + ": ")) << moved.err;
}

// A robot that turns among three beacons, with its odometry, and where it truly was.
struct RobotFile {
  std::string text;
  std::string truth;
};

RobotFile robot_and_beacons() {
  isotherm::Random random(4);
  std::ostringstream poses;
  std::ostringstream steps;
  std::ostringstream ranges;
  std::ostringstream truth;
  truth << "node,x,y\n";
  const double beacons[3][2] = {{12.0, 3.0}, {-7.0, 9.0}, {4.0, -11.0}};
  double x = 0.0;
  double y = 0.0;
  double heading = 0.0;
  for (int k = 0; k < 90; ++k) {
    poses << "VERTEX_SE2 " << k << " A" << k << " 0 0 0\n";  // a time, and no place to speak of
    truth << 'A' << k << ',' << x << ',' << y << '\n';
    const double turn = 0.15 * std::sin(0.1 * k) + 0.05;
    const auto& beacon = beacons[k % 3];
    const double range = std::hypot(x - beacon[0], y - beacon[1]) + random.normal(0.0, 0.1);
    ranges << "EDGE_RANGE " << k << " A" << k << " L" << k % 3 << ' ' << range << " 0.01\n";
    if (k < 89) {
      steps << "EDGE_SE2 " << k + 1 << " A" << k << " A" << k + 1 << ' '
            << 1.0 + random.normal(0.0, 0.02) << ' ' << random.normal(0.0, 0.02) << ' '
            << turn + random.normal(0.0, 0.01) << " 0.0004 0 0 0.0004 0 0.0001\n";
    }
    x += std::cos(heading + 0.5 * turn);
    y += std::sin(heading + 0.5 * turn);
    heading += turn;
  }
  return {poses.str() + steps.str() + ranges.str(), truth.str()};
}

TEST_F(NetworkVerbs, OdometryAndRangesTogether) {
  const auto robot = robot_and_beacons();
  write_text(folder / "robot.pyfg", robot.text);
  write_text(folder / "truth.csv", robot.truth);
  const auto said =
      run("localize robot.pyfg -o p.csv --trajectory robot.tum --verdicts v.csv --json r.json");
  EXPECT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("used: 90 poses, 89 steps of odometry, 3 beacons, 90 ranges"));
  EXPECT_THAT(said.err, HasSubstr("learned: ranges "));
  EXPECT_THAT(read_text(folder / "p.csv"), HasSubstr("\nL2,"));
  const auto tum = read_text(folder / "robot.tum");
  EXPECT_EQ(std::count(tum.begin(), tum.end(), '\n'), 90);
  EXPECT_THAT(read_text(folder / "v.csv"), HasSubstr(",A1,L1\n"));
  const auto json = read_text(folder / "r.json");
  EXPECT_EQ(number_at(json, "steps"), 89);
  EXPECT_GE(number_at(json, "kept"), 85);
  const auto errors = run_ok("eval positions p.csv truth.csv --align --json -");
  EXPECT_LT(number_at(errors, "rmsd"), 0.3) << errors;
}

TEST_F(NetworkVerbs, ALogOfRangesBesideOdometry) {
  write_text(folder / "robot.pyfg", robot_and_beacons().text);
  std::ostringstream log;
  for (int k = 0; k < 90; ++k) log << k << ".25 1 " << 5 + k % 3 << " 9.5\n";
  write_text(folder / "log.txt", log.str());
  const auto said = run("localize log.txt --odometry robot.pyfg -o p.csv");
  EXPECT_THAT(said.err, HasSubstr("90 ranges matched to odometry by time")) << said.err;
  EXPECT_EQ(run("localize log.txt --odometry log.txt -o p.csv").code, 3);
  EXPECT_EQ(run("localize log.txt --trajectory t.tum -o p.csv").code, 2);
}

TEST_F(NetworkVerbs, BadInput) {
  write_text(folder / "ranges.csv", "from,to,range\na,b,1\nb,c,-2\n");
  const auto negative = run("localize ranges.csv -o out.csv");
  EXPECT_EQ(negative.code, 3);
  EXPECT_THAT(negative.err, HasSubstr("ranges.csv:3:5"));
  write_text(folder / "ranges.csv", "from,to,range\na,b,1\nb,c,nan\n");
  EXPECT_EQ(run("localize ranges.csv -o out.csv").code, 3);
  write_text(folder / "ranges.csv", "from,to,range\na,b,1\nb,b,2\n");
  const auto self = run("localize ranges.csv -o out.csv");
  EXPECT_EQ(self.code, 3);
  EXPECT_THAT(self.err, HasSubstr("ranges.csv:3:3: expected another node than the first"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out.csv"));

  write_text(folder / "ranges.csv", "from,to,range\na,b,1\nb,c,2\na,c,1.5\n");
  write_text(folder / "anchors.csv", "node,x,y\na,0,0\nz,1,1\n");
  EXPECT_THAT(run("localize ranges.csv --anchors anchors.csv -o -").err,
              HasSubstr("no range leads to the anchor z"));
  EXPECT_EQ(run("localize ranges.csv --anchors anchors.csv -o - --strict").code, 2);
  write_text(folder / "anchors.csv", "node,x,y\na,0,0\na,1,1\n");
  const auto twice = run("localize ranges.csv --anchors anchors.csv -o -");
  EXPECT_EQ(twice.code, 3);
  EXPECT_THAT(twice.err, HasSubstr("anchors.csv:3:1: node already given"));
  write_text(folder / "anchors.csv", "node,x\na,0\n");
  EXPECT_EQ(run("localize ranges.csv --anchors anchors.csv -o -").code, 3);
  EXPECT_EQ(run("simulate network --nodes 1 -o a.csv").code, 2);
  EXPECT_EQ(run("simulate network --noise 2 -o a.csv").code, 2);
}

TEST_F(NetworkVerbs, TheSameSeedGivesTheSameBytes) {
  const auto first = run_ok("simulate network --nodes 50 --false-fraction 0.2 --seed 3 -o -");
  EXPECT_EQ(run_ok("simulate network --nodes 50 --false-fraction 0.2 --seed 3 -o -"), first);
  EXPECT_NE(run_ok("simulate network --nodes 50 --false-fraction 0.2 --seed 4 -o -"), first);
}

}  // namespace
