// What is noticed before a map is destroyed.
#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

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
using Fields = std::vector<std::string>;

// Every line of a g2o file, as `change` makes it of its fields.
std::string changed(const std::string& text, const std::function<void(Fields&)>& change) {
  std::istringstream lines(text);
  std::string all;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    Fields fields;
    for (std::string word; words >> word;) fields.push_back(word);
    change(fields);
    for (const auto& field : fields) all += field + " ";
    all += "\n";
  }
  return all;
}

bool is_edge(const Fields& fields) { return fields[0] == "EDGE_SE2"; }
bool is_step(const Fields& fields) {
  return is_edge(fields) && std::abs(std::stoi(fields[1]) - std::stoi(fields[2])) == 1;
}

void to_degrees(Fields& fields) {
  auto& angle = fields[is_edge(fields) ? 5 : 4];
  angle = std::to_string(std::stod(angle) * 180.0 / std::numbers::pi);
}

class Doubts : public isotherm_test::CommandTest {
 protected:
  Doubts() {
    run_ok("simulate city --poses 800 --loops 200 --seed 4 -q -o sound.g2o");
    sound = read_text(folder / "sound.g2o");
  }

  std::string said_of(const std::function<void(Fields&)>& change,
                      const std::string& method = "consensus") {
    write_text(folder / "odd.g2o", changed(sound, change));
    const auto result = run("prune odd.g2o -o out.g2o --method " + method);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.err;
  }

  std::string sound;
};

TEST_F(Doubts, ASoundGraphRaisesNone) {
  EXPECT_THAT(said_of([](Fields&) {}), Not(HasSubstr("warning")));
}

TEST_F(Doubts, DegreesForRadians) {
  const auto said = said_of(to_degrees);
  EXPECT_THAT(said, HasSubstr("edge with more than a full turn: are angles in degrees?"));
}

TEST_F(Doubts, SwappedEnds) {
  const auto said = said_of([](Fields& fields) {
    if (is_edge(fields) && !is_step(fields)) std::swap(fields[1], fields[2]);
  });
  EXPECT_THAT(said, HasSubstr("warning: swapped ends? "));
  EXPECT_THAT(said, HasSubstr("fit odometry only with the ends of loops swapped, "));
  const auto info = Json::parse(run_ok("info odd.g2o --json -"));
  EXPECT_EQ(info["doubts"][0]["kind"], "swapped ends");
}

TEST_F(Doubts, InformationThatIsNoneOrTheSame) {
  const auto with = [&](const char* diagonal) {
    return said_of([diagonal](Fields& fields) {
      if (!is_edge(fields)) return;
      for (std::size_t k = 6; k < 12; ++k) fields[k] = "0";
      for (const std::size_t k : {6, 9, 11}) fields[k] = diagonal;
    });
  };
  EXPECT_THAT(with("1"), HasSubstr("identity information? all edges state the identity"));
  EXPECT_THAT(with("0"), HasSubstr("zero information? 999 edges state zero information, of 999"));
  with("4");
  EXPECT_THAT(run_ok("info odd.g2o"), HasSubstr("all edges state the same information, "
                                                "deviations of 0.5 m and 0.5 rad"));
}

TEST_F(Doubts, OdometryMissingOrOutOfOrder) {
  EXPECT_THAT(said_of([](Fields& fields) {
                if (is_step(fields)) fields = {"#"};
              }),
              HasSubstr("no odometry? no edge joins 799 of 799 pairs of poses"));
  EXPECT_THAT(said_of([](Fields& fields) {
                for (const std::size_t k : {1, 2}) {
                  if (k == 1 || is_edge(fields)) {
                    fields[k] = std::to_string(std::stoi(fields[k]) * 7 % 800);
                  }
                }
              }),
              HasSubstr("ids without order? "));
}

TEST_F(Doubts, AResultWithoutLoopsNamesLikelyCauses) {
  // Edges that all claim to be exact, which consensus sees through.
  const auto claim = [](Fields& fields) {
    if (!is_edge(fields)) return;
    for (const std::size_t k : {6, 9, 11}) fields[k] += "e7";
  };
  EXPECT_THAT(said_of(claim, "chi2"),
              HasSubstr(" of 200 loops are pruned. If most of them should be true: "));
  const auto seen_through = said_of(claim);
  EXPECT_THAT(seen_through, HasSubstr("200 kept, 0 pruned"));
  EXPECT_THAT(seen_through, HasSubstr("says nothing"));
}

// A file whose angles are in degrees loses its loops to most methods: they say so.
TEST_F(Doubts, IntelInDegrees) {
  ISOTHERM_REAL_DATA_OR_SKIP(path, "posegraph2d/intel/intel.g2o");
  sound = read_text(path);
  EXPECT_THAT(said_of(to_degrees), HasSubstr("are angles in degrees?"));
  const auto said = said_of(to_degrees, "chi2");
  EXPECT_THAT(said, HasSubstr("are angles in degrees?"));
  EXPECT_THAT(said, HasSubstr(" of 895 loops are pruned. If most of them should be true: angles in "
                              "degrees?"));
}

}  // namespace
