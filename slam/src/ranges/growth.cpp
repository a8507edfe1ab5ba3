#include "ranges/growth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "isotherm/base/error.hpp"
#include "ranges/rigid_join.hpp"
#include "ranges/step_forest.hpp"

namespace isotherm::slam::detail {
namespace {

// Odds that decide: those of the network's localiser for the mirror image of a node.
const double kDecisive = std::log(1e3);
constexpr std::size_t kFirstWindow = 24;   // ranges: enough for the first beacons
constexpr double kGrowth = 1.5;            // of windows
constexpr double kWorthAnotherTry = 1.25;  // as many ranges as at the last one
constexpr std::size_t kMostRivals = 4;
constexpr int kWindowSteps = 30;

using BodyPair = std::pair<Index, Index>;

template <class Pose>
class MapGrowth {
 public:
  MapGrowth(const KnownWorld<Pose>& world, const RangeModel& model, const RunContext& run)
      : world_(world),
        graph_(world.graph),
        run_(run),
        random_(run.seed),
        forest_(step_forest(graph_)) {
    const auto n = graph_.names.size();
    map_.estimate.poses = graph_.positions;
    map_.estimate.model = model;
    map_.mirrored.assign(n, false);
    map_.bodies.parent.resize(n);
    std::iota(map_.bodies.parent.begin(), map_.bodies.parent.end(), 0);
    map_.bodies.active.assign(n, false);
    first_held_ = found_known();
    for (const auto& step : graph_.steps) map_.bodies.join(step.from, step.to);
  }

  GrownMap<Pose> run(bool grows) {
    const auto limits = windows(grows);
    for (std::size_t k = 0; k < limits.size(); ++k) {
      tell(k, limits.size());
      activate(limits[k]);
      join_decided();
      fit_all();
    }
    join_undecided();
    return std::move(map_);
  }

 private:
  // Anchors and the world are one body from the start.
  Index found_known() {
    Index first = -1;
    for (Index v = 0; v < graph_.node_count(); ++v) {
      if (!world_.held[v]) continue;
      map_.bodies.active[v] = true;
      if (first < 0) first = v;
      map_.bodies.join(first, v);
    }
    return first;
  }

  double reach(const network::RangeMeasurement& range) const {
    return std::max(forest_.rank[range.from], forest_.rank[range.to]);
  }

  // Ranks up to which poses take part, the last of which is all.
  std::vector<double> windows(bool grow) const {
    std::vector<double> limits;
    std::vector<double> reaches;
    if (!grow) return {std::numeric_limits<double>::infinity()};
    for (const auto& range : graph_.ranges) reaches.push_back(reach(range));
    std::ranges::sort(reaches);
    for (double size = kFirstWindow; size < static_cast<double>(reaches.size()); size *= kGrowth) {
      limits.push_back(reaches[static_cast<std::size_t>(size)]);
    }
    limits.push_back(std::numeric_limits<double>::infinity());
    return limits;
  }

  void activate(double limit) {
    auto& active = map_.bodies.active;
    for (const Index v : forest_.order) {
      const auto& link = forest_.links[v];
      const bool unknown = graph_.is_point[v] && link.parent < 0;
      if (active[v] || unknown || forest_.rank[v] > limit) continue;
      if (link.parent >= 0) {
        if (!active[link.parent]) continue;
        map_.estimate.poses[v] = map_.estimate.poses[link.parent] * link.T_parent_child;
      } else {
        map_.estimate.poses[v] = Pose();
      }
      active[v] = true;
    }
  }

  bool is_lone_point(Index body) { return graph_.is_point[body] && !map_.bodies.active[body]; }

  bool can_join(Index v) { return map_.bodies.active[v] || is_lone_point(map_.bodies.of(v)); }

