#include "prune/consensus/objective/error_scales.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "isotherm/base/random.hpp"
#include "prune/consensus/estimate/log_normal.hpp"
#include "prune/consensus/objective/loop_gain.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam::detail {
namespace {

TEST(ScaleShares, AreAsLikelyAsAnyOrderOfTheLoopsSays) {
  // 3, 2 and none of shares (1, 1/3, 1/3, 1/3): 1 2 3 (1/3 4/3) / (2 3 4 5 6), one after the other.
  EXPECT_NEAR((ScaleShares{{3.0, 2.0, 0.0, 0.0}}).log_evidence(),
              std::log(6.0 * (4.0 / 9.0) / 720.0), 1e-12);
  EXPECT_NEAR(ScaleShares{}.log_evidence(), 0.0, 1e-12);
}

TEST(ScaleMixture, ExpectsWhatWasFoundAndWhatIsKnownBefore) {
  const auto mixture = expected_mixture(1e-3, {{6.0, 2.0, 0.0, 0.0}});
  EXPECT_NEAR(mixture.log_share[0], std::log(0.7), 1e-12);
  EXPECT_NEAR(mixture.log_share[1], std::log(7.0 / 30.0), 1e-12);
  EXPECT_NEAR(mixture.log_share[3], std::log(1.0 / 30.0), 1e-12);
  EXPECT_NEAR(mixture.share_of_worse(), 0.3, 1e-12);
}

TEST(ScaleShares, GoFromScaleToScaleWithMost) {
  const auto wider = wider_most({{8.0, 4.0, 2.0, 1.0}});
  EXPECT_EQ(wider.shares.loops, (ByScale{12.0, 2.0, 0.0, 1.0}));
  EXPECT_DOUBLE_EQ(wider.factor, 3.0);
  EXPECT_EQ(all_as_most({{1.0, 2.0, 4.0, 1.0}}).loops, (ByScale{8.0, 0.0, 0.0, 0.0}));
  const auto widest = all_as_worst({{1.0, 2.0, 4.0, 1.0}});
  EXPECT_EQ(widest.shares.loops, (ByScale{7.0, 0.0, 0.0, 1.0}));
  EXPECT_DOUBLE_EQ(widest.factor, 9.0);
  const auto sharper = sharper_most({{8.0, 4.0, 2.0, 1.0}});
  EXPECT_EQ(sharper.shares.loops, (ByScale{4.0, 4.0, 6.0, 1.0}));
  EXPECT_DOUBLE_EQ(sharper.factor, 1.0 / 3.0);
}

TEST(ScaleShares, CountLoopsAsOfDifferentScalesFromOneStepOn) {
  EXPECT_TRUE(are_of_different_scales(1.0, 1.0 / 3.0));
  EXPECT_TRUE(are_of_different_scales(1.0 / 9.0, 1.0));
  EXPECT_FALSE(are_of_different_scales(0.4, 0.9));
}

TEST(ScaleMixture, GoesAsFarAsTheFileStates) {
  EXPECT_DOUBLE_EQ(expected_mixture(1e-5, {}).relative.back() * 1e-5, 1.0);
  EXPECT_TRUE(expected_mixture(0.2, {}, 0.5).has(kAsStated)) << "in a coordinate";
  const auto nearer = expected_mixture(0.2, {{6.0, 2.0, 0.0, 0.0}});
  EXPECT_NEAR(std::exp(nearer.log_share[2]), 2.0 / 30.0, 1e-12) << "stated counts among the worst";
  EXPECT_EQ(std::exp(nearer.log_share[3]), 0.0);
}

TEST(ErrorScale, BoundsTheLogOfTheMixtureTightly) {
  constexpr int kDof = 3;
  const auto mixture = expected_mixture(0.01, {{9.0, 0.0, 1.0}});
  for (const double chi2 : {0.0, 3.0, 30.0, 300.0}) {
    for (const double stated : {0.0, 0.01 * chi2, 0.3 * chi2}) {
      const auto scale = error_scale(mixture, Misfit{chi2, stated, kDof, 11.0});
      double bound =
          scale.evidence - 0.5 * (scale.weight.learnt * chi2 + scale.weight.stated * stated);
      double density = std::exp(mixture.log_share[kAsStated] - 0.5 * (11.0 + stated));
      for (std::size_t j = 0; j < kScaleCount; ++j) {
        bound += scale.probability[j] * mixture.log_share[j];
        if (j == kAsStated) continue;
        density += std::exp(mixture.log_share[j] - 0.5 * chi2 / mixture.relative[j]) /
                   std::pow(mixture.relative[j], 0.5 * kDof);
      }
      EXPECT_NEAR(bound, std::log(density), 1e-9) << chi2 << " " << stated;
    }
  }
}

TEST(ErrorScale, WeighsALoopLessTheFartherOutItIs) {
  const auto mixture = expected_mixture(0.01, {{99.0, 0.0, 1.0}});
  // Stated covariances are a hundred times those of most.
  const auto factor = [&](double chi2) {
    const Misfit misfit{chi2, 0.01 * chi2, 3.0, 3.0 * std::log(100.0)};
    return mixture.factor(error_scale(mixture, misfit).weight);
  };
  EXPECT_NEAR(factor(1.0), 1.0, 0.01);
  EXPECT_NEAR(factor(30.0), 1.0 / 9.0, 0.05);
  EXPECT_NEAR(factor(1000.0), 0.01, 1e-6);
}

template <class Pose>
class LoopGainOf : public testing::Test {};
using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(LoopGainOf, Poses);

// By the densities of the mixture, one after the other.
TYPED_TEST(LoopGainOf, IsTheLogDensityOfTheMixture) {
  using Pose = TypeParam;
  using Matrix = typename Pose::Matrix;
  Random random(3);
  const auto spread = [&random](double size) {
    Matrix A;
    for (double& entry : A.reshaped()) entry = size * random.normal();
    return Matrix(A * A.transpose() + 1e-3 * size * size * Matrix::Identity());
  };
  for (int k = 0; k < 20; ++k) {
    typename Pose::Tangent r;
    for (double& entry : r) entry = 0.1 * random.normal();
    const Matrix P = spread(0.05);
    const Matrix learnt = spread(0.1);
    const Matrix stated = spread(0.2);
    const auto mixture = expected_mixture(0.04, {{5.0, 1.0, 2.0}});
    double density = std::exp(mixture.log_share[kAsStated] + log_normal<Pose>(r, P + stated));
    for (std::size_t j = 0; j < kAsStated; ++j) {
      const Matrix S = P + mixture.scale * mixture.relative[j] * learnt;
      density += std::exp(mixture.log_share[j] + log_normal<Pose>(r, S));
    }
    const auto gain = loop_gain<Pose>({r, P}, {learnt, stated}, mixture);
    EXPECT_NEAR(gain.log_density, std::log(density), 1e-8);
  }
}

// Against the same integral over fine steps of both logs, far out.
TYPED_TEST(LoopGainOf, IntegratesOverScalesThatAreNotKnown) {
  using Pose = TypeParam;
  using Matrix = typename Pose::Matrix;
  const typename Pose::Tangent r = Pose::Tangent::Constant(0.4);
  const Matrix P = 0.01 * Matrix::Identity();
  const Matrix Sigma = 0.02 * Matrix::Identity();
  const auto mixture = expected_mixture(0.5, {{3.0, 1.0, 0.0}});
  const CovarianceScale deviation = {1.2, 0.8};
  constexpr double kStep = 0.1;
  double sum = 0.0;
  double all = 0.0;
  for (double x = -6.0; x < 6.0; x += kStep) {
    for (double y = -6.0; y < 6.0; y += kStep) {
      const double weight = std::exp(-0.5 * (x * x + y * y));
      all += weight;
      const Matrix known = std::exp(deviation.odometry * x) * P;
      for (std::size_t j = 0; j < kScaleCount; ++j) {
        const double own = mixture.scale * mixture.relative[j] * std::exp(deviation.loops * y);
        const Matrix S = known + own * Sigma;
        sum += weight * std::exp(mixture.log_share[j] + log_normal<Pose>(r, S));
      }
    }
  }
  EXPECT_NEAR(loop_gain<Pose>({r, P}, {Sigma, Sigma}, mixture, deviation).log_density,
              std::log(sum / all), 0.05);
}

// By matrices: the information of the loop is taken away from that of all.
TYPED_TEST(LoopGainOf, TakesTheLoopOutOfWhatAllSay) {
  using Pose = TypeParam;
  using Matrix = typename Pose::Matrix;
  const typename Pose::Tangent r = Pose::Tangent::Constant(0.01);
  const Matrix others = 0.3 * Matrix::Identity() + 0.2 * Matrix::Ones();
  const Matrix Omega = (0.4 * Matrix::Identity() + 0.1 * Matrix::Ones()).inverse();
  const Matrix all = (others.inverse() + Omega).inverse();
  const auto left = without<Pose>({r, all}, Omega);
  EXPECT_TRUE(left.P.isApprox(others, 1e-12));
  // The residual is fitted by all of them: without the loop it is (1 - gain)^-1 as long.
  EXPECT_TRUE(left.r.isApprox(others * all.inverse() * r, 1e-12));
}

}  // namespace
}  // namespace isotherm::slam::detail
