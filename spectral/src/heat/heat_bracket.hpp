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

/// What a Lanczos process has told, wherever it runs.
struct LanczosMatrix {
  std::span<const double> diagonal;
  std::span<const double> off_diagonal;  ///< as many: the last is the norm of the next residual
  double norm_bound = 0.0;               ///< of what the process works on
  bool exhausted = false;                ///< the matrix says everything

  int steps() const { return static_cast<int>(diagonal.size()); }
};

/// Brackets a quadratic form of exp(-tL) by a Lanczos matrix: the Gauss rule from below and the
/// Gauss-Radau rule with a node at 0 from above (exp(-t lambda) is completely monotone: Golub and
/// Meurant 2010, ch. 6), with an allowance for what rounding may have done.
class HeatRules {
 public:
  /// `tolerance` is the bracket width aimed at; it sets how accurately the
  /// rules are evaluated.
  explicit HeatRules(double tolerance);

  /// Begins anew with a vector of this squared norm.
  void start(double squared_norm);

  /// Extends the matrix by one row, so that 0 becomes a node; where rounding has left no such
  /// rule an earlier one stands.
  void extend_to_radau(const LanczosMatrix& matrix);

  /// Intersects a bracket with the one of the current rules; gives the number of rules evaluated.
  int tighten(const LanczosMatrix& matrix, double scale, CertifiedValue& bracket) const;

  /// What evaluating a rule, and rounding before it, may have cost.
  double allowance(const LanczosMatrix& matrix, double scale) const;

  /// Whether a bracket is good enough, or as good as rounding lets it become.
  bool settled(const LanczosMatrix& matrix, const HeatGoal& goal, std::size_t scale,
               const CertifiedValue& bracket) const;

 private:
  TridiagonalExponential exponential_;
  double squared_norm_ = 0.0;           // of the target's vector
  std::vector<double> radau_diagonal_;  // of the latest rule with a node at 0, if any
};

/// Brackets a quadratic form of exp(-tL) at every scale of a goal from one local Lanczos run.
class HeatBracketer {
 public:
  HeatBracketer(const SparseMatrix& laplacian, double tolerance);

  /// Fills `values`, one entry a scale, and returns the number of steps taken.
  /// @pre the target is not trivial.
  int run(const HeatTarget& target, const HeatGoal& goal, std::span<CertifiedValue> values);

  /// Effort of the last run until `scale` was bracketed well enough (or until
  /// the end), in units of a matrix entry multiplied.
  std::int64_t work_at(std::size_t scale) const { return work_at_[scale]; }

 private:
  bool settled_all(const HeatGoal& goal, std::span<CertifiedValue> values);
  void tighten(double scale, CertifiedValue& bracket);
  LanczosMatrix matrix() const;

  LocalLanczos lanczos_;
  HeatRules rules_;
  std::vector<std::size_t> order_;  // scales, largest first
  std::int64_t rule_work_ = 0;
  std::vector<std::int64_t> work_at_;
};

}  // namespace isotherm::spectral::detail