  // Ranges between bodies, at least one of which has poses; the second moves.
  std::map<BodyPair, std::vector<std::size_t>> ranges_between() {
    std::map<BodyPair, std::vector<std::size_t>> between;
    for (std::size_t k = 0; k < graph_.ranges.size(); ++k) {
      const auto& range = graph_.ranges[k];
      if (!can_join(range.from) || !can_join(range.to)) continue;
      const Index a = map_.bodies.of(range.from);
      const Index b = map_.bodies.of(range.to);
      if (a == b || (is_lone_point(a) && is_lone_point(b))) continue;
      between[moves_second(a, b) ? BodyPair(a, b) : BodyPair(b, a)].push_back(k);
    }
    return between;
  }

  // What is known stays; points come to poses.
  bool moves_second(Index a, Index b) {
    if (is_lone_point(a) != is_lone_point(b)) return is_lone_point(b);
    if (first_held_ < 0) return a < b;
    const Index known = map_.bodies.of(first_held_);
    return b != known && (a == known || a < b);
  }

  std::vector<BodyRange<Pose>> as_body_ranges(const BodyPair& pair,
                                              const std::vector<std::size_t>& ranges) {
    const bool point = is_lone_point(pair.second);
    std::vector<BodyRange<Pose>> result;
    const auto place = [&](Index v) { return map_.estimate.poses[v].translation(); };
    for (const std::size_t k : ranges) {
      const auto& range = graph_.ranges[k];
      const bool forward = map_.bodies.of(range.from) == pair.first;
      const Index a = forward ? range.from : range.to;
      const Index b = forward ? range.to : range.from;
      const typename Pose::Translation origin = Pose::Translation::Zero();
      result.push_back(
          {place(a), point ? origin : place(b), corrected(range.distance), world_.sigma[k]});
    }
    return result;
  }

  double corrected(double measured) const {
    const auto& model = map_.estimate.model;
    return std::max(0.0, (measured - model.offset) / std::exp(model.log_stretch));
  }

  int freedom(const BodyPair& pair) { return is_lone_point(pair.second) ? Pose::kDim : Pose::kDof; }

  // Pairs with enough ranges that were not tried with about as many, those with most first.
  std::vector<std::pair<BodyPair, std::vector<std::size_t>>> worth_trying() {
    std::vector<std::pair<BodyPair, std::vector<std::size_t>>> result;
    for (auto& [pair, ranges] : ranges_between()) {
      if (static_cast<int>(ranges.size()) <= freedom(pair)) continue;
      const auto tried = tried_.find(pair);
      if (tried != tried_.end() &&
          static_cast<double>(ranges.size()) < kWorthAnotherTry * tried->second) {
        continue;
      }
      result.emplace_back(pair, std::move(ranges));
    }
    std::ranges::stable_sort(
        result, [](const auto& x, const auto& y) { return x.second.size() > y.second.size(); });
    return result;
  }

  bool explains(const std::vector<BodyRange<Pose>>& ranges, const JoinMode<Pose>& mode,
                int freedom) const {
    // A place among all those on the map has to be paid for.
    const double places = freedom * std::log(world_.longest / world_.typical_sigma);
    return unexplained_cost(ranges, world_.longest) - mode.cost > std::max(places, 0.0) + kDecisive;
  }

  void join_decided() {
    for (bool joined = true; joined;) {
      joined = false;
      for (const auto& [pair, members] : worth_trying()) {
        tried_[pair] = static_cast<double>(members.size());
        const auto ranges = as_body_ranges(pair, members);
        const auto modes = join_modes(ranges, is_lone_point(pair.second), random_);
        if (modes.empty() || !explains(ranges, modes.front(), freedom(pair))) continue;
        if (modes.size() > 1 && modes[1].cost - modes[0].cost < kDecisive) continue;
        place(pair, modes.front().T_a_b);
        joined = true;
        break;
      }
    }
  }

