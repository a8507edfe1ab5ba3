#include "isotherm/slam/simulate/corrupt.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/simulate/simulate.hpp"

namespace isotherm::slam {
namespace {

const Simulation<Pose2>& city() {
  static const auto simulation =
      simulate_city({.poses = 1000, .measurements = {.loops = 400}, .seed = 1});
  return simulation;
}

// The injected constraints: those whose label is not `correct`.
std::vector<Constraint<Pose2>> injected(const Corrupted<Pose2>& corrupted) {
  std::vector<Constraint<Pose2>> loops;
  for (const auto& label : corrupted.labels) {
    if (label.label != Label::correct) loops.push_back(corrupted.graph.constraints[label.edge]);
  }
  return loops;
}

Corrupted<Pose2> corrupt_city(const CorruptOptions& options) {
  return corrupt(city().graph, city().truth, options);
}

TEST(Corrupt, AddsTheNumberThatWasAskedFor) {
  EXPECT_EQ(injected(corrupt_city({.count = 123})).size(), 123u);
  EXPECT_EQ(injected(corrupt_city({.ratio = 0.5})).size(), 200u);
  EXPECT_EQ(injected(corrupt_city({.fraction = 0.9})).size(), 3600u);
  EXPECT_EQ(injected(corrupt_city({.count = 0})).size(), 0u);
}

TEST(Corrupt, LabelsEveryCandidateOfTheNewGraphAndKeepsTheOldOnes) {
  const auto corrupted = corrupt_city({.count = 300, .seed = 4});
  const auto roles = edge_roles(corrupted.graph);
  ASSERT_EQ(corrupted.labels.size(), roles.candidates.size());
  EXPECT_EQ(roles.odometry.size(), 999u) << "no false loop looks like odometry";
  for (std::size_t c = 0; c < roles.candidates.size(); ++c) {
    const auto& label = corrupted.labels[c];
    const auto& constraint = corrupted.graph.constraints[roles.candidates[c]];
    EXPECT_EQ(label.edge, roles.candidates[c]);
    EXPECT_EQ(label.from, corrupted.graph.ids[constraint.from]);
    EXPECT_EQ(label.to, corrupted.graph.ids[constraint.to]);
  }
  EXPECT_EQ(count(corrupted.labels, Label::correct), 400);
}

TEST(Corrupt, ConsistentFalseLoopsAreIgnored) {
  const auto corrupted = corrupt_city({.type = NoiseType::local, .count = 4000, .seed = 5});
  for (const auto& label : corrupted.labels) {
    if (label.label == Label::correct) continue;
    const auto& loop = corrupted.graph.constraints[label.edge];
    const auto r = residual(loop, city().truth[loop.from], city().truth[loop.to]);
    const bool consistent = r.dot(loop.information * r) <= 16.2662;
    EXPECT_EQ(label.label, consistent ? Label::ignore : Label::incorrect);
  }
}

TEST(Corrupt, LocalLoopsAreLocalAndRandomOnesAreNot) {
  const auto reach = [](const CorruptOptions& options) {
    Index longest = 0;
    for (const auto& loop : injected(corrupt_city(options))) {
      EXPECT_GE(std::abs(loop.from - loop.to), 2);
      longest = std::max(longest, std::abs(loop.from - loop.to));
    }
    return longest;
  };
  EXPECT_LE(reach({.type = NoiseType::local, .count = 500}), 20);
  EXPECT_LE(reach({.type = NoiseType::local_grouped, .count = 500}), 20);
  EXPECT_LE(reach({.style = NoiseStyle::paper, .type = NoiseType::local, .count = 500}), 40);
  EXPECT_GT(reach({.type = NoiseType::random, .count = 500}), 700);
  EXPECT_GT(reach({.type = NoiseType::random_grouped, .count = 500}), 700);
}

TEST(Corrupt, VertigoGroupsShareOneTransformNearTheIdentity) {
  const auto loops =
      injected(corrupt_city({.type = NoiseType::random_grouped, .count = 2000, .shuffle = false}));
  ASSERT_EQ(loops.size(), 2000u);
  int followers = 0;
  double squares = 0.0;
  double turns = 0.0;
  for (std::size_t k = 1; k < loops.size(); ++k) {
    const auto& previous = loops[k - 1];
    const auto& loop = loops[k];
    if (loop.T_from_to.translation() == previous.T_from_to.translation()) {
      ++followers;
      EXPECT_EQ(loop.from - previous.from, 1);
      EXPECT_EQ(loop.to - previous.to, 1);
    } else {
      squares += loop.T_from_to.translation().squaredNorm();
      turns += std::pow(loop.T_from_to.angle(), 2);
    }
  }
  const int groups = 1999 - followers;
  EXPECT_NEAR(groups, 200, 15) << "groups of ten, a few cut short by the end of the path";
  // Standard deviations of 0.3 m an axis and ten degrees; five standard errors.
  const double error = 5.0 * std::sqrt(1.0 / groups);
  EXPECT_NEAR(squares / groups, 2 * 0.09, 2 * 0.09 * error);
  const double degree = std::numbers::pi / 180.0;
  EXPECT_NEAR(turns / groups, std::pow(10.0 * degree, 2),
              std::pow(10.0 * degree, 2) * error * std::numbers::sqrt2);
}

TEST(Corrupt, PaperTransformsAreWildAndTheirInformationOftenInvalid) {
  const auto loops = injected(corrupt_city({.style = NoiseStyle::paper,
                                            .count = 2000,
                                            .information = NoiseInformation::paper,
                                            .shuffle = false}));
  int negative = 0;
  std::vector<double> lengths;
  for (const auto& loop : loops) {
    lengths.push_back(loop.T_from_to.translation().norm());
    negative += loop.information(0, 0) < 0.0;
  }
  EXPECT_GE(*std::min_element(lengths.begin(), lengths.end()), 10.0 - 1e-9);
  EXPECT_LE(*std::max_element(lengths.begin(), lengths.end()), 1000.0 + 1e-9);
  // A quarter of U[-1, 3] is negative; five binomial standard deviations.
  EXPECT_NEAR(negative, 500, 5 * std::sqrt(2000 * 0.25 * 0.75));
}

TEST(Corrupt, AllRandomHasGroupsOfSeveralSizes) {
  const auto loops = injected(corrupt_city({.style = NoiseStyle::vertigo,
                                            .type = NoiseType::all_random,
                                            .count = 1000,
                                            .group_size = 5,
                                            .shuffle = false}));
  std::vector<int> sizes{1};
  for (std::size_t k = 1; k < loops.size(); ++k) {
    if (loops[k].T_from_to.translation() == loops[k - 1].T_from_to.translation()) {
      ++sizes.back();
    } else {
      sizes.push_back(1);
    }
  }
  sizes.pop_back();  // the last group may be cut short by the count
  for (int size = 2; size <= 7; ++size) {
    EXPECT_GT(std::count(sizes.begin(), sizes.end(), size), 10) << size;
  }
  EXPECT_LE(*std::max_element(sizes.begin(), sizes.end()), 7);
}

TEST(Corrupt, ShufflingHidesThemAndDirectionsFollowTheGraph) {
  const auto corrupted = corrupt_city({.count = 400, .seed = 9});
  int early = 0;
  for (std::size_t c = 0; c < 400; ++c) {
    early += corrupted.labels[c].label != Label::correct;
  }
  EXPECT_NEAR(early, 200, 50) << "false loops are spread over the candidates";
  for (const auto& loop : injected(corrupted)) {
    EXPECT_LT(loop.from, loop.to) << "every loop of the simulated graph leads forward";
  }
}

TEST(Corrupt, RepeatsWithTheSeed) {
  const auto a = corrupt_city({.count = 50, .seed = 1});
  const auto b = corrupt_city({.count = 50, .seed = 1});
  const auto c = corrupt_city({.count = 50, .seed = 2});
  const auto ends = [](const Corrupted<Pose2>& corrupted) {
    std::vector<std::pair<Index, Index>> all;
    for (const auto& edge : corrupted.graph.constraints) all.emplace_back(edge.from, edge.to);
    return all;
  };
  EXPECT_EQ(ends(a), ends(b));
  EXPECT_NE(ends(a), ends(c));
}

TEST(Corrupt, RejectsWhatCannotBeDone) {
  EXPECT_THROW(corrupt_city({}), InvalidArgument) << "no amount";
  EXPECT_THROW(corrupt_city({.count = 1, .ratio = 1.0}), InvalidArgument);
  EXPECT_THROW(corrupt_city({.fraction = 1.0}), InvalidArgument);
  EXPECT_THROW(corrupt(city().graph, {}, {.count = 1}), InvalidArgument) << "no truth";
  const auto no_loops = simulate_city({.poses = 100, .measurements = {.loops = 0}});
  EXPECT_THROW(corrupt(no_loops.graph, no_loops.truth, {.count = 1}), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::slam
