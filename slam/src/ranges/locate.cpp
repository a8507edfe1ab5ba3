#include "isotherm/slam/ranges/locate.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "isotherm/base/error.hpp"
#include "ranges/growth.hpp"
#include "ranges/range_verdicts.hpp"
#include "ranges/rigid_join.hpp"

namespace isotherm::slam {
namespace {

using network::LocalizeStatus;
using network::NodeStatus;

template <class Pose>
class Location {
 public:
  Location(const RangeGraph<Pose>& given, const std::vector<Index>& anchors,
           const LocateOptions& options, const RunContext& run)
      : given_(given),
        options_(options),
        run_(run),
        world_(detail::know_world(given, anchors)),
        fitting_{.max_iterations = options.max_steps, .progress = run.progress} {}

  LocateResult<Pose> run() {
    problem_.too_long = options_.bias != ModelChoice::no;
    problem_.calibrated = options_.calibrate != ModelChoice::yes;
    if (options_.start == RangeStart::file) {
      consider(map_of_file());
    } else {
      std::size_t tries = is_large() ? kStartsOfLarge : kStarts.size();
      for (std::size_t k = 0; k < tries && !explained(); ++k) consider(grow(kStarts[k]));
      repair();
    }
    choose_model();
    return finish();
  }

 private:
  // Odometry may be much worse than stated, which an early window cannot tell.
  struct Start {
    double odometry;  // on stated covariances
    bool windows;
  };
  static constexpr std::array<Start, 6> kStarts = {
      {{1.0, true}, {100.0, true}, {1.0, false}, {1e4, true}, {100.0, false}, {1e4, false}}};
  static constexpr std::size_t kStartsOfLarge = 3;
  static constexpr Index kLarge = 4000;  // nodes: a start takes seconds

  bool is_large() const { return given_.node_count() >= kLarge; }

  detail::RangeModel first_model() const {
    detail::RangeModel model;
    model.longest = world_.longest;
    model.excess = network::typical_excess(world_.typical_sigma, world_.longest);
    if (options_.bias == ModelChoice::no) network::leave_out_too_long(model);
    return model;
  }

  detail::GrownMap<Pose> grow(const Start& start) const {
    auto model = first_model();
    model.odometry = start.odometry;
    return detail::grow_map(world_, model, start.windows, run_);
  }

  // Whether the map so far has a place for all nodes, and errors about as large as stated: one
  // that bent to wrong places needs larger ones of odometry, or smaller ones of ranges.
  bool explained() const {
    if (!found_ || problem_.terms.size() < world_.graph.ranges.size()) return false;
    const auto& model = map_.estimate.model;
    const double most = std::log(kAsStated);
    return std::abs(std::log(model.scale)) < most && std::log(model.odometry) < 2.0 * most;
  }

  // Takes a map, fitted, if it is the likeliest so far.
  void consider(detail::GrownMap<Pose> map) {
    choose_main(map);
    auto problem = detail::problem_of(world_, map.bodies);
    problem.too_long = problem_.too_long;
    problem.calibrated = problem_.calibrated;
    auto summary = fit(problem, map.estimate);
    iterations_ += map.iterations;
    if (found_ && !(summary.evidence > summary_.evidence)) return;
    found_ = true;
    map_ = std::move(map);
    problem_ = std::move(problem);
    summary_ = std::move(summary);
  }

  detail::GrownMap<Pose> map_of_file() const {
    const auto n = world_.graph.names.size();
    detail::GrownMap<Pose> map;
    for (std::size_t v = 0; v < n; ++v) {
      if (!world_.graph.placed[v]) {
        throw InvalidArgument("start", "the file has no position for " + world_.graph.names[v]);
      }
    }
    map.estimate = {world_.graph.positions, first_model()};
    map.bodies.parent.assign(n, 0);
    map.bodies.active.assign(n, true);
    map.mirrored.assign(n, false);
    return map;
  }

  // The body that is known, or else the largest. Others are in no common frame and left out.
  void choose_main(detail::GrownMap<Pose>& map) const {
    const auto n = static_cast<Index>(world_.held.size());
    std::vector<Index> size(world_.held.size(), 0);
    Index main = -1;
    for (Index v = 0; v < n; ++v) {
      if (!map.bodies.active[v]) continue;
      const Index body = map.bodies.of(v);
      ++size[body];
      if (main < 0 || (!world_.anchored() && size[body] > size[main])) main = body;
      if (world_.held[v]) main = body;
    }
    for (Index v = 0; v < n; ++v) {
      if (map.bodies.active[v] && map.bodies.of(v) != main) map.bodies.active[v] = false;
    }
  }

  void choose_model() {
    if (options_.bias == ModelChoice::automatic) {
      auto without = problem_;
      without.too_long = false;
      auto at = map_.estimate;
      network::leave_out_too_long(at.model);
      keep_if_likelier(without, std::move(at));
    }
    if (options_.calibrate == ModelChoice::automatic) {
      auto calibrating = problem_;
      calibrating.calibrated = false;
      keep_if_likelier(calibrating, map_.estimate);
    }
  }

  // The evidence counts ranges that take no part as what can be any length.
  detail::FitSummary fit(const detail::RangeProblem<Pose>& problem,
                         detail::RangeEstimate<Pose>& at) {
    auto summary = detail::fit(problem, fitting_, at);
    iterations_ += summary.iterations;
    const auto left = static_cast<double>(world_.graph.ranges.size() - problem.terms.size());
    summary.evidence -= left * std::log(world_.longest);
    return summary;
  }

  bool keep_if_likelier(const detail::RangeProblem<Pose>& problem, detail::RangeEstimate<Pose> at) {
    auto summary = fit(problem, at);
    if (!(summary.evidence > summary_.evidence)) return false;
    problem_ = problem;
    map_.estimate = std::move(at);
    summary_ = std::move(summary);
    return true;
  }

