#pragma once

#include <algorithm>

namespace isotherm::network::detail {

/// Geman and McClure's loss s / (1 + s / width^2) of a squared deviation s, and its
/// derivative, which is the weight of a reweighted least-squares step. An infinite
/// width is plain least squares, a width of 0 no loss at all.
struct GemanMcClure {
  double width = 0.0;

  double loss(double squared) const {
    return width > 0.0 ? squared / (1.0 + squared / (width * width)) : 0.0;
  }
  double weight(double squared) const {
    if (width == 0.0) return 0.0;
    const double share = 1.0 / (1.0 + squared / (width * width));
    return share * share;
  }
};

/// One step of Levenberg and Marquardt. The system offers `linearise()`,
/// `move(damping)`, which solves with that much added to the diagonal and moves
/// there (false if it cannot), `take_back()` and `cost()`. Damping and cost are those
/// of the last step and are updated. False if no step was found that lowers the cost.
template <class System>
bool damped_step(System& system, double& damping, double& cost) {
  constexpr double kMost = 1e6;
  constexpr double kLeast = 1e-9;
  if (!system.linearise()) return false;
  for (; damping < kMost; damping *= 10.0) {
    if (!system.move(damping)) continue;
    const double reached = system.cost();
    if (reached < cost) {
      damping = std::max(kLeast, 0.1 * damping);
      cost = reached;
      return true;
    }
    system.take_back();
  }
  return false;
}

}  // namespace isotherm::network::detail
