#include "isotherm/base/range.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace isotherm {
namespace {

struct Example {
  int count = 3;
  std::vector<double> scales = {1.0, 2.0};
  bool on = true;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, Example>
void visit_fields(Options& options, Visitor&& visit) {
  visit("count", options.count, "how many", closed(1, 5));
  visit("scales", options.scales, "how far", left_open(0, 2));
  visit("on", options.on, "whether");
}

std::string field_refused(const Example& example) {
  try {
    require_fields_in_range(example);
  } catch (const InvalidArgument& error) {
    return error.option();
  }
  return {};
}

TEST(Range, HasEndsThatBelongToItOrNot) {
  for (const Range& range : {closed(0, 1), open(0, 1), left_open(0, 1), right_open(0, 1)}) {
    EXPECT_EQ(range.contains(0.0), range.has_low);
    EXPECT_EQ(range.contains(1.0), range.has_high);
    EXPECT_TRUE(range.contains(std::nextafter(0.0, 1.0)));
    EXPECT_FALSE(range.contains(std::nextafter(0.0, -1.0)));
    EXPECT_FALSE(range.contains(std::nextafter(1.0, 2.0)));
    EXPECT_FALSE(range.contains(std::nan("")));
    EXPECT_FALSE(range.contains(std::numeric_limits<double>::infinity()));
  }
  EXPECT_EQ(to_string(right_open(-1, 0.5)), "[-1, 0.5)");
  EXPECT_EQ(to_string(left_open(0, 1e12)), "(0, 1e+12]");
}

TEST(Range, MayAllowAListToBeEmpty) {
  EXPECT_NO_THROW(require_in_range("scales", std::vector<double>(), or_none(closed(0, 1))));
  EXPECT_THROW(require_in_range("scales", {2.0}, or_none(closed(0, 1))), InvalidArgument);
}

TEST(Range, IsThatOfEveryFieldThatStatesOne) {
  EXPECT_EQ(field_refused({}), "");
  EXPECT_EQ(field_refused({.count = 0}), "count");
  EXPECT_EQ(field_refused({.count = 6}), "count");
  EXPECT_EQ(field_refused({.scales = {}}), "scales");
  EXPECT_EQ(field_refused({.scales = {1.0, 2.5}}), "scales");
}

}  // namespace
}  // namespace isotherm
