#include "block_covariance.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <numeric>

#include <Eigen/Dense>

#include "dense_kernels.hpp"
#include "front_tree.hpp"

namespace isotherm::slam {
namespace {

using Eigen::MatrixXd;

// Pairs whose products with a front are formed together.
constexpr std::ptrdiff_t kBatch = 128;

// What elimination of the fronts below one front leaves of e_a on the rows of that
// front, for every row a of some pairs that is eliminated below it. Rows whose
// branches have met are carried on together.
template <int Dof>
class Remainders {
 public:
  using Pair = std::pair<Index, Index>;

  Remainders(const FrontTree& tree, std::span<const Pair> pairs, std::span<const std::size_t> batch,
             Index front)
      : tree_(tree) {
    for (const std::size_t k : batch) {
      start(pairs[k].first, front);
      start(pairs[k].second, front);
      const bool below = tree.front_of(pairs[k].first) != front;
      any_between_ = any_between_ || (below && tree.front_of(pairs[k].second) != front);
    }
    // A parent's number is above its children's.
    while (!groups_.empty() && groups_.begin()->first != front) {
      auto lowest = groups_.extract(groups_.begin());
      carry_up(lowest.key(), std::move(lowest.mapped()));
    }
    if (groups_.empty()) return;
    columns_ = std::move(groups_.begin()->second.x);
    const auto& blocks = groups_.begin()->second.blocks;
    for (std::size_t k = 0; k < blocks.size(); ++k) place_[blocks[k]] = static_cast<Index>(k);
  }

  /// Whether some pair has both of its rows below the front.
  bool any_between() const { return any_between_; }

  /// Dof columns a row, in no particular order.
  const MatrixXd& columns() const { return columns_; }
  Index column(Index block) const { return place_.at(block) * Dof; }
  auto of(Index block) const { return columns_.template middleCols<Dof>(column(block)); }

 private:
  struct Group {
    std::vector<Index> blocks;
    MatrixXd x;  // on the rows of a front, Dof columns a block
  };

  void start(Index block, Index front) {
    const Index own = tree_.front_of(block);
    if (own == front || !place_.emplace(block, 0).second) return;
    auto x = append(own, {&block, 1});
    x.template middleRows<Dof>(tree_.column_of(block) * Dof).setIdentity();
  }

  // New columns, zero, of the group at a front.
  auto append(Index front, std::span<const Index> blocks) {
    auto& group = groups_[front];
    const auto before = static_cast<Eigen::Index>(group.blocks.size()) * Dof;
    const auto added = static_cast<Eigen::Index>(blocks.size()) * Dof;
    group.blocks.insert(group.blocks.end(), blocks.begin(), blocks.end());
    group.x.conservativeResize(Eigen::Index{tree_.size(front)} * Dof, before + added);
    auto fresh = group.x.rightCols(added);
    fresh.setZero();
    return fresh;
  }

  void carry_up(Index front, Group group) {
    const auto L = tree_.values(front);
    const Eigen::Index width = L.cols();
    const Eigen::Index below = L.rows() - width;
    auto own = group.x.topRows(width);
    auto left = group.x.bottomRows(below);
    solve_lower(L.topRows(width), own);
    add_product(left, -1.0, L.bottomRows(below), own);
    auto target = append(tree_.parent(front), group.blocks);
    const auto places = tree_.place_in_parent(front);
    for (std::size_t k = 0; k < places.size(); ++k) {
      target.template middleRows<Dof>(places[k] * Dof) = left.template middleRows<Dof>(k * Dof);
    }
  }

  const FrontTree& tree_;
  std::map<Index, Group> groups_;  // by the front they have come to
  std::map<Index, Index> place_;   // of a row among the columns
  bool any_between_ = false;
  MatrixXd columns_;
};

template <int Dof>
class PairInversion {
 public:
  using Block = typename PairCovariance<Dof>::Block;
  using Pair = std::pair<Index, Index>;
  // Z between all rows of a front.
  using Front = std::shared_ptr<const MatrixXd>;