  // Points that an early window put in a wrong place: each is tried where its ranges, by the map
  // as it is now, have their best one, and at its mirror image, to which the map may have bent.
  void repair() {
    Random random(run_.seed);
    for (Index v = 0; v < static_cast<Index>(world_.held.size()); ++v) {
      if (!world_.graph.is_point[v] || !map_.bodies.active[v] || world_.held[v]) continue;
      const auto ranges = ranges_to(v);
      if (ranges.size() < static_cast<std::size_t>(Pose::kDim)) continue;
      auto places = detail::join_modes(ranges, true, random);
      if (places.size() > 1) places.resize(1);
      places.push_back({detail::mirror_image(ranges, map_.estimate.poses[v]), 0.0});
      for (const auto& place : places) try_place(v, place.T_a_b);
    }
  }

  // With scales as stated, since those of a wrong map would make false what contradicts it.
  void try_place(Index point, const Pose& place) {
    const double apart = (place.translation() - map_.estimate.poses[point].translation()).norm();
    if (apart < kElsewhere * map_.estimate.model.scale * world_.typical_sigma) return;
    auto at = map_.estimate;
    at.model = first_model();
    at.poses[point] = place;
    keep_if_likelier(problem_, std::move(at));
  }

  std::vector<detail::BodyRange<Pose>> ranges_to(Index point) const {
    const auto& model = map_.estimate.model;
    std::vector<detail::BodyRange<Pose>> ranges;
    for (const auto& term : problem_.terms) {
      if (term.from != point && term.to != point) continue;
      const Index other = term.from == point ? term.to : term.from;
      const double distance = (term.distance - model.offset) / std::exp(model.log_stretch);
      ranges.push_back({map_.estimate.poses[other].translation(), Pose::Translation::Zero(),
                        std::max(0.0, distance), model.sigma(term.sigma)});
    }
    return ranges;
  }

  LocateResult<Pose> finish() {
    LocateResult<Pose> result;
    result.poses.assign(map_.estimate.poses.begin(),
                        map_.estimate.poses.begin() + given_.node_count());
    result.nodes = statuses();
    result.verdicts =
        detail::range_verdicts(world_, problem_, map_.estimate, summary_, options_.doubt);
    result.covariances = detail::position_covariances(problem_, map_.estimate, given_.node_count());
    result.status = result.count(NodeStatus::localised) == 0 ? LocalizeStatus::no_start
                    : summary_.converged                     ? LocalizeStatus::converged
                                                             : LocalizeStatus::not_converged;
    result.anchored = world_.anchored();
    result.errors = errors();
    result.cost = -summary_.evidence;
    result.evidence = summary_.evidence;
    result.iterations = iterations_;
    return result;
  }

  std::vector<NodeStatus> statuses() const {
    std::vector<int> ranges(world_.held.size(), 0);
    for (const auto& range : world_.graph.ranges) {
      ++ranges[range.from];
      ++ranges[range.to];
    }
    std::vector<NodeStatus> result;
    for (Index v = 0; v < given_.node_count(); ++v) {
      const bool few = given_.is_point[v] && ranges[v] < Pose::kDim;
      result.push_back(map_.bodies.active[v] ? (world_.held[v]     ? NodeStatus::anchor
                                                : map_.mirrored[v] ? NodeStatus::mirrored
                                                                   : NodeStatus::localised)
                       : ranges[v] == 0      ? NodeStatus::not_connected
                       : few                 ? NodeStatus::not_rigid
                                             : NodeStatus::not_placed);
    }
    return result;
  }

  RangeErrors errors() const {
    const auto& model = map_.estimate.model;
    RangeErrors errors;
    errors.scale = model.scale;
    errors.odometry = model.odometry;
    errors.too_long = problem_.too_long ? model.share[network::kTooLong] : 0.0;
    errors.excess = problem_.too_long ? model.excess : 0.0;
    errors.anything = model.share[network::kAnything];
    errors.calibrated = !problem_.calibrated;
    errors.offset = model.offset;
    errors.stretch = std::exp(model.log_stretch);
    return errors;
  }

  static constexpr double kAsStated = 2.0;   // within this factor
  static constexpr double kElsewhere = 3.0;  // deviations of a range

  const RangeGraph<Pose>& given_;
  const LocateOptions& options_;
  const RunContext& run_;
  detail::KnownWorld<Pose> world_;
  detail::FitOptions fitting_;
  detail::GrownMap<Pose> map_;
  detail::RangeProblem<Pose> problem_;
  detail::FitSummary summary_;
  bool found_ = false;
  int iterations_ = 0;
};

}  // namespace

void LocateOptions::validate() const { require_fields_in_range(*this); }

template <class Pose>
std::int64_t LocateResult<Pose>::count(NodeStatus wanted) const {
  return std::ranges::count(nodes, wanted);
}

template <class Pose>
LocateResult<Pose> locate(const RangeGraph<Pose>& graph, const std::vector<Index>& anchors,
                          const LocateOptions& options, const RunContext& run) {
  options.validate();
  const auto start = std::chrono::steady_clock::now();
  auto result = Location<Pose>(graph, anchors, options, run).run();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

template struct LocateResult<Pose2>;
template struct LocateResult<Pose3>;
template LocateResult<Pose2> locate(const RangeGraph<Pose2>&, const std::vector<Index>&,
                                    const LocateOptions&, const RunContext&);
template LocateResult<Pose3> locate(const RangeGraph<Pose3>&, const std::vector<Index>&,
                                    const LocateOptions&, const RunContext&);

}  // namespace isotherm::slam
