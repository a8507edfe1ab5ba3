#pragma once

#include <array>
#include <concepts>
#include <string>
#include <type_traits>
#include <vector>

#include "isotherm/base/options.hpp"
#include "isotherm/base/progress.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/slam/optimize/initialize.hpp"
#include "isotherm/slam/prune/consensus.hpp"
#include "isotherm/slam/prune/heat_prune.hpp"
#include "isotherm/slam/prune/pcm.hpp"
#include "isotherm/slam/prune/rrr.hpp"
#include "isotherm/spectral/edges/edge_verdicts.hpp"

namespace isotherm::slam {

/// How false loop closures are found.
enum class PruneMethod {
  consensus,  ///< forward consensus, see consensus.hpp
  heat,       ///< multi-scale heat-kernel pruning, see heat_prune.hpp
  chi2,       ///< chi-squared of each loop against odometry alone, see odometry_chi2.hpp
  lap_line,   ///< how unlike the paths at its ends are, see curve_evidence.hpp
  rrr,        ///< consistent clusters of loops, see rrr.hpp
  pcm,        ///< largest pairwise consistent set, see pcm.hpp
  // What a robust optimisation gives less than half its weight, see robust_kernel.hpp.
  sc,
  dcs,
  cauchy,
  gnc,
};

constexpr std::array<EnumName<PruneMethod>, 10> enum_names(PruneMethod) {
  return {{{PruneMethod::consensus, "consensus"},
           {PruneMethod::heat, "heat"},
           {PruneMethod::chi2, "chi2"},
           {PruneMethod::lap_line, "lap-line"},
           {PruneMethod::rrr, "rrr"},
           {PruneMethod::pcm, "pcm"},
           {PruneMethod::sc, "sc"},
           {PruneMethod::dcs, "dcs"},
           {PruneMethod::cauchy, "cauchy"},
           {PruneMethod::gnc, "gnc"}}};
}

struct PruneOptions {
  PruneMethod method = PruneMethod::consensus;
  /// Probability with which a correct loop may be pruned, where a method tests
  /// against a distribution; in (0, 1), or 0 for the method's own default: 0.0001
  /// for consensus, whose predictions sharpen as it goes, 0.01 for chi2.
  double significance = 0.0;
  HeatPruneOptions heat;
  ConsensusOptions consensus;
  RrrOptions rrr;
  PcmOptions pcm;
  /// Width of the kernel of sc, dcs, cauchy and gnc; 0: default_kernel_width().
  double kernel_width = 0.0;
  /// Where rrr, sc, dcs, cauchy and gnc start optimising.
  Initialization initialization = Initialization::automatic;
  /// Method lap_line, which compares curves by heat.induction.curve: the score
  /// above which a loop is pruned; in [0, 1].
  double curve_threshold = 0.5;
  ProgressCallback progress = {};
  int threads = 0;  ///< 0: all cores; results do not depend on it

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, PruneOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("method", options.method, "how false loop closures are found");
  visit("significance", options.significance,
        "probability with which a correct loop may be pruned; 0: 0.0001 for consensus, 0.01 for "
        "chi2");
  visit_fields(options.consensus, visit);
  visit_fields(options.heat, visit);
  visit_fields(options.rrr, visit);
  visit_fields(options.pcm, visit);
  visit("kernel_width", options.kernel_width,
        "width of the kernel (sc, dcs, cauchy, gnc); 0: its own default");
  visit("initialization", options.initialization,
        "where optimisation starts (rrr, sc, dcs, cauchy, gnc)");
  visit("curve_threshold", options.curve_threshold,
        "lap-line: score of the paths above which a loop is pruned");
}

struct PruneResult {
  PruneMethod method = PruneMethod::consensus;
  spectral::EdgeVerdicts verdicts;    ///< one a candidate, in file order
  std::vector<HeatRound> rounds;      ///< method heat: one a scale
  ConsensusResult consensus;          ///< method consensus: all but the verdicts
  std::vector<std::string> warnings;  ///< what a user should know about the result
  double seconds = 0.0;               ///< wall time
};

/// Judges every candidate of `roles` by the chosen method. Where all information
/// matrices of odometry or of candidates are zero, consensus gives way to heat
/// with uniform weights; `method` and `warnings` of the result say so.
/// @throws InvalidArgument, NumericalError, Cancelled
template <class Pose>
PruneResult prune(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                  const PruneOptions& options = {});

/// The graph without the constraints that are pruned, nor, unless
/// `keep_ambiguous`, those that are ambiguous.
/// @throws InvalidArgument if a verdict's edge is not one of the graph's
template <class Pose>
PoseGraph<Pose> apply_verdicts(const PoseGraph<Pose>& graph, const spectral::EdgeVerdicts& verdicts,
                               bool keep_ambiguous = false);

}  // namespace isotherm::slam
