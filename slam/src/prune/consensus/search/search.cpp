#include "prune/consensus/search/search.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <span>

#include "prune/consensus/log_odds.hpp"
#include "prune/consensus/search/report.hpp"
#include "prune/consensus/search/sample.hpp"
#include "prune/consensus/search/starts.hpp"

namespace isotherm::slam::detail {
namespace {

// Best first. One at about the scale of a better one that keeps the same loops is the same peak.
template <class Pose>
void keep_peaks(std::vector<Explanation<Pose>>& found) {
  std::ranges::stable_sort(found, std::greater{}, &Explanation<Pose>::evidence);
  std::vector<Explanation<Pose>> peaks;
  for (auto& one : found) {
    const bool same = std::ranges::any_of(peaks, [&](const auto& better) {
      return better.accepted == one.accepted && about_the_same(better.scale, one.scale);
    });
    if (!same) peaks.push_back(std::move(one));
  }
  found = std::move(peaks);
}

// Evidence of what is not so much worse than the best of these that it changes no probability.
template <class Pose>
double least_that_tells(const std::vector<Explanation<Pose>>& found) {
  return found.empty() ? -std::numeric_limits<double>::infinity()
                       : best_of(found).evidence - kNoDigit;
}

// As numbers of a sample say which loops of all those are.
KnownBefore known_of(const std::vector<Index>& sampled, std::size_t all) {
  KnownBefore known{.loops = {}, .vertex = [](Index vertex) { return std::optional(vertex); }};
  known.loops.resize(all);
  for (std::size_t k = 0; k < sampled.size(); ++k) known.loops[sampled[k]] = static_cast<Index>(k);
  return known;
}

// None of few loops.
template <class Pose>
std::vector<Index> sample_of(const Climb<Pose>& climb, bool soon) {
  const auto& all = climb.objective().stated().reduced;
  const std::size_t every = soon ? sampled_at_most(all.loops.size()) : kBatchGrowth;
  return sample(all, climb.options().window, every);
}

// Where the climbs on a sample of the loops ended; none where few are true, which tells nothing of
// scales.
template <class Pose>
std::vector<Standpoint<Pose>> standpoints(const Climb<Pose>& whole,
                                          const std::vector<Index>& sampled, SearchDepth depth) {
  const Objective<Pose>& objective = whole.objective();
  const auto& all = objective.stated().reduced;
  std::vector<Standpoint<Pose>> standpoints;
  if (sampled.empty()) return standpoints;
  const Objective<Pose> part = objective.of(sampled);
  Climb<Pose> climb = whole.on(part);
  depth.of_sample = true;
  const auto found = search(climb, depth);
  if (!can_refute(found.front().accepted_count())) return standpoints;
  const double least = found.front().evidence - log_odds_of(1.0 - whole.options().significance);
  const KnownBefore known = known_of(sampled, all.loops.size());
  const auto carry_over = [&](const auto& peak) {
    climb.stand_at(peak);
    standpoints.push_back(carry(peak, climb.assessment().findings(), objective, known));
  };
  for (const auto& peak : found) {
    if (peak.evidence >= least) unless_it_breaks_down(carry_over, peak);
  }
  return standpoints;
}

// Whether nothing was found that is likelier than that no loop is true.
template <class Pose>
bool is_astray(Climb<Pose>& climb, const std::vector<Explanation<Pose>>& found) {
  if (found.empty()) return true;
  const auto* none = climb.nothing(least_that_tells(found));
  return none && std::ranges::all_of(
                     found, [&](const auto& peak) { return peak.evidence <= none->evidence; });
}

// The best that was found, for the same loops.
template <class Pose>
void refine(Climb<Pose>& climb, std::vector<Explanation<Pose>>& found) {
  const auto learn = [&](const auto& best) { found.push_back(climb.refined(best)); };
  unless_it_breaks_down(learn, best_of(found));
}

// The loops of the best that was found, explained anew.
template <class Pose>
void settle_anew(const Climb<Pose>& climb, std::vector<Explanation<Pose>>& found) {
  if (!best_of(found).tells_of_scales()) return;
  Climb<Pose> afresh = climb.on(climb.objective());
  settle_on(afresh, best_of(found).accepted, found);
}

// The best that was found with slips of odometry that it hides, and what speaks for others.
template <class Pose>
void try_slips(Climb<Pose>& climb, std::vector<Explanation<Pose>>& found) {
  const auto slip = [&](const auto& best) { found.push_back(climb.slipping(best)); };
  unless_it_breaks_down(slip, best_of(found));
  found.insert(found.end(), climb.doubted().begin(), climb.doubted().end());
}

// That all loops are true: each that is rejected may be refuted without the others alone.
template <class Pose>
void weigh_all(Climb<Pose>& climb, std::vector<Explanation<Pose>>& found) {
  if (best_of(found).accepts_all()) return;
  const double least = least_that_tells(found);
  const auto accept = [&](const auto& best) { found.push_back(climb.all_true(best, least)); };
  unless_it_breaks_down(accept, best_of(found));
}

}  // namespace

template <class Pose>
std::vector<Explanation<Pose>> search(Climb<Pose>& climb, SearchDepth depth) {
  const bool calibrate = climb.options().calibrate;
  const std::vector<Index> sampled = sample_of(climb, depth.sample_soon);
  const bool at_once = sampled.empty();
  const bool to_the_last = at_once && depth.to_the_last;
  climb.look_afar(at_once);
  climb.go_to_the_last(to_the_last);
  std::vector<Explanation<Pose>> found;
  const auto all_explained = [&] { return !found.empty() && climb.explains_all(best_of(found)); };
  const auto try_from = [&](const auto&... start) {
    if (!all_explained()) found.push_back(climb.from(start...));
  };
  for (const auto& standpoint : standpoints(climb, sampled, depth)) {
    unless_it_breaks_down(try_from, standpoint);
  }
  const auto astray = [&] { return is_astray(climb, found); };
  const auto try_start = [&](const StartScales& start) {
    const auto climb_from = [&](bool known) { try_from(start, known); };
    if (start.known) unless_it_breaks_down(climb_from, true);
    if (start.unknown) unless_it_breaks_down(climb_from, false);
  };
  if (astray()) climb_from_each_start(calibrate, try_start);
  if (calibrate && !astray()) {
    const bool enough = depth.of_sample && climb.is_decided(best_of(found));
    if (!all_explained() && !enough) {
      try_slips(climb, found);
      if (at_once) settle_anew(climb, found);
    }
    refine(climb, found);
    if (at_once) weigh_all(climb, found);
  }
  for (const StartScales& start : std::span(kStarts).subspan(kStartsAlways)) {
    if (!calibrate || !astray()) break;
    try_start(start);
  }
  if (const auto* none = climb.nothing(least_that_tells(found))) found.push_back(*none);
  keep_peaks(found);
  return found;
}

template std::vector<Explanation<Pose2>> search(Climb<Pose2>&, SearchDepth);
template std::vector<Explanation<Pose3>> search(Climb<Pose3>&, SearchDepth);

}  // namespace isotherm::slam::detail
