#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Core>

#include "isotherm/spectral/sparse/block_cholesky.hpp"

namespace isotherm::spectral {

/// The diagonal of a matrix, with a floor for directions that nothing measures.
Eigen::VectorXd damping_scale(const BlockCholesky& matrix);

/// x = A^-1 b where A is numerically positive definite. Elsewhere with the least
/// multiple of `damping_scale` on the diagonal that makes it so.
/// @throws NumericalError if up to the whole diagonal does not
Eigen::MatrixXd solve_least_damped(BlockCholesky& matrix, const Eigen::MatrixXd& rhs);

/// What became of one attempt at a damped step.
struct DampedTrial {
  bool solved = false;    ///< the damped system has a solution
  bool lower = false;     ///< the step was made, and lowers the cost
  double cost = 0.0;      ///< where the system is now
  double promised = 0.0;  ///< decrease in the quadratic model
};

/// One attempt at a step of Levenberg and Marquardt from a point of known cost. The
/// system, set up there, offers `move(damping)`, which solves with that much damping, moves
/// there and gives the decrease that its model promises (or nothing if it cannot);
/// `cost()`; and `take_back()`, which undoes the move.
template <class System>
DampedTrial try_damped_step(System& system, double damping, double cost) {
  const std::optional<double> promised = system.move(damping);
  if (!promised) return {false, false, cost, 0.0};
  const double reached = system.cost();
  if (reached < cost) return {true, true, reached, *promised};
  system.take_back();
  return {true, false, cost, *promised};
}

/// Damping that follows how well the model foretold what a step gains (Nielsen 1999).
struct GainDamping {
  double value = 0.0;
  double growth = 2.0;

  /// @param gain achieved decrease by that promised; negative for a step not made
  void follow(double gain) {
    if (gain > 0.0) {
      value *= std::max(0.1, 1.0 - std::pow(2.0 * gain - 1.0, 3));
      growth = 2.0;
    } else {
      value *= growth;
      growth *= 2.0;
    }
  }
};

/// One step, with ten times as much damping after each attempt that fails and a tenth
/// after one that does not. The system also offers `linearise()`, which sets it up where it
/// is (false if nothing can move). Damping and cost are those of the last step and are
/// updated. False if no step was found that lowers the cost.
template <class System>
bool damped_step(System& system, double& damping, double& cost) {
  constexpr double kMost = 1e6;
  constexpr double kLeast = 1e-9;
  if (!system.linearise()) return false;
  for (; damping < kMost; damping *= 10.0) {
    const DampedTrial trial = try_damped_step(system, damping, cost);
    if (!trial.lower) continue;
    damping = std::max(kLeast, 0.1 * damping);
    cost = trial.cost;
    return true;
  }
  return false;
}

}  // namespace isotherm::spectral
