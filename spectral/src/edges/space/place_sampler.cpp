#include "edges/space/place_sampler.hpp"

#include <cmath>

#include "edges/space/place_chain.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr int kLevels = 8;                     // of the width
constexpr int kPerLevel = 8;                   // trajectories
constexpr int kUncounted = 33, kCounted = 67;  // trajectories at the last level
constexpr double kWidest = 0.3;

template <int Dimension>
void count(const PlaceChain<Dimension>& chain, std::span<const AskedPair> pairs, LeftOut& sums) {
  const auto& places = chain.places();
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto& [ends, reach, joined] = pairs[k];
    const double distance = (places.col(ends.from) - places.col(ends.to)).norm();
    const double near = chance_of_contact(distance, reach, chain.model());
    const double weight = 1.0 / chance_of_pair(joined, near, chain.model());
    sums.near[k] += weight * near;
    sums.weight[k] += weight;
  }
}

}  // namespace

template <int Dimension>
LeftOut sample_places(const ContactGraph& graph, const ContactModel& model,
                      const Places<Dimension>& start, std::span<const AskedPair> pairs,
                      std::uint64_t seed) {
  PlaceChain<Dimension> chain(graph, model, start, seed);
  for (int level = 0; level < kLevels; ++level) {
    const double done = static_cast<double>(level) / kLevels;
    chain.set_width(kWidest * std::pow(model.width / kWidest, done));
    for (int k = 0; k < kPerLevel; ++k) chain.move_and_fit();
  }
  chain.set_width(model.width);
  for (int k = 0; k < kUncounted; ++k) chain.move_and_fit();
  LeftOut sums{std::vector<double>(pairs.size(), 0.0), std::vector<double>(pairs.size(), 0.0)};
  for (int k = 0; k < kCounted; ++k) {
    chain.move();
    count(chain, pairs, sums);
  }
  return sums;
}

double sampling_steps() {
  return PlaceChain<2>::kLeaps * (kLevels * kPerLevel + kUncounted + kCounted);
}

template LeftOut sample_places<2>(const ContactGraph&, const ContactModel&, const Places<2>&,
                                  std::span<const AskedPair>, std::uint64_t);
template LeftOut sample_places<3>(const ContactGraph&, const ContactModel&, const Places<3>&,
                                  std::span<const AskedPair>, std::uint64_t);

}  // namespace isotherm::spectral::detail
