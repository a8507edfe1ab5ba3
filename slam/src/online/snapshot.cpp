#include "online/snapshot.hpp"

#include <algorithm>

#include "graph/candidate_verdicts.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/slam/graph/usable_odometry.hpp"
#include "prune/consensus/judge.hpp"
#include "prune/consensus/search/report.hpp"
#include "prune/consensus/search/sample.hpp"
#include "prune/consensus/search/search.hpp"

namespace isotherm::slam::detail {
namespace {

// Times as many edges until the density of near pairs is found anew.
constexpr double kGrown = 1.1;

// Work of a batch on so few loops that a sample of them is none, in times of that of its climbs
// from every start: it settles anew what these found (CSAIL 2.7, intel 4.5, measured). On more a
// search by a sample takes about as long as the batch will on the many that it has then.
constexpr double kToTheLast = 3.0;

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
  climb_.emplace(*objective_, options_, RunContext{.threads = 1}, pace);
  pace(2.0 * static_cast<double>(graph_.constraints.size()));
}

template <class Pose>
void Snapshot<Pose>::explain(const std::vector<const Snapshot*>& others, bool everywhere,
                             const Pace& pace) {
  const Pace counted = [this, pace](double work) {
    work_ += work;
    pace(work);
  };
  prepare(counted);
  if (!explained()) return judge();
  nearness_of_ = graph_.constraints.size();
  climb_->hold_nearness(true);
  const double prepared = work_;
  for (const Snapshot* other : others) {
    if (other->explained()) add(go_on_from(*other, everywhere));
  }
  if (everywhere || !found_) climb_from_nothing(everywhere);
  search_work_.growing += prepared;
  climb_->hold_nearness(false);
  climb_->stand_at(best_);
  judge();
}

// As the batch does, which finds the density of near pairs at every assessment, but not to the last
// nats.
template <class Pose>
void Snapshot<Pose>::climb_from_nothing(bool everywhere) {
  const double before = work_;
  const auto nearness_before = assessment().nearness_found();
  if (everywhere) {
    for (const auto& peak : search(*climb_, {.to_the_last = false, .sample_soon = true})) {
      surpassed_ = add(peak) || surpassed_;
    }
  } else {
    add(climb_->from(kStarts.front(), true));
  }
  const auto& nearness = assessment().nearness_found();
  const double done = (nearness.times - nearness_before.times) * nearness.kWork;
  search_work_ = {(nearness.assessments - nearness_before.assessments) * nearness.kWork,
                  work_ - before - done};
}

template <class Pose>
double Snapshot<Pose>::searches_a_batch_takes() const {
  return sampled_at_most(roles_.candidates.size()) < 2 ? kToTheLast : 1.0;
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
  auto standpoint = carry(other);
  const bool about_the_same = static_cast<double>(graph_.constraints.size()) <
                              kGrown * static_cast<double>(other.nearness_of_);
  if (about_the_same && !everywhere) {
    nearness_of_ = other.nearness_of_;
    standpoint.found.near = other.assessment().findings().near;
    standpoint.found.near_of = other.assessment().findings().near_of;
  }
  return climb_->resume(std::move(standpoint));
}

template <class Pose>
Standpoint<Pose> Snapshot<Pose>::carry(const Snapshot& other) const {
  KnownBefore known{.loops = {},
                    .vertex = [&](Index vertex) { return other.graph_.find(graph_.ids[vertex]); }};
  const auto& before = other.roles_.candidates;
  for (const Index edge : roles_.candidates) {
    const auto at = std::ranges::lower_bound(before, edge);
    known.loops.emplace_back();
    if (at != before.end() && *at == edge)
      known.loops.back() = static_cast<Index>(at - before.begin());
  }
  return detail::carry(other.best_, other.assessment().findings(), *objective_, known);
}

template <class Pose>
std::optional<Anchor<Pose>> Snapshot<Pose>::anchor(Index vertex) const {
  if (!explained()) return std::nullopt;
  auto nearest = nearest_node(assessment().graph(), vertex);
  if (nearest) nearest->path.covariance *= best_.scale.odometry;
  return nearest;
}

template <class Pose>
std::optional<Pose> Snapshot<Pose>::pose(Index vertex) const {
  if (!explained()) return std::nullopt;
  return pose_of(assessment().graph(), best_.layout.poses, vertex);
}

template <class Pose>
void Snapshot<Pose>::judge() {
  if (explained()) {
    refutes_ = can_refute(best_.accepted_count());
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
