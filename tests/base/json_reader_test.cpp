#include "isotherm/base/json_reader.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace isotherm {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(JsonReader, ReadsValuesInTheirOrder) {
  JsonReader json("a.json",
                  " {\"number\": -1.5e-1, \"key\": 6989586621679009860,\n"
                  "  \"list\": [ ], \"other\": {\"a\": [1, {\"b\": null}], \"c\": true},\n"
                  "  \"text\": \"a\\\"\\u00e9\\n\\ud83d\\ude00\"} ");
  std::vector<std::string> names;
  json.object("a log", [&](const std::string& name) {
    names.push_back(name);
    if (name == "number") {
      EXPECT_EQ(json.number("a number"), -0.15);
    } else if (name == "key") {
      EXPECT_EQ(json.unsigned_integer("a key"), 6989586621679009860U);
    } else if (name == "list") {
      EXPECT_TRUE(json.at_array());
      json.array("a list", [] { FAIL(); });
    } else if (name == "text") {
      EXPECT_EQ(json.location().line, 3U);
      EXPECT_EQ(json.string("a text"), "a\"\u00e9\n\U0001F600");
    } else {
      EXPECT_TRUE(json.at_object());
      json.skip();
    }
  });
  EXPECT_THAT(names, ElementsAre("number", "key", "list", "other", "text"));
  json.expect_end();
}

std::string problem_of(const std::string& text) {
  JsonReader json("a.json", text);
  try {
    json.skip();
    json.expect_end();
  } catch (const ParseError& error) {
    return error.what();
  }
  return "";
}

TEST(JsonReader, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(problem_of("{\"a\": 1,\n \"b\": [1 2]}"), "a.json:2:10: expected ',' or ']' (got '2')");
  EXPECT_THAT(problem_of("[1, 2"), HasSubstr("',' or ']', found the end of the file"));
  EXPECT_THAT(problem_of("{\"a\" 1}"), HasSubstr("a.json:1:6: expected ':'"));
  EXPECT_THAT(problem_of("{a: 1}"), HasSubstr("the name of a member"));
  EXPECT_THAT(problem_of("[1] 2"), HasSubstr("the end of the file"));
  EXPECT_THAT(problem_of("[nan]"), HasSubstr("a value"));
  EXPECT_THAT(problem_of("[1,]"), HasSubstr("a value"));
  EXPECT_THAT(problem_of(""), HasSubstr("a value, found the end of the file"));
  EXPECT_THAT(problem_of("\"a"), HasSubstr("its end"));
  EXPECT_THAT(problem_of("\"\\x\""), HasSubstr("escape"));
  EXPECT_THAT(problem_of("\"\\u12g4\""), HasSubstr("four hexadecimal digits"));
  EXPECT_THAT(problem_of("\"\\ud800\""), HasSubstr("half of a code point"));
  EXPECT_THAT(problem_of(std::string("[1\0]", 4)), HasSubstr("a value"));
  EXPECT_THAT(problem_of(std::string(100, '[')), HasSubstr("nested deeper than 64"));
}

TEST(JsonReader, TakesOnlyNumbersThatFit) {
  for (const char* text : {"1e400", "+1", ".5", "0x1", "\"1\"", "-", ""}) {
    EXPECT_THROW(JsonReader("a", text).number("x"), ParseError) << text;
  }
  for (const char* text : {"-1", "1.5", "18446744073709551616", "1e2"}) {
    EXPECT_THROW(JsonReader("a", text).unsigned_integer("x"), ParseError) << text;
  }
}

}  // namespace
}  // namespace isotherm
