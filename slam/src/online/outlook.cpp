#include "online/outlook.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include <Eigen/Cholesky>

#include "isotherm/slam/graph/information.hpp"
#include "prune/consensus/estimate/log_normal.hpp"
#include "prune/consensus/objective/loop_gain.hpp"
#include "prune/consensus/objective/own_frames.hpp"
#include "prune/consensus/pairs/loop_pair.hpp"

namespace isotherm::slam::detail {
namespace {

// Loops before a new one among which it can be a copy of one.
constexpr Index kRecent = 64;

template <class Pose>
typename Pose::Matrix scaled(const typename Pose::Matrix& covariance,
                             const typename Pose::Tangent& variances) {
  const typename Pose::Tangent deviations = variances.cwiseSqrt();
  return deviations.asDiagonal() * covariance * deviations.asDiagonal();
}

}  // namespace

template <class Pose>
Outlook<Pose>::Outlook(const EdgeLog<Pose>& log, const Snapshot<Pose>& map,
                       const ConsensusOptions& options)
    : log_(log),
      map_(map),
      window_(options.window),
      covariance_(map.assessment().estimate().factor()) {
  const auto& standings = map.best().standings;
  if (!standings.empty()) prior_ = standings.front().log_odds - standings.front().evidence;
}

// Back along the steps that came since, to a vertex of the map.
template <class Pose>
std::optional<typename Outlook<Pose>::Place> Outlook<Pose>::place(VertexId id) const {
  Place found;
  UncertainPose<Pose> since;
  const typename Pose::Tangent variances = map_.best().scale.odometry * map_.best().shapes.odometry;
  std::optional<typename Snapshot<Pose>::Anchor> anchor;
  while (true) {
    const auto vertex = map_.graph().find(id);
    if (vertex) anchor = map_.anchor(*vertex);
    if (anchor) {
      found.position = *vertex;
      break;
    }
    const auto* step = log_.step_to(id);
    if (step == nullptr) return std::nullopt;
    since = compose(step->path(variances), since);
    id = step->before;
    ++found.steps;
  }
  found.node = anchor->node;
  found.part = map_.best().layout.component[found.node];
  found.chain = map_.assessment().graph().chain[found.node];
  found.at = compose(anchor->path, since);
  return found;
}

// Along the steps that came since alone, where one vertex comes before the other there.
template <class Pose>
std::optional<UncertainPose<Pose>> Outlook<Pose>::tail(VertexId from, VertexId to) const {
  if (from > to) {
    auto back = tail(to, from);
    if (back) back = inverse(*back);
    return back;
  }
  const typename Pose::Tangent variances = map_.best().scale.odometry * map_.best().shapes.odometry;
  UncertainPose<Pose> path;
  while (to != from) {
    const auto* step = log_.step_to(to);
    if (map_.graph().find(to) || step == nullptr) return std::nullopt;
    path = compose(step->path(variances), path);
    to = step->before;
  }
  return path;
}

// d(T_a^-1 T_b) = -Ad(T_b_a) d_a + d_b, each of which is that of its node, carried along, and what
// the way from there adds.
template <class Pose>
UncertainPose<Pose> Outlook<Pose>::between(const Place& a, const Place& b) const {
  const auto& estimate = map_.assessment().estimate();
  const Pose T_nodes = estimate.poses()[a.node].inverse() * estimate.poses()[b.node];
  const Pose T_a_b = a.at.T.inverse() * T_nodes * b.at.T;
  const Matrix across = T_a_b.inverse().adjoint();
  const auto& variable = estimate.gauge().variable;
  std::array<typename spectral::BranchCovariance<Pose::kDof>::Term, 2> terms;
  terms[0].row = variable[a.node];
  terms[0].G = -(across * a.at.T.inverse().adjoint()).transpose();
  terms[1].row = variable[b.node];
  terms[1].G = b.at.T.inverse().adjoint().transpose();
  Matrix covariance = Matrix::Zero();
  if (a.node != b.node) covariance = covariance_.of(terms);
  return {T_a_b, covariance + across * a.at.covariance * across.transpose() + b.at.covariance};
}

template <class Pose>
Standing Outlook<Pose>::standing(Index edge) const {
  const auto& told = log_.edges()[edge];
  auto measured = told.measured;
  measured.from = 0;
  measured.to = 1;
  measured = in_own_frame(measured);
  const VertexId from = measured.from == 0 ? told.from : told.to;
  const VertexId to = measured.from == 0 ? told.to : told.from;
  const auto a = place(from);
  const auto b = place(to);
  auto path = tail(from, to);
  const auto& best = map_.best();
  const auto& assessment = map_.assessment();
  const Matrix Sigma = scaled<Pose>(covariance_from_information<Pose::kDof>(measured.information),
                                    best.shapes.loops);
  Standing standing{.parts = {0, 0}};
  double density = -map_.objective().log_volume();
  if (!path && a && b && a->part == b->part) path = between(*a, *b);
  if (path) {
    const typename Pose::Tangent r = (measured.T_from_to.inverse() * path->T).log();
    const auto gain =
        loop_gain<Pose>(predict<Pose>(r, path->covariance, Sigma), assessment.findings().mixture,
                        map_.objective().scale_deviation(best.redundancy));
    standing.chi2 = gain.chi2;
    density = gain.log_density;
  } else {
    standing.parts.second = 1;
  }
  const Place nowhere{.chain = -1};
  standing.evidence = density - log_alternative(edge, a ? *a : nowhere, b ? *b : nowhere, Sigma);
  standing.log_odds = standing.evidence + prior_;
  return standing;
}

template <class Pose>
double Outlook<Pose>::log_alternative(Index edge, const Place& a, const Place& b,
                                      const Matrix& Sigma) const {
  const auto& [from, to, measured, step] = log_.edges()[edge];
  const auto& found = map_.assessment().findings();
  const double scale = map_.best().scale.loops;
  if (is_copied(edge)) {
    const double log_sigma =
        log_determinant(Eigen::LLT<Matrix>(Sigma)) + Pose::kDof * std::log(scale);
    return log_copy_density<Pose>(log_sigma);
  }
  const Index apart = std::abs((a.position + a.steps) - (b.position + b.steps));
  const std::size_t group = a.chain == b.chain ? span_class(apart) : kSpanClasses;
  const Pose forward = from <= to ? measured.T_from_to : measured.T_from_to.inverse();
  return found.near[group] +
         map_.objective().nearness().log_false_density(forward, scale * map_.best().shapes.loops);
}

// Whether one of the loops just before it, with ends near its own, states the same.
template <class Pose>
bool Outlook<Pose>::is_copied(Index edge) const {
  const auto apart = [](VertexId a, VertexId b) { return a > b ? a - b : b - a; };
  const auto& own = log_.edges()[edge];
  Index seen = 0;
  for (Index k = edge - 1; k >= 0 && seen < kRecent; --k) {
    const auto& other = log_.edges()[k];
    if (other.step) continue;
    ++seen;
    const auto window = static_cast<VertexId>(window_);
    if (apart(other.from, own.from) > window || apart(other.to, own.to) > window) continue;
    if (measure_the_same(own.measured.T_from_to, other.measured.T_from_to)) return true;
  }
  return false;
}

template class Outlook<Pose2>;
template class Outlook<Pose3>;

}  // namespace isotherm::slam::detail
