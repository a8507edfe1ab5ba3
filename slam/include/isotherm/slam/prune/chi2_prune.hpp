#pragma once

#include <concepts>
#include <string_view>
#include <type_traits>

#include "isotherm/base/range.hpp"
#include "isotherm/base/run_context.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam {

struct PruneResult;  // prune.hpp

/// Chi-squared of each loop against odometry alone, see odometry_chi2.hpp. A loop that no
/// odometry path can contradict is kept.
struct Chi2PruneOptions {
  static std::string_view method() { return "chi2"; }
  static std::string_view title() { return "The chi-squared gate"; }

  /// Probability with which a correct loop may be pruned; in (0, 1).
  double significance = 0.01;

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, Chi2PruneOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("significance", options.significance, "probability with which a correct loop may be pruned",
        open(0, 1));
}

namespace detail {

/// The door of the method's room, through which prune() comes.
template <class Pose>
PruneResult prune_by(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const Chi2PruneOptions& options, const RunContext& run);

}  // namespace detail

}  // namespace isotherm::slam
