#include "prune/consensus/odometry/bias_fit.hpp"

#include "matrices/decompositions.hpp"

namespace isotherm::slam::detail {

template <class Pose>
BiasFit<Pose>::BiasFit(const Estimate<Pose>& estimate, const ReducedGraph<Pose>& graph,
                       const BiasPrior<Pose>& prior, double scale)
    : estimate_(estimate),
      graph_(graph),
      root_(prior.variance.cwiseSqrt()),
      now_((root_.array() > 0.0).select(prior.now.cwiseQuotient(root_), Bias::Zero())) {
  const auto& variable = estimate.gauge().variable;
  const Eigen::Index rows = estimate.variable_count() * Pose::kDof;
  Eigen::MatrixXd coupling = Eigen::MatrixXd::Zero(rows, root_.size());
  Square information = Square::Zero();
  Bias gradient = Bias::Zero();
  direct_.reserve(prior.by_bias.size());
  for (std::size_t k = 0; k < prior.by_bias.size(); ++k) {
    const auto& step = graph.steps[k];
    const auto [r, by_a, by_b] = estimate.derivative(step);
    // log(exp(-J d) exp(r)) = r - J_l^-1(r) J d, with J_l(r) = J_r(-r).
    const ByBias<Pose> direct = -residual_jacobian<Pose>(-r) * prior.by_bias[k];
    const ByBias<Pose> weighed = step.information / scale * direct;
    information += direct.transpose() * weighed;
    gradient += weighed.transpose() * estimate.residual(step);
    const auto add = [&](Index node, const Matrix& by) {
      if (variable[node] < 0) return;
      coupling.middleRows(variable[node] * Pose::kDof, Pose::kDof) += by.transpose() * weighed;
    };
    add(step.a, by_a);
    add(step.b, by_b);
    direct_.push_back(direct);
  }
  moves_.resize(rows, root_.size());
  for (Eigen::Index d = 0; d < root_.size(); ++d) {
    moves_.col(d) = -estimate.factor().solve(coupling.col(d));
  }
  information += coupling.transpose() * moves_;
  const Square told = root_.asDiagonal() * information * root_.asDiagonal();
  precision_ = told + Square::Identity();
  likeliest_ = precision_.llt().solve(told * now_ - root_.cwiseProduct(gradient));
}

template <class Pose>
double BiasFit<Pose>::gain() const {
  const Bias change = likeliest_ - now_;
  return 0.5 * change.dot(precision_ * change);
}

template <class Pose>
double BiasFit<Pose>::log_evidence() const {
  return -0.5 * (now_.squaredNorm() + log_determinant(Eigen::LLT<Square>(precision_))) + gain();
}

// Of a residual, by poses that follow the bias.
template <class Pose>
ByBias<Pose> BiasFit<Pose>::moved(const Link<Pose>& link) const {
  const auto [r, by_a, by_b] = estimate_.derivative(link);
  const auto& variable = estimate_.gauge().variable;
  ByBias<Pose> by = ByBias<Pose>::Zero();
  const auto add = [&](Index node, const Matrix& by_pose) {
    if (variable[node] < 0) return;
    by += by_pose * moves_.middleRows(variable[node] * Pose::kDof, Pose::kDof);
  };
  add(link.a, by_a);
  add(link.b, by_b);
  return by;
}

template <class Pose>
Belief<Pose> BiasFit<Pose>::carried(const ByBias<Pose>& by) const {
  const ByBias<Pose> by_deviation = by * root_.asDiagonal();
  return {by_deviation * (likeliest_ - now_),
          by_deviation * precision_.llt().solve(by_deviation.transpose())};
}

template <class Pose>
Belief<Pose> BiasFit<Pose>::of_step(std::size_t step) const {
  ByBias<Pose> by = moved(graph_.steps[step]);
  if (step < direct_.size()) by += direct_[step];
  return carried(by);
}

template <class Pose>
typename BiasFit<Pose>::Bias BiasFit<Pose>::drawn(const Bias& deviations) const {
  return root_.cwiseProduct(precision_.llt().matrixU().solve(deviations));
}

template class BiasFit<Pose2>;
template class BiasFit<Pose3>;

}  // namespace isotherm::slam::detail
