#include "isotherm/slam/prune/curve_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/base/parallel.hpp"
#include "isotherm/base/statistics.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/geometry/curves/curve_stretch.hpp"
#include "isotherm/slam/graph/odometry.hpp"

namespace isotherm::slam {
namespace {

// A comparison takes the square of this.
constexpr double kMostSteps = 1000.0;

// The odometry path of every chain, and where each vertex is on it.
template <class Pose>
class Paths {
 public:
  static constexpr int kDim = Pose::kDim;
  using Polyline = geometry::Polyline<kDim>;

  Paths(const PoseGraph<Pose>& graph, const EdgeRoles& roles)
      : poses_(odometry_poses(graph, roles)), place_(poses_.size()) {
    std::vector<bool> joined(poses_.size(), false);  // to the vertex before
    for (const Index k : roles.odometry) {
      joined[std::max(graph.constraints[k].from, graph.constraints[k].to)] = true;
    }
    std::vector<typename Pose::Translation> points;
    for (std::size_t v = 0; v < poses_.size(); ++v) {
      if (v > 0 && !joined[v]) {
        polylines_.emplace_back(std::move(points));
        points.clear();
      }
      place_[v] = {polylines_.size(), static_cast<int>(points.size())};
      points.push_back(poses_[v].translation());
    }
    if (!points.empty()) polylines_.emplace_back(std::move(points));
  }

  std::size_t size() const { return poses_.size(); }
  const Pose& pose(Index v) const { return poses_[v]; }
  const Polyline& polyline(Index v) const { return polylines_[place_[v].polyline]; }
  int point(Index v) const { return place_[v].point; }
  std::size_t chain(Index v) const { return place_[v].polyline; }
  double arc_length(Index v) const { return polyline(v).arc_lengths()[point(v)]; }

  /// Metres along odometry between two vertices; infinite between chains.
  double arc_between(Index a, Index b) const {
    if (chain(a) != chain(b)) return std::numeric_limits<double>::infinity();
    return std::abs(arc_length(a) - arc_length(b));
  }

  /// Length of a step, averaged over all chains; 0 without steps.
  double mean_step() const {
    double length = 0.0;
    for (const auto& polyline : polylines_) length += polyline.length();
    const std::size_t steps = poses_.size() - polylines_.size();
    return steps > 0 ? length / static_cast<double>(steps) : 0.0;
  }

  /// Vertices, about `count` of them, at equal distances along the paths.
  std::vector<Index> places(int count) const {
    double length = 0.0;
    for (const auto& polyline : polylines_) length += polyline.length();
    const double spacing = length / count;
    std::vector<Index> found;
    double travelled = spacing / 2.0;  // so that the ends are not favoured
    for (Index v = 0; v < static_cast<Index>(size()); ++v) {
      if (v > 0 && chain(v) == chain(v - 1)) travelled += arc_length(v) - arc_length(v - 1);
      if (travelled < spacing || !(spacing > 0.0)) continue;
      found.push_back(v);
      travelled = std::fmod(travelled, spacing);
    }
    return found;
  }

