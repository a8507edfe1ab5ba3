#pragma once

#include <array>
#include <vector>

#include "isotherm/base/options.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam {

/// Where an optimisation starts.
enum class Initialization {
  /// The method's own: switchable for GNC and RRR, odometry for the other robust ones;
  /// without a kernel the chordal relaxation or the spanning tree, whichever costs less.
  automatic,
  odometry,       ///< chained odometry; parts it does not join hang on other constraints
  spanning_tree,  ///< shortest paths, in constraints, from the held vertices
  chordal,        ///< linear least squares for rotations, then for translations
  file,           ///< the graph's own poses
  /// The optimum of switchable constraints (robust_kernel.hpp) from odometry: a start
  /// near the map that most loops agree on, for methods that only go downhill.
  switchable,
};

constexpr std::array<EnumName<Initialization>, 6> enum_names(Initialization) {
  return {{{Initialization::automatic, "automatic"},
           {Initialization::odometry, "odometry"},
           {Initialization::spanning_tree, "spanning-tree"},
           {Initialization::chordal, "chordal"},
           {Initialization::file, "file"},
           {Initialization::switchable, "switchable"}}};
}

/// A first estimate of every pose.
///
/// Vertices that the graph fixes, and the first vertex of every connected
/// component without one, are where the graph's own poses put them, or at the
/// identity if it has none. Constraints with zero information join nothing.
///
/// `odometry` and `spanning_tree` cost O(n + m) and satisfy the constraints they
/// follow exactly. `chordal` uses every constraint: it relaxes rotations to
/// matrices, solves two sparse linear systems and projects back (L. Carlone et
/// al., "Initialization Techniques for 3D SLAM", ICRA 2015); false loops spoil
/// it, but on clean graphs it starts close to the global optimum. `switchable`
/// optimises, with the candidates of `roles` switched; odometry where that diverges.
/// @throws InvalidArgument for `file` if the graph has no poses.
template <class Pose>
std::vector<Pose> initial_poses(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                Initialization method);

}  // namespace isotherm::slam
