// The report of a run, as page, document and picture.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "run_command.hpp"

namespace {

using isotherm_test::CommandTest;
using isotherm_test::read_text;
using isotherm_test::write_text;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

// Bytes of a base64 text, digit by digit; independent of the encoder.
std::vector<std::uint8_t> decoded(const std::string& text) {
  const std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> count));
  }
  return bytes;
}

template <class Number>
std::vector<Number> numbers(const Json& packed, const char* type) {
  const auto bytes = decoded(packed.at(type).get<std::string>());
  std::vector<Number> values(bytes.size() / sizeof(Number));
  std::copy_n(bytes.begin(), values.size() * sizeof(Number),
              reinterpret_cast<std::uint8_t*>(values.data()));
  return values;
}

// Five poses in a row, numbered from 2^63; loop 0-4 is right, loop 0-3 is far off.
constexpr std::uint64_t kFirst = 1ULL << 63;
constexpr std::string_view kFive =
    "VERTEX_SE2 9223372036854775808 0 0 0\n"
    "VERTEX_SE2 9223372036854775809 1 0 0\n"
    "VERTEX_SE2 9223372036854775810 2 0 0\n"
    "VERTEX_SE2 9223372036854775811 3 0 0\n"
    "VERTEX_SE2 9223372036854775812 4 0 0\n"
    "EDGE_SE2 9223372036854775808 9223372036854775809 1 0 0 100 0 0 100 0 100\n"
    "EDGE_SE2 9223372036854775809 9223372036854775810 1 0 0 100 0 0 100 0 100\n"
    "EDGE_SE2 9223372036854775810 9223372036854775811 1 0 0 100 0 0 100 0 100\n"
    "EDGE_SE2 9223372036854775811 9223372036854775812 1 0 0 100 0 0 100 0 100\n"
    "EDGE_SE2 9223372036854775808 9223372036854775812 4 0 0 100 0 0 100 0 100\n"
    "EDGE_SE2 9223372036854775808 9223372036854775811 -9 5 1 100 0 0 100 0 100\n";

class Report : public CommandTest {
 protected:
  Json document(const std::string& arguments) const {
    run_ok(arguments + " --report report.json");
    return Json::parse(read_text(folder / "report.json"));
  }
};

TEST_F(Report, DocumentHoldsEveryCandidateExactly) {
  write_text(folder / "five.g2o", std::string(kFive));
  const auto json = document("prune five.g2o --method chi2");
  EXPECT_EQ(json["schema"], "isotherm.report/1");
  EXPECT_EQ(json["kind"], "pose_graph");
  EXPECT_EQ(json["title"], "five.g2o");
  EXPECT_THAT(numbers<std::uint64_t>(json["nodes"]["names"], "u64"),
              ElementsAre(kFirst, kFirst + 1, kFirst + 2, kFirst + 3, kFirst + 4));
  const auto& all = json["candidates"];
  EXPECT_EQ(all["count"], 2);
  EXPECT_THAT(numbers<std::uint32_t>(all["edge"], "u32"), ElementsAre(4, 5));
  EXPECT_THAT(numbers<std::uint32_t>(all["line"], "u32"), ElementsAre(10, 11));
  EXPECT_THAT(numbers<std::int32_t>(all["from"], "i32"), ElementsAre(0, 0));
  EXPECT_THAT(numbers<std::int32_t>(all["to"], "i32"), ElementsAre(4, 3));
  EXPECT_THAT(numbers<std::uint8_t>(all["verdict"], "u8"), ElementsAre(0, 1));
  const auto score = numbers<float>(all["score"], "f32");
  const auto threshold = numbers<float>(all["threshold"], "f32");
  EXPECT_LT(score[0], threshold[0]);
  EXPECT_GT(score[1], threshold[1]);
  // Before: as in the file, relative to the first pose.
  EXPECT_THAT(numbers<float>(json["layouts"][0]["positions"], "f32"),
              ElementsAre(0, 0, 1, 0, 2, 0, 3, 0, 4, 0));
}

