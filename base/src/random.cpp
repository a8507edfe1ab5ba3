#include "isotherm/base/random.hpp"

#include <cmath>
#include <limits>

#include "isotherm/base/error.hpp"

namespace isotherm {

double Random::uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

double Random::uniform(double low, double high) { return low + (high - low) * uniform(); }

std::uint64_t Random::index(std::uint64_t count) {
  if (count == 0) throw InvalidArgument("count", "must be positive");
  // Draws below this bound fall into `count` equally large classes.
  const std::uint64_t bound = std::numeric_limits<std::uint64_t>::max() -
                              (std::numeric_limits<std::uint64_t>::max() % count + 1) % count;
  std::uint64_t draw = engine_();
  while (draw > bound) draw = engine_();
  return draw % count;
}

double Random::normal(double mean, double sigma) {
  if (has_spare_) {
    has_spare_ = false;
    return mean + sigma * spare_;
  }
  double u = 0.0;
  double v = 0.0;
  double s = 0.0;
  do {
    u = uniform(-1.0, 1.0);
    v = uniform(-1.0, 1.0);
    s = u * u + v * v;
  } while (s >= 1.0 || s == 0.0);
  const double scale = std::sqrt(-2.0 * std::log(s) / s);
  spare_ = v * scale;
  has_spare_ = true;
  return mean + sigma * u * scale;
}

}  // namespace isotherm
