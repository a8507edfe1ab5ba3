#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "heat/heat_target.hpp"
#include "heat/local_lanczos.hpp"
#include "heat/tridiagonal_exponential.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"

namespace isotherm::spectral::detail {

/// When a bracket is good enough.
struct HeatGoal {
  std::span<const double> scales;
  double tolerance = 0.0;
  std::span<const double> thresholds;  ///< one a scale, or empty
  int max_steps = 0;
  std::vector<bool> optional = {};  ///< scales that a run need not reach; none if empty
  bool watch_every_scale = false;   ///< note when each scale is reached, not only the last
  std::int64_t max_work = std::numeric_limits<std::int64_t>::max();  ///< ends a run

  bool required(std::size_t scale) const { return optional.empty() || !optional[scale]; }
  bool reached(const CertifiedValue& value, std::size_t scale) const;
};

/// Brackets a quadratic form of exp(-tL) at every scale of a goal from one Lanczos run,
/// by the Gauss rule from below and the Gauss-Radau rule with a node at 0 from
/// above (exp(-t lambda) is completely monotone: Golub and Meurant 2010, ch. 6).
class HeatBracketer {
 public:
  /// `tolerance` is the bracket width aimed at; it sets how accurately the
  /// rules are evaluated.
  HeatBracketer(const SparseMatrix& laplacian, double tolerance);

  /// Fills `values`, one entry a scale, and returns the number of steps taken.
  /// @pre the target is not trivial.
  int run(const HeatTarget& target, const HeatGoal& goal, std::span<CertifiedValue> values);

  /// Effort of the last run until `scale` was bracketed well enough (or until
  /// the end), in units of a matrix entry multiplied.
  std::int64_t work_at(std::size_t scale) const { return work_at_[scale]; }

 private:
  bool settled_all(const HeatGoal& goal, std::span<CertifiedValue> values);
  double allowance(double scale) const;
  void tighten(double scale, CertifiedValue& bracket);
  void extend_to_radau();

  LocalLanczos lanczos_;
  TridiagonalExponential exponential_;
  double squared_norm_ = 0.0;           // of the target's vector
  std::vector<std::size_t> order_;      // scales, largest first
  std::vector<double> radau_diagonal_;  // of the latest rule with a node at 0, if any
  std::int64_t rule_work_ = 0;
  std::vector<std::int64_t> work_at_;
};

}  // namespace isotherm::spectral::detail