TEST_F(Report, TrajectoryErrorIsThatOfEval) {
  run_ok("simulate city --poses 300 --loops 100 --seed 5 -o city.g2o --ground-truth gt.g2o");
  const auto json = document("prune city.g2o --ground-truth gt.g2o -o kept.g2o");
  run_ok("optimize kept.g2o -o map.g2o");
  const auto ate = Json::parse(run_ok("eval ate map.g2o gt.g2o --align se --json -"));
  const auto errors = numbers<float>(json["layouts"][1]["errors"], "f32");
  ASSERT_EQ(errors.size(), 300U);
  EXPECT_NEAR(*std::max_element(errors.begin(), errors.end()), ate["max"].get<double>(), 1e-5);
}

TEST_F(Report, PageIsWhatTheSavedDocumentMakes) {
  write_text(folder / "five.g2o", std::string(kFive));
  document("prune five.g2o --method chi2");
  run_ok("report report.json -o page.html");
  const auto page = read_text(folder / "page.html");
  EXPECT_THAT(page, testing::StartsWith("<!doctype html>"));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_THAT(page, HasSubstr("isotherm.report/1"));
  EXPECT_THAT(page, Not(HasSubstr("__ISOTHERM_REPORT__")));
  run_ok("report report.json -o page.html --json again.json");
  EXPECT_EQ(Json::parse(read_text(folder / "again.json")),
            Json::parse(read_text(folder / "report.json")));
}

TEST_F(Report, HostileNamesCannotLeaveTheData) {
  const std::string name = "<img src=x onerror=alert(1)>.g2o";
  write_text(folder / name, std::string(kFive));
  run_ok("prune '" + name + "' --method chi2 --report page.html --svg map.svg");
  const auto page = read_text(folder / "page.html");
  EXPECT_THAT(page, HasSubstr("\\u003cimg src=x onerror=alert(1)>.g2o"));
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_THAT(read_text(folder / "map.svg"), HasSubstr("&lt;img src=x onerror=alert(1)&gt;.g2o"));
}

TEST_F(Report, NameThatIsNotUtf8IsReplaced) {
  write_text(folder / "caf\xe9.g2o", std::string(kFive));
  EXPECT_EQ(document("prune 'caf\xe9.g2o' --method chi2")["title"], "caf\xef\xbf\xbd.g2o");
}

TEST_F(Report, SvgHasALayerAKindAndALegend) {
  write_text(folder / "five.g2o", std::string(kFive));
  run_ok("prune five.g2o --method chi2 --svg map.svg");
  const auto svg = read_text(folder / "map.svg");
  EXPECT_THAT(svg, testing::StartsWith("<svg xmlns=\"http://www.w3.org/2000/svg\""));
  EXPECT_THAT(svg, HasSubstr("odometry (4)"));
  EXPECT_THAT(svg, HasSubstr("kept loops (1)"));
  EXPECT_THAT(svg, HasSubstr("pruned loops (1)"));
  EXPECT_THAT(svg, Not(HasSubstr("ambiguous")));
  EXPECT_THAT(svg, HasSubstr("0.5 m</text>"));
  EXPECT_THAT(svg, testing::EndsWith("</svg>\n"));
}

TEST_F(Report, GraphWithoutLoopsHasAReport) {
  const std::string text(kFive);
  write_text(folder / "chain.g2o",
             text.substr(0, text.find("EDGE_SE2 9223372036854775808 9223372036854775812")));
  const auto json = document("prune chain.g2o --svg map.svg");
  EXPECT_EQ(json["candidates"]["count"], 0);
  EXPECT_EQ(json["nodes"]["count"], 5);
}

TEST_F(Report, PlainGraphIsDrawnWhereItsEigenvectorsPutIt) {
  std::string ring;
  for (int k = 0; k < 40; ++k) {
    ring += std::to_string(k) + "," + std::to_string((k + 1) % 40) + "\n" + std::to_string(k) +
            "," + std::to_string((k + 2) % 40) + "\n";
  }
  write_text(folder / "ring.csv", ring);
  const auto json = document("edges ring.csv");
  EXPECT_EQ(json["kind"], "graph");
  EXPECT_EQ(json["candidates"]["count"], 80);
  // The first two eigenvectors of a ring go round a circle.
  const auto rows = numbers<float>(json["layouts"][0]["positions"], "f32");
  ASSERT_EQ(rows.size(), 80U);
  double x = 0.0;
  double y = 0.0;
  for (std::size_t k = 0; k < 40; ++k) {
    x += rows[2 * k] / 40.0;
    y += rows[2 * k + 1] / 40.0;
  }
  const double radius = std::hypot(rows[0] - x, rows[1] - y);
  for (std::size_t k = 1; k < 40; ++k) {
    EXPECT_NEAR(std::hypot(rows[2 * k] - x, rows[2 * k + 1] - y), radius, 1e-4 * radius);
  }
}

