#include "ranges/range_equations.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Cholesky>

#include "isotherm/spectral/sparse/block_covariance.hpp"
#include "isotherm/spectral/sparse/damped_step.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr double kStretchDeviation = std::numbers::ln10;  // of its log: a factor of ten

template <class Pose>
std::vector<std::pair<Index, Index>> couplings_of(const RangeProblem<Pose>& problem) {
  std::vector<std::pair<Index, Index>> couplings;
  for (const auto& term : problem.terms) couplings.emplace_back(term.from, term.to);
  return couplings;
}

// From the second end to the first; nothing where they are at one place.
template <class Pose>
typename Pose::Translation direction(const RangeTerm& term, const std::vector<Pose>& poses) {
  const typename Pose::Translation apart =
      poses[term.from].translation() - poses[term.to].translation();
  const double length = apart.norm();
  if (length > 0.0) return apart / length;
  return Pose::Translation::Zero();
}

// Of the prediction, by the perturbation T exp(xi) of an end that `along` points away from.
template <class Pose>
typename Pose::Tangent by_end(const Pose& end, const typename Pose::Translation& along) {
  typename Pose::Tangent derivative = Pose::Tangent::Zero();
  derivative.template head<Pose::kDim>() = end.rotation_matrix().transpose() * along;
  return derivative;
}

}  // namespace

template <class Pose>
double range_error(const RangeTerm& term, const RangeEstimate<Pose>& at) {
  const double distance =
      (at.poses[term.from].translation() - at.poses[term.to].translation()).norm();
  return term.distance - at.model.offset - std::exp(at.model.log_stretch) * distance;
}

template <class Pose>
RangeEquations<Pose>::RangeEquations(const RangeProblem<Pose>& problem, spectral::FactorForm form)
    : problem_(problem),
      equations_(problem.steps, problem.gauge, couplings_of(problem), form),
      curvature_(problem.terms.size(), 0.0) {}

template <class Pose>
double RangeEquations<Pose>::steps_chi2(const RangeEstimate<Pose>& at) const {
  return equations_.chi2(at.poses).sum();
}

template <class Pose>
double RangeEquations<Pose>::cost(const RangeEstimate<Pose>& at) const {
  const auto& model = at.model;
  const double size = Pose::kDof * static_cast<double>(equations_.constraint_count());
  double cost = 0.5 * (steps_chi2(at) / model.odometry + size * std::log(model.odometry)) +
                network::log_scale_cost(model.odometry);
  for (const auto& term : problem_.terms) {
    const double sigma = model.sigma(term.sigma);
    cost += range_loss(model, range_error(term, at), sigma * sigma).cost;
  }
  cost += log_prior_cost(model, problem_.typical_excess, problem_.too_long);
  if (problem_.calibrated) return cost;
  const double offset = model.offset / problem_.longest;
  const double stretch = model.log_stretch / kStretchDeviation;
  return cost + 0.5 * (offset * offset + stretch * stretch) + std::log(problem_.longest) +
         std::log(kStretchDeviation);
}

template <class Pose>
void RangeEquations<Pose>::linearise(const RangeEstimate<Pose>& at) {
  const double weight = 1.0 / at.model.odometry;
  equations_.linearize(at.poses, [&](Index, double) { return EdgeScaling{weight, weight, 0.0}; });
  const int border = problem_.calibrated ? 0 : 2;
  border_ = Eigen::MatrixXd::Zero(equations_.gradient().size(), border);
  corner_ = Eigen::MatrixXd::Zero(border, border);
  border_gradient_ = Eigen::VectorXd::Zero(border);
  if (border > 0) {
    const Eigen::Vector2d precision(1.0 / (problem_.longest * problem_.longest),
                                    1.0 / (kStretchDeviation * kStretchDeviation));
    corner_.diagonal() = precision;
    border_gradient_ =
        precision.cwiseProduct(Eigen::Vector2d(at.model.offset, at.model.log_stretch));
  }
  for (std::size_t k = 0; k < problem_.terms.size(); ++k) add_range(k, at);
  // Nothing says how points are turned.
  typename Pose::Matrix turn = Pose::Matrix::Zero();
  turn.diagonal().template tail<Pose::kDof - Pose::kDim>().setOnes();
  for (std::size_t v = 0; v < problem_.is_point.size(); ++v) {
    if (problem_.is_point[v]) {
      equations_.add_term(static_cast<Index>(v), turn, Pose::Tangent::Zero());
    }
  }
}

template <class Pose>
void RangeEquations<Pose>::add_range(std::size_t k, const RangeEstimate<Pose>& at) {
  const auto& term = problem_.terms[k];
  const double sigma = at.model.sigma(term.sigma);
  const auto loss = range_loss(at.model, range_error(term, at), sigma * sigma);
  const double stretch = std::exp(at.model.log_stretch);
  const typename Pose::Translation along = stretch * direction(term, at.poses);
  const typename Pose::Tangent from = by_end<Pose>(at.poses[term.from], along);
  const typename Pose::Tangent to = by_end<Pose>(at.poses[term.to], -along);
  curvature_[k] = loss.curvature;
  // The error falls where the prediction rises.
  equations_.add_term(term.from, loss.curvature * from * from.transpose(), -loss.slope * from);
  equations_.add_term(term.to, loss.curvature * to * to.transpose(), -loss.slope * to);
  equations_.add_coupling(static_cast<Index>(k), loss.curvature * from * to.transpose());
  if (problem_.calibrated) return;
  const double distance =
      (at.poses[term.from].translation() - at.poses[term.to].translation()).norm();
  const Eigen::Vector2d by_border(1.0, stretch * distance);
  corner_ += loss.curvature * by_border * by_border.transpose();
  border_gradient_ -= loss.slope * by_border;
  for (const auto& [vertex, derivative] : {std::pair(term.from, from), std::pair(term.to, to)}) {
    const Index variable = problem_.gauge.variable[vertex];
    if (variable < 0) continue;
    border_.template middleRows<Pose::kDof>(Eigen::Index{variable} * Pose::kDof) +=
        loss.curvature * derivative * by_border.transpose();
  }
}

