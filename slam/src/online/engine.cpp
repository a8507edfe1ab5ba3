#include "online/engine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/base/statistics.hpp"
#include "online/present_map.hpp"
#include "prune/consensus/constants.hpp"
#include "prune/consensus/log_odds.hpp"
#include "prune/consensus/search/report.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// Searches from every start begin where one of the loops can be pruned. Where effort allows it
// there is another one for at least twice as many loops, or for any more when none come; and in any
// case for eight times as many, of which the last one says little. Each is done by the time that
// there are a twentieth more edges, so that it is of the map that is there; of so few loops, as
// soon as it can be.
constexpr Index kFirst = kFewLoops;
constexpr Index kGrowth = 2;
constexpr Index kMostGrowth = 8;
constexpr double kUntil = 0.05;
constexpr Index kFew = 32;

// Of all work, what following up may do at most.
constexpr double kFollowing = 1.0 / 3.0;

// What a call may do: about one solution of the map, of so many factorisations, and of a small one
// some 20 ms.
constexpr double kFactorisations = 3.0;
constexpr double kLeastWork = 1e4;

double most_work(std::size_t edges) {
  return std::max(kFactorisations * static_cast<double>(edges), kLeastWork);
}

}  // namespace

template <class Pose>
OnlineEngine<Pose>::OnlineEngine(const OnlineOptions& options, RunContext run)
    : options_(options), run_(std::move(run)) {}

template <class Pose>
std::vector<LoopChange> OnlineEngine<Pose>::add(VertexId from, VertexId to, const Pose& T_from_to,
                                                const Matrix& information, LinkKind link) {
  add_silently(from, to, T_from_to, information, link);
  const auto edge = static_cast<Index>(rows_.size()) - 1;
  if (!log_.edges().back().step) judge(edge);
  go_on();
  return changes();
}

template <class Pose>
void OnlineEngine<Pose>::add_silently(VertexId from, VertexId to, const Pose& T_from_to,
                                      const Matrix& information, LinkKind link) {
  const bool step = log_.add(from, to, T_from_to, information, link).step;
  rows_.emplace_back();
  finished_ = false;
  if (step) return;
  ++loops_;
  last_loop_ = static_cast<Index>(rows_.size()) - 1;
}

template <class Pose>
void OnlineEngine<Pose>::ask_to_go_on() const {
  if (!run_.progress) return;
  const auto edges = static_cast<std::uint64_t>(rows_.size());
  if (!run_.progress({"online", edges, 0})) throw Cancelled();
}

template <class Pose>
void OnlineEngine<Pose>::go_on() {
  ask_to_go_on();
  if (loops_ == 0) return;
  const auto work = most_work(rows_.size());
  const bool few = searched_ <= kFew;
  const double until = search_work(loops_) / (kUntil * static_cast<double>(rows_.size()));
  search_everywhere(!map_ ? kNoLimit : few ? work : std::min(work, until));
  follow_up(work);
}

// Of one search from every start on so many loops: as many pieces as in the last one, with as many
// more links in each as there are more loops.
template <class Pose>
double OnlineEngine<Pose>::search_work(Index loops) const {
  const double growth = static_cast<double>(loops) / static_cast<double>(search_of_);
  return search_work_.constant + search_work_.growing * growth;
}

// What all searches may take for so many loops.
template <class Pose>
double OnlineEngine<Pose>::allowance(Index loops) const {
  return options_.effort * searches_a_batch_takes_ * search_work(loops);
}

template <class Pose>
double OnlineEngine<Pose>::following_credit() const {
  return kFollowing * allowance(loops_) - following_work_;
}

// All work that is done stays within what effort allows, of a batch on no more loops than twice
// those of the last search: beyond that it is not known.
template <class Pose>
bool OnlineEngine<Pose>::is_search_due() const {
  if (loops_ < kFirst || loops_ == searched_) return false;
  if (loops_ >= kMostGrowth * searched_) return true;
  const Index known = std::min(loops_, kGrowth * searched_);
  const double spent = searches_work_ + following_work_;
  if (spent + search_work(known) > allowance(known)) return false;
  return loops_ >= kGrowth * searched_ || is_quiet();
}

