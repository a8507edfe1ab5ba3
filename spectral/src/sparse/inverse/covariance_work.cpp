#include "isotherm/spectral/sparse/covariance_work.hpp"

#include "sparse/inverse/front_tree.hpp"
#include "sparse/inverse/pair_plan.hpp"

namespace isotherm::spectral {

CovarianceWork covariance_work(const BlockCholesky& factor,
                               std::span<const std::pair<Index, Index>> pairs) {
  const detail::FrontTree tree(factor);
  const detail::PairPlan plan(tree, pairs);
  const double d = tree.block_size();
  CovarianceWork work{.pairs = 2.0 * d * d * d * plan.products()};
  for (Index f = 0; f < tree.front_count(); ++f) {
    if (!plan.wanted(f)) continue;
    const double own = d * tree.width(f);
    const double outside = d * (tree.size(f) - tree.width(f));
    work.fronts += own * (2.0 / 3.0 * own * own + 2.0 * own * outside + 2.0 * outside * outside);
  }
  return work;
}

}  // namespace isotherm::spectral
