#include "prune/set_aside.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "graph/candidate_verdicts.hpp"
#include "isotherm/base/words.hpp"
#include "isotherm/slam/graph/repeats.hpp"

namespace isotherm::slam::detail {
namespace {

using spectral::EdgeVerdict;
using spectral::EdgeVerdicts;

// Where a candidate's row and details come from: among those that were judged, or nowhere.
constexpr Index kNowhere = -1;

template <class Detail>
void spread(const std::vector<Index>& sources, std::vector<Detail>& details) {
  if (details.empty()) return;
  std::vector<Detail> all(sources.size());
  for (std::size_t k = 0; k < sources.size(); ++k) {
    if (sources[k] != kNowhere) all[k] = details[sources[k]];
  }
  details = std::move(all);
}

Index position_of(const EdgeVerdicts& rows, std::int64_t edge) {
  const auto found = std::lower_bound(
      rows.begin(), rows.end(), edge,
      [](const EdgeVerdict& row, std::int64_t wanted) { return row.edge < wanted; });
  return static_cast<Index>(found - rows.begin());
}

}  // namespace

template <class Pose>
SetAside::SetAside(const PoseGraph<Pose>& graph, EdgeRoles& roles) {
  take_self_edges(graph, roles);
  take_repeats(graph, roles);
  std::sort(rows_.begin(), rows_.end(),
            [](const Row& a, const Row& b) { return a.verdict.edge < b.verdict.edge; });
}

template <class Pose>
void SetAside::take_self_edges(const PoseGraph<Pose>& graph, EdgeRoles& roles) {
  EdgeRoles own;
  std::erase_if(roles.candidates, [&](Index k) {
    const bool joins_itself = graph.constraints[k].from == graph.constraints[k].to;
    if (joins_itself) own.candidates.push_back(k);
    return joins_itself;
  });
  self_edges_ = own.candidates.size();
  for (auto& row : candidate_verdicts(graph, own)) {
    row.verdict = spectral::Verdict::ambiguous;
    row.stage = "self-edge";
    rows_.push_back({std::move(row)});
  }
}

// Of edges that say the same, odometry stands for all, or else the first.
template <class Pose>
void SetAside::take_repeats(const PoseGraph<Pose>& graph, EdgeRoles& roles) {
  const auto repeats = exact_repeats(graph);
  if (repeats.empty()) return;
  std::vector<Index> original(graph.constraints.size());
  for (Index k = 0; k < graph.constraint_count(); ++k) original[k] = k;
  for (const auto& repeat : repeats) original[repeat.edge] = repeat.original;
  std::vector<Index> stands(graph.constraints.size(), kNowhere);  // for those of one original
  std::vector<bool> trusted(graph.constraints.size(), false);
  const auto is_repeat = [&](Index k) {
    Index& first = stands[original[k]];
    if (first == kNowhere) first = k;
    return first != k;
  };
  for (const Index k : roles.odometry) trusted[k] = true;
  repeats_ = std::erase_if(roles.odometry, is_repeat);
  EdgeRoles own;
  std::erase_if(roles.candidates, [&](Index k) {
    const bool repeat = is_repeat(k);
    if (repeat) own.candidates.push_back(k);
    return repeat;
  });
  repeats_ += own.candidates.size();
  for (auto& row : candidate_verdicts(graph, own)) {
    const Index first = stands[original[row.edge]];
    row.stage = "repeat";
    rows_.push_back({std::move(row), trusted[first] ? kNowhere : first});
  }
}

void SetAside::warn(PruneResult& result) const {
  if (self_edges_ > 0) {
    result.warnings.push_back(counted(self_edges_, "edge joins", "edges join") +
                              " a vertex with itself; set aside");
  }
  if (repeats_ > 0) {
    result.warnings.push_back(counted(repeats_, "edge repeats", "edges repeat") +
                              " another one to the last digit; counted once");
  }
}

EdgeVerdict SetAside::verdict_of(const Row& row, const EdgeVerdict* original) {
  EdgeVerdict verdict = row.verdict;
  if (original == nullptr) return verdict;
  verdict.verdict = original->verdict;
  verdict.score = original->score;
  verdict.threshold = original->threshold;
  verdict.probability = original->probability;
  return verdict;
}

void SetAside::return_to(PruneResult& result) const {
  warn(result);
  if (rows_.empty()) return;
  EdgeVerdicts all;
  std::vector<Index> sources;
  std::vector<Index> place;  // of those that were judged, among all
  auto own = rows_.begin();
  const auto add_own_before = [&](std::int64_t edge) {
    for (; own != rows_.end() && own->verdict.edge < edge; ++own) {
      const Index source =
          own->original < 0 ? kNowhere : position_of(result.verdicts, own->original);
      all.push_back(verdict_of(*own, source == kNowhere ? nullptr : &result.verdicts[source]));
      sources.push_back(source);
    }
  };
  for (const auto& judged : result.verdicts) {
    add_own_before(judged.edge);
    sources.push_back(static_cast<Index>(place.size()));
    place.push_back(static_cast<Index>(all.size()));
    all.push_back(judged);
  }
  add_own_before(std::numeric_limits<std::int64_t>::max());
  result.verdicts = std::move(all);
  for (auto& detail : result.consensus.details) {
    for (Index& conflict : detail.conflicts) conflict = place[conflict];
  }
  spread(sources, result.consensus.details);
}

template SetAside::SetAside(const PoseGraph<Pose2>&, EdgeRoles&);
template SetAside::SetAside(const PoseGraph<Pose3>&, EdgeRoles&);

}  // namespace isotherm::slam::detail
