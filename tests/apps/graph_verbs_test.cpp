// The verbs on plain weighted graphs.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "run_command.hpp"

namespace {

using isotherm_test::CommandTest;
using isotherm_test::read_text;
using isotherm_test::write_text;
using testing::HasSubstr;
using testing::StartsWith;

class GraphVerbs : public CommandTest {
 protected:
  /// A strip of triangles, vertices numbered from 100, and one edge across it.
  void make_strip() const {
    std::string text = "from,to,weight\n";
    for (int v = 0; v < 40; ++v) {
      for (const int step : {1, 2, 3}) {
        if (v + step < 40) {
          text += std::to_string(100 + v) + "," + std::to_string(100 + v + step) + ",1\n";
        }
      }
    }
    text += "100,135,1\n";
    write_text(folder / "strip.csv", text);
  }
};

TEST_F(GraphVerbs, EdgesFindsTheShortCircuitByEveryMethod) {
  make_strip();
  for (const std::string method : {"heat", "affinity", "resistance", "jaccard"}) {
    run_ok("edges strip.csv -o kept.csv --verdicts verdicts.csv --json result.json --method " +
           method);
    EXPECT_THAT(read_text(folder / "verdicts.csv"), HasSubstr("\n114,100,135,prune,")) << method;
    EXPECT_THAT(read_text(folder / "kept.csv"), testing::Not(HasSubstr("100,135")));
    const auto json = read_text(folder / "result.json");
    for (const char* key : {"isotherm.edges/1", "\"candidates\": 115", "\"pruned\"",
                            "\"ambiguous\"", "\"threshold\"", "\"options\""}) {
      EXPECT_THAT(json, HasSubstr(key)) << method;
    }
  }
}

TEST_F(GraphVerbs, EdgesJoinsPoints) {
  std::string text = "x,y,z\n";
  for (int v = 0; v < 5; ++v) text += std::to_string(v) + ",0,1\n";
  write_text(folder / "points.csv", text);
  const auto rows = [&](const std::string& flag) {
    return run_ok("edges points.csv -o - --method jaccard " + flag);
  };
  // A path is all bridges, which stay unless asked otherwise.
  EXPECT_EQ(rows("--radius 1"), "from,to,weight\n0,1,1\n1,2,1\n2,3,1\n3,4,1\n");
  EXPECT_EQ(rows("--radius 1 --drop-ambiguous"), "from,to,weight\n");
  EXPECT_THAT(run_ok("edges points.csv --neighbours 2 --verdicts -"), HasSubstr("\n1,0,2,"));
  EXPECT_EQ(run("edges points.csv --radius 1 --neighbours 2").code, 2);
  EXPECT_EQ(run("edges points.csv --radius 0").code, 2);
  EXPECT_EQ(run("edges points.csv --neighbours 0").code, 2);
  write_text(folder / "bad_points.csv", "0,0\n1,x\n");
  const auto result = run("edges bad_points.csv --radius 1 -o out.csv");
  EXPECT_EQ(result.code, 3);
  EXPECT_THAT(result.err, HasSubstr("bad_points.csv:2:3: expected a coordinate"));
}

TEST_F(GraphVerbs, EdgesTakesPositions) {
  make_strip();
  std::string text = "node,x,y\n7,0,0\n";  // and one of no vertex
  for (int v = 139; v >= 100; --v) text += std::to_string(v) + "," + std::to_string(v) + ",0\n";
  write_text(folder / "xy.csv", text);
  const std::string edges = "edges strip.csv --method rank --verdicts - ";
  EXPECT_THAT(run_ok(edges + "--positions xy.csv"), HasSubstr("\n114,100,135,prune,34,"));
  EXPECT_EQ(run(edges).code, 2);
  EXPECT_EQ(run(edges + "--positions none.csv").code, 3);
  EXPECT_EQ(run(edges + "--positions xy.csv --radius 1").code, 2);
  const auto error_of = [&](const std::string& rows) {
    write_text(folder / "bad.csv", rows);
    const auto result = run(edges + "--positions bad.csv");
    EXPECT_EQ(result.code, 3);
    return result.err;
  };
  EXPECT_THAT(error_of("node,x,y\n100,0,0\n"), HasSubstr("no position of this vertex (got '101')"));
  EXPECT_THAT(error_of(text + "100,0,0\n"), HasSubstr("bad.csv:43"));
  EXPECT_THAT(error_of("node,x,y\n100,nan,0\n"), HasSubstr("a finite number"));
}

TEST_F(GraphVerbs, PositionsWithoutAUseAreRefused) {
  make_strip();
  std::string rows = "node,x,y\n";
  for (int v = 0; v < 40; ++v) rows += std::to_string(100 + v) + "," + std::to_string(v) + ",0\n";
  write_text(folder / "xy.csv", rows);
  for (const std::string method : {"heat", "jaccard", "resistance"}) {
    const std::string edges = "edges strip.csv --positions xy.csv --method " + method;
    const auto result = run(edges + " -o kept.csv");
    EXPECT_EQ(result.code, 2) << method;
    EXPECT_THAT(result.err, HasSubstr("positions: have no use"));
    EXPECT_FALSE(std::filesystem::exists(folder / "kept.csv"));
    run_ok(edges + " --svg map.svg");
  }
}

TEST_F(GraphVerbs, ResistancesWithoutABoundAreFlagged) {
  // Weights over more than 200 decades.
  write_text(folder / "wide.csv", "0,1,1e-150\n1,2,1e150\n2,0,1\n2,3,1\n3,0,1\n");
  const auto wide = run("edges wide.csv --method resistance --json result.json");
  EXPECT_EQ(wide.code, 0) << wide.err;
  EXPECT_THAT(wide.err, HasSubstr("warning: effective resistances have no proven bound"));
  EXPECT_THAT(read_text(folder / "result.json"), HasSubstr("no proven bound"));
  make_strip();
  const auto strip = run("edges strip.csv --method resistance");
  EXPECT_EQ(strip.code, 0);
  EXPECT_EQ(strip.err.find("bound"), std::string::npos) << strip.err;
}

TEST_F(GraphVerbs, EmbedSaysHowWellVectorsAreKnown) {
  std::string ring;
  for (int v = 0; v < 30; ++v)
    ring += std::to_string(v) + "," + std::to_string((v + 1) % 30) + "\n";
  write_text(folder / "ring.csv", ring);
  const auto whole = run("embed ring.csv --dimensions 2 -o rows.csv --json -");
  EXPECT_EQ(whole.code, 0);
  EXPECT_EQ(whole.err.find("warning"), std::string::npos) << whole.err;
  auto json = nlohmann::json::parse(whole.out);
  EXPECT_EQ(json["vector_groups"], nlohmann::json({0, 1, 1}));
  for (const double bound : json["vector_bounds"]) EXPECT_LT(bound, 1e-10);
  // The third coordinate is one of two with the same eigenvalue.
  const auto part = run("embed ring.csv --dimensions 3 -o rows.csv --json -");
  EXPECT_THAT(part.err, HasSubstr("warning: the last 1 coordinate cannot be told from the next"));
  json = nlohmann::json::parse(part.out);
  EXPECT_EQ(json["vector_groups"], nlohmann::json({0, 1, 1, 3}));
  EXPECT_EQ(json["vector_bounds"][3], 1.0);
  EXPECT_EQ(json["eigenvalues"].size(), 4U);
}

TEST_F(GraphVerbs, EmbedWritesOneRowAVertex) {
  make_strip();
  for (const std::string method : {"commute-time", "heat", "eigenmaps"}) {
    const auto text = run_ok("embed strip.csv -o - --dimensions 3 --method " + method);
    EXPECT_THAT(text, StartsWith("vertex,x0,x1,x2\n100,")) << method;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 41);
  }
  run_ok("embed strip.csv -o rows.npy --dimensions 3 --laplacian normalised --json result.json");
  const auto bytes = read_text(folder / "rows.npy");
  EXPECT_THAT(bytes, StartsWith("\x93NUMPY"));
  EXPECT_THAT(bytes, HasSubstr("'shape': (40, 3)"));
  EXPECT_EQ(bytes.size() % 64, (40 * 3 * 8) % 64);
  EXPECT_THAT(read_text(folder / "result.json"), HasSubstr("\"converged\": true"));
}

