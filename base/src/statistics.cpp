#include "isotherm/base/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>

#include "isotherm/base/error.hpp"

namespace isotherm {
namespace {

boost::math::chi_squared distribution(int dof) {
  if (dof < 1) throw InvalidArgument("dof", "must be at least 1");
  return boost::math::chi_squared(dof);
}

void require_probability(double probability) {
  if (!(probability >= 0.0 && probability < 1.0)) {
    throw InvalidArgument("probability", "must be in [0, 1)");
  }
}

}  // namespace

double median(std::vector<double> values) {
  const auto half = static_cast<std::ptrdiff_t>(values.size() / 2);
  const auto upper = values.begin() + half;
  std::nth_element(values.begin(), upper, values.end());
  if (values.size() % 2 == 1) return *upper;
  return 0.5 * (*upper + *std::max_element(values.begin(), upper));
}

double quantile(std::vector<double> values, double share) {
  require_probability(share);
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double chi_squared_quantile(double probability, int dof) {
  require_probability(probability);
  return boost::math::quantile(distribution(dof), probability);
}

double chi_squared_upper_tail(double value, int dof) {
  if (!(value >= 0.0)) throw InvalidArgument("value", "must not be negative");
  if (std::isinf(value)) return 0.0;
  return boost::math::cdf(boost::math::complement(distribution(dof), value));
}

double f_quantile(double probability, double dof, double dof_below) {
  require_probability(probability);
  if (!(dof > 0.0)) throw InvalidArgument("dof", "must be positive");
  if (!(dof_below > 0.0)) throw InvalidArgument("dof_below", "must be positive");
  return boost::math::quantile(boost::math::fisher_f(dof, dof_below), probability);
}

}  // namespace isotherm
