#include "isotherm/spectral/sparse/block_covariance.hpp"

#include <algorithm>
#include <map>
#include <memory>

#include <Eigen/Dense>

#include "sparse/dense_kernels.hpp"
#include "sparse/inverse/half_solve.hpp"
#include "sparse/inverse/pair_plan.hpp"
#include "sparse/inverse/remainders.hpp"

namespace isotherm::spectral {
namespace {

using Eigen::MatrixXd;

// Pairs whose products with a front are formed together.
constexpr std::size_t kBatch = 128;

template <int Dof>
class PairInversion {
 public:
  using Block = typename PairCovariance<Dof>::Block;
  using Pair = std::pair<Index, Index>;
  // Z between all rows of a front.
  using Front = std::shared_ptr<const MatrixXd>;

  PairInversion(const BlockCholesky& factor, std::span<const Pair> pairs)
      : tree_(factor),
        pairs_(pairs),
        plan_(tree_, pairs),
        answers_(pairs.size()),
        diagonal_(factor.block_count()) {}

  std::vector<PairCovariance<Dof>> run() {
    for (const Index root : plan_.roots()) descend(root, nullptr);
    half_solve();
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      const auto [a, b] = pairs_[k];
      if (a >= 0) answers_[k].first = diagonal_[a];
      if (b >= 0) answers_[k].second = diagonal_[b];
    }
    return std::move(answers_);
  }

 private:
  // Follows the heaviest branch and leaves the others to calls of its own, which
  // therefore nest no deeper than the logarithm of the number of fronts.
  void descend(Index front, Front parent) {
    while (true) {
      const Front Z = std::make_shared<const MatrixXd>(invert(front, parent.get()));
      if (!plan_.half_solved(front)) answer(front, *Z);
      const auto& children = plan_.children(front);
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
    const auto pairs = plan_.meeting_at(front);
    for (std::size_t at = 0; at < pairs.size(); at += kBatch) {
      answer_batch(front, Z, pairs.subspan(at, std::min(kBatch, pairs.size() - at)));
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

  // A front's pairs are those that meet there, and those handed on from below.
  void half_solve() {
    std::map<Index, std::vector<std::size_t>> handed_on;
    for (Index f = 0; f < tree_.front_count(); ++f) {
      if (!plan_.half_solved(f)) continue;
      auto pairs = std::move(handed_on[f]);
      handed_on.erase(f);
      const auto own = plan_.meeting_at(f);
      pairs.insert(pairs.end(), own.begin(), own.end());
      add_half_solved(f, pairs);
      if (tree_.parent(f) == FrontTree::kNone) continue;
      auto& above = handed_on[tree_.parent(f)];
      above.insert(above.end(), pairs.begin(), pairs.end());
    }
  }

  void add_half_solved(Index front, std::span<const std::size_t> pairs) {
    std::vector<Index> blocks;
    blocks.reserve(2 * pairs.size());
    for (const std::size_t k : pairs) {
      blocks.push_back(pairs_[k].first);
      blocks.push_back(pairs_[k].second);
    }
    HalfSolve<Dof> x(tree_, front, blocks);
    while (x.next()) {
      for (const std::size_t k : pairs) {
        const auto [a, b] = pairs_[k];
        answers_[k].cross += x.of(a).transpose().lazyProduct(x.of(b));
      }
    }
  }

  FrontTree tree_;
  std::span<const Pair> pairs_;
  PairPlan plan_;
  std::vector<PairCovariance<Dof>> answers_;
  std::vector<Block> diagonal_;
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

}  // namespace isotherm::spectral
