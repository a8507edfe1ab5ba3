#include "isotherm/spectral/sparse/branch_covariance.hpp"

#include <map>

#include "sparse/dense_kernels.hpp"
#include "sparse/inverse/front_tree.hpp"

namespace isotherm::spectral {
namespace {

// What is left of G on the rows of the fronts that elimination has come to.
using OnFronts = std::map<Index, Eigen::MatrixXd>;

template <int Dof>
Eigen::MatrixXd& rows_of(const detail::FrontTree& tree, Index front, OnFronts& left) {
  auto& rows = left[front];
  if (rows.size() == 0) rows = Eigen::MatrixXd::Zero(Eigen::Index{tree.size(front)} * Dof, Dof);
  return rows;
}

// Eliminates a front's own rows, and hands the rest on to its parent.
template <int Dof>
Eigen::Matrix<double, Dof, Dof> eliminate(const detail::FrontTree& tree, Index front,
                                          Eigen::MatrixXd rows, OnFronts& left) {
  const auto L = tree.values(front);
  auto own = rows.topRows(L.cols());
  auto below = rows.bottomRows(L.rows() - L.cols());
  detail::solve_lower(L.topRows(L.cols()), own);
  if (below.rows() > 0) {
    detail::add_product(below, -1.0, L.bottomRows(below.rows()), own);
    auto& parent = rows_of<Dof>(tree, tree.parent(front), left);
    const auto places = tree.place_in_parent(front);
    for (std::size_t k = 0; k < places.size(); ++k) {
      parent.template middleRows<Dof>(places[k] * Dof) +=
          below.template middleRows<Dof>(static_cast<Eigen::Index>(k) * Dof);
    }
  }
  return own.transpose() * own;
}

}  // namespace

template <int Dof>
BranchCovariance<Dof>::BranchCovariance(const BlockCholesky& factor)
    : tree_(std::make_unique<const detail::FrontTree>(factor)) {}

template <int Dof>
BranchCovariance<Dof>::~BranchCovariance() = default;
template <int Dof>
BranchCovariance<Dof>::BranchCovariance(BranchCovariance&&) noexcept = default;
template <int Dof>
BranchCovariance<Dof>& BranchCovariance<Dof>::operator=(BranchCovariance&&) noexcept = default;

template <int Dof>
typename BranchCovariance<Dof>::Block BranchCovariance<Dof>::of(std::span<const Term> terms) const {
  OnFronts left;
  for (const auto& [row, G] : terms) {
    if (row < 0) continue;
    auto& rows = rows_of<Dof>(*tree_, tree_->front_of(row), left);
    rows.template middleRows<Dof>(Eigen::Index{tree_->column_of(row)} * Dof) += G;
  }
  Block sum = Block::Zero();
  // A parent's number is above its children's.
  while (!left.empty()) {
    auto lowest = left.extract(left.begin());
    sum += eliminate<Dof>(*tree_, lowest.key(), std::move(lowest.mapped()), left);
  }
  return sum;
}

template class BranchCovariance<2>;
template class BranchCovariance<3>;
template class BranchCovariance<6>;

}  // namespace isotherm::spectral
