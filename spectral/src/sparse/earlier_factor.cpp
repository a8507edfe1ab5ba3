#include "isotherm/spectral/sparse/earlier_factor.hpp"

#include <cmath>

namespace isotherm::spectral {
namespace {

// Of a Newton step that another one follows, or that is small: the next is still a hundred times
// nearer (Dembo, Eisenstat and Steihaug 1982).
constexpr double kTolerance = 1e-2;
// As many solutions take half as long as a factorisation (measured, meshes in space of 10^4 to
// 10^5 poses and chains: 11 to 17 are as long).
constexpr int kMostSteps = 6;

// Whether squared lengths of residuals have fallen so far that they will be small enough in time.
bool on_the_way(double squared, double first, int step) {
  return squared <= first * std::pow(kTolerance, 2.0 * step / kMostSteps);
}

}  // namespace

std::optional<Eigen::VectorXd> solve_by_earlier_factor(const BlockCholesky& matrix,
                                                       const Eigen::VectorXd& rhs) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(rhs.size());
  Eigen::VectorXd left = rhs;
  Eigen::VectorXd direction = matrix.solve(left);
  const double first = left.dot(direction);
  double squared = first;  // of what is left, in the norm of the inverse
  for (int step = 1; squared > kTolerance * kTolerance * first; ++step) {
    const Eigen::VectorXd image = matrix.multiply(direction);
    const double length = squared / direction.dot(image);
    x += length * direction;
    left -= length * image;
    const Eigen::VectorXd next = matrix.solve(left);
    const double before = squared;
    squared = left.dot(next);
    if (!(length > 0.0) || !on_the_way(squared, first, step)) return std::nullopt;
    direction = next + squared / before * direction;
  }
  if (!std::isfinite(first)) return std::nullopt;
  return x;
}

}  // namespace isotherm::spectral