template <class Pose>
std::vector<typename Pose::Matrix> RangeEquations<Pose>::own_covariances() const {
  std::vector<std::pair<Index, Index>> alone;
  for (Index v = 0; v < problem_.gauge.variable_count; ++v) alone.emplace_back(v, -1);
  std::vector<typename Pose::Matrix> result;
  if (alone.empty()) return result;
  for (const auto& block : spectral::pair_covariances<Pose::kDof>(equations_.hessian(), alone)) {
    result.push_back(block.first);
  }
  return result;
}

template <class Pose>
double RangeEquations<Pose>::fitted(const std::vector<double>& variances) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < variances.size(); ++k) sum += curvature_[k] * variances[k];
  return sum;
}

template <class Pose>
double RangeEquations<Pose>::steps_redundancy(double fitted) const {
  double unknowns = static_cast<double>(equations_.hessian().size());
  for (std::size_t v = 0; v < problem_.is_point.size(); ++v) {
    if (problem_.is_point[v] && problem_.gauge.variable[v] >= 0) {
      unknowns -= Pose::kDof - Pose::kDim;
    }
  }
  const double measured = Pose::kDof * static_cast<double>(equations_.constraint_count());
  return std::max(0.0, measured - unknowns + fitted);
}

template <class Pose>
Eigen::VectorXd RangeEquations<Pose>::damping_scale() const {
  return spectral::damping_scale(equations_.hessian());
}

template <class Pose>
std::optional<double> RangeEquations<Pose>::move(double damping, const Eigen::VectorXd& scale,
                                                 RangeEstimate<Pose>& at) {
  auto& hessian = equations_.hessian();
  if (hessian.size() > 0 && !hessian.factorise(damping * scale)) return std::nullopt;
  Eigen::MatrixXd rhs(scale.size(), 1 + border_.cols());
  rhs.col(0) = -equations_.gradient();
  rhs.rightCols(border_.cols()) = border_;
  const Eigen::MatrixXd solved = hessian.size() > 0 ? hessian.solve(rhs) : rhs;
  Eigen::VectorXd step = solved.col(0);
  Eigen::VectorXd border = Eigen::VectorXd::Zero(border_.cols());
  if (border_.cols() > 0) {
    Eigen::MatrixXd schur = corner_ - border_.transpose() * solved.rightCols(border_.cols());
    schur.diagonal() += damping * corner_.diagonal();
    border = schur.llt().solve(-border_gradient_ - border_.transpose() * step);
    step -= solved.rightCols(border_.cols()) * border;
    at.model.offset += border[0];
    at.model.log_stretch += border[1];
  }
  if (!step.allFinite() || !border.allFinite()) return std::nullopt;
  equations_.retract(step, at.poses);
  // Of H d = -g with damping: -g'd/2 and half of the damping's part.
  return 0.5 * (damping * (step.dot(scale.cwiseProduct(step)) +
                           border.dot(corner_.diagonal().cwiseProduct(border))) -
                step.dot(equations_.gradient()) - border.dot(border_gradient_));
}

template <class Pose>
std::optional<double> RangeEquations<Pose>::log_determinant() {
  auto& hessian = equations_.hessian();
  if (hessian.size() == 0) return 0.0;
  if (!hessian.factorise()) return std::nullopt;
  double result = hessian.log_determinant();
  if (border_.cols() > 0) {
    const Eigen::MatrixXd schur = corner_ - border_.transpose() * hessian.solve(border_);
    const double determinant = schur.determinant();
    if (!(determinant > 0.0)) return std::nullopt;
    result += std::log(determinant);
  }
  return result;
}

template <class Pose>
std::vector<double> RangeEquations<Pose>::prediction_variances(
    const RangeEstimate<Pose>& at) const {
  const auto& variable = problem_.gauge.variable;
  std::vector<std::pair<Index, Index>> pairs;
  for (const auto& term : problem_.terms) {
    pairs.emplace_back(variable[term.from], variable[term.to]);
  }
  std::vector<double> variances(pairs.size(), 0.0);
  if (equations_.hessian().size() == 0) return variances;
  const auto blocks = spectral::pair_covariances<Pose::kDof>(equations_.hessian(), pairs);
  const double stretch = std::exp(at.model.log_stretch);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto& term = problem_.terms[k];
    const typename Pose::Translation along = stretch * direction(term, at.poses);
    const typename Pose::Tangent from = by_end<Pose>(at.poses[term.from], along);
    const typename Pose::Tangent to = by_end<Pose>(at.poses[term.to], -along);
    variances[k] = std::max(0.0, from.dot(blocks[k].first * from) + to.dot(blocks[k].second * to) +
                                     2.0 * from.dot(blocks[k].cross * to));
  }
  return variances;
}

template double range_error(const RangeTerm&, const RangeEstimate<Pose2>&);
template double range_error(const RangeTerm&, const RangeEstimate<Pose3>&);
template class RangeEquations<Pose2>;
template class RangeEquations<Pose3>;

}  // namespace isotherm::slam::detail