TEST_F(GraphVerbs, HeatEmbeddingTellsComponentsApart) {
  // A triangle and an edge: with all coordinates, distances are those of exp(-t L).
  write_text(folder / "parts.csv", "0 1\n1 2\n2 0\n5 6\n");
  const auto text = run_ok("embed parts.csv -o - --method heat --scale 1e3 --dimensions 5");
  std::map<int, std::vector<double>> rows;
  std::istringstream lines(text.substr(text.find('\n') + 1));
  for (std::string line; std::getline(lines, line);) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    int vertex = 0;
    fields >> vertex;
    for (double x = 0.0; fields >> x;) rows[vertex].push_back(x);
  }
  const auto squared = [&rows](int i, int j) {
    double sum = 0.0;
    for (std::size_t k = 0; k < rows[i].size(); ++k) sum += std::pow(rows[i][k] - rows[j][k], 2);
    return sum;
  };
  EXPECT_NEAR(squared(0, 1), 0.0, 1e-12);
  EXPECT_NEAR(squared(0, 5), 1.0 / 3 + 1.0 / 2, 1e-12);
  const auto few = run("embed parts.csv -o - --method heat --dimensions 1");
  EXPECT_THAT(few.err, HasSubstr("1 coordinates do not tell 2 components apart"));
}

TEST_F(GraphVerbs, SmallGraphsAndBadInput) {
  write_text(folder / "edge.csv", "7 9\n");
  EXPECT_THAT(run_ok("embed edge.csv -o - --dimensions 5"), StartsWith("vertex,x0\n7,"));
  EXPECT_THAT(run_ok("edges edge.csv --verdicts -"), HasSubstr("7,9,ambiguous"));
  write_text(folder / "bad.csv", "from,to,weight\n1,2,nan\n");
  for (const std::string verb : {"edges", "embed"}) {
    const auto result = run(verb + " bad.csv -o out.csv");
    EXPECT_EQ(result.code, 3);
    EXPECT_THAT(result.err, HasSubstr("bad.csv:2"));
    EXPECT_FALSE(std::filesystem::exists(folder / "out.csv"));
  }
  EXPECT_EQ(run("embed edge.csv -o - --dimensions 0").code, 2);
  EXPECT_EQ(run("edges edge.csv --scale -1").code, 2);
}

}  // namespace
