#include "prune/consensus/judge/crowded_gate.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"
#include "isotherm/base/statistics.hpp"
#include "slam/prune/consensus/chi_squared_sample.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr int kDof = 6;
const double kSixDofGate = chi_squared_quantile(1.0 - 1e-4, kDof);

using SpannedLoops = std::vector<SpannedChi2>;
constexpr Index kNear = 10;
constexpr Index kFar = 1000;

void add_true_loops(Random& random, int count, double scale, Index span, SpannedLoops& loops) {
  for (const double x : isotherm_test::chi_squared_sample(random, count, kDof, scale)) {
    loops.push_back({span, x});
  }
}

void add_false_loops(Random& random, int count, double least, Index span, SpannedLoops& loops) {
  for (int k = 0; k < count; ++k)
    loops.push_back({span, random.uniform(least, 10.0 * kSixDofGate)});
}

double near_gate(const SpannedLoops& loops) {
  return crowded_gate(loops, kSixDofGate)[span_class(kNear)];
}
double far_gate(const SpannedLoops& loops) {
  return crowded_gate(loops, kSixDofGate)[span_class(kFar)];
}

TEST(CrowdedGate, StaysWhereNoFalseLoopsCrowd) {
  Random random(71);
  for (const double scale : {1e-4, 1.0}) {
    SpannedLoops loops;
    add_true_loops(random, 3000, scale, kNear, loops);
    EXPECT_EQ(near_gate(loops), kSixDofGate) << "none at all";
    for (int k = 0; k < 3000; ++k)
      loops.push_back({kNear, random.uniform(100.0, 1e4) * kSixDofGate});
    EXPECT_EQ(near_gate(loops), kSixDofGate) << "all far off";
  }
  EXPECT_EQ(near_gate({}), kSixDofGate);
  EXPECT_EQ(near_gate({{kNear, 0.0}, {kNear, 0.0}, {kNear, 1.0}, {kNear, kSixDofGate + 1.0}}),
            kSixDofGate)
      << "too few to tell";
}

TEST(CrowdedGate, PartsAccurateLoopsFromFalseOnesInsideTheGate) {
  Random random(72);
  SpannedLoops loops;
  add_true_loops(random, 3000, 0.02, kNear, loops);
  add_false_loops(random, 3000, 0.3 * kSixDofGate, kNear, loops);
  const double gate = near_gate(loops);
  EXPECT_LT(gate, 0.3 * kSixDofGate);
  EXPECT_GT(gate, 0.02 * kSixDofGate) << "all true ones are inside";
}

TEST(CrowdedGate, StaysWhereTrueLoopsReachIt) {
  Random random(73);
  SpannedLoops loops;
  add_true_loops(random, 3000, 2.0, kNear, loops);
  add_false_loops(random, 300, 0.0, kNear, loops);
  EXPECT_EQ(near_gate(loops), kSixDofGate);
}

TEST(CrowdedGate, StaysForSpansAtWhichNoFalseLoopsCrowd) {
  Random random(74);
  SpannedLoops loops;
  add_true_loops(random, 3000, 0.02, kNear, loops);
  add_false_loops(random, 3000, 0.3 * kSixDofGate, kNear, loops);
  EXPECT_EQ(far_gate(loops), near_gate(loops)) << "of that span nothing is known";
  add_true_loops(random, 3000, 0.5, kFar, loops);
  EXPECT_LT(near_gate(loops), kSixDofGate);
  EXPECT_EQ(far_gate(loops), kSixDofGate);
  add_false_loops(random, 3000, 0.3 * kSixDofGate, kFar, loops);
  EXPECT_EQ(far_gate(loops), near_gate(loops));
}

}  // namespace
}  // namespace isotherm::slam::detail