// Whether no loop came for as many calls as a search takes, so that none is to be expected until it
// is done, either.
template <class Pose>
bool OnlineEngine<Pose>::is_quiet() const {
  const auto calls = static_cast<double>(static_cast<Index>(rows_.size()) - 1 - last_loop_);
  return calls * most_work(rows_.size()) >= search_work(loops_);
}

// The first loop's, to hold others against; then from every start, where loops have grown enough.
template <class Pose>
void OnlineEngine<Pose>::search_everywhere(double budget) {
  if (!everywhere_) {
    const bool due = is_search_due();
    if (!due && map_) return;
    if (due) searched_ = loops_;
    everywhere_ = begin(due);
  }
  if (!run(*everywhere_, budget)) return;
  const auto map = everywhere_->map;
  if (map->explained()) {
    search_work_ = map->search_work();
    searches_a_batch_takes_ = map->searches_a_batch_takes();
    search_of_ = everywhere_->loops;
  }
  searches_work_ += everywhere_->task->spent();
  everywhere_.reset();
  const bool latest = !map_ || map->graph().constraints.size() >= map_->graph().constraints.size();
  if (latest) {
    next_.reset();
    adopt(map);
  } else if (map->surpassed()) {
    rival_ = map;
  }
}

// Whether a loop has come that the map has not seen, and as many more edges, for all there are, as
// following up takes of what it may: so what is left lasts.
template <class Pose>
bool OnlineEngine<Pose>::is_following_due() const {
  const Index seen = map_->graph().constraint_count();
  const auto all = static_cast<Index>(rows_.size());
  return last_loop_ >= seen && (all - seen) * following_credit() >= last_following_ * all;
}

// From where the last one stood, and from where a search from every start led higher. Once begun it
// is ended: else all of it would be for nothing.
template <class Pose>
void OnlineEngine<Pose>::follow_up(double budget) {
  if (!map_) return;
  if (!next_) {
    if (!rival_ && !is_following_due()) return;
    next_ = begin(false);
    rival_.reset();
  }
  const double before = next_->task->spent();
  const bool done = run(*next_, budget);
  following_work_ += next_->task->spent() - before;
  if (!done) return;
  last_following_ = next_->task->spent();
  const auto map = next_->map;
  next_.reset();
  adopt(map);
}

template <class Pose>
typename OnlineEngine<Pose>::Search OnlineEngine<Pose>::begin(bool everywhere) const {
  Search search{std::make_shared<Snapshot<Pose>>(log_.graph(), options_.consensus), loops_, {}, {}};
  for (const auto& other : {map_, rival_}) {
    if (other) search.from.push_back(other);
  }
  search.task = std::make_unique<PacedTask>(
      [map = search.map.get(), from = search.from, everywhere](const Pace& pace) {
        std::vector<const Snapshot<Pose>*> others;
        for (const auto& other : from) others.push_back(other.get());
        map->explain(others, everywhere, pace);
      });
  return search;
}

// Where the equations break down nothing is explained.
template <class Pose>
bool OnlineEngine<Pose>::run(Search& search, double budget) {
  try {
    return search.task->run(budget);
  } catch (const NumericalError&) {
    search.map = std::make_shared<Snapshot<Pose>>(search.map->graph(), options_.consensus);
    return true;
  }
}

template <class Pose>
void OnlineEngine<Pose>::adopt(std::shared_ptr<Snapshot<Pose>> map) {
  const bool broke_down = !map->explained() && map_ && map_->explained();
  if (broke_down) return;
  const auto seen = static_cast<Index>(map->graph().constraints.size());
  take_over(map->verdicts());
  outlook_.reset();
  map_ = std::move(map);
  if (map_->explained()) outlook_.emplace(log_, *map_, options_.consensus);
  runs_ = OpenRuns(outlook_ ? outlook_->labels() : LabelCounts());
  standings_.clear();
  judge_since(seen);
}