  PairInversion(const BlockCholesky& factor, std::span<const Pair> pairs)
      : tree_(factor), pairs_(pairs), answers_(pairs.size()), diagonal_(factor.block_count()) {
    sort_pairs_by_meeting();
    find_wanted_fronts();
  }

  std::vector<PairCovariance<Dof>> run() {
    for (const Index root : roots_) descend(root, nullptr);
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      const auto [a, b] = pairs_[k];
      if (a >= 0) answers_[k].first = diagonal_[a];
      if (b >= 0) answers_[k].second = diagonal_[b];
    }
    return std::move(answers_);
  }

 private:
  void sort_pairs_by_meeting() {
    std::vector<Index> meeting(pairs_.size(), FrontTree::kNone);
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      const auto [a, b] = pairs_[k];
      if (a >= 0 && b >= 0) meeting[k] = tree_.meeting(tree_.front_of(a), tree_.front_of(b));
    }
    by_meeting_.resize(pairs_.size());
    std::iota(by_meeting_.begin(), by_meeting_.end(), std::size_t{0});
    std::stable_sort(by_meeting_.begin(), by_meeting_.end(),
                     [&](std::size_t x, std::size_t y) { return meeting[x] < meeting[y]; });
    first_pair_.assign(tree_.front_count() + 1, 0);
    for (std::size_t k = 0; k < pairs_.size(); ++k) ++first_pair_[meeting[k] + 1];
    std::partial_sum(first_pair_.begin(), first_pair_.end(), first_pair_.begin());
  }

  // Those on the way from a root to a row that is asked for. A front's cost is that of
  // its whole branch.
  void find_wanted_fronts() {
    const Index fronts = tree_.front_count();
    std::vector<bool> wanted(fronts, false);
    for (const auto& [a, b] : pairs_) {
      if (a >= 0) wanted[tree_.front_of(a)] = true;
      if (b >= 0) wanted[tree_.front_of(b)] = true;
    }
    cost_.assign(fronts, 0.0);
    children_.resize(fronts);
    for (Index f = 0; f < fronts; ++f) {
      if (!wanted[f]) continue;
      const double size = Dof * tree_.size(f);
      cost_[f] += size * size * Dof * tree_.width(f);
      const Index p = tree_.parent(f);
      if (p == FrontTree::kNone) {
        roots_.push_back(f);
      } else {
        wanted[p] = true;
        cost_[p] += cost_[f];
        children_[p].push_back(f);
      }
    }
    // The heaviest child comes first.
    for (auto& list : children_) {
      if (list.empty()) continue;
      std::iter_swap(list.begin(),
                     std::max_element(list.begin(), list.end(),
                                      [&](Index x, Index y) { return cost_[x] < cost_[y]; }));
    }
  }

  // Follows the heaviest branch and leaves the others to calls of its own, which
  // therefore nest no deeper than the logarithm of the number of fronts.
  void descend(Index front, Front parent) {
    while (true) {
      const Front Z = std::make_shared<const MatrixXd>(invert(front, parent.get()));
      answer(front, *Z);
      const auto& children = children_[front];
      if (children.empty()) return;
      for (auto child = children.begin() + 1; child != children.end(); ++child) descend(*child, Z);
      parent = Z;
      front = children.front();
    }
  }

