#include "heat/tridiagonal_exponential.hpp"

#include <cmath>
#include <limits>

namespace isotherm::spectral::detail {

TridiagonalExponential::TridiagonalExponential(const RationalExponential& rational)
    : constant_(rational.constant), approximation_error_(rational.error) {
  shift_real_.fill(1.0);
  shift_imag_.fill(0.0);
  residue_real_.fill(0.0);
  residue_imag_.fill(0.0);
  for (std::size_t k = 0; k < rational.terms.size(); ++k) {
    const auto& term = rational.terms[k];
    const double conjugates = is_real(term) ? 1.0 : 2.0;
    shift_real_[k] = term.shift.real();
    shift_imag_[k] = term.shift.imag();
    residue_real_[k] = conjugates * term.residue.real();
    residue_imag_[k] = conjugates * term.residue.imag();
    const double resolvent = resolvent_norm(term);
    rounding_constant_ += conjugates * std::abs(term.residue) * resolvent;
    rounding_slope_ += conjugates * std::abs(term.residue) * resolvent * resolvent;
  }
}

double TridiagonalExponential::operator()(std::span<const double> diagonal,
                                          std::span<const double> off_diagonal,
                                          double scale) const {
  // Pivots from the bottom up: d_k = t alpha_k + z - (t beta_k)^2 / d_(k+1).
  // Their imaginary parts only grow, so no division is by less than |Im z|.
  const std::size_t last = diagonal.size() - 1;
  Lanes real, imag;
  for (std::size_t p = 0; p < kLanes; ++p) {
    real[p] = scale * diagonal[last] + shift_real_[p];
    imag[p] = shift_imag_[p];
  }
  for (std::size_t k = last; k-- > 0;) {
    const double alpha = scale * diagonal[k];
    const double beta = scale * off_diagonal[k];
    const double squared = beta * beta;
    for (std::size_t p = 0; p < kLanes; ++p) {
      const double factor = squared / (real[p] * real[p] + imag[p] * imag[p]);
      real[p] = alpha + shift_real_[p] - factor * real[p];
      imag[p] = shift_imag_[p] + factor * imag[p];
    }
  }
  double sum = constant_;
  for (std::size_t p = 0; p < kLanes; ++p) {
    sum += (residue_real_[p] * real[p] + residue_imag_[p] * imag[p]) /
           (real[p] * real[p] + imag[p] * imag[p]);
  }
  return sum;
}

double TridiagonalExponential::error_bound(double scale, double norm) const {
  constexpr double kUnit = std::numeric_limits<double>::epsilon();
  return approximation_error_ +
         4.0 * kUnit * (1.0 + rounding_constant_ + rounding_slope_ * scale * norm);
}

}  // namespace isotherm::spectral::detail
