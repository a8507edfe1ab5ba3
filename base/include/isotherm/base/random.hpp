#pragma once

#include <cstdint>
#include <random>

namespace isotherm {

/// A seeded source of random numbers that gives the same sequence with every
/// standard library (the distributions of <random> do not promise that).
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [0, 1), with 53 random bits.
  double uniform();

  /// Uniform in [low, high).
  double uniform(double low, double high);

  /// Uniform integer in [0, count), without modulo bias. `count` must be positive.
  std::uint64_t index(std::uint64_t count);

  /// Normal with the given mean and standard deviation (Marsaglia's polar method).
  double normal(double mean = 0.0, double sigma = 1.0);

  /// A vector of fixed size whose entries are normal, of zero mean and unit deviation.
  template <class Vector>
  Vector normal_vector() {
    Vector vector;
    for (double& entry : vector) entry = normal();
    return vector;
  }

 private:
  std::mt19937_64 engine_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace isotherm
