#include "edges/pair_ranks.hpp"

#include <algorithm>

#include "graph/point_tree.hpp"
#include "isotherm/base/parallel.hpp"

namespace isotherm::spectral::detail {

std::vector<double> pair_ranks(const Eigen::MatrixXd& positions,
                               const std::vector<VertexPair>& pairs, int threads,
                               const ProgressCallback& progress) {
  const PointTree tree(positions);
  std::vector<double> ranks(pairs.size(), 0.0);
  isotherm::parallel_for(static_cast<std::int64_t>(pairs.size()), threads, progress, "ranks",
                         [&](std::int64_t k) {
                           const auto& [i, j] = pairs[k];
                           ranks[k] = std::min(tree.count_nearer(i, j), tree.count_nearer(j, i));
                         });
  return ranks;
}

}  // namespace isotherm::spectral::detail
