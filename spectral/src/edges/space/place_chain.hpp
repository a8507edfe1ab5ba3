#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "edges/space/contact_graph.hpp"
#include "isotherm/base/random.hpp"

namespace isotherm::spectral::detail {

/// Places, their momenta (of unit masses), and the energy of the places with its gradient.
template <int Dimension>
struct Motion {
  Places<Dimension> places;
  Places<Dimension> momenta;
  Places<Dimension> gradient;
  double energy = 0.0;

  double total() const { return energy + 0.5 * momenta.squaredNorm(); }
};

/// Leapfrog steps: reversible, and what they add to the total energy falls with the square of the
/// step (Duane, Kennedy, Pendleton and Roweth 1987).
/// @param close the pairs without an edge that may come near on the way
template <int Dimension>
void leap(const ContactGraph& graph, const ContactModel& model, std::span<const VertexPair> close,
          double step, int count, Motion<Dimension>& motion);

/// A chain of places by Hamiltonian Monte Carlo, whose distribution tends to the probability that
/// ContactGraph::energy() is the -log of.
template <int Dimension>
class PlaceChain {
 public:
  static constexpr int kLeaps = 8;  // of a trajectory

  PlaceChain(const ContactGraph& graph, const ContactModel& model, Places<Dimension> start,
             std::uint64_t seed);

  void set_width(double width) { model_.width = width; }

  const Places<Dimension>& places() const { return at_.places; }

  const ContactModel& model() const { return model_; }

  /// One trajectory, that is taken with the probability that keeps the distribution (Metropolis).
  /// @return whether it was taken
  bool move();

  /// The same, and fits the length of the steps, so that about two of three are taken. Only moves
  /// after the last fit keep the distribution.
  void move_and_fit();

 private:
  /// Finds the pairs that may come close in one trajectory of steps so long.
  void look_around(double step);

  const ContactGraph& graph_;
  ContactModel model_;
  Random random_;
  Motion<Dimension> at_;
  std::vector<VertexPair> close_;
  double step_ = 0.1;  // in widths
};

}  // namespace isotherm::spectral::detail
