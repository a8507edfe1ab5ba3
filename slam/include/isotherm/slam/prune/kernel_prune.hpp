#pragma once

#include <concepts>
#include <string_view>
#include <type_traits>

#include "isotherm/base/options.hpp"
#include "isotherm/base/range.hpp"
#include "isotherm/base/run_context.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/slam/optimize/initialize.hpp"
#include "isotherm/slam/optimize/robust_kernel.hpp"

namespace isotherm::slam {

struct PruneResult;  // prune.hpp

/// What a robust optimisation gives less than half its weight, see robust_kernel.hpp.
template <RobustKernel chosen>
struct KernelPruneOptions {
  static constexpr RobustKernel kKernel = chosen;
  static std::string_view method() { return enum_name(chosen); }
  static std::string_view title();

  /// See evaluate_kernel(); finite, >= 0; 0: default_kernel_width().
  double kernel_width = 0.0;
  /// Where the optimisation starts.
  Initialization initialization = Initialization::automatic;

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

using ScOptions = KernelPruneOptions<RobustKernel::sc>;
using DcsOptions = KernelPruneOptions<RobustKernel::dcs>;
using CauchyOptions = KernelPruneOptions<RobustKernel::cauchy>;
using GncOptions = KernelPruneOptions<RobustKernel::gnc>;

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, KernelPruneOptions<Options::kKernel>>
void visit_fields(Options& options, Visitor&& visit) {
  visit("kernel_width", options.kernel_width, "width of the kernel; 0: its own default",
        closed(0, 1e12));
  visit("initialization", options.initialization, "where the optimisation starts");
}

namespace detail {

/// The door of the methods' room, through which prune() comes.
template <class Pose, RobustKernel kernel>
PruneResult prune_by(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const KernelPruneOptions<kernel>& options, const RunContext& run);

}  // namespace detail

}  // namespace isotherm::slam
