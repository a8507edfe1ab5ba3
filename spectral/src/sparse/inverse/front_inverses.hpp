#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

#include "sparse/inverse/front_tree.hpp"

namespace isotherm::spectral::detail {

/// Up to this many rows of a front, plain loops beat the set-up of a blocked product.
constexpr Eigen::Index kSmallFront = 24;

inline double multiply(double a, double b) { return a * b; }

/// Without the standard's treatment of infinities, which costs a call.
inline std::complex<double> multiply(const std::complex<double>& a, const std::complex<double>& b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

/// target -= factor * source, `count` entries.
template <class Scalar>
void subtract_multiple(Scalar* target, const Scalar* source, Scalar factor, Eigen::Index count) {
  for (Eigen::Index i = 0; i < count; ++i) target[i] -= multiply(factor, source[i]);
}

/// What a factor A = L D L' holds of a front with own columns J and rows R below, by
/// columns: the inverse of the block that was eliminated, (L_JJ D_J L_JJ')^-1, and
/// X = L_RJ L_JJ^-1.
template <class Scalar>
struct EliminatedFront {
  const Scalar* pivots = nullptr;
  const Scalar* x = nullptr;
};

/// All of Z = A^-1 between the rows of each front, from the root of the elimination tree
/// down, by Takahashi's recurrence (Takahashi, Fagan and Chin 1973; Erisman and Tinney
/// 1975) with dense fronts:
///
///     Z_RJ = -Z_RR X,   Z_JJ = (L_JJ D_J L_JJ')^-1 - X' Z_RJ.
///
/// Only those on the way to the root are held at once. Scalar is double or
/// std::complex<double>.
template <class Scalar>
class FrontInverses {
 public:
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  using View = Eigen::Map<Matrix, 0, Eigen::OuterStride<>>;

  /// `tree` must outlive this object.
  explicit FrontInverses(const FrontTree& tree);

  /// Both triangles of Z on a front, until the next call. Fronts must come in descending
  /// order, after their parents.
  View enter(Index front, const EliminatedFront<Scalar>& eliminated);

 private:
  struct Ancestor {
    Index front;
    Eigen::Index begin;  // of its inverse in stack_
  };

  void gather(Index front, View corner);

  const FrontTree& tree_;
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> stack_;  // inverses of the ancestors' fronts
  Eigen::Index top_ = 0;                            // of what is in use
  std::vector<Ancestor> ancestors_;
  std::vector<Eigen::Index> places_;
};

extern template class FrontInverses<double>;
extern template class FrontInverses<std::complex<double>>;

}  // namespace isotherm::spectral::detail
