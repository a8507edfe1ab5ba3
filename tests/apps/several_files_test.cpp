// Several files as one graph, and repeats in one: what a person sees.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "isotherm_test/data.hpp"
#include "run_command.hpp"

namespace {

using isotherm_test::read_text;
using isotherm_test::write_text;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

// Two robots that drive side by side: the loops between them are in the files of both.
class SeveralInputs : public isotherm_test::CommandTest {
 protected:
  SeveralInputs() {
    write_text(folder / "left.g2o", robot('a') + between());
    write_text(folder / "right.g2o", robot('b') + between());
    write_text(folder / "both.g2o", robot('a') + between() + robot('b') + between());
  }

  static std::string key(char letter, int number) {
    return std::to_string(static_cast<std::uint64_t>(letter) << 56 | number);
  }
  static std::string robot(char letter) {
    std::string text;
    for (int k = 0; k < 9; ++k) {
      text += "VERTEX_SE2 " + key(letter, k) + " " + std::to_string(k) + " 0 0\n";
    }
    for (int k = 0; k < 8; ++k) {
      text +=
          "EDGE_SE2 " + key(letter, k) + " " + key(letter, k + 1) + " 1 0 0 100 0 0 100 0 1000\n";
    }
    return text;
  }
  static std::string between() {
    std::string text;
    for (const int k : {1, 4, 7}) {
      text += "EDGE_SE2 " + key('a', k) + " " + key('b', k) + " 0 2 0 100 0 0 100 0 1000\n";
    }
    return text;
  }
};

TEST_F(SeveralInputs, AreOneGraphWhoseRepeatsCountOnce) {
  const auto pruned = run("prune left.g2o right.g2o -o map.g2o --verdicts verdicts.csv");
  EXPECT_EQ(pruned.code, 0) << pruned.err;
  EXPECT_THAT(pruned.err, HasSubstr("right.g2o:18: edge repeats line 18 of left.g2o"));
  EXPECT_THAT(pruned.err, HasSubstr("2 files read as one graph: 18 poses, 19 edges, 3 repeated "
                                    "edges counted once; robots a (9 poses), b (9 poses)"));
  EXPECT_THAT(pruned.err, HasSubstr(": 3 loops"));
  EXPECT_THAT(read_text(folder / "map.g2o"), HasSubstr("EDGE_SE2 " + key('a', 1)));

  const auto optimized = run("optimize left.g2o right.g2o -o poses.g2o");
  EXPECT_EQ(optimized.code, 0) << optimized.err;
  run_ok("convert left.g2o right.g2o -o merged.g2o");
  const auto merged = Json::parse(run_ok("info merged.g2o --json -"));
  EXPECT_EQ(merged["edges"], 19);
  const auto both = Json::parse(run_ok("info left.g2o right.g2o --json -"));
  EXPECT_EQ(both["edges"], 19);
  EXPECT_EQ(both["poses_of_robots"]["b"], 9);
}

TEST_F(SeveralInputs, RepeatsInOneFileHaveRowsButNoWeight) {
  const auto once = run("prune left.g2o right.g2o --verdicts once.csv");
  const auto twice = run("prune both.g2o --verdicts twice.csv");
  EXPECT_EQ(twice.code, 0) << twice.err;
  EXPECT_THAT(twice.err, HasSubstr("3 edges repeat another one to the last digit; counted once"));
  const auto rows = read_text(folder / "twice.csv");
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 1 + 6);
  EXPECT_THAT(rows, testing::ContainsRegex(",repeat,[0-9.e-]+,a1,b1\n"));
  EXPECT_THAT(run("optimize both.g2o -o poses.g2o").err, HasSubstr("3 edges repeat another"));
  const auto info = run_ok("info both.g2o");
  EXPECT_THAT(info, HasSubstr("edge a1 -> b1 says again what line 18 says"));
}

TEST_F(SeveralInputs, FilesNameRobotsWhereIdsDoNot) {
  const std::string tail = " 1 0 0 1 0 0 1 0 1\n";
  write_text(folder / "red.g2o", "EDGE_SE2 0 1" + tail + "EDGE_SE2 1 100" + tail);
  write_text(folder / "blue.g2o", "EDGE_SE2 100 101" + tail);
  const auto said = run("optimize red.g2o blue.g2o -o poses.g2o").err;
  EXPECT_THAT(said, HasSubstr("robots red (2 poses), blue (2 poses)"));
  write_text(folder / "t.tum", "1 0 0 0 0 0 0 1\n");
  const auto refused = run("prune red.g2o t.tum");
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err, HasSubstr("t.tum: several files are read as one pose graph"));
}

// Each loop between two of these robots is in the files of both.
TEST_F(SeveralInputs, FourRobotsOfACollectionGiveWhatTheirUniqueEdgesGive) {
  ISOTHERM_REAL_DATA_OR_SKIP(path, "multirobot/doorslam_argos_4robots/spoiled");
  const auto merged = run("prune '" + path.string() + "'/?.g2o --verdicts merged.csv");
  EXPECT_EQ(merged.code, 0) << merged.err;
  EXPECT_THAT(merged.err, HasSubstr("43 repeated edges counted once; robots a (275 poses)"));
  EXPECT_THAT(merged.err, HasSubstr("45 loops"));
  std::string all;
  for (const char* name : {"0", "1", "2", "3"})
    all += read_text(path / (name + std::string(".g2o")));
  write_text(folder / "all.g2o", all);
  const auto repeated = run("prune all.g2o --verdicts all.csv");
  EXPECT_THAT(repeated.err, HasSubstr("43 edges repeat another one"));
  EXPECT_THAT(repeated.err, HasSubstr("88 loops"));
}

// What rtabmap in robust mode and Vertigo write.
class SwitchableInput : public isotherm_test::CommandTest {};

TEST_F(SwitchableInput, HasLoopsAndASayingAboutWhatIsNotUsed) {
  std::string text;
  for (int k = 0; k < 12; ++k) {
    text += "VERTEX_SE2 " + std::to_string(k) + " " + std::to_string(k) + " 0 0\n";
  }
  for (int k = 0; k < 11; ++k) {
    text += "EDGE_SE2 " + std::to_string(k) + " " + std::to_string(k + 1) +
            " 1 0 0 100 0 0 100 0 100 0\n";
  }
  text += "VERTEX_SWITCH 100 1\nEDGE_SWITCH_PRIOR 100 1 1\nVERTEX_XY 200 0 0\n";
  for (const int k : {0, 1, 2}) {
    text += "EDGE_SE2_SWITCHABLE " + std::to_string(k) + " " + std::to_string(k + 8) +
            " 100 8 0 0 100 0 0 100 0 100\n";
  }
  write_text(folder / "robust.g2o", text);
  const auto result = run("prune robust.g2o -o out.g2o");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("3 loops, "));
  EXPECT_THAT(result.err, HasSubstr(" 0 pruned")) << "of so few";
  EXPECT_THAT(result.err, HasSubstr("switchable edge; read as a loop without its switch, and 2 "
                                    "more like it"));
  EXPECT_THAT(result.err, HasSubstr("a landmark; kept as it stands but not used"));
  EXPECT_THAT(read_text(folder / "out.g2o"), Not(HasSubstr("SWITCH")));
}

}  // namespace
