#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "edges/space/contact_graph.hpp"

namespace isotherm::spectral::detail {

/// A pair of vertices of a contact graph of which one asks whether they are near.
struct AskedPair {
  VertexPair ends;
  double reach = 1.0;
  bool joined = false;
};

/// Of each pair asked for, sums over places sampled, from which it has to be near if nothing is
/// known of the pair itself: the mean of rho over the places, each weighted by 1 over the
/// probability of what is seen of the pair (Gelfand, Dey and Chang 1992).
struct LeftOut {
  std::vector<double> near;
  std::vector<double> weight;
};

/// Places of the vertices by Hamiltonian Monte Carlo (Duane, Kennedy, Pendleton and Roweth 1987),
/// from a first guess on, in which the model's width falls from 0.3 to `model.width` (annealing).
template <int Dimension>
LeftOut sample_places(const ContactGraph& graph, const ContactModel& model,
                      const Places<Dimension>& start, std::span<const AskedPair> pairs,
                      std::uint64_t seed);

/// How often energies are worked out by sample_places(), about.
double sampling_steps();

}  // namespace isotherm::spectral::detail
