#include "isotherm/spectral/sparse/block_covariance.hpp"

#include <algorithm>
#include <map>

#include <Eigen/Dense>

#include "isotherm/base/error.hpp"
#include "sparse/dense_kernels.hpp"
#include "sparse/inverse/front_inverses.hpp"
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
  using Front = detail::FrontInverses<double>::View;  // Z between all rows of a front

  PairInversion(const BlockCholesky& factor, std::span<const Pair> pairs, int threads)
      : tree_(factor),
        pairs_(pairs),
        threads_(threads),
        plan_(tree_, pairs),
        answers_(pairs.size()),
        inverses_(tree_),
        diagonal_(factor.block_count()) {}

  std::vector<PairCovariance<Dof>> run() {
    for (Index f = tree_.front_count() - 1; f >= 0; --f) {
      if (plan_.wanted(f)) visit(f);
    }
    half_solve();
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      const auto [a, b] = pairs_[k];
      if (a >= 0) answers_[k].first = diagonal_[a];
      if (b >= 0) answers_[k].second = diagonal_[b];
    }
    return std::move(answers_);
  }

 private:
  void visit(Index front) {
    const auto L = tree_.values(front);
    const Eigen::Index width = L.cols();
    MatrixXd eliminated = L.topRows(width);
    detail::invert_from_factor(eliminated);
    MatrixXd X = L.bottomRows(L.rows() - width);
    detail::solve_lower_from_right(L.topRows(width), X);
    const Front Z = inverses_.enter(front, {eliminated.data(), X.data()});
    for (Index k = 0; k < tree_.width(front); ++k) {
      diagonal_[tree_.block(front, k)] = Z.template block<Dof, Dof>(k * Dof, k * Dof);
    }
    read(front, Z);
    if (!plan_.half_solved(front)) answer(front, Z);
  }

  void read(Index front, const Front& Z) {
    for (const std::size_t k : plan_.held_by(front)) {
      const auto [a, b] = pairs_[k];
      answers_[k].cross =
          Z.template block<Dof, Dof>(tree_.place(front, a) * Dof, tree_.place(front, b) * Dof);
    }
  }

  void answer(Index front, const Front& Z) {
    const auto pairs = plan_.meeting_at(front);
    for (std::size_t at = 0; at < pairs.size(); at += kBatch) {
      answer_batch(front, Z, pairs.subspan(at, std::min(kBatch, pairs.size() - at)));
    }
  }

  // Z_ab = w_a' Z w_b, where w_a has one block where a is the front's own.
  void answer_batch(Index front, const Front& Z, std::span<const std::size_t> batch) {
    const detail::Remainders<Dof> w(tree_, pairs_, batch, front);
    MatrixXd product;
    if (w.any_between()) {
      product = MatrixXd::Zero(Z.rows(), w.columns().cols());
      detail::add_product(product, 1.0, Z, w.columns());
    }
    for (const std::size_t k : batch) {
      const auto [a, b] = pairs_[k];
      Block& cross = answers_[k].cross;
      if (tree_.front_of(a) != front && tree_.front_of(b) != front) {
        cross.noalias() = w.of(a).transpose() * product.template middleCols<Dof>(w.column(b));
      } else if (tree_.front_of(b) != front) {
        cross.noalias() = Z.template middleRows<Dof>(tree_.column_of(a) * Dof) * w.of(b);
      } else {
        cross.noalias() =
            w.of(a).transpose() * Z.template middleCols<Dof>(tree_.column_of(b) * Dof);
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
      if (tree_.parent(f) == detail::FrontTree::kNone) continue;
      auto& above = handed_on[tree_.parent(f)];
      above.insert(above.end(), pairs.begin(), pairs.end());
    }
  }

  void add_half_solved(Index front, std::span<const std::size_t> numbers) {
    std::vector<Pair> pairs;
    pairs.reserve(numbers.size());
    for (const std::size_t k : numbers) pairs.push_back(pairs_[k]);
    const auto products = detail::HalfSolve<Dof>(tree_, front, pairs).products(threads_);
    for (std::size_t k = 0; k < numbers.size(); ++k) answers_[numbers[k]].cross += products[k];
  }

  detail::FrontTree tree_;
  std::span<const Pair> pairs_;
  int threads_;
  detail::PairPlan plan_;
  std::vector<PairCovariance<Dof>> answers_;
  detail::FrontInverses<double> inverses_;
  std::vector<Block> diagonal_;
};

}  // namespace

template <int Dof>
std::vector<PairCovariance<Dof>> pair_covariances(const BlockCholesky& factor,
                                                  std::span<const std::pair<Index, Index>> pairs,
                                                  int threads) {
  if (pairs.empty()) return {};
  if (factor.block_count() > 0 && factor.supernodes().values.empty()) {
    throw NumericalError("cholesky", "covariances without a factor");
  }
  return PairInversion<Dof>(factor, pairs, threads).run();
}

template std::vector<PairCovariance<2>> pair_covariances(const BlockCholesky&,
                                                         std::span<const std::pair<Index, Index>>,
                                                         int);
template std::vector<PairCovariance<3>> pair_covariances(const BlockCholesky&,
                                                         std::span<const std::pair<Index, Index>>,
                                                         int);
template std::vector<PairCovariance<6>> pair_covariances(const BlockCholesky&,
                                                         std::span<const std::pair<Index, Index>>,
                                                         int);

}  // namespace isotherm::spectral
