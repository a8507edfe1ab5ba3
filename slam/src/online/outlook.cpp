#include "online/outlook.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "isotherm/slam/graph/information.hpp"
#include "matrices/decompositions.hpp"
#include "prune/consensus/estimate/log_normal.hpp"
#include "prune/consensus/objective/loop_gain.hpp"
#include "prune/consensus/objective/own_frames.hpp"
#include "prune/consensus/pairs/loop_pair.hpp"

namespace isotherm::slam::detail {
namespace {

// Loops before a new one among which it can be a copy of one.
constexpr Index kRecent = 64;

// Whether one is known better than the other.
template <class Pose>
bool is_closer(const UncertainPose<Pose>& one, const UncertainPose<Pose>& other) {
  return one.covariance.determinant() < other.covariance.determinant();
}

}  // namespace

template <class Pose>
Outlook<Pose>::Outlook(const EdgeLog<Pose>& log, const Snapshot<Pose>& map,
                       const ConsensusOptions& options)
    : log_(log),
      map_(map),
      window_(options.window),
      covariance_(map.assessment().estimate().factor()) {}

// Back along the steps that came since, to a vertex of the map or one that is known from there.
template <class Pose>
std::optional<typename Outlook<Pose>::Place> Outlook<Pose>::place(VertexId id) const {
  std::vector<VertexId> behind;
  auto found = known_place(id);
  while (!found) {
    const auto* step = log_.step_to(id);
    if (step == nullptr) return std::nullopt;
    behind.push_back(id);
    id = step->before;
    found = known_place(id);
  }
  const typename Pose::Tangent variances = map_.best().scale.odometry * map_.best().shapes.odometry;
  while (!behind.empty()) {
    found->at = compose(found->at, log_.step_to(behind.back())->path(variances));
    ++found->steps;
    places_.emplace(behind.back(), *found);
    behind.pop_back();
  }
  return found;
}

template <class Pose>
std::optional<typename Outlook<Pose>::Place> Outlook<Pose>::known_place(VertexId id) const {
  const auto known = places_.find(id);
  if (known != places_.end()) return known->second;
  const auto vertex = map_.graph().find(id);
  const auto anchor = vertex ? map_.anchor(*vertex) : std::nullopt;
  if (!anchor) return std::nullopt;
  return Place{.node = anchor->node,
               .part = map_.best().layout.component[anchor->node],
               .chain = map_.assessment().graph().chain[anchor->node],
               .position = *vertex,
               .at = anchor->path};
}

// Along steps alone, where one vertex comes before the other there, and where none between them
// need be on the map.
template <class Pose>
std::optional<UncertainPose<Pose>> Outlook<Pose>::steps(VertexId from, VertexId to,
                                                        bool on_map) const {
  if (from > to) {
    auto back = steps(to, from, on_map);
    if (back) back = inverse(*back);
    return back;
  }
  const typename Pose::Tangent variances = map_.best().scale.odometry * map_.best().shapes.odometry;
  UncertainPose<Pose> path;
  while (to > from) {
    const auto* step = log_.step_to(to);
    if (step == nullptr || (!on_map && map_.graph().find(to))) return std::nullopt;
    path = compose(step->path(variances), path);
    to = step->before;
  }
  if (to != from) return std::nullopt;
  return path;
}

// d(T_a^-1 T_b) = -Ad(T_b_a) d_a + d_b, each of which is that of its node, carried along, and what
// the way from there adds.
template <class Pose>
UncertainPose<Pose> Outlook<Pose>::between(const Place& a, const Place& b) const {
  const auto& estimate = map_.assessment().estimate();
  const Pose T_nodes = estimate.poses()[a.node].between(estimate.poses()[b.node]);
  const Pose T_a_b = a.at.T.between(T_nodes * b.at.T);
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

// Only the way from the map changes, not how many steps ago the map was left.
template <class Pose>
void Outlook<Pose>::follow(Index edge) {
  const auto loop = forward(edge);
  const auto from = place(loop.from);
  const auto to = place(loop.to);
  if (!from || !to || to->steps == 0) return;
  const auto at = compose(from->at, loop.measured);
  if (!is_closer(at, to->at)) return;
  Place& known = places_.at(loop.to);
  known.node = from->node;
  known.part = from->part;
  known.at = at;
}

template <class Pose>
Standing Outlook<Pose>::standing(Index edge) const {
  if (const auto loop = loop_of(edge)) return map_.best().standings[*loop];
  const Told loop = told(edge);
  const auto a = place(loop.from);
  const auto b = place(loop.to);
  auto path = steps(loop.from, loop.to, false);
  const auto& best = map_.best();
  const auto& assessment = map_.assessment();
  Standing standing{.parts = {0, 0}};
  double density = -map_.objective().log_volume();
  if (a && b && a->part == b->part) {
    const auto across = between(*a, *b);
    if (!path || is_closer(across, *path)) path = across;
  }
  if (path) {
    const typename Pose::Tangent r = loop.T_from_to.between(path->T).log();
    const Matrix J = residual_jacobian<Pose>(r);
    const Belief<Pose> others{r, J * path->covariance * J.transpose()};
    const auto gain =
        loop_gain<Pose>(others, {loop.learnt, loop.stated}, assessment.findings().mixture,
                        map_.objective().scale_deviation(best.redundancy));
    standing.chi2 = gain.chi2;
    density = gain.log_density;
    if (!is_copied(edge)) {
      const Matrix Omega = gain.weight.learnt / best.scale.loops * loop.learnt.inverse() +
                           gain.weight.stated * loop.information;
      density += map_.objective().near_density().log_nearer(
          loop.T_from_to, residual_with(others, Omega), loop.from <= loop.to);
    }
  } else {
    standing.parts.second = 1;
  }
  standing.evidence = density - log_alternative(edge);
  standing.log_odds = standing.evidence + prior();
  return standing;
}

template <class Pose>
double Outlook<Pose>::chi2_at_even_odds(Index edge) const {
  const Matrix Sigma = map_.best().scale.loops * told(edge).learnt;
  const double density = log_normal<Pose>(Pose::Tangent::Zero(), Sigma);
  return std::max(2.0 * (density - log_alternative(edge) + prior()), 0.0);
}

template <class Pose>
typename Outlook<Pose>::Told Outlook<Pose>::told(Index edge) const {
  const auto& [from, to, measured, step] = log_.edges()[edge];
  auto known = measured;
  known.from = 0;
  known.to = 1;
  known = in_own_frame(known);
  const bool turned = known.from != 0;
  const Matrix stated = covariance_from_information<Pose::kDof>(known.information);
  const typename Pose::Tangent root = map_.best().shapes.loops.cwiseSqrt();
  return {turned ? to : from,
          turned ? from : to,
          known.T_from_to,
          known.information,
          stated,
          root.asDiagonal() * stated * root.asDiagonal()};
}

// The density that the loop's is held against.
template <class Pose>
double Outlook<Pose>::log_alternative(Index edge) const {
  if (const auto loop = loop_of(edge)) {
    return map_.assessment().log_alternative(static_cast<Index>(*loop));
  }
  const auto& own = log_.edges()[edge];
  const Place nowhere{.chain = -1};
  const Place a = place(own.from).value_or(nowhere);
  const Place b = place(own.to).value_or(nowhere);
  const Index apart = std::abs((a.position + a.steps) - (b.position + b.steps));
  const std::size_t group = a.chain == b.chain ? span_class(apart) : kSpanClasses;
  const double by_chance = map_.assessment().findings().near[group];
  if (!is_copied(edge)) return by_chance;
  const Matrix Sigma = map_.best().scale.loops * told(edge).learnt;
  return log_copy_density<Pose>(log_determinant(Eigen::LLT<Matrix>(Sigma)), by_chance);
}

// Its place among the loops of the snapshot, if that judged it.
template <class Pose>
std::optional<std::size_t> Outlook<Pose>::loop_of(Index edge) const {
  const auto& loops = map_.loops();
  const auto found = std::ranges::lower_bound(loops, edge);
  if (found == loops.end() || *found != edge) return std::nullopt;
  return static_cast<std::size_t>(found - loops.begin());
}

// Not a repeat, and not accepted.
template <class Pose>
bool Outlook<Pose>::is_open(Index edge) const {
  if (edge < map_.graph().constraint_count()) {
    const auto loop = loop_of(edge);
    return loop && !map_.best().accepted[*loop];
  }
  const auto& other = log_.edges()[edge];
  return other.from != other.to && !log_.repeated_by(other);
}

// The loops just before it whose ends are near its own.
template <class Pose>
template <class Visit>
void Outlook<Pose>::for_each_near(Index edge, const Visit& visit) const {
  const auto near = [this](VertexId a, VertexId b) {
    return (a > b ? a - b : b - a) <= static_cast<VertexId>(window_);
  };
  const auto& own = log_.edges()[edge];
  const auto [first, last] = std::minmax(own.from, own.to);
  Index seen = 0;
  for (Index k = edge - 1; k >= 0 && seen < kRecent; --k) {
    const auto& other = log_.edges()[k];
    if (other.step) continue;
    ++seen;
    const auto [other_first, other_last] = std::minmax(other.from, other.to);
    if (near(first, other_first) && near(last, other_last)) visit(k);
  }
}

template <class Pose>
bool Outlook<Pose>::is_copied(Index edge) const {
  const auto& own = log_.edges()[edge];
  bool copied = false;
  for_each_near(edge, [&](Index k) {
    const auto& other = log_.edges()[k];
    const bool turned = (own.from < own.to) != (other.from < other.to);
    const Pose T = turned ? other.measured.T_from_to.inverse() : other.measured.T_from_to;
    copied = copied || measure_the_same(own.measured.T_from_to, T);
  });
  return copied;
}

template <class Pose>
typename Outlook<Pose>::Forward Outlook<Pose>::forward(Index edge) const {
  const Told loop = told(edge);
  const UncertainPose<Pose> pose{loop.T_from_to, map_.best().scale.loops * loop.learnt};
  if (loop.from <= loop.to) return {loop.from, loop.to, pose};
  return {loop.to, loop.from, inverse(pose)};
}

// Of the other's measurement, as the known one and the odometry between their ends predict it.
template <class Pose>
std::optional<double> Outlook<Pose>::log_density(const Forward& known, const Forward& other) const {
  const auto before = steps(other.from, known.from, true);
  const auto after = steps(known.to, other.to, true);
  if (!before || !after) return std::nullopt;
  const auto predicted = compose(compose(*before, known.measured), *after);
  const typename Pose::Tangent r = other.measured.T.between(predicted.T).log();
  const Matrix J = residual_jacobian<Pose>(r);
  return log_normal<Pose>(r, other.measured.covariance + J * predicted.covariance * J.transpose());
}

template <class Pose>
std::optional<typename Outlook<Pose>::Lead> Outlook<Pose>::lead(Index edge) const {
  const Forward own = forward(edge);
  std::optional<Index> nearest;
  VertexId least = 0;
  for_each_near(edge, [&](Index k) {
    if (!is_open(k)) return;
    const auto& other = log_.edges()[k];
    const auto [first, last] = std::minmax(other.from, other.to);
    const auto apart = [](VertexId a, VertexId b) { return a > b ? a - b : b - a; };
    const VertexId distance = apart(first, own.from) + apart(last, own.to);
    if (nearest && distance >= least) return;
    nearest = k;
    least = distance;
  });
  if (!nearest) return std::nullopt;
  const auto density = log_density(forward(*nearest), own);
  if (!density) return std::nullopt;
  return Lead{*nearest, *density - log_alternative(edge)};
}

template class Outlook<Pose2>;
template class Outlook<Pose3>;

}  // namespace isotherm::slam::detail