template <class Pose>
void OnlineEngine<Pose>::judge_since(Index first) {
  std::vector<Index> repeats;
  for (Index k = first; k < static_cast<Index>(rows_.size()); ++k) {
    const auto& edge = log_.edges()[k];
    if (edge.step) continue;
    if (log_.repeated_by(edge)) {
      repeats.push_back(k);
    } else {
      judge(k);
    }
  }
  for (const Index k : repeats) judge(k);
}

// Adds a loop to those that are not accepted, behind those before it in its run.
template <class Pose>
void OnlineEngine<Pose>::consider(Index edge) {
  std::vector<OpenRuns::Member> ahead;
  for (Index k = edge; k != OpenRuns::kNone && !runs_.contains(k);) {
    const auto lead = outlook_->lead(k);
    standings_[k] = outlook_->standing(k);
    ahead.push_back({.edge = k, .own = standings_[k].evidence});
    if (lead) ahead.back().before = lead->edge;
    if (lead) ahead.back().with_before = lead->evidence;
    k = ahead.back().before;
  }
  for (; !ahead.empty(); ahead.pop_back()) runs_.add(ahead.back());
}

// All loops of its run.
template <class Pose>
void OnlineEngine<Pose>::judge_run(Index edge) {
  const auto run = runs_.log_odds(edge);
  for (const auto& [k, log_odds] : run) {
    const auto& told = log_.edges()[k];
    const auto& standing = standings_.at(k);
    const bool together = run.size() > 1 && standing.log_odds <= 0.0;
    const bool accepted = log_odds > 0.0 && (standing.connected() || run.size() > 1);
    spectral::EdgeVerdict row{.edge = k, .from = told.from, .to = told.to};
    row.score = -log_odds;
    row.threshold = log_odds_of(1.0 - options_.consensus.significance);
    row.verdict =
        verdict_of(accepted, log_odds, row.threshold, map_->refutes() && standing.connected());
    row.probability = probability_of(log_odds);
    row.stage = stage_of(accepted, standing.connected());
    set(std::move(row), {.chi2 = standing.chi2, .together = accepted && together});
  }
}

template <class Pose>
void OnlineEngine<Pose>::take_over(const PruneResult& result) {
  const auto& details = result.consensus.details;
  for (std::size_t k = 0; k < result.verdicts.size(); ++k) {
    const double chi2 = details.empty() ? 0.0 : details[k].chi2;
    set(result.verdicts[k], {.chi2 = chi2});
  }
}

// Whether later loops may be judged by a loop: what is beyond what the map tells of its own errors
// is not, however many others say the same, as the map is wrong then, and others hang on that.
template <class Pose>
bool OnlineEngine<Pose>::may_follow(Index edge) const {
  if (rows_[edge].now->verdict != spectral::Verdict::keep) return false;
  return standings_.at(edge).chi2 <=
         chi_squared_quantile(1.0 - options_.consensus.significance, Pose::kDof);
}

// A loop that came after the snapshot, by that and the others that came.
template <class Pose>
void OnlineEngine<Pose>::judge(Index number) {
  const auto& edge = log_.edges()[number];
  spectral::EdgeVerdict row{.edge = number, .from = edge.from, .to = edge.to};
  row.verdict = spectral::Verdict::ambiguous;
  row.stage = "waiting";
  const auto repeated = log_.repeated_by(edge);
  if (edge.from == edge.to) {
    row.stage = "self-edge";
  } else if (repeated) {
    const auto& original = rows_[*repeated].now;
    if (original) row = *original;
    row.edge = number;
    if (!original) row.verdict = spectral::Verdict::keep;
    row.stage = "repeat";
  } else if (outlook_) {
    consider(number);
    judge_run(number);
    if (may_follow(number)) outlook_->follow(number);
    return;
  }
  set(std::move(row), {});
}

template <class Pose>
void OnlineEngine<Pose>::set(spectral::EdgeVerdict verdict, const Grounds& grounds) {
  const auto edge = static_cast<Index>(verdict.edge);
  Row& row = rows_[edge];
  row.now = std::move(verdict);
  row.grounds = grounds;
  if (row.told != row.now->verdict) fresh_.push_back(edge);
}

