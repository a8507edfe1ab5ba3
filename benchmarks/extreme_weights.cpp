// Effective resistances and heat distances of random pairs, with weights over many decades, held
// against arithmetic in a hundred digits. Prints the rows of docs/results/spectral.md.
//
// usage: extreme_weights [VALUES [SEED]]
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "isotherm/base/random.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"
#include "isotherm/spectral/resistance/effective_resistance.hpp"

namespace {

using namespace isotherm;
using namespace isotherm::spectral;
using Exact = boost::multiprecision::cpp_bin_float_100;
using Matrix = std::vector<std::vector<Exact>>;

constexpr double kDecades = 16.0;
constexpr int kOfAGraph = 50;  // values

Index random_vertex(Random& random, Index count) {
  return static_cast<Index>(random.index(static_cast<std::uint64_t>(count)));
}

double random_weight(Random& random) {
  return std::pow(10.0, random.uniform(-kDecades / 2, kDecades / 2));
}

/// A tree and as many further edges, parallel ones among them.
WeightedGraph random_graph(Random& random) {
  const auto count = static_cast<Index>(10 + random.index(31));
  std::vector<WeightedEdge> edges;
  for (Index v = 1; v < count; ++v) {
    edges.push_back({random_vertex(random, v), v, random_weight(random)});
  }
  for (Index k = 0; k < count; ++k) {
    edges.push_back(
        {random_vertex(random, count), random_vertex(random, count), random_weight(random)});
  }
  return {count, std::move(edges)};
}

std::vector<VertexPair> random_pairs(Index count, Random& random) {
  std::vector<VertexPair> pairs;
  while (pairs.size() < kOfAGraph) {
    const VertexPair pair{random_vertex(random, count), random_vertex(random, count)};
    if (pair.from != pair.to) pairs.push_back(pair);
  }
  return pairs;
}

Matrix exact_laplacian(const WeightedGraph& graph) {
  Matrix laplacian(graph.vertex_count(), std::vector<Exact>(graph.vertex_count(), 0));
  for (const auto& [from, to, weight] : graph.edges()) {
    if (from == to) continue;
    laplacian[from][from] += weight;
    laplacian[to][to] += weight;
    laplacian[from][to] -= weight;
    laplacian[to][from] -= weight;
  }
  return laplacian;
}

/// Jacobi's rotations, until nothing is left beside the diagonal.
struct Spectrum {
  std::vector<Exact> values;
  Matrix vectors;  // by column

  explicit Spectrum(Matrix a) : vectors(a.size(), std::vector<Exact>(a.size(), 0)) {
    for (std::size_t k = 0; k < a.size(); ++k) vectors[k][k] = 1;
    while (sweep(a)) {
    }
    for (std::size_t k = 0; k < a.size(); ++k) values.push_back(a[k][k]);
  }

 private:
  bool sweep(Matrix& a) {
    static const Exact kNegligible("1e-90");
    Exact norm = 0;
    for (std::size_t p = 0; p < a.size(); ++p) norm = std::max<Exact>(norm, abs(a[p][p]));
    bool any = false;
    for (std::size_t p = 0; p < a.size(); ++p) {
      for (std::size_t q = p + 1; q < a.size(); ++q) {
        if (abs(a[p][q]) <= kNegligible * norm) continue;
        rotate(a, p, q);
        any = true;
      }
    }
    return any;
  }

  void rotate(Matrix& a, std::size_t p, std::size_t q) {
    const Exact ratio = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    const Exact root = sqrt(1 + ratio * ratio);
    const Exact t = ratio < 0 ? 1 / (ratio - root) : 1 / (ratio + root);
    const Exact c = 1 / sqrt(1 + t * t), s = t * c;
    for (std::size_t k = 0; k < a.size(); ++k) {
      const Exact x = a[k][p], y = a[k][q];
      a[k][p] = c * x - s * y;
      a[k][q] = s * x + c * y;
    }
    for (std::size_t k = 0; k < a.size(); ++k) {
      const Exact x = a[p][k], y = a[q][k];
      a[p][k] = c * x - s * y;
      a[q][k] = s * x + c * y;
      const Exact u = vectors[k][p], v = vectors[k][q];
      vectors[k][p] = c * u - s * v;
      vectors[k][q] = s * u + c * v;
    }
  }
};

/// The sum of f(eigenvalue) times what the pair's difference has of its eigenvector, squared.
template <class Function>
Exact quadratic_form(const Spectrum& spectrum, VertexPair pair, Function f) {
  Exact sum = 0;
  for (std::size_t k = 0; k < spectrum.values.size(); ++k) {
    const Exact part = spectrum.vectors[pair.from][k] - spectrum.vectors[pair.to][k];
    sum += f(spectrum.values[k]) * part * part;
  }
  return sum;
}

/// What was seen of one kind of value.
struct Tally {
  std::int64_t values = 0, outside = 0, wide = 0, wide_unflagged = 0;
  double largest_error = 0.0;  // relative
  double widest = 0.0;         // bound, relative, of those that are not flagged