TEST_F(Report, PointsAreDrawnWhereTheyAre) {
  write_text(folder / "points.csv", "1e6,0,5\n1000001,0,5\n1000000,1,5\n1000000,0,6.5\n");
  const auto json = document("edges points.csv --neighbours 3 --method jaccard");
  EXPECT_EQ(json["dimension"], 3);
  EXPECT_THAT(numbers<float>(json["layouts"][0]["positions"], "f32"),
              ElementsAre(0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1.5));
  EXPECT_EQ(json["layouts"][0]["origin"], Json({1e6, 0.0, 5.0}));
}

TEST_F(Report, NetworkErrorsAreThoseOfEval) {
  run_ok(
      "simulate network --nodes 60 --anchors 6 --seed 4 -o ranges.csv --anchor-file anchors.csv "
      "--ground-truth truth.csv");
  const auto json =
      document("localize ranges.csv --anchors anchors.csv --ground-truth truth.csv -o found.csv");
  EXPECT_EQ(json["kind"], "network");
  EXPECT_EQ(json["nodes"]["count"], 60);
  EXPECT_EQ(numbers<std::int32_t>(json["nodes"]["landmarks"], "i32").size(), 6U);
  const auto metrics = Json::parse(run_ok("eval positions found.csv truth.csv --json -"));
  double largest = 0.0;
  for (const float error : numbers<float>(json["layouts"][0]["errors"], "f32")) {
    if (error > largest) largest = error;
  }
  EXPECT_NEAR(largest, metrics["max"].get<double>(), 1e-6);
}

TEST_F(Report, OtherDocumentsAreRefused) {
  write_text(folder / "five.g2o", std::string(kFive));
  run_ok("prune five.g2o --json result.json");
  const auto other = run("report result.json -o page.html");
  EXPECT_EQ(other.code, 3);
  EXPECT_THAT(other.err, HasSubstr("isotherm.report/1"));
  write_text(folder / "broken.json", "{\"schema\": ");
  EXPECT_EQ(run("report broken.json -o page.html").code, 3);
  EXPECT_EQ(run("report nowhere.json -o page.html").code, 3);
  EXPECT_FALSE(std::filesystem::exists(folder / "page.html"));
}

TEST_F(Report, EveryMemberOfADocumentIsChecked) {
  write_text(folder / "five.g2o", std::string(kFive));
  run_ok("prune five.g2o --report document.json");
  const auto whole = Json::parse(read_text(folder / "document.json"));
  const auto expect_refused = [&](const Json& document, const std::string& place) {
    write_text(folder / "changed.json", document.dump());
    const auto result = run("report changed.json -o page.html");
    EXPECT_EQ(result.code, 3) << place;
    EXPECT_THAT(result.err, HasSubstr("changed.json: " + place));
    EXPECT_FALSE(std::filesystem::exists(folder / "page.html")) << place;
  };
  for (const auto& [key, value] : whole.items()) {
    auto without = whole;
    without.erase(key);
    expect_refused(without, key == "schema" ? "is not an" : "the document has no member '" + key);
    auto other = whole;
    other[key] = true;
    expect_refused(other, key == "schema" ? "is not an" : key);
  }
  const auto change = [&](const std::string& pointer, const Json& value, const std::string& place) {
    auto document = whole;
    document[Json::json_pointer(pointer)] = value;
    expect_refused(document, place);
  };
  change("/kind", "map", "kind must be one of");
  change("/dimension", 4, "dimension must be");
  change("/nodes/count", 1, "nodes.names has");
  change("/nodes/count", -1, "nodes.count must be an integer");
  change("/layouts", Json::array(), "layouts must not be empty");
  change("/layouts/0/positions/f32", "AAAA", "layouts[0].positions holds no base64");
  change("/layouts/0/positions/f32", "AAAA*AA=", "layouts[0].positions holds no base64");
  change("/layouts/0/positions/f32", "AACAPw==", "layouts[0].positions has 1 entries");
  change("/candidates/count", 17, "candidates.edge has");
  change("/candidates/verdict/u8", "CQkJCQ==", "candidates.verdict ");
  change("/trusted/i32", "/////wAAAAA=", "trusted points to -1");
  change("/rounds/columns", {"one", 2}, "rounds.columns[1] must be a string");
  write_text(folder / "changed.json", whole.dump());
  run_ok("report changed.json -o page.html");
}

