#include "edges/odds/edge_odds.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

namespace isotherm::spectral::detail {
namespace {

constexpr double kLeastFalse = 0.5;  // less than an edge is none

/// Both groups under each other, every feature with mean 0 and deviation 1, and a column of ones.
struct Design {
  Eigen::MatrixXd rows;
  Eigen::VectorXd is_pair;
  Eigen::VectorXd weights;

  Design(const PairFeatures& features, const Eigen::ArrayXd& edge_weights)
      : rows(features.edges.rows() + features.pairs.rows(), features.edges.cols() + 1),
        is_pair(rows.rows()),
        weights(rows.rows()) {
    const auto edge_count = features.edges.rows(), pair_count = features.pairs.rows();
    rows.leftCols(features.edges.cols()) << features.edges, features.pairs;
    for (Eigen::Index c = 0; c < features.edges.cols(); ++c) {
      auto column = rows.col(c);
      column.array() -= column.mean();
      const double deviation = std::sqrt(column.squaredNorm() / static_cast<double>(rows.rows()));
      if (deviation > 0.0) column /= deviation;
    }
    rows.rightCols(1).setOnes();
    is_pair << Eigen::VectorXd::Zero(edge_count), Eigen::VectorXd::Ones(pair_count);
    weights << edge_weights.matrix(), Eigen::VectorXd::Ones(pair_count);
  }
};

/// Coefficients of the features have a standard normal prior, which keeps them finite where the
/// groups do not overlap; the constant has none but for what keeps it finite.
class Regression {
 public:
  explicit Regression(const Design& design)
      : design_(design), precision_(Eigen::VectorXd::Ones(design.rows.cols())) {
    constexpr double kVague = 1e-6;
    precision_[precision_.size() - 1] = kVague;
  }

  /// Newton's method; a step that does not raise the log posterior is halved.
  Eigen::VectorXd fit() const {
    constexpr int kMostSteps = 50;
    constexpr double kGain = 1e-9;  // of the log posterior, in nats
    Eigen::VectorXd coefficients = Eigen::VectorXd::Zero(design_.rows.cols());
    double value = log_posterior(coefficients);
    for (int step = 0; step < kMostSteps; ++step) {
      Eigen::VectorXd change = newton_step(coefficients);
      double next = log_posterior(coefficients + change);
      for (int k = 0; k < kMostSteps && !(next >= value); ++k) {
        change *= 0.5;
        next = log_posterior(coefficients + change);
      }
      if (!(next >= value)) break;
      coefficients += change;
      if (next - value < kGain) break;
      value = next;
    }
    return coefficients;
  }

 private:
  double log_posterior(const Eigen::VectorXd& coefficients) const {
    const Eigen::ArrayXd odds = (design_.rows * coefficients).array();
    const Eigen::ArrayXd log_sum = odds.max(0.0) + (-odds.abs()).exp().log1p();
    return (design_.weights.array() * (design_.is_pair.array() * odds - log_sum)).sum() -
           0.5 * precision_.dot(coefficients.cwiseAbs2());
  }

  Eigen::VectorXd newton_step(const Eigen::VectorXd& coefficients) const {
    const Eigen::ArrayXd odds = (design_.rows * coefficients).array();
    const Eigen::ArrayXd chance = 1.0 / (1.0 + (-odds).exp());
    const Eigen::VectorXd off = design_.weights.array() * (design_.is_pair.array() - chance);
    const Eigen::VectorXd spread = design_.weights.array() * chance * (1.0 - chance);
    const Eigen::VectorXd gradient =
        design_.rows.transpose() * off - precision_.cwiseProduct(coefficients);
    Eigen::MatrixXd curvature = design_.rows.transpose() * spread.asDiagonal() * design_.rows;
    curvature.diagonal() += precision_;
    return curvature.llt().solve(gradient);
  }

  const Design& design_;
  Eigen::VectorXd precision_;
};

/// The share of false ones that makes the edges most likely, given the log odds of each.
double fit_false_count(const Eigen::ArrayXd& scores, double first) {
  constexpr int kMostRounds = 200;
  constexpr double kSettled = 1e-3;  // change, relative
  const auto count = static_cast<double>(scores.size());
  double current = std::max(first, kLeastFalse);
  for (int round = 0; round < kMostRounds; ++round) {
    const double odds = std::log(current / (count - current));
    const double next = std::max((1.0 / (1.0 + (-scores - odds).exp())).sum(), kLeastFalse);
    const bool settled = std::abs(next - current) <= kSettled * current;
    current = std::min(next, count - kLeastFalse);
    if (settled) break;
  }
  return current;
}

}  // namespace

EdgeOdds edge_odds(const PairFeatures& features, std::vector<double> truth) {
  EdgeOdds result;
  result.truth = std::move(truth);
  result.scores.assign(result.truth.size(), 0.0);
  const auto edge_count = static_cast<Eigen::Index>(result.truth.size());
  Eigen::Map<Eigen::ArrayXd> true_share(result.truth.data(), edge_count);
  const double true_count = true_share.sum();
  if (edge_count < 2 || features.pairs.rows() == 0 || true_count == 0.0) return result;

  const Design design(features, true_share);
  const Eigen::VectorXd coefficients = Regression(design).fit();
  Eigen::Map<Eigen::ArrayXd> scores(result.scores.data(), edge_count);
  scores = (design.rows.topRows(edge_count) * coefficients).array() +
           std::log(true_count / static_cast<double>(features.pairs.rows()));
  const auto count = static_cast<double>(edge_count);
  result.false_count = fit_false_count(scores, count - true_count);
  const double share = result.false_count / count;
  true_share = 1.0 / (1.0 + (scores + std::log(share / (1.0 - share))).exp());
  // log ((1 - c) f_true / f_pairs + c), without overflow.
  const Eigen::ArrayXd of_true = std::log(1.0 - share) - scores;
  const double of_false = std::log(share);
  result.log_evidence =
      (of_true.max(of_false) + (-(of_true - of_false).abs()).exp().log1p()).sum() -
      0.5 * coefficients.head(coefficients.size() - 1).squaredNorm();
  return result;
}

}  // namespace isotherm::spectral::detail
