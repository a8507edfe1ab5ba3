// Kernels of the spectral engine on simulated city graphs with a tenth as many
// loops as poses.
#include <benchmark/benchmark.h>

#include "cholmod_timing.hpp"
#include "isotherm/slam/prune/induce.hpp"
#include "isotherm/slam/simulate/simulate.hpp"
#include "isotherm/spectral/eigen/eigen_decomposition.hpp"
#include "isotherm/spectral/heat/heat_affinity.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"
#include "isotherm/spectral/resistance/effective_resistance.hpp"

namespace {

using namespace isotherm;
using namespace isotherm::spectral;

WeightedGraph city(std::int64_t poses) {
  slam::CityOptions options;
  options.poses = poses;
  options.measurements.loops = poses / 10;
  const auto simulation = slam::simulate_city(options);
  return slam::induce(simulation.graph, slam::edge_roles(simulation.graph)).graph;
}

std::vector<VertexPair> loops_of(const WeightedGraph& graph) {
  std::vector<VertexPair> loops;
  for (const auto& edge : graph.edges()) {
    if (std::abs(edge.from - edge.to) != 1) loops.push_back({edge.from, edge.to});
  }
  return loops;
}

void heat(benchmark::State& state, HeatMethod method) {
  const auto graph = city(state.range(0));
  const auto loops = loops_of(graph);
  const std::vector<double> scales = {100, 10, 1};
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        heat_distances(graph, loops, scales, {.method = method, .threads = 1}));
  }
  state.SetComplexityN(state.range(0));
}

void heat_lanczos(benchmark::State& state) { heat(state, HeatMethod::lanczos); }
void heat_rational(benchmark::State& state) { heat(state, HeatMethod::rational); }
void heat_automatic(benchmark::State& state) { heat(state, HeatMethod::automatic); }

void affinities(benchmark::State& state) {
  const auto graph = city(state.range(0));
  const auto pairs = edge_pairs(graph);
  const std::vector<double> scales = {1.0};
  for (auto _ : state) {
    benchmark::DoNotOptimize(heat_affinities(graph, pairs, scales, {.threads = 1}));
  }
  state.SetComplexityN(state.range(0));
}

void resistances(benchmark::State& state) {
  const auto graph = city(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(edge_resistances(graph));
  state.SetComplexityN(state.range(0));
}

void cholmod_factorisation(benchmark::State& state) {
  const auto graph = city(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(isotherm_bench::time_cholmod(graph));
  state.SetComplexityN(state.range(0));
}

void eigenpairs(benchmark::State& state) {
  const Laplacian laplacian(city(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(smallest_eigenpairs(laplacian, {.count = 20}));
  state.SetComplexityN(state.range(0));
}

void sizes(benchmark::internal::Benchmark* kernel) {
  kernel->RangeMultiplier(10)->Range(10000, 100000)->Unit(benchmark::kMillisecond)->Complexity();
}

BENCHMARK(heat_lanczos)->Apply(sizes);
BENCHMARK(heat_rational)->Apply(sizes);
BENCHMARK(heat_automatic)->Apply(sizes);
BENCHMARK(affinities)->Apply(sizes);
BENCHMARK(resistances)->Apply(sizes);
BENCHMARK(cholmod_factorisation)->Apply(sizes);
BENCHMARK(eigenpairs)->Apply(sizes);

}  // namespace
