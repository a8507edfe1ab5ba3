#include "isotherm/base/statistics.hpp"

#include <cmath>

#include <boost/math/distributions/chi_squared.hpp>

#include "isotherm/base/error.hpp"

namespace isotherm {
namespace {

boost::math::chi_squared distribution(int dof) {
  if (dof < 1) throw InvalidArgument("dof", "must be at least 1");
  return boost::math::chi_squared(dof);
}

}  // namespace

double chi_squared_quantile(double probability, int dof) {
  if (!(probability >= 0.0 && probability < 1.0)) {
    throw InvalidArgument("probability", "must be in [0, 1)");
  }
  return boost::math::quantile(distribution(dof), probability);
}

double chi_squared_upper_tail(double value, int dof) {
  if (!(value >= 0.0)) throw InvalidArgument("value", "must not be negative");
  if (std::isinf(value)) return 0.0;
  return boost::math::cdf(boost::math::complement(distribution(dof), value));
}

}  // namespace isotherm