  // With J a front's own columns, R the rows below and Y = L_RJ L_JJ^-1:
  // Z_RJ = -Z_RR Y and Z_JJ = (L_JJ L_JJ')^-1 - Y' Z_RJ.
  MatrixXd invert(Index front, const MatrixXd* parent) {
    const auto L = tree_.values(front);
    const Eigen::Index width = L.cols();
    const Eigen::Index below = L.rows() - width;
    const auto pivots = L.topRows(width).template triangularView<Eigen::Lower>();
    MatrixXd Z(L.rows(), L.rows());
    const MatrixXd root = pivots.solve(MatrixXd::Identity(width, width));
    Z.topLeftCorner(width, width).noalias() = root.transpose() * root;
    if (below > 0) {
      gather(tree_.place_in_parent(front), *parent, Z.bottomRightCorner(below, below));
      const MatrixXd Y = L.bottomRows(below) * root;
      Z.bottomLeftCorner(below, width).noalias() = -Z.bottomRightCorner(below, below) * Y;
      Z.topLeftCorner(width, width).noalias() -= Y.transpose() * Z.bottomLeftCorner(below, width);
      Z.topRightCorner(width, below) = Z.bottomLeftCorner(below, width).transpose();
    }
    for (Index k = 0; k < tree_.width(front); ++k) {
      diagonal_[tree_.block(front, k)] = Z.template block<Dof, Dof>(k * Dof, k * Dof);
    }
    return Z;
  }

  template <class Target>
  static void gather(std::span<const Index> places, const MatrixXd& from, Target&& to) {
    for (std::size_t j = 0; j < places.size(); ++j) {
      for (std::size_t i = 0; i < places.size(); ++i) {
        to.template block<Dof, Dof>(i * Dof, j * Dof) =
            from.template block<Dof, Dof>(places[i] * Dof, places[j] * Dof);
      }
    }
  }

  void answer(Index front, const MatrixXd& Z) {
    const auto first = by_meeting_.begin() + first_pair_[front];
    const auto last = by_meeting_.begin() + first_pair_[front + 1];
    for (auto at = first; at < last;) {
      const auto end = at + std::min<std::ptrdiff_t>(kBatch, last - at);
      answer_batch(front, Z, {at, end});
      at = end;
    }
  }

  // Z_ab = w_a' Z w_b, where w_a has one block where a is the front's own.
  void answer_batch(Index front, const MatrixXd& Z, std::span<const std::size_t> batch) {
    const Remainders<Dof> w(tree_, pairs_, batch, front);
    MatrixXd product;
    if (w.any_between()) {
      product = MatrixXd::Zero(Z.rows(), w.columns().cols());
      add_product(product, 1.0, Z, w.columns());
    }
    for (const std::size_t k : batch) {
      const auto [a, b] = pairs_[k];
      Block& cross = answers_[k].cross;
      if (tree_.front_of(a) != front && tree_.front_of(b) != front) {
        cross.noalias() = w.of(a).transpose() * product.template middleCols<Dof>(w.column(b));
      } else if (tree_.front_of(b) != front) {
        cross.noalias() = Z.template middleRows<Dof>(tree_.column_of(a) * Dof) * w.of(b);
      } else if (tree_.front_of(a) != front) {
        cross.noalias() =
            w.of(a).transpose() * Z.template middleCols<Dof>(tree_.column_of(b) * Dof);
      } else {
        cross = Z.template block<Dof, Dof>(tree_.column_of(a) * Dof, tree_.column_of(b) * Dof);
      }
    }
  }

  FrontTree tree_;
  std::span<const Pair> pairs_;
  std::vector<PairCovariance<Dof>> answers_;
  std::vector<Block> diagonal_;
  std::vector<std::size_t> by_meeting_;       // pairs, by the front where their branches meet
  std::vector<std::size_t> first_pair_;       // places in by_meeting_, one a front and an end
  std::vector<std::vector<Index>> children_;  // those wanted, the heaviest first
  std::vector<double> cost_;
  std::vector<Index> roots_;
};

}  // namespace

template <int Dof>
std::vector<PairCovariance<Dof>> pair_covariances(const BlockCholesky& factor,
                                                  std::span<const std::pair<Index, Index>> pairs) {
  if (pairs.empty()) return {};
  return PairInversion<Dof>(factor, pairs).run();
}

template std::vector<PairCovariance<3>> pair_covariances(const BlockCholesky&,
                                                         std::span<const std::pair<Index, Index>>);
template std::vector<PairCovariance<6>> pair_covariances(const BlockCholesky&,
                                                         std::span<const std::pair<Index, Index>>);

}  // namespace isotherm::slam