TEST_F(Report, TwoOfOneGraphAreCompared) {
  write_text(folder / "five.g2o", std::string(kFive));
  run_ok("prune five.g2o --method chi2 --report chi2.json");
  run_ok("prune five.g2o --method heat --report heat.json");
  run_ok("report chi2.json heat.json -o both.html");
  const auto page = read_text(folder / "both.html");
  const std::string start = "id=\"document\">";
  const auto from = page.find(start) + start.size();
  const auto json = Json::parse(page.substr(from, page.find("</script>", from) - from));
  EXPECT_EQ(json["schema"], "isotherm.comparison/1");
  EXPECT_EQ(json["names"], Json({"chi2.json", "heat.json"}));
  ASSERT_EQ(json["reports"].size(), 2U);
  EXPECT_EQ(json["reports"][0], Json::parse(read_text(folder / "chi2.json")));
  EXPECT_EQ(json["reports"][1], Json::parse(read_text(folder / "heat.json")));
}

TEST_F(Report, OnlyReportsOnOneGraphAreCompared) {
  write_text(folder / "five.g2o", std::string(kFive));
  auto other = std::string(kFive);
  other.replace(other.find("811 -9 5 1"), 3, "810");
  write_text(folder / "other.g2o", other);
  run_ok("prune five.g2o --method chi2 --report five.json");
  run_ok("prune other.g2o --method chi2 --report other.json");
  const auto result = run("report five.json other.json -o both.html");
  EXPECT_EQ(result.code, 3);
  EXPECT_THAT(result.err, HasSubstr("other.json: is not about the same graph"));
  EXPECT_THAT(result.err, HasSubstr("candidates/to"));
  const auto saved = run("report five.json five.json -o both.json");
  EXPECT_EQ(saved.code, 2);
  EXPECT_THAT(saved.err, HasSubstr("name it .html"));
  EXPECT_EQ(run("report five.json five.json five.json -o both.html").code, 2);
  EXPECT_EQ(run("report five.json nowhere.json -o both.html").code, 3);
  EXPECT_FALSE(std::filesystem::exists(folder / "both.html"));
  EXPECT_FALSE(std::filesystem::exists(folder / "both.json"));
}

TEST_F(Report, HeatIsThereWhereItDecided) {
  run_ok("simulate city --poses 60 --loops 20 --seed 2 -o city.g2o");
  const auto expect_heat = [this](const std::string& arguments, bool there) {
    const auto json = document(arguments);
    EXPECT_EQ(json["heat"]["scales"].empty(), !there) << arguments;
    EXPECT_EQ(json["spectrum"]["values"].empty(), !there) << arguments;
  };
  expect_heat("prune city.g2o", false);
  expect_heat("prune city.g2o --method heat", true);
  write_text(folder / "graph.csv", "0,1\n1,2\n2,3\n3,0\n0,2\n1,3\n");
  expect_heat("edges graph.csv --method heat", true);
  expect_heat("edges graph.csv --method affinity", true);
  expect_heat("edges graph.csv --method jaccard", false);
}

