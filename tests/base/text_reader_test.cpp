#include "isotherm/base/text_reader.hpp"

#include <bit>
#include <clocale>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/text_writer.hpp"
#include "isotherm_test/parse_error.hpp"
#include "isotherm_test/temporary.hpp"

namespace isotherm {
namespace {

using isotherm_test::message_of;
using isotherm_test::TemporaryFolder;
using isotherm_test::write_file;

TEST(TextReader, SplitsLinesAndTokens) {
  TextReader reader("f", "a\t b  12\r\n\n  \n-1.5e+003 x");
  ASSERT_TRUE(reader.next_line());
  EXPECT_EQ(reader.line(), "a\t b  12");
  EXPECT_EQ(reader.word(), "a");
  EXPECT_EQ(reader.word(), "b");
  EXPECT_EQ(reader.location().column, 4u);
  EXPECT_EQ(reader.unsigned_integer("id"), 12u);
  EXPECT_TRUE(reader.at_line_end());
  EXPECT_EQ(reader.word(), "");
  ASSERT_TRUE(reader.next_line());
  EXPECT_EQ(reader.line(), "");
  ASSERT_TRUE(reader.next_line());
  EXPECT_TRUE(reader.at_line_end());
  ASSERT_TRUE(reader.next_line());
  EXPECT_EQ(reader.line_number(), 4u);
  EXPECT_EQ(reader.number("x"), -1500.0);
  EXPECT_EQ(message_of([&] { reader.expect_line_end(); }),
            "f:4:11: expected the end of the line (got 'x')");
  EXPECT_FALSE(reader.next_line());
  EXPECT_FALSE(reader.next_line());
}

TEST(TextReader, AFinalNewlineAddsNoLine) {
  TextReader reader("f", "a\n");
  EXPECT_TRUE(reader.next_line());
  EXPECT_FALSE(reader.next_line());
  TextReader empty("f", "");
  EXPECT_FALSE(empty.next_line());
}

TEST(TextReader, NumbersOfEveryForm) {
  TextReader reader("f", "1 -2. .5 +3 1e5 1E+005 1e-400 0.1 -0 18446744073709551615");
  reader.next_line();
  for (const double expected : {1.0, -2.0, 0.5, 3.0, 1e5, 1e5, 0.0, 0.1, -0.0}) {
    EXPECT_EQ(reader.number("x"), expected);
  }
  EXPECT_EQ(reader.unsigned_integer("id"), 18446744073709551615u);
}

TEST(TextReader, SaysWhatWasExpected) {
  for (const char* text :
       {"nan", "inf", "-inf", "1e999", "1,5", "0x10", "1.5x", "--1", "+-1", "+", "-", "e5"}) {
    TextReader reader("f", text);
    reader.next_line();
    EXPECT_EQ(message_of([&] { reader.number("x"); }),
              "f:1:1: expected x, a finite number (got '" + std::string(text) + "')");
  }
  for (const char* text : {"-1", "1.0", "18446744073709551616", "x", "+1"}) {
    TextReader reader("f", text);
    reader.next_line();
    EXPECT_EQ(
        message_of([&] { reader.unsigned_integer("a vertex id"); }),
        "f:1:1: expected a vertex id, an integer in [0, 2^64) (got '" + std::string(text) + "')");
  }
  TextReader reader("f", "1 ");
  reader.next_line();
  reader.word();
  EXPECT_EQ(message_of([&] { reader.number("y"); }),
            "f:1:3: expected y, found the end of the line");
}

TEST(TextReader, DoesNotDependOnTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8"}) std::setlocale(LC_ALL, name);
  double value = 0;
  EXPECT_TRUE(parse_number("1.5", value));
  EXPECT_EQ(value, 1.5);
  EXPECT_EQ(format_number(1.5), "1.5");
  std::setlocale(LC_ALL, before.c_str());
}

TEST(TextReader, LinesLongerThanTheBuffer) {
  const std::string longish(700'000, 'x');
  const std::string text = "a\n" + longish + "\nb\n" + longish;
  TextReader reader("f", text);
  EXPECT_EQ(reader.peek().substr(0, 2), "a\n");
  std::vector<std::size_t> lengths;
  while (reader.next_line()) lengths.push_back(reader.line().size());
  EXPECT_THAT(lengths, testing::ElementsAre(1, 700'000, 1, 700'000));
}

TEST(TextReader, RefusesAnEndlessLine) {
  const std::string text = "a\n" + std::string(3 << 20, 'x');
  TextReader reader("f", text);
  reader.next_line();
  EXPECT_EQ(message_of([&] { reader.next_line(); }), "f:2: line longer than 1048576 bytes");
}

TEST(TextReader, SkipsAByteOrderMarkAndLooksAheadWithoutConsuming) {
  TextReader reader("f", "\xEF\xBB\xBFVERTEX_SE2 0\n");
  EXPECT_EQ(reader.peek(), "VERTEX_SE2 0\n");
  EXPECT_EQ(reader.peek(), "VERTEX_SE2 0\n");
  ASSERT_TRUE(reader.next_line());
  EXPECT_EQ(reader.word(), "VERTEX_SE2");
}

TEST(TextReader, ReadsCompressedFilesAndRefusesDamagedOnes) {
  const TemporaryFolder folder;
  std::string text;
  for (int i = 0; i < 100'000; ++i) text += std::to_string(i) + "\n";
  OutputFile file(folder / "a.gz");
  file.write(text);
  file.commit();
  const std::string packed = isotherm_test::read_file(folder / "a.gz");
  EXPECT_LT(packed.size(), text.size() / 2);

  TextReader reader(folder / "a.gz");
  std::uint64_t expected = 0;
  while (reader.next_line()) ASSERT_EQ(reader.unsigned_integer("n"), expected++);
  EXPECT_EQ(expected, 100'000u);

  write_file(folder / "cut.gz", packed.substr(0, packed.size() / 2));
  EXPECT_THAT(message_of([&] {
                TextReader cut(folder / "cut.gz");
                while (cut.next_line()) {
                }
              }),
              testing::HasSubstr("cut.gz: cannot be read: "));
}

TEST(TextReader, ReadsPartsOfATextAndBytesAsTheyAre) {
  const std::string text("three\nfo\0ur\nx", 13);
  const auto source = [rest = std::string_view(text)](std::span<char> target) mutable {
    const auto count = std::min<std::size_t>({rest.size(), target.size(), 4});
    std::copy_n(rest.begin(), count, target.begin());
    rest.remove_prefix(count);
    return count;
  };
  TextReader reader("part", source, 2);
  ASSERT_TRUE(reader.next_line());
  EXPECT_EQ(reader.line_number(), 3u);
  std::string bytes(6, ' ');
  EXPECT_EQ(reader.bytes(bytes), 6u);
  EXPECT_EQ(bytes, std::string("fo\0ur\n", 6));
  EXPECT_EQ(reader.bytes(bytes), 1u);
  EXPECT_EQ(bytes.front(), 'x');
}

TEST(TextReader, NamesWhatItCannotOpen) {
  const TemporaryFolder folder;
  EXPECT_THROW(TextReader(folder / "absent"), FileError);
  EXPECT_THROW(TextReader(folder.path().string()), FileError);
  EXPECT_THAT(message_of([&] { TextReader reader(folder / "absent"); }),
              testing::EndsWith("absent: cannot be opened: No such file or directory"));
}

TEST(FormatNumber, RoundTripsEveryBitPattern) {
  std::mt19937_64 engine(3);
  for (int i = 0; i < 100'000; ++i) {
    const double value = std::bit_cast<double>(engine());
    if (!std::isfinite(value)) continue;
    double back = 0.0;
    ASSERT_TRUE(parse_number(format_number(value), back)) << value;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(back), std::bit_cast<std::uint64_t>(value));
  }
  EXPECT_EQ(format_number(0.1), "0.1");
  EXPECT_EQ(format_number(5.0), "5");
}

}  // namespace
}  // namespace isotherm
