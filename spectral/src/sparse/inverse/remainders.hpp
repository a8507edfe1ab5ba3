#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "sparse/inverse/front_tree.hpp"

namespace isotherm::spectral::detail {

/// What elimination of the fronts below one front leaves of e_a on the rows of that
/// front, for every row a of some pairs that is eliminated below it. Rows whose
/// branches have met are carried on together.
template <int Dof>
class Remainders {
 public:
  using Pair = std::pair<Index, Index>;

  /// @param batch which of `pairs`; the branches of each must meet at `front`.
  /// `tree` must outlive this object.
  Remainders(const FrontTree& tree, std::span<const Pair> pairs, std::span<const std::size_t> batch,
             Index front);

  /// Whether some pair has both of its rows below the front.
  bool any_between() const { return any_between_; }

  /// Dof columns a row, in no particular order.
  const Eigen::MatrixXd& columns() const { return columns_; }
  Index column(Index block) const { return place_.at(block) * Dof; }
  auto of(Index block) const { return columns_.template middleCols<Dof>(column(block)); }

 private:
  struct Group {
    std::vector<Index> blocks;
    Eigen::MatrixXd x;  // on the rows of a front, Dof columns a block
  };

  void start(Index block, Index front);
  auto append(Index front, std::span<const Index> blocks);
  void carry_up(Index front, Group group);

  const FrontTree& tree_;
  std::map<Index, Group> groups_;  // by the front they have come to
  std::map<Index, Index> place_;   // of a row among the columns
  bool any_between_ = false;
  Eigen::MatrixXd columns_;
};

extern template class Remainders<2>;
extern template class Remainders<3>;
extern template class Remainders<6>;

}  // namespace isotherm::spectral::detail
