#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "isotherm/base/options.hpp"
#include "isotherm/base/progress.hpp"
#include "isotherm/base/range.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"
#include "isotherm/spectral/types.hpp"

/// Squared heat distances D_e(t) = (e_i - e_j)' exp(-tL) (e_i - e_j) (paper
/// eq. 9) for many pairs e = (i, j) at many scales t, each with a certified
/// bracket, without an n x n matrix and without a truncated spectrum.
namespace isotherm::spectral {

/// How a heat distance was found.
enum class HeatMethod {
  automatic,  ///< in options: the cheaper of the two by counted operations
  lanczos,    ///< local Lanczos, bracketed by Gauss and Gauss-Radau quadrature
  rational,   ///< rational approximation of exp, selected inversion of each shifted L
  exact,      ///< in results: both ends coincide, nothing to compute
};

constexpr std::array<EnumName<HeatMethod>, 4> enum_names(HeatMethod) {
  return {{{HeatMethod::automatic, "automatic"},
           {HeatMethod::lanczos, "lanczos"},
           {HeatMethod::rational, "rational"},
           {HeatMethod::exact, "exact"}}};
}

struct HeatDistanceOptions {
  /// Largest allowed width of a bracket: absolute, on D in [0, 2]; > 0.
  double tolerance = 1e-6;
  HeatMethod method = HeatMethod::automatic;
  /// Most Lanczos steps a pair; >= 1. A run takes about sqrt(t * lambda_max)
  /// steps. Pairs that need more go to the rational method, if it may be used.
  int max_steps = 1000;
  /// Threads to use; 0 means all cores. The values do not depend on it.
  int threads = 0;
  /// Called with the number of pairs, or of factorisations, done.
  ProgressCallback progress = {};

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, HeatDistanceOptions>
void visit_fields(Options& options, Visitor&& visitor) {
  visitor("tolerance", options.tolerance, "largest width of a heat distance's bracket",
          left_open(0, 2));
  visitor("heat_solver", options.method, "how heat distances are computed");
  visitor("max_steps", options.max_steps, "most Lanczos steps a pair", closed(1, 1e6));
}

/// Whether a value is known to a millionth of itself.
inline bool is_precise(const CertifiedValue& value) { return value.width() <= 1e-6 * value.lower; }

/// "12 of 300 heat distances have bounds wider than 1e-6 relative", to warn with where a part of
/// `all` values is imprecise.
std::string words_of_imprecise(std::int64_t imprecise, std::int64_t all, std::string_view what);

/// Heat distances of `pairs` at `scales`, row-major: pairs x scales.
struct HeatDistanceResult {
  std::vector<VertexPair> pairs;
  std::vector<double> scales;
  std::vector<double> thresholds;      ///< one a scale, or none
  std::vector<CertifiedValue> values;  ///< pairs x scales
  std::vector<HeatMethod> methods;     ///< pairs x scales: which method decided
  std::vector<std::int32_t> steps;     ///< per pair: Lanczos steps taken
  std::vector<std::string> reasons;    ///< per scale: why its method was chosen
  std::int64_t unconverged = 0;        ///< values wider than asked for; their bracket still holds
  double widest = 0.0;                 ///< largest width of a bracket
  /// Values that are not known to a millionth of themselves (is_precise()): small ones
  /// beside an absolute tolerance, and those of which rounding leaves no more.
  std::int64_t imprecise = 0;
  double seconds = 0.0;  ///< wall time

  bool converged() const { return unconverged == 0; }
  const CertifiedValue& at(std::size_t pair, std::size_t scale) const {
    return values[pair * scales.size() + scale];
  }
  /// The values (bracket midpoints) of all pairs at one scale.
  std::vector<double> column(std::size_t scale) const;
};

/// Keeps a graph's Laplacian ready for heat distances of any pairs and scales.
class HeatDistance {
 public:
  /// O(n + m).
  /// @throws InvalidArgument for options out of range.
  explicit HeatDistance(const WeightedGraph& graph, HeatDistanceOptions options = {});
  ~HeatDistance();
  HeatDistance(HeatDistance&&) noexcept;
  HeatDistance& operator=(HeatDistance&&) noexcept;

  /// D_e(t) for every pair and scale, to the tolerance of the options.
  ///
  /// A pair in two components gets H_ii(t) + H_jj(t); a pair (i, i) gets 0.
  /// `scales` (times, in units of 1/weight) are finite and >= 0, in any order.
  /// @throws InvalidArgument for a vertex outside the graph or a bad scale;
  ///   Cancelled if the progress callback asks for it.
  HeatDistanceResult evaluate(std::span<const VertexPair> pairs,
                              std::span<const double> scales) const;

  /// The same, but a value is also good enough as soon as its bracket lies on
  /// one side of its scale's threshold (`thresholds` has one entry a scale).
  HeatDistanceResult evaluate(std::span<const VertexPair> pairs, std::span<const double> scales,
                              std::span<const double> thresholds) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One-off form of HeatDistance.
HeatDistanceResult heat_distances(const WeightedGraph& graph, std::span<const VertexPair> pairs,
                                  std::span<const double> scales,
                                  const HeatDistanceOptions& options = {});

}  // namespace isotherm::spectral
