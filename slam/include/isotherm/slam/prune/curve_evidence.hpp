#pragma once

#include <array>
#include <concepts>
#include <type_traits>
#include <vector>

#include "isotherm/base/options.hpp"
#include "isotherm/base/range.hpp"
#include "isotherm/base/run_context.hpp"
#include "isotherm/geometry/curves/lap_line.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam {

/// How the odometry paths at the two ends of a loop are compared.
enum class CurveComparison {
  /// By their Lap-line descriptors (S. Datta et al., section V-A-1).
  lap_line,
  /// As curves, laid on each other by the loop's measured transform.
  common_frame,
};

constexpr std::array<EnumName<CurveComparison>, 2> enum_names(CurveComparison) {
  return {
      {{CurveComparison::lap_line, "lap-line"}, {CurveComparison::common_frame, "common-frame"}}};
}

/// What is asked of a loop whose two windows overlap on the path that joins its ends.
/// Such a stretch of path is laid on itself: where it is straight, it fits however
/// far it is shifted along itself.
enum class SharedPath {
  all_halves,  ///< every half of the windows must fit
  any_half,    ///< one half must fit, as for other loops
  left_out,    ///< one half must fit; windows end in the middle between the ends
};

constexpr std::array<EnumName<SharedPath>, 3> enum_names(SharedPath) {
  return {{{SharedPath::all_halves, "all-halves"},
           {SharedPath::any_half, "any-half"},
           {SharedPath::left_out, "left-out"}}};
}

/// A loop that is correct joins two visits of one place, which are likely to follow
/// the same path at least on one side of it.
struct CurveEvidenceOptions {
  CurveComparison comparison = CurveComparison::common_frame;

  /// Of CurveComparison::lap_line. A loop that turns its two ends by more than a
  /// right angle is compared in reversed travel.
  geometry::LapLineOptions lap_line;

  // The rest is of CurveComparison::common_frame.

  /// Metres of path to either side of an end, each > 0; the evidence is the mean
  /// over the windows.
  std::vector<double> windows = {60.0};
  double step = 1.0;  ///< metres between points of a path, in (0, smallest window]
  double cap = 3.0;   ///< metres; larger distances between the paths count as this, > 0

  SharedPath shared_path = SharedPath::all_halves;

  /// Whether a match counts by how rare it is: the share of other places at which
  /// the path would match as well, instead of by its distance.
  bool rarity = false;
  int places = 200;  ///< places, equally spaced along odometry, for `rarity`, >= 1
  /// The share of places at which a match counts half; in (0, 1).
  double chance = 0.05;

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, CurveEvidenceOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("curve", options.comparison, "how the paths at a loop's ends are compared");
  visit("lap_interval", options.lap_line.interval,
        "curve lap-line: metres between samples; 0: mean odometry step", closed(0, 1e6));
  visit("lap_window", options.lap_line.window, "curve lap-line: length described, in intervals",
        closed(2, 10000));
  visit("lap_max_turn", options.lap_line.max_turn,
        "curve lap-line: radians a described path may turn", left_open(0, 1.5708));
  visit("curve_windows", options.windows,
        "curve common-frame: metres of path to either side; several are averaged",
        closed(1e-6, 1e6));
  visit("curve_step", options.step, "curve common-frame: metres between points of a path",
        closed(1e-6, 1e6));
  visit("curve_cap", options.cap, "curve common-frame: metres beyond which paths just differ",
        left_open(0, 1e9));
  visit("curve_shared_path", options.shared_path,
        "curve common-frame: what must fit where windows overlap on one path");
  visit("curve_rarity", options.rarity,
        "curve common-frame: judge a match by how few other places match as well");
  visit("curve_places", options.places, "curve common-frame: places compared for rarity",
        closed(1, 100000));
  visit("curve_chance", options.chance,
        "curve common-frame: share of places at which a match counts half", open(0, 1));
}

/// What the paths say about one loop.
struct CurveEvidence {
  /// In [0, 1); larger for less similar paths: d / (d + median d) over all candidates
  /// or, with rarity, p / (p + chance) where p is the share of other places that match
  /// as well. 1/2 where nothing can be compared.
  double score = 0.5;
  double disparity = 0.0;  ///< d, metres; the mean over the windows
  bool compared = false;   ///< false: paths too short, so they tell nothing
};

/// Compares the odometry paths at the ends of every candidate; one entry each, in
/// the order of roles.candidates. Independent of the number of threads.
///
/// Lap-line costs O(window^2) a candidate. The common frame costs
/// O((window / step)^2) a candidate, times `places` with rarity.
/// @throws InvalidArgument, Cancelled
template <class Pose>
std::vector<CurveEvidence> curve_evidence(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                          const CurveEvidenceOptions& options = {},
                                          const RunContext& run = {});

}  // namespace isotherm::slam
