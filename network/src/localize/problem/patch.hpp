#pragma once

#include <vector>

#include "isotherm/network/localize/localize.hpp"
#include "localize/problem/range_problem.hpp"
#include "localize/problem/small_network.hpp"

namespace isotherm::network::detail {

/// A map of a node and its neighbours in a frame of its own.
struct Patch {
  std::vector<Index> members;  ///< ascending; empty if the node has no rigid surroundings
  Eigen::MatrixXd positions;   ///< dimension x members

  bool empty() const { return members.empty(); }
  /// Place of a node among the members, or -1.
  int find(Index node) const;
};

/// The trusted pairs among `members`, which ascend; ends are places among them.
std::vector<SmallRange> inner_ranges(const RangeProblem& problem, const std::vector<bool>& trusted,
                                     const std::vector<Index>& members);

/// The patch of every node, made of the trusted pairs: the node with those of its
/// neighbours that have at least d + 1 trusted pairs inside the patch (or one to every
/// member, where these are fewer), placed by scaling, then robustly fitted. A network
/// of at most `options.patch_size` nodes is one patch, given to its first node. In
/// parallel; the result does not depend on the threads.
std::vector<Patch> make_patches(const RangeProblem& problem, const std::vector<bool>& trusted,
                                const LocalizeOptions& options);

}  // namespace isotherm::network::detail