 private:
  struct Place {
    std::size_t polyline = 0;
    int point = 0;
  };
  std::vector<Pose> poses_;
  std::vector<Polyline> polylines_;
  std::vector<Place> place_;
};

// Scores d / (d + median) of those disparities that there are.
void score_by_median(std::vector<CurveEvidence>& evidence) {
  std::vector<double> disparities;
  for (const auto& e : evidence) {
    if (e.compared) disparities.push_back(e.disparity);
  }
  if (disparities.empty()) return;
  const double middle = median(std::move(disparities));
  for (auto& e : evidence) {
    if (!e.compared) continue;
    e.score = e.disparity + middle > 0.0 ? e.disparity / (e.disparity + middle) : 0.5;
  }
}

template <class Pose>
std::vector<CurveEvidence> compare_descriptors(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                               const CurveEvidenceOptions& options,
                                               const RunContext& run) {
  const Paths<Pose> paths(graph, roles);
  std::vector<CurveEvidence> evidence(roles.candidates.size());
  auto lap_line = options.lap_line;
  if (!(lap_line.interval > 0.0)) lap_line.interval = paths.mean_step();
  if (!(lap_line.interval > 0.0)) return evidence;

  const auto describe = [&](Index v) {
    return geometry::lap_line(paths.polyline(v), paths.point(v), lap_line);
  };
  const auto compare = [&](std::int64_t c) {
    const auto& loop = graph.constraints[roles.candidates[c]];
    const auto from = describe(loop.from);
    auto to = describe(loop.to);
    if (loop.T_from_to.rotation_matrix()(0, 0) < 0.0) to = geometry::reversed(to);
    const auto found = geometry::disparity(from, to);
    evidence[c].disparity = found.rms;
    evidence[c].compared = found.samples > 1;
  };
  parallel_for(static_cast<std::int64_t>(evidence.size()), run.threads, run.progress, "lap-line",
               compare);
  score_by_median(evidence);
  return evidence;
}

// The comparison in a common frame, for one length of window.
template <class Pose>
class CommonFrame {
 public:
  static constexpr int kDim = Pose::kDim;
  using Stretch = geometry::CurveStretch<kDim>;

  CommonFrame(const Paths<Pose>& paths, const CurveEvidenceOptions& options, double window)
      : paths_(paths),
        options_(options),
        window_(window),
        least_(std::max(1, static_cast<int>(0.5 * window / options.step))) {
    if (!options.rarity) return;
    for (const Index v : paths.places(options.places)) places_.push_back({v, stretch(v)});
  }

  /// Not `compared` if none of the four halves is long enough.
  CurveEvidence compare(const Constraint<Pose>& loop) const {
    const Stretch from = stretch_of(loop.from, loop.to);
    const Stretch to = stretch_of(loop.to, loop.from);
    const Stretch to_in_from = moved(loop.T_from_to, to);
    const Stretch from_in_to = moved(loop.T_from_to.inverse(), from);
    CurveEvidence evidence;
    const bool all_halves = options_.shared_path == SharedPath::all_halves &&
                            paths_.arc_between(loop.from, loop.to) < 2.0 * window_;
    const double first = gap(to_in_from, from, all_halves);
    const double second = gap(from_in_to, to, all_halves);
    const double disparity = all_halves ? std::fmax(first, second) : std::fmin(first, second);
    if (std::isnan(disparity)) return evidence;
    evidence.compared = true;
    evidence.disparity = disparity;
    if (options_.rarity) {
      Rank rank;
      count_matches(to_in_from, loop, all_halves, disparity, rank);
      count_matches(from_in_to, loop, all_halves, disparity, rank);
      // Half a place each way keeps the share inside (0, 1).
      const double share = (rank.as_good + 0.5) / (rank.places + 1.0);
      evidence.score = share / (share + options_.chance);
    }
    return evidence;
  }

 private:
  struct PlacedStretch {
    Index vertex = 0;
    Stretch stretch;
  };
  struct Rank {
    int places = 0;
    int as_good = 0;
  };

  // Around a vertex, in its own frame.
  Stretch stretch(Index v) const {
    return moved(
        paths_.pose(v).inverse(),
        geometry::stretch_around(paths_.polyline(v), paths_.arc_length(v), window_, options_.step));
  }

  // Around an end of a loop, in its own frame, as far as the options allow.
  Stretch stretch_of(Index end, Index other) const {
    const Stretch whole = stretch(end);
    const double between = paths_.arc_between(end, other);
    if (options_.shared_path != SharedPath::left_out || std::isinf(between)) return whole;
    const auto middle = static_cast<int>(between / (2.0 * options_.step));
    return other > end ? geometry::cropped(whole, whole.behind, middle)
                       : geometry::cropped(whole, middle, whole.ahead);
  }

