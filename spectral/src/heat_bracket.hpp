#pragma once

#include <span>
#include <vector>

#include "isotherm/spectral/heat_distance.hpp"
#include "local_lanczos.hpp"
#include "tridiagonal.hpp"

namespace isotherm::spectral::detail {

/// When a bracket is good enough.
struct HeatGoal {
  std::span<const double> scales;
  double tolerance = 0.0;
  std::span<const double> thresholds;  ///< one a scale, or empty
  int max_steps = 0;

  bool reached(const CertifiedValue& value, std::size_t scale) const;
};

/// Brackets D_e(t) of one pair at every scale of a goal from one Lanczos run,
/// by the Gauss rule from below and the Gauss-Radau rule with a node at 0 from
/// above (exp(-t lambda) is completely monotone: Golub and Meurant 2010, ch. 6).
class HeatBracketer {
 public:
  explicit HeatBracketer(const SparseMatrix& laplacian) : lanczos_(laplacian) {}

  /// Fills `values`, one entry a scale, and returns the number of steps taken.
  /// @pre from != to.
  int run(VertexPair pair, const HeatGoal& goal, std::span<CertifiedValue> values);

  /// Matrix entries and quadrature operations spent by the last run.
  std::int64_t work() const { return work_; }

 private:
  bool tighten(const HeatGoal& goal, std::span<CertifiedValue> values);
  bool radau_rule();

  LocalLanczos lanczos_;
  QuadratureRule gauss_;
  QuadratureRule radau_;
  std::vector<double> radau_diagonal_;
  std::int64_t work_ = 0;
};

}  // namespace isotherm::spectral::detail
