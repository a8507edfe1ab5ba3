#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "heat/heat_bracket.hpp"
#include "heat/heat_plan.hpp"
#include "heat/heat_target.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"
#include "isotherm/spectral/types.hpp"

namespace isotherm::spectral::detail {

struct RationalExponential;

/// Values of quadratic forms of exp(-tL), row-major: targets x scales.
struct HeatTable {
  std::vector<CertifiedValue> values;
  std::vector<HeatMethod> methods;
  std::vector<std::int32_t> steps;
  HeatPlan plan;
};

/// @throws InvalidArgument naming the first scale that is negative or not finite.
void check_scales(std::span<const double> scales);

/// Evaluates quadratic forms of exp(-tL) by the cheapest mix of methods.
/// Options are checked by the caller; both arguments are kept by reference.
class HeatEngine {
 public:
  HeatEngine(const SparseMatrix& laplacian, const HeatDistanceOptions& options)
      : laplacian_(laplacian), options_(options) {}

  /// All targets at all scales; `thresholds` is empty or has one entry a scale.
  HeatTable evaluate(std::span<const HeatTarget> targets, std::span<const double> scales,
                     std::span<const double> thresholds) const;

 private:
  class Rational;

  HeatPlan choose(std::span<const HeatTarget> targets, const HeatGoal& goal,
                  Rational& rational) const;
  void run_lanczos(std::span<const HeatTarget> targets, const HeatGoal& goal,
                   HeatTable& table) const;
  void run_rational(std::span<const HeatTarget> targets, const HeatGoal& goal,
                    std::span<const std::size_t> scales, Rational& rational,
                    HeatTable& table) const;
  void narrow(std::span<const HeatTarget> targets, const HeatGoal& goal,
              std::span<const std::size_t> scales, const RationalExponential& approximation,
              Rational& rational, HeatTable& table) const;

  const SparseMatrix& laplacian_;
  const HeatDistanceOptions& options_;
};

}  // namespace isotherm::spectral::detail
