#include "isotherm/base/csv.hpp"

#include <string>

#include <gtest/gtest.h>

#include "isotherm_test/parse_error.hpp"

namespace isotherm {
namespace {

using isotherm_test::message_of;

CsvReader csv(std::string_view text) { return CsvReader(TextReader("f.csv", text)); }

TEST(CsvReader, FindsColumnsByName) {
  auto reader = csv("# made by hand\nedge, from ,verdict\n\n3,7,keep\r\n4, 8 ,prune");
  ASSERT_TRUE(reader.has_header());
  const auto verdict = reader.column("verdict", 0);
  const auto from = reader.column("from", 0);
  ASSERT_TRUE(reader.next_row());
  EXPECT_EQ(reader.text(verdict, "verdict"), "keep");
  ASSERT_TRUE(reader.next_row());
  EXPECT_EQ(reader.unsigned_integer(from, "from"), 8u);
  EXPECT_EQ(reader.text(verdict, "verdict"), "prune");
  EXPECT_EQ(reader.line_number(), 5u);
  EXPECT_FALSE(reader.next_row());
  EXPECT_EQ(reader.find_column("score"), std::nullopt);
  EXPECT_EQ(message_of([&] { reader.column("score", 0); }),
            "f.csv: expected a column named 'score'");
}

TEST(CsvReader, WithoutHeaderColumnsGoByPosition) {
  auto reader = csv("1.5, 2\n3, 4\n");
  EXPECT_FALSE(reader.has_header());
  ASSERT_TRUE(reader.next_row());
  EXPECT_EQ(reader.number(reader.column("x", 0), "x"), 1.5);
  ASSERT_TRUE(reader.next_row());
  EXPECT_EQ(reader.number(reader.column("y", 1), "y"), 4.0);
  EXPECT_FALSE(reader.next_row());
}

TEST(CsvReader, LocatesProblems) {
  auto reader = csv("a,b\n1, x\n1\n");
  reader.next_row();
  EXPECT_EQ(message_of([&] { reader.number(1, "b"); }),
            "f.csv:2:4: expected b, a finite number (got 'x')");
  EXPECT_EQ(message_of([&] { reader.text(2, "c"); }),
            "f.csv:2: expected c in field 3, found 2 fields");
  EXPECT_EQ(message_of([&] { reader.next_row(); }),
            "f.csv:3: expected 2 fields as in the header, found 1");
}

TEST(CsvReader, EmptyInput) {
  auto reader = csv("");
  EXPECT_FALSE(reader.has_header());
  EXPECT_FALSE(reader.next_row());
}

TEST(CsvReader, OtherSeparatorsAreTold) {
  const auto error = [](const std::string& text) {
    return message_of([&] { CsvReader(TextReader("f", text)); });
  };
  EXPECT_EQ(error("# mine\nx;y\n1;2\n"),
            "f:2: fields are separated by semicolons; expected commas (got 'x;y')");
  EXPECT_EQ(error("1,5;2,5\n"),
            "f:1: fields are separated by semicolons; expected commas (got '1,5;2,5')");
  EXPECT_EQ(error("1 2 3\n"), "f:1: fields are separated by blanks; expected commas (got '1 2 3')");
  EXPECT_EQ(error("x\n1\n"), "no error");
  EXPECT_EQ(error("x, y\n1, 2\n"), "no error");
}

}  // namespace
}  // namespace isotherm
