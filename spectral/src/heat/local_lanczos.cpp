#include "heat/local_lanczos.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace isotherm::spectral::detail {
namespace {

constexpr Index kUndiscovered = -1;

/// A residual this small against the norm is rounding: the space is exhausted.
constexpr double kBreakdown = 4.0 * std::numeric_limits<double>::epsilon();

}  // namespace

LocalLanczos::LocalLanczos(const SparseMatrix& laplacian)
    : laplacian_(&laplacian), local_of_(laplacian.rows(), kUndiscovered) {}

void LocalLanczos::start(const HeatTarget& target) {
  for (const Index vertex : ball_) local_of_[vertex] = kUndiscovered;
  ball_.clear();
  row_start_.assign(1, 0);
  columns_.clear();
  weights_.clear();
  degrees_.clear();
  previous_.clear();
  current_.clear();
  next_.clear();
  diagonal_.clear();
  off_diagonal_.clear();
  norm_bound_ = 0.0;
  work_ = 0;
  exhausted_ = false;

  excluded_ = target.excluded;
  discover(target.from);
  current_ = {1.0};
  if (!target.single()) {
    discover(target.to);
    const double root_half = std::sqrt(0.5);
    current_ = {root_half, -root_half};
  }
  inner_ = 0;
  support_ = static_cast<Index>(ball_.size());
}

void LocalLanczos::discover(Index vertex) {
  local_of_[vertex] = static_cast<Index>(ball_.size());
  ball_.push_back(vertex);
}

/// The weight between two vertices without the excluded edge.
double LocalLanczos::weight_left(Index vertex, Index neighbour, double weight) const {
  const bool forward = vertex == excluded_.from && neighbour == excluded_.to;
  const bool backward = vertex == excluded_.to && neighbour == excluded_.from;
  return forward || backward ? excluded_.remaining : weight;
}

/// Stores the rows of the vertices that came into the support last, and
/// discovers their neighbours.
void LocalLanczos::expand_frontier() {
  const auto* outer = laplacian_->outerIndexPtr();
  const auto* rows = laplacian_->innerIndexPtr();
  const auto* values = laplacian_->valuePtr();
  for (Index u = static_cast<Index>(degrees_.size()); u < support_; ++u) {
    const Index vertex = ball_[u];
    double degree = 0.0;
    for (Index k = outer[vertex]; k < outer[vertex + 1]; ++k) {
      if (rows[k] == vertex) {
        degree = values[k];
        continue;
      }
      const double weight = weight_left(vertex, rows[k], -values[k]);
      if (weight == 0.0) continue;
      if (local_of_[rows[k]] == kUndiscovered) discover(rows[k]);
      columns_.push_back(local_of_[rows[k]]);
      weights_.push_back(weight);
    }
    if (vertex == excluded_.from || vertex == excluded_.to) degree -= excluded_.weight;
    degrees_.push_back(degree);
    row_start_.push_back(static_cast<Index>(columns_.size()));
    norm_bound_ = std::max(norm_bound_, 2.0 * degree);
  }
  current_.resize(ball_.size(), 0.0);
}

void LocalLanczos::step() {
  expand_frontier();
  const auto touched = static_cast<Index>(ball_.size());
  const double beta = off_diagonal_.empty() ? 0.0 : off_diagonal_.back();
  next_.assign(ball_.size(), 0.0);

  // Rows inside the support gather; rows beyond it only hear from its outermost layer.
  double alpha = 0.0;
  for (Index u = 0; u < support_; ++u) {
    double sum = degrees_[u] * current_[u];
    for (Index k = row_start_[u]; k < row_start_[u + 1]; ++k) {
      sum -= weights_[k] * current_[columns_[k]];
    }
    if (u < inner_) sum -= beta * previous_[u];
    alpha += sum * current_[u];
    next_[u] = sum;
  }
  for (Index u = inner_; u < support_; ++u) {
    for (Index k = row_start_[u]; k < row_start_[u + 1]; ++k) {
      if (columns_[k] >= support_) next_[columns_[k]] -= weights_[k] * current_[u];
    }
  }

  double squared_norm = 0.0;
  for (Index u = 0; u < touched; ++u) {
    next_[u] -= alpha * current_[u];
    squared_norm += next_[u] * next_[u];
  }
  const double norm = std::sqrt(squared_norm);
  diagonal_.push_back(alpha);
  off_diagonal_.push_back(norm);
  work_ += row_start_.back();
  if (norm <= kBreakdown * norm_bound_) {
    exhausted_ = true;
    return;
  }
  const double scale = 1.0 / norm;
  for (double& entry : next_) entry *= scale;
  std::swap(previous_, current_);
  std::swap(current_, next_);
  inner_ = support_;
  support_ = touched;
}

}  // namespace isotherm::spectral::detail