  static Stretch moved(const Pose& pose, Stretch stretch) {
    const Eigen::Matrix<double, Eigen::Dynamic, kDim> rotated =
        stretch.points.matrix() * pose.rotation_matrix().transpose();
    stretch.points = (rotated.rowwise() + pose.translation().transpose()).array();
    return stretch;
  }

  // By the half of `a` that fits best, or worst.
  double gap(const Stretch& a, const Stretch& b, bool all_halves) const {
    const auto halves = geometry::stretch_gap(a, b, options_.cap, least_);
    return all_halves ? halves.greatest() : halves.least();
  }

  // How the same path would fit with the same transform at places that are not near
  // either end of the loop.
  void count_matches(const Stretch& path, const Constraint<Pose>& loop, bool all_halves,
                     double disparity, Rank& rank) const {
    for (const auto& place : places_) {
      if (paths_.arc_between(place.vertex, loop.from) < 0.5 * window_ ||
          paths_.arc_between(place.vertex, loop.to) < 0.5 * window_) {
        continue;
      }
      ++rank.places;
      if (gap(path, place.stretch, all_halves) <= disparity) ++rank.as_good;
    }
  }

  const Paths<Pose>& paths_;
  const CurveEvidenceOptions& options_;
  double window_;
  int least_;
  std::vector<PlacedStretch> places_;
};

template <class Pose>
std::vector<CurveEvidence> compare_in_common_frame(const PoseGraph<Pose>& graph,
                                                   const EdgeRoles& roles,
                                                   const CurveEvidenceOptions& options,
                                                   const RunContext& run) {
  const Paths<Pose> paths(graph, roles);
  std::vector<CurveEvidence> evidence(roles.candidates.size());
  for (auto& e : evidence) e.score = 0.0;
  std::vector<int> windows_compared(evidence.size(), 0);
  for (const double window : options.windows) {
    const CommonFrame<Pose> frame(paths, options, window);
    const auto compare = [&](std::int64_t c) {
      const auto found = frame.compare(graph.constraints[roles.candidates[c]]);
      if (!found.compared) return;
      evidence[c].compared = true;
      evidence[c].disparity += found.disparity;
      evidence[c].score += found.score;
      ++windows_compared[c];
    };
    parallel_for(static_cast<std::int64_t>(evidence.size()), run.threads, run.progress,
                 "common frame", compare);
  }
  for (std::size_t c = 0; c < evidence.size(); ++c) {
    if (!evidence[c].compared) {
      evidence[c] = CurveEvidence();
      continue;
    }
    evidence[c].disparity /= windows_compared[c];
    evidence[c].score /= windows_compared[c];
  }
  if (!options.rarity) score_by_median(evidence);
  return evidence;
}

}  // namespace

void CurveEvidenceOptions::validate() const {
  require_fields_in_range(*this);
  lap_line.validate();
  for (const double window : windows) {
    if (step > window) throw InvalidArgument("curve_step", "must be at most every window");
    if (window / step > kMostSteps) {
      throw InvalidArgument("curve_step",
                            "must divide no window into more than " + format_number(kMostSteps));
    }
  }
}

template <class Pose>
std::vector<CurveEvidence> curve_evidence(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                          const CurveEvidenceOptions& options,
                                          const RunContext& run) {
  options.validate();
  switch (options.comparison) {
    case CurveComparison::lap_line:
      return compare_descriptors(graph, roles, options, run);
    case CurveComparison::common_frame:
      return compare_in_common_frame(graph, roles, options, run);
  }
  throw InvalidArgument("curve", "unknown");
}

template std::vector<CurveEvidence> curve_evidence(const PoseGraph<Pose2>&, const EdgeRoles&,
                                                   const CurveEvidenceOptions&, const RunContext&);
template std::vector<CurveEvidence> curve_evidence(const PoseGraph<Pose3>&, const EdgeRoles&,
                                                   const CurveEvidenceOptions&, const RunContext&);

}  // namespace isotherm::slam
