#include "online/snapshot.hpp"

#include <algorithm>
#include <cstdlib>
#include <memory>

#include <Eigen/Cholesky>

#include "graph/candidate_verdicts.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/slam/graph/usable_odometry.hpp"
#include "prune/consensus/climb/report.hpp"
#include "prune/consensus/climb/starts.hpp"
#include "prune/consensus/judge.hpp"

namespace isotherm::slam::detail {
namespace {

// Times as many edges until the density of near pairs is found anew.
constexpr double kGrown = 1.1;

}  // namespace

template <class Pose>
Snapshot<Pose>::Snapshot(PoseGraph<Pose> graph, const ConsensusOptions& options)
    : graph_(std::move(graph)), options_(options) {}

// The same as prune() does before it judges.
template <class Pose>
void Snapshot<Pose>::prepare(const Pace& pace) {
  roles_ = edge_roles(graph_);
  set_aside_.emplace(graph_, roles_);
  verdicts_.verdicts = candidate_verdicts(graph_, roles_);
  if (roles_.candidates.empty() || !has_information(graph_, roles_)) return;
  const auto unusable = unusable_information(graph_, roles_);
  if (!unusable.empty()) graph_ = with_usable_information(graph_, roles_, unusable);
  objective_.emplace(graph_, roles_, options_.window, options_.calibrate);
  climb_.emplace(*objective_, options_, no_progress_, pace);
  pace(2.0 * static_cast<double>(graph_.constraints.size()));
}

template <class Pose>
void Snapshot<Pose>::explain(const std::vector<const Snapshot*>& others, bool everywhere,
                             const Pace& pace) {
  prepare([this, pace](double work) {
    work_ += work;
    pace(work);
  });
  if (!explained()) return judge();
  nearness_of_ = graph_.constraints.size();
  climb_->hold_nearness(true);
  const double prepared = work_;
  for (const Snapshot* other : others) {
    if (other->explained()) add(go_on_from(*other, everywhere));
  }
  if (everywhere || !found_) climb_from_nothing(everywhere);
  batch_work_.growing += prepared;
  climb_->hold_nearness(false);
  climb_->stand_at(best_);
  judge();
}

// As the batch does, which finds the density of near pairs at every assessment.
template <class Pose>
void Snapshot<Pose>::climb_from_nothing(bool everywhere) {
  const double before = work_;
  const auto nearness_before = assessment().nearness_found();
  add(everywhere ? climb_->nothing() : climb_->from({}));
  const auto climb_from = [this](const CovarianceScale& start) {
    const bool better = add(climb_->from(start));
    surpassed_ = surpassed_ || better;
  };
  if (everywhere) climb_from_each_start(options_.calibrate, climb_from);
  const auto& nearness = assessment().nearness_found();
  const double done = (nearness.times - nearness_before.times) * nearness.kWork;
  batch_work_ = {(nearness.assessments - nearness_before.assessments) * nearness.kWork,
                 work_ - before - done};
}

// Whether it is the best so far.
template <class Pose>
bool Snapshot<Pose>::add(const Explanation<Pose>& next) {
  const bool better = !found_ || next.evidence > best_.evidence;
  if (better) best_ = next;
  found_ = true;
  return better;
}

// What is near by chance is that of the other while edges are about the same.
template <class Pose>
Explanation<Pose> Snapshot<Pose>::go_on_from(const Snapshot& other, bool everywhere) {
  auto [standpoint, findings] = carry(other);
  const bool about_the_same = static_cast<double>(graph_.constraints.size()) <
                              kGrown * static_cast<double>(other.nearness_of_);
  if (about_the_same && !everywhere) {
    nearness_of_ = other.nearness_of_;
  } else {
    findings.near_of.reset();
  }
  return climb_->resume(std::move(standpoint), std::move(findings));
}

// Of loops that came since, none is accepted; scales and weights are those that were learnt.
template <class Pose>
typename Snapshot<Pose>::Standpoint Snapshot<Pose>::carry(const Snapshot& other) const {
  const auto& before = other.best_;
  const auto& known = other.assessment().findings();
  Explanation<Pose> now{.scale = before.scale, .shapes = before.shapes, .shares = before.shares};
  now.redundancy = before.redundancy;
  typename Assessment<Pose>::Findings found{.shapes = before.shapes};
  found.graph = std::make_shared<ScaledGraph<Pose>>(
      before.shapes == Shapes<Pose>{} ? objective_->stated() : objective_->scaled(before.shapes));
  found.mixture = known.mixture;
  found.near = known.near;
  found.near_of = known.near_of;
  found.held_scale = before.scale.odometry;
  for (std::size_t k = 0; k < roles_.candidates.size(); ++k) {
    const auto at = std::ranges::lower_bound(other.roles_.candidates, roles_.candidates[k]);
    const bool old = at != other.roles_.candidates.end() && *at == roles_.candidates[k];
    const auto j = static_cast<std::size_t>(at - other.roles_.candidates.begin());
    now.accepted.push_back(old && before.accepted[j]);
    now.weights.push_back(old ? before.weights[j] : 1.0);
    found.held.push_back(old ? known.held[j] : 0.0);
    found.covariances.push_back(old ? known.covariances[j]
                                    : Pose::Matrix::Zero());  // not known yet
  }
  carry_layout(other, now.layout);
  return {std::move(now), std::move(found)};
}

// Poses that the other has not follow odometry from those it has.
template <class Pose>
void Snapshot<Pose>::carry_layout(const Snapshot& other,
                                  typename Estimate<Pose>::Layout& layout) const {
  const auto& reduced = objective_->stated().reduced;
  const auto& before = other.best_.layout;
  const Index count = reduced.node_count();
  layout.poses = reduced.poses;
  layout.component.assign(count, -1);
  for (Index a = 0; a < count; ++a) {
    const auto vertex = other.graph_.find(graph_.ids[reduced.vertex[a]]);
    const auto anchor = vertex ? other.anchor(*vertex) : std::nullopt;
    if (!anchor) continue;
    layout.poses[a] = before.poses[anchor->node] * anchor->path.T;
    layout.component[a] = before.component[anchor->node];
  }
  const auto follow = [&](Index a, Index neighbour) {
    if (layout.component[a] >= 0 || layout.component[neighbour] < 0) return;
    if (reduced.chain[a] != reduced.chain[neighbour]) return;
    const auto path = reduced.odometry.relative(reduced.vertex[neighbour], reduced.vertex[a]);
    layout.poses[a] = layout.poses[neighbour] * path.T;
    layout.component[a] = layout.component[neighbour];
  };
  for (Index a = 1; a < count; ++a) follow(a, a - 1);
  for (Index a = count - 1; a > 0; --a) follow(a - 1, a);
  const auto parts = before.component;
  const Index first_new = parts.empty() ? 0 : 1 + *std::ranges::max_element(parts);
  for (Index a = 0; a < count; ++a) {
    if (layout.component[a] < 0) layout.component[a] = first_new + reduced.chain[a];
  }
}

template <class Pose>
std::optional<typename Snapshot<Pose>::Anchor> Snapshot<Pose>::anchor(Index vertex) const {
  if (!explained()) return std::nullopt;
  const auto& reduced = assessment().graph();
  const auto after = std::ranges::lower_bound(reduced.vertex, vertex) - reduced.vertex.begin();
  std::optional<Anchor> nearest;
  Index steps = 0;
  for (const auto node : {static_cast<Index>(after) - 1, static_cast<Index>(after)}) {
    if (node < 0 || node >= reduced.node_count()) continue;
    if (reduced.chain[node] != reduced.odometry.chain(vertex)) continue;
    const Index apart = std::abs(reduced.vertex[node] - vertex);
    if (nearest && apart >= steps) continue;
    steps = apart;
    nearest = Anchor{node, reduced.odometry.relative(reduced.vertex[node], vertex)};
  }
  if (nearest) nearest->path.covariance *= best_.scale.odometry;
  return nearest;
}

// Between two nodes, the error that odometry has there is spread along it by its covariance.
template <class Pose>
std::optional<Pose> Snapshot<Pose>::pose(Index vertex) const {
  const auto nearest = anchor(vertex);
  if (!nearest) return std::nullopt;
  const auto& reduced = assessment().graph();
  const auto& poses = best_.layout.poses;
  const auto b = std::ranges::lower_bound(reduced.vertex, vertex) - reduced.vertex.begin();
  const bool inside = b > 0 && b < reduced.node_count() && reduced.chain[b - 1] == reduced.chain[b];
  if (!inside || reduced.vertex[b] == vertex) return poses[nearest->node] * nearest->path.T;
  const Index first = reduced.vertex[b - 1];
  const auto part = reduced.odometry.relative(first, vertex);
  const auto whole = reduced.odometry.relative(first, reduced.vertex[b]);
  const auto in_first = [](const UncertainPose<Pose>& path) {
    const typename Pose::Matrix carry = path.T.adjoint();
    return (carry * path.covariance * carry.transpose()).eval();
  };
  const typename Pose::Tangent error = ((poses[b - 1] * whole.T).inverse() * poses[b]).log();
  const typename Pose::Tangent share =
      in_first(part) * in_first(whole).ldlt().solve(whole.T.adjoint() * error);
  return poses[b - 1] * Pose::exp(share) * part.T;
}

template <class Pose>
void Snapshot<Pose>::judge() {
  if (explained()) {
    verdicts_.consensus.verdicts = std::move(verdicts_.verdicts);
    report(std::vector<Explanation<Pose>>{best_}, options_.significance, verdicts_.consensus);
    verdicts_.verdicts = std::move(verdicts_.consensus.verdicts);
  } else {
    for (auto& row : verdicts_.verdicts) {
      row.verdict = spectral::Verdict::ambiguous;
      row.stage = "waiting";
    }
  }
  set_aside_->return_to(verdicts_);
}

template class Snapshot<Pose2>;
template class Snapshot<Pose3>;

}  // namespace isotherm::slam::detail
