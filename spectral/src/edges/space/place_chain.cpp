#include "edges/space/place_chain.hpp"

#include <cmath>
#include <utility>

namespace isotherm::spectral::detail {

template <int Dimension>
void leap(const ContactGraph& graph, const ContactModel& model, std::span<const VertexPair> close,
          double step, int count, Motion<Dimension>& motion) {
  for (int k = 0; k < count; ++k) {
    motion.momenta -= 0.5 * step * motion.gradient;
    motion.places += step * motion.momenta;
    motion.energy = graph.energy(motion.places, model, close, motion.gradient);
    motion.momenta -= 0.5 * step * motion.gradient;
  }
}

template <int Dimension>
PlaceChain<Dimension>::PlaceChain(const ContactGraph& graph, const ContactModel& model,
                                  Places<Dimension> start, std::uint64_t seed)
    : graph_(graph), model_(model), random_(seed) {
  constexpr double kJitter = 0.1;
  at_.places = std::move(start);
  for (double& x : at_.places.reshaped()) x += random_.normal(0.0, kJitter);
}

template <int Dimension>
bool PlaceChain<Dimension>::move() {
  const double step = step_ * model_.width * random_.uniform(0.6, 1.2);
  look_around(step);
  at_.momenta.resize(Dimension, at_.places.cols());
  for (double& p : at_.momenta.reshaped()) p = random_.normal();
  auto next = at_;
  leap(graph_, model_, close_, step, kLeaps, next);
  const bool taken = std::log(random_.uniform()) < at_.total() - next.total();
  if (taken) at_ = std::move(next);
  return taken;
}

template <int Dimension>
void PlaceChain<Dimension>::move_and_fit() {
  constexpr double kLonger = 1.03, kShorter = 0.95;
  step_ *= move() ? kLonger : kShorter;
}

template <int Dimension>
void PlaceChain<Dimension>::look_around(double step) {
  constexpr double kFastest = 6.0;  // deviations of a velocity, of both vertices together
  close_ = graph_.open_pairs(at_.places, model_.silent_from() + kFastest * kLeaps * step);
  at_.energy = graph_.energy(at_.places, model_, close_, at_.gradient);
}

template void leap<2>(const ContactGraph&, const ContactModel&, std::span<const VertexPair>, double,
                      int, Motion<2>&);
template void leap<3>(const ContactGraph&, const ContactModel&, std::span<const VertexPair>, double,
                      int, Motion<3>&);
template class PlaceChain<2>;
template class PlaceChain<3>;

}  // namespace isotherm::spectral::detail
