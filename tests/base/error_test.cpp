#include "isotherm/base/error.hpp"

#include <string>

#include <gtest/gtest.h>

namespace isotherm {
namespace {

TEST(ParseError, SaysWhereWhatAndWhichToken) {
  const ParseError error({"a.g2o", 7, 3}, "nan", "expected a finite number");
  EXPECT_STREQ(error.what(), "a.g2o:7:3: expected a finite number (got 'nan')");
  EXPECT_EQ(error.path(), "a.g2o");
  EXPECT_EQ(error.line(), 7u);
  EXPECT_EQ(error.column(), 3u);
  EXPECT_EQ(error.token(), "nan");
}

TEST(ParseError, LeavesOutWhatIsUnknown) {
  EXPECT_STREQ(ParseError({"a.g2o", 0, 0}, "", "is empty").what(), "a.g2o: is empty");
  EXPECT_STREQ(ParseError({"a.g2o", 2, 0}, "", "is short").what(), "a.g2o:2: is short");
}

TEST(ParseError, MakesHostileTokensShortAndPrintable) {
  const std::string token = "\x1b[31m" + std::string(100, 'x');
  const ParseError error({"f", 1, 1}, token, "bad");
  const std::string message = error.what();
  EXPECT_EQ(message.find('\x1b'), std::string::npos);
  EXPECT_LT(message.size(), 80u);
  EXPECT_EQ(error.token(), token) << "the whole token stays available";
}

TEST(InvalidArgument, NamesTheOption) {
  const InvalidArgument error("konst", "must be finite");
  EXPECT_STREQ(error.what(), "konst: must be finite");
  EXPECT_EQ(error.option(), "konst");
}

}  // namespace
}  // namespace isotherm