  void place(const BodyPair& pair, const Pose& T_a_b) {
    auto& bodies = map_.bodies;
    const Index moving = bodies.of(pair.second);
    if (is_lone_point(moving)) {
      map_.estimate.poses[moving] = T_a_b;
      bodies.active[moving] = true;
    } else {
      for (Index v = 0; v < graph_.node_count(); ++v) {
        if (bodies.active[v] && bodies.of(v) == moving) {
          map_.estimate.poses[v] = T_a_b * map_.estimate.poses[v];
        }
      }
    }
    bodies.join(pair.first, moving);
  }

  double fit_all() {
    const auto problem = problem_of(world_, map_.bodies);
    if (problem.terms.empty()) return 0.0;
    const auto summary = fit(problem, fitting_, map_.estimate);
    map_.iterations += summary.iterations;
    return summary.evidence;
  }

  // One after the other, where the fit is best; the one with most ranges first.
  void join_undecided() {
    tried_.clear();
    for (;;) {
      auto pairs = ranges_between();
      std::erase_if(pairs, [&](const auto& entry) {
        return tried_.contains(entry.first) ||
               static_cast<int>(entry.second.size()) < freedom(entry.first);
      });
      if (pairs.empty()) return;
      const auto most = std::ranges::max_element(
          pairs, [](const auto& x, const auto& y) { return x.second.size() < y.second.size(); });
      tried_[most->first] = static_cast<double>(most->second.size());
      join_best(most->first, most->second);
    }
  }

  void join_best(const BodyPair& pair, const std::vector<std::size_t>& members) {
    const auto ranges = as_body_ranges(pair, members);
    auto modes = join_modes(ranges, is_lone_point(pair.second), random_);
    if (modes.empty() || unexplained_cost(ranges, world_.longest) < modes.front().cost) return;
    const double best = modes.front().cost;
    std::erase_if(modes, [&](const auto& mode) { return mode.cost - best > kDecisive; });
    if (modes.size() > kMostRivals) modes.resize(kMostRivals);
    const auto before = map_;
    std::optional<GrownMap<Pose>> chosen;
    double most = 0.0;
    double second = -std::numeric_limits<double>::infinity();
    for (const auto& mode : modes) {
      map_ = before;
      place(pair, mode.T_a_b);
      const double evidence = fit_all();
      if (!chosen || evidence > most) {
        if (chosen) second = most;
        most = evidence;
        chosen = map_;
      } else {
        second = std::max(second, evidence);
      }
    }
    map_ = std::move(*chosen);
    if (most - second < kDecisive) mark_mirrored(pair, before);
  }

  void mark_mirrored(const BodyPair& pair, const GrownMap<Pose>& before) {
    auto bodies = before.bodies;
    for (Index v = 0; v < graph_.node_count(); ++v) {
      if (bodies.of(v) == bodies.of(pair.second)) map_.mirrored[v] = true;
    }
  }

  void tell(std::size_t done, std::size_t total) const {
    if (run_.progress && !run_.progress({"windows of time", done, total})) throw Cancelled();
  }

  const KnownWorld<Pose>& world_;
  const RangeGraph<Pose>& graph_;
  const FitOptions fitting_{.max_iterations = kWindowSteps};
  const RunContext& run_;
  Random random_;
  StepForest<Pose> forest_;
  GrownMap<Pose> map_;
  Index first_held_ = -1;
  std::map<BodyPair, double> tried_;  // with how many ranges
};

}  // namespace

template <class Pose>
GrownMap<Pose> grow_map(const KnownWorld<Pose>& world, const RangeModel& model, bool windows,
                        const RunContext& run) {
  return MapGrowth<Pose>(world, model, run).run(windows);
}

template GrownMap<Pose2> grow_map(const KnownWorld<Pose2>&, const RangeModel&, bool,
                                  const RunContext&);
template GrownMap<Pose3> grow_map(const KnownWorld<Pose3>&, const RangeModel&, bool,
                                  const RunContext&);

}  // namespace isotherm::slam::detail
