// What loops with neighbouring ends say about each other.
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "prune/consensus/pairs/conflicts.hpp"
#include "prune/consensus/pairs/loop_pair.hpp"
#include "prune/consensus/pairs/near_pairs.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr double kGate = 25.0;

template <class Pose>
class PairsOf : public testing::Test {
 protected:
  using Matrix = typename Pose::Matrix;

  // Two passes of the same path, each loop joining corresponding poses; every
  // second one is stated backwards.
  static PoseGraph<Pose> two_passes(Random& random) {
    auto graph = isotherm_test::random_chain<Pose>(random, 40, 1e4);
    const auto roles = edge_roles(graph);
    const auto poses = odometry_poses(graph, roles);
    for (Index k = 2; k < 14; k += 3) {
      Constraint<Pose> loop{k, k + 20, poses[k].inverse() * poses[k + 20]};
      loop.information = 1e4 * Pose::Matrix::Identity();
      if (k % 2 == 0) {
        std::swap(loop.from, loop.to);
        loop.T_from_to = loop.T_from_to.inverse();
      }
      graph.constraints.push_back(loop);
    }
    return graph;
  }

  static void shift(Constraint<Pose>& loop) {
    typename Pose::Tangent xi = Pose::Tangent::Zero();
    xi[0] = 50.0;
    loop.T_from_to = loop.T_from_to * Pose::exp(xi);
  }

  static double chi2_of(const ReducedGraph<Pose>& graph, const std::pair<Index, Index>& pair) {
    const auto loops = forward_loops(graph, {});
    const auto [r, S] = pair_residual(graph, {}, loops[pair.first], loops[pair.second]);
    return r.dot(Eigen::LLT<Matrix>(S).solve(r));
  }

  // Odometry from one vertex to another, in either direction, step by step.
  static std::vector<UncertainPose<Pose>> steps(const PoseGraph<Pose>& graph, Index from, Index to,
                                                double scale) {
    std::vector<UncertainPose<Pose>> all;
    for (Index v = from; v != to; v += from < to ? 1 : -1) {
      const auto& step = graph.constraints[from < to ? v : v - 1];  // stated either way
      const Matrix covariance = scale * step.information.inverse();
      const Matrix turn = step.T_from_to.adjoint();
      if (step.from == v) {
        all.push_back({step.T_from_to, covariance});
      } else {
        all.push_back({step.T_from_to.inverse(), turn * covariance * turn.transpose()});
      }
    }
    return all;
  }

  // Of log(T^-1 product of the factors), each moved in turn.
  static Matrix covariance_of(const std::vector<UncertainPose<Pose>>& factors, const Pose& T) {
    constexpr double kStep = 1e-6;
    Matrix covariance = Matrix::Zero();
    for (std::size_t k = 0; k < factors.size(); ++k) {
      const auto residual = [&](const typename Pose::Tangent& moved) {
        Pose product;
        for (std::size_t i = 0; i < factors.size(); ++i) {
          product = product * factors[i].T;
          if (i == k) product = product * Pose::exp(moved);
        }
        return (T.inverse() * product).log();
      };
      Matrix J;
      for (int d = 0; d < Pose::kDof; ++d) {
        const typename Pose::Tangent by = kStep * Pose::Tangent::Unit(d);
        J.col(d) = (residual(by) - residual(-by)) / (2.0 * kStep);
      }
      covariance += J * factors[k].covariance * J.transpose();
    }
    return covariance;
  }
};
using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(PairsOf, Poses);

TYPED_TEST(PairsOf, NeighboursAgreeWhicheverWayTheyAreStated) {
  Random random(21);
  const auto graph = this->two_passes(random);
  const auto reduced = reduce(graph, edge_roles(graph));
  const auto pairs = near_pairs(reduced, 20);
  EXPECT_EQ(pairs.size(), 6u) << "every pair of the four";
  for (const auto& pair : pairs) EXPECT_LT(this->chi2_of(reduced, pair), 1e-9);
}

TYPED_TEST(PairsOf, DistantLoopsAreNoPairs) {
  Random random(22);
  const auto graph = this->two_passes(random);
  const auto reduced = reduce(graph, edge_roles(graph));
  EXPECT_EQ(near_pairs(reduced, 3).size(), 3u) << "only direct neighbours";
  EXPECT_TRUE(near_pairs(reduced, 1).empty());
}

