#pragma once

#include <concepts>
#include <string_view>
#include <type_traits>

#include "isotherm/base/range.hpp"
#include "isotherm/base/run_context.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/slam/prune/curve_evidence.hpp"

namespace isotherm::slam {

struct PruneResult;  // prune.hpp

/// How unlike the odometry paths at the ends of a loop are, see curve_evidence.hpp. A loop
/// that ends on paths too short to compare is kept.
struct CurvePruneOptions {
  static std::string_view method() { return "lap-line"; }
  static std::string_view title() { return "The comparison of curves"; }

  CurveEvidenceOptions curve;
  /// The score above which a loop is pruned; in [0, 1].
  double curve_threshold = 0.5;

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, CurvePruneOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("curve_threshold", options.curve_threshold,
        "score of the paths above which a loop is pruned", closed(0, 1));
  visit_fields(options.curve, visit);
}

namespace detail {

/// The door of the method's room, through which prune() comes.
template <class Pose>
PruneResult prune_by(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const CurvePruneOptions& options, const RunContext& run);

}  // namespace detail

}  // namespace isotherm::slam