// The file of a city whose odometry is far more accurate than its information says.
TEST_F(Report, SaysHowSureVerdictsAreAndWhatTheFileIsWorth) {
  run_ok("simulate city --poses 200 --loops 80 --seed 4 -o city.g2o");
  const auto how_sure = [this](const std::string& arguments) {
    const auto json = document(arguments);
    for (const auto& paragraph : json["summary"]) {
      if (paragraph["heading"] == "How sure") return paragraph["text"].get<std::string>();
    }
    return std::string();
  };
  const auto plain = how_sure("prune city.g2o");
  EXPECT_THAT(plain, testing::StartsWith("Verdicts are probabilities of being true"));
  EXPECT_THAT(plain, HasSubstr("among the 80 loops that are kept fewer than"));
  EXPECT_THAT(plain, HasSubstr("None is undecided."));
  EXPECT_THAT(plain, Not(HasSubstr("factor of")));
  EXPECT_THAT(how_sure("prune city.g2o --no-calibrate"), HasSubstr("taken at its word"));
  EXPECT_THAT(how_sure("prune city.g2o --method chi2"), HasSubstr("within a factor of two"));

  const auto city = read_text(folder / "city.g2o");
  const auto stating = [&](const std::string& information) {
    auto changed = city;
    const std::string stated = " 2500 0 0 2500 0 250000\n";  // of odometry
    for (auto at = changed.find(stated); at != std::string::npos; at = changed.find(stated, at)) {
      changed.replace(at, stated.size(), information);
    }
    write_text(folder / "off.g2o", changed);
    return how_sure("prune off.g2o");
  };
  EXPECT_THAT(
      stating(" 2.5 0 0 2.5 0 250\n"),
      HasSubstr("Of the accuracy of odometry the file is off by more than a factor of ten"));
  EXPECT_THAT(stating(" 0.0025 0 0 0.0025 0 0.25\n"),
              HasSubstr("What the file states of the accuracy of odometry is meaningless"));
}

TEST_F(Report, SaysByHowMuchOdometryTurnsTooLittle) {
  run_ok("simulate city --poses 800 --loops 200 --seed 4 -o city.g2o");
  std::istringstream city(read_text(folder / "city.g2o"));
  std::ostringstream turned;
  for (std::string line; std::getline(city, line);) {
    std::istringstream words(line);
    std::string tag, rest;
    std::int64_t from = 0, to = 0;
    double x = 0.0, y = 0.0, angle = 0.0;
    if (words >> tag >> from >> to >> x >> y >> angle && to == from + 1 && tag == "EDGE_SE2") {
      std::getline(words, rest);
      turned << tag << ' ' << from << ' ' << to << ' ' << x << ' ' << y << ' ' << angle - 1e-3;
      line = rest;
    }
    turned << line << '\n';
  }
  write_text(folder / "turned.g2o", turned.str());
  const auto json = document("prune turned.g2o");
  std::string text;
  for (const auto& paragraph : json["summary"]) text += paragraph["text"].get<std::string>();
  EXPECT_THAT(text, testing::ContainsRegex("In each step the robot turned by (0.9|1|1.1)[0-9]* "
                                           "mrad more than odometry tells\\."));
}

TEST_F(Report, LoopsThatNoOdometryReachesHaveNoChiSquaredAgainstIt) {
  // Two robots that see each other once.
  write_text(folder / "two.g2o",
             "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 10 11 1 0 0 1 0 0 1 0 1\n"
             "EDGE_SE2 0 10 0 1 0 1 0 0 1 0 1\nEDGE_SE2 1 11 0 1 0 1 0 0 1 0 1\n");
  const auto json = document("prune two.g2o");
  const auto& column = json["candidates"]["columns"][0];
  EXPECT_EQ(column["key"], "chi2_odometry");
  for (const float value : numbers<float>(column["values"], "f32")) {
    EXPECT_TRUE(std::isnan(value)) << value;
  }
}

TEST_F(Report, ThePictureIsXmlWhateverTheFileIsCalled) {
  for (const std::string name :
       {"a&b<c>.g2o", "quote\"s'.g2o", "latin\xE4.g2o", "bell\x07\x1B.g2o", "\xED\xA0\x80.g2o",
        "\xEF\xBF\xBE.g2o", "\xF4\x90\x80\x80.g2o", "\xC0\xAF.g2o", "gr\xC3\xBC\xC3\x9F.g2o"}) {
    write_text(folder / name, std::string(kFive));
    std::string quoted = name;
    if (const auto at = quoted.find('\''); at != quoted.npos) quoted.replace(at, 1, "'\\''");
    run_ok("prune '" + quoted + "' --svg map.svg -q");
    const std::string check =
        "python3 -c 'import sys, xml.dom.minidom as x; x.parse(sys.argv[1])' '";
    EXPECT_EQ(std::system((check + file("map.svg") + "'").c_str()), 0) << name;
  }
  EXPECT_THAT(read_text(folder / "map.svg"), HasSubstr("<title>gr\xC3\xBC\xC3\x9F.g2o</title>"));
}

}  // namespace
