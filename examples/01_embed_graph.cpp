// Embeds a ring of twelve vertices with one chord, and shows that squared
// distances in the commute-time embedding are effective resistances.
#include <cmath>
#include <cstdio>
#include <vector>

#include <isotherm/spectral.hpp>

int main() {
  using namespace isotherm::spectral;

  std::vector<WeightedEdge> edges;
  for (Index v = 0; v < 12; ++v) edges.push_back({v, (v + 1) % 12, 1.0});
  edges.push_back({0, 6, 1.0});  // the chord
  const WeightedGraph ring(12, edges);

  const auto eigen = smallest_eigenpairs(Laplacian(ring), {.count = 12});
  std::printf("eigenvalues:");
  for (Index k = 0; k < eigen.count(); ++k) std::printf(" %.4f", eigen.values[k]);
  std::printf("\n(%d of them 0: so many connected components)\n", eigen.null_count);

  // Between the ends of the chord: two ways of six edges and the chord itself, in
  // parallel.
  const auto embedding = commute_time_embedding(eigen);
  const double resistance = (embedding.row(0) - embedding.row(6)).squaredNorm();
  const double expected = 1.0 / (1.0 / 6.0 + 1.0 / 6.0 + 1.0);
  std::printf("effective resistance of the chord: %.6f (by hand: %.6f)\n", resistance, expected);

  // Heat distances at three scales: large ones still see the two sides.
  for (const double t : {0.1, 1.0, 10.0}) {
    const auto heat = heat_embedding(eigen, t);
    std::printf("t = %4.1f: heat distance of the chord %.4f, of a ring edge %.4f\n", t,
                (heat.row(0) - heat.row(6)).squaredNorm(),
                (heat.row(2) - heat.row(3)).squaredNorm());
  }
  return std::abs(resistance - expected) < 1e-12 ? 0 : 1;
}