// By differences: how the residual moves with every step of odometry and with the known loop.
TYPED_TEST(PairsOf, TheResidualHasTheCovarianceOfWhatPredictsIt) {
  using Pose = TypeParam;
  Random random(24);
  const auto graph = this->two_passes(random);
  const auto reduced = reduce(graph, edge_roles(graph));
  const CovarianceScale scale = {3.0, 0.5};
  const auto loops = forward_loops(reduced, scale);
  const auto &known = loops[1], &measured = loops[2];
  auto factors = this->steps(graph, measured.from, known.from, scale.odometry);
  factors.push_back(known.measured);
  for (const auto& step : this->steps(graph, known.to, measured.to, scale.odometry)) {
    factors.push_back(step);
  }
  const typename Pose::Matrix expected =
      measured.measured.covariance + this->covariance_of(factors, measured.measured.T);
  const auto [r, S] = pair_residual(reduced, scale, known, measured);
  EXPECT_LT(r.norm(), 1e-9);
  EXPECT_LT((S - expected).norm(), 1e-6 * expected.norm());
}

TYPED_TEST(PairsOf, ALoopThatRepeatsAMeasurementIsACopy) {
  Random random(23);
  auto graph = this->two_passes(random);
  auto copy = graph.constraints.back();
  graph.constraints.push_back(copy);
  std::swap(copy.from, copy.to);
  graph.constraints.push_back(copy);
  graph.constraints.push_back({5, 25, TypeParam(), TypeParam::Matrix::Identity()});
  graph.constraints.push_back({5, 25, TypeParam(), TypeParam::Matrix::Identity()});
  const auto loops = reduce(graph, edge_roles(graph)).loops;
  EXPECT_TRUE(is_copy(loops[3], loops[4]));
  EXPECT_TRUE(is_copy(loops[4], loops[5])) << "whatever it joins";
  EXPECT_FALSE(is_copy(loops[2], loops[3]));
  EXPECT_FALSE(is_copy(loops[6], loops[7])) << "to be back where one was is said by many";
}

TYPED_TEST(PairsOf, AccusersOfAFalseLoopAreTheNearestThatItContradicts) {
  Random random(25);
  auto graph = this->two_passes(random);
  this->shift(graph.constraints.back());
  const auto reduced = reduce(graph, edge_roles(graph));
  const std::vector<bool> accepted = {true, true, true, false};
  const std::vector<bool> refuted = {false, false, false, true};
  using Named = std::vector<std::vector<Index>>;
  EXPECT_EQ(name_conflicts(reduced, {}, kGate, accepted, refuted), (Named{{}, {}, {}, {2, 1, 0}}));
  // With so much drift none of them contradicts it alone.
  EXPECT_EQ(name_conflicts(reduced, {1e8, 1.0}, kGate, accepted, refuted),
            (Named{{}, {}, {}, {2, 1, 0}}));
  const std::vector<bool> none(4, false);
  EXPECT_EQ(name_conflicts(reduced, {}, kGate, none, refuted), Named(4)) << "nothing is accepted";
  EXPECT_EQ(name_conflicts(reduced, {}, kGate, accepted, none), Named(4)) << "nothing is refuted";
}

TYPED_TEST(PairsOf, ALoopThatAgreesIsNotNamedWhereAnotherContradicts) {
  Random random(26);
  auto graph = this->two_passes(random);
  this->shift(graph.constraints[graph.constraints.size() - 2]);
  this->shift(graph.constraints.back());
  // The last two say the same wrong thing, if along the same way; one of them is accepted.
  const auto reduced = reduce(graph, edge_roles(graph));
  const bool agree = this->chi2_of(reduced, {2, 3}) <= kGate;
  const auto named =
      name_conflicts(reduced, {}, kGate, {true, true, true, false}, {false, false, false, true});
  EXPECT_EQ(named.back().front(), agree ? 1 : 2);
}

TYPED_TEST(PairsOf, LoopsBetweenOtherPartsAccuseNobody) {
  Random random(27);
  auto graph = this->two_passes(random);
  this->shift(graph.constraints.back());
  graph.constraints.erase(graph.constraints.begin() + 22);  // behind the end of the first loop
  const auto reduced = reduce(graph, edge_roles(graph));
  const auto named =
      name_conflicts(reduced, {}, kGate, {true, false, false, false}, {false, false, false, true});
  EXPECT_TRUE(named.back().empty());
}

}  // namespace
}  // namespace isotherm::slam::detail
