#include "online/open_runs.hpp"

#include <cmath>
#include <map>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/base/random.hpp"

namespace isotherm::slam::detail {
namespace {

using Member = OpenRuns::Member;

// By going through all states.
std::map<Index, double> log_odds_of_all(const std::vector<Member>& members,
                                        const LabelCounts& labels) {
  std::map<Index, double> yes;
  std::map<Index, double> no;
  for (unsigned state = 0; state < 1U << members.size(); ++state) {
    std::map<Index, bool> is_true;
    double weight = 0.0;
    for (std::size_t k = 0; k < members.size(); ++k) {
      const auto& member = members[k];
      const bool is = is_true[member.edge] = (state >> k & 1U) != 0;
      const bool first = member.before == OpenRuns::kNone;
      const bool led = !first && is_true[member.before];
      weight += first ? labels.log_share(LabelCounts::kFirst, is) : labels.log_next(led, is);
      if (is) weight += led ? std::max(member.own, member.with_before) : member.own;
    }
    for (const auto& [edge, is] : is_true) (is ? yes : no)[edge] += std::exp(weight);
  }
  for (auto& [edge, odds] : yes) odds = std::log(odds / no[edge]);
  return yes;
}

TEST(OpenRuns, SumOverAllStates) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    LabelCounts labels;
    for (int k = 0; k < 5; ++k) labels.add(LabelCounts::kFirst, random.uniform(0.0, 1.0));
    for (int k = 0; k < 9; ++k) {
      const double before = random.uniform(0.0, 1.0);
      labels.add_next(before, random.uniform(0.0, 1.0));
    }
    OpenRuns runs(labels);
    std::vector<Member> members;
    for (Index k = 0; k < 8; ++k) {
      const bool starts = k == 0 || random.index(6) == 0;
      const Index before = starts ? OpenRuns::kNone : members[random.index(members.size())].edge;
      members.push_back({3 * k + 1, random.uniform(-6.0, 3.0), before, random.uniform(-3.0, 6.0)});
      runs.add(members.back());
    }
    const auto expected = log_odds_of_all(members, labels);
    for (const auto& member : members) {
      const auto odds = runs.log_odds(member.edge);
      EXPECT_TRUE(runs.contains(member.edge));
      bool found = false;
      for (const auto& [edge, log_odds] : odds) {
        EXPECT_NEAR(log_odds, expected.at(edge), 1e-9);
        found = found || edge == member.edge;
      }
      EXPECT_TRUE(found);
    }
  }
}

TEST(OpenRuns, AreTrueTogetherWhereNoneIsAlone) {
  OpenRuns runs;
  runs.add({0, -25.0});
  for (Index k = 1; k < 10; ++k) runs.add({k, -25.0, k - 1, 7.0});
  for (const auto& [edge, log_odds] : runs.log_odds(4)) EXPECT_GT(log_odds, 5.0) << edge;
  OpenRuns apart;
  for (Index k = 0; k < 10; ++k) apart.add({k, -25.0, k == 0 ? OpenRuns::kNone : k - 1, -3.0});
  for (const auto& [edge, log_odds] : apart.log_odds(4)) EXPECT_LT(log_odds, -10.0) << edge;
}

TEST(OpenRuns, RefuseWhatDoesNotGoTogether) {
  OpenRuns runs;
  runs.add({5, 1.0});
  EXPECT_THROW(runs.add({5, 1.0}), InvalidArgument);
  EXPECT_THROW(runs.add({6, 1.0, 4}), InvalidArgument);
  EXPECT_TRUE(runs.log_odds(6).empty());
  EXPECT_NEAR(runs.log_odds(5).front().second, 1.0, 1e-12);
}

}  // namespace
}  // namespace isotherm::slam::detail