template <class Pose>
std::vector<LoopChange> OnlineEngine<Pose>::changes() {
  std::ranges::sort(fresh_);
  std::vector<LoopChange> changes;
  for (const Index edge : fresh_) {
    Row& row = rows_[edge];
    if (row.told == row.now->verdict) continue;
    changes.push_back({*row.now, reason_of(*row.now, row.grounds), !row.told.has_value()});
    row.told = row.now->verdict;
  }
  fresh_.clear();
  return changes;
}

template <class Pose>
std::vector<LoopChange> OnlineEngine<Pose>::catch_up() {
  if (loops_ > 0) {
    next_.reset();
    everywhere_ = begin(loops_ >= kFirst);
    searched_ = loops_;
    search_everywhere(kNoLimit);
  }
  return changes();
}

template <class Pose>
PruneResult OnlineEngine<Pose>::result() const {
  const PruneOptions options = options_.consensus;
  return prune(log_.graph(), options, run_);
}

template <class Pose>
std::vector<LoopChange> OnlineEngine<Pose>::finish() {
  const auto final = result();
  next_.reset();
  everywhere_.reset();
  for (auto& row : rows_) row.now.reset();  // what has become odometry meanwhile has no verdict
  take_over(final);
  std::erase_if(fresh_, [this](Index edge) { return !rows_[edge].now; });
  finished_ = true;
  return changes();
}

template <class Pose>
spectral::EdgeVerdicts OnlineEngine<Pose>::verdicts() const {
  spectral::EdgeVerdicts all;
  for (const auto& row : rows_) {
    if (row.now) all.push_back(*row.now);
  }
  return all;
}

// Whether other loops may be thought true than the snapshot has accepted.
template <class Pose>
bool OnlineEngine<Pose>::has_news() const {
  if (finished_) return true;
  return outlook_ && std::ranges::any_of(standings_, [this](const auto& known) {
           return is_accepted(known.first);
         });
}

template <class Pose>
bool OnlineEngine<Pose>::is_accepted(Index edge) const {
  const auto& now = rows_[edge].now;
  return now && now->stage == stage_of(true, true);
}

// With the loops that are thought true now, as accurate as was learnt.
template <class Pose>
void OnlineEngine<Pose>::bring_up_to_date(PoseGraph<Pose>& graph) const {
  const auto edges = static_cast<Index>(rows_.size());
  const Index judged_together = finished_ ? edges : map_->graph().constraint_count();
  std::vector<Use> uses;
  for (Index k = 0; k < edges; ++k) {
    Use use;
    if (log_.edges()[k].step) {
      use.as = Use::As::step;
    } else if (is_accepted(k)) {
      use.as = Use::As::loop;
      if (k >= judged_together) use.most_chi2 = outlook_->chi2_at_even_odds(k);
    }
    uses.push_back(use);
  }
  const auto& best = map_->best();
  const Accuracy<Pose> accuracy{best.scale.odometry * best.shapes.odometry,
                                best.scale.loops * best.shapes.loops};
  settle_poses(graph, uses, accuracy);
}

// Vertices that the map has not follow odometry.
template <class Pose>
PoseGraph<Pose> OnlineEngine<Pose>::graph() const {
  auto graph = log_.graph();
  if (!map_ && graph.poses.empty()) graph.poses = odometry_poses(graph, edge_roles(graph));
  if (!map_) return graph;
  const auto given = std::move(graph.poses);
  graph.poses.assign(graph.ids.size(), Pose());
  for (Index v = 0; v < graph.vertex_count(); ++v) {
    const auto known = map_->graph().find(graph.ids[v]);
    const auto pose = known ? map_->pose(*known) : std::nullopt;
    const auto* step = log_.step_to(graph.ids[v]);
    if (pose) {
      graph.poses[v] = *pose;
    } else if (step != nullptr) {
      graph.poses[v] = graph.poses[*graph.find(step->before)] * step->path(Pose::Tangent::Ones()).T;
    } else if (!given.empty()) {
      graph.poses[v] = given[v];
    }
  }
  if (has_news()) bring_up_to_date(graph);
  return graph;
}

template class OnlineEngine<Pose2>;
template class OnlineEngine<Pose3>;

}  // namespace isotherm::slam::detail
