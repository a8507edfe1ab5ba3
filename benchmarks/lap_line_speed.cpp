// How long 100,000 curve descriptors of 60 samples take, on one and on all cores.
#include <cmath>
#include <numeric>
#include <vector>

#include <benchmark/benchmark.h>

#include "isotherm/base/random.hpp"
#include "isotherm/geometry/curves/lap_line.hpp"

namespace {

using namespace isotherm;
using namespace isotherm::geometry;

// A path that wanders by about 0.01 rad a step, so that windows are full.
template <int Dim>
Polyline<Dim> wandering_path(int points) {
  Random random(1);
  std::vector<Eigen::Matrix<double, Dim, 1>> path(points, Eigen::Matrix<double, Dim, 1>::Zero());
  double heading = 0.0;
  for (int k = 1; k < points; ++k) {
    heading += 0.01 * random.normal();
    path[k] = path[k - 1];
    path[k].x() += std::cos(heading);
    path[k].y() += std::sin(heading);
    if constexpr (Dim == 3) path[k].z() += 0.05 * std::sin(0.03 * k);
  }
  return Polyline<Dim>(std::move(path));
}

template <int Dim>
void descriptors(benchmark::State& state) {
  constexpr int kCount = 100000;
  const auto path = wandering_path<Dim>(kCount);
  std::vector<int> vertices(kCount);
  std::iota(vertices.begin(), vertices.end(), 0);
  double samples = 0.0;
  for (auto _ : state) {
    const auto found = lap_lines(path, vertices, {.window = 62}, static_cast<int>(state.range(0)));
    samples = 0.0;
    for (const auto& descriptor : found) samples += descriptor.samples();
  }
  state.counters["samples_each"] = samples / kCount;
}

BENCHMARK(descriptors<2>)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(descriptors<3>)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