  void add(const Exact& exact, double value, double lower, double upper, bool flagged) {
    constexpr double kWide = 1e-6;
    ++values;
    if (Exact(lower) > exact || exact > Exact(upper)) ++outside;
    const double width = exact > 0 ? static_cast<double>((Exact(upper) - lower) / exact) : 0.0;
    if (!(width <= kWide)) ++wide;
    if (!(width <= kWide) && !flagged) ++wide_unflagged;
    if (flagged) return;
    widest = std::max(widest, width);
    largest_error = std::max(largest_error, static_cast<double>(abs(Exact(value) / exact - 1)));
  }

  void print(const std::string& name) const {
    std::printf("| %s | %lld | %lld | %lld | %lld | %.1e | %.1e |\n", name.c_str(),
                static_cast<long long>(values), static_cast<long long>(outside),
                static_cast<long long>(wide), static_cast<long long>(wide_unflagged), widest,
                largest_error);
    std::fflush(stdout);
  }
};

void judge_resistances(const WeightedGraph& graph, const Spectrum& spectrum,
                       std::span<const VertexPair> pairs, Tally& tally) {
  const auto result = effective_resistances(graph, pairs);
  // The null space, found up to rounding, counts for nothing in a difference.
  const auto null = std::min_element(spectrum.values.begin(), spectrum.values.end());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const Exact exact = quadratic_form(spectrum, pairs[k], [&](const Exact& value) {
      return &value == &*null ? Exact(0) : 1 / value;
    });
    const double value = result.values[k];
    tally.add(exact, value, value * (1.0 - result.bound), value * (1.0 + result.bound),
              !std::isfinite(result.bound));
  }
}

void judge_heat(const WeightedGraph& graph, const Spectrum& spectrum,
                std::span<const VertexPair> pairs, HeatMethod method, Random& random,
                Tally& tally) {
  const std::vector<double> scales = {random_weight(random)};
  const HeatDistanceOptions options = {.tolerance = 1e-12, .method = method, .threads = 1};
  const auto result = heat_distances(graph, pairs, scales, options);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const Exact exact = quadratic_form(
        spectrum, pairs[k], [&](const Exact& value) -> Exact { return exp(-scales[0] * value); });
    const auto& value = result.at(k, 0);
    tally.add(exact, value.value, value.lower, value.upper, !is_precise(value));
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int values = argc > 1 ? std::atoi(argv[1]) : 10'000;
  Random random(argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1);
  Tally resistances, automatic, lanczos, rational;
  for (int done = 0; done < values; done += kOfAGraph) {
    const auto graph = random_graph(random);
    const Spectrum spectrum(exact_laplacian(graph));
    const auto pairs = random_pairs(graph.vertex_count(), random);
    judge_resistances(graph, spectrum, pairs, resistances);
    judge_heat(graph, spectrum, pairs, HeatMethod::automatic, random, automatic);
    judge_heat(graph, spectrum, pairs, HeatMethod::lanczos, random, lanczos);
    judge_heat(graph, spectrum, pairs, HeatMethod::rational, random, rational);
  }
  std::printf(
      "| value | count | outside its bounds | wider than 1e-6 | of these not flagged "
      "| widest not flagged | largest error not flagged |\n|---|---|---|---|---|---|---|\n");
  resistances.print("effective resistance");
  automatic.print("heat distance, automatic");
  lanczos.print("heat distance, lanczos");
  rational.print("heat distance, rational");
  return resistances.outside + automatic.outside + lanczos.outside + rational.outside == 0 ? 0 : 1;
}
