#include "edges/space/place_sampler.hpp"

#include <cmath>

#include "isotherm/base/random.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr int kLeaps = 8;     // of a trajectory
constexpr int kLevels = 16;   // of the width
constexpr int kPerLevel = 8;  // trajectories
constexpr int kLast = 100;    // trajectories at the last level; the first third are not counted
constexpr double kWidest = 0.3;

template <int Dimension>
class Sampler {
 public:
  Sampler(const ContactGraph& graph, const ContactModel& model, const Places<Dimension>& start,
          std::uint64_t seed)
      : graph_(graph), model_(model), random_(seed), places_(start) {
    constexpr double kJitter = 0.1;
    for (double& x : places_.reshaped()) x += random_.normal(0.0, kJitter);
  }

  void set_width(double width) { model_.width = width; }

  /// One trajectory, that is taken with the probability that keeps the distribution (Metropolis).
  void move() {
    constexpr double kLonger = 1.03, kShorter = 0.95;  // about two of three are taken
    const double step = step_ * model_.width * random_.uniform(0.6, 1.2);
    look_around(step);
    Places<Dimension> momentum(Dimension, places_.cols());
    for (double& p : momentum.reshaped()) p = random_.normal();
    const double before = energy_ + 0.5 * momentum.squaredNorm();
    auto places = places_;
    auto gradient = gradient_;
    double energy = energy_;
    for (int leap = 0; leap < kLeaps; ++leap) {
      momentum -= 0.5 * step * gradient;
      places += step * momentum;
      energy = graph_.energy(places, model_, close_, gradient);
      momentum -= 0.5 * step * gradient;
    }
    const double after = energy + 0.5 * momentum.squaredNorm();
    const bool taken = std::log(random_.uniform()) < before - after;
    step_ *= taken ? kLonger : kShorter;
    if (!taken) return;
    places_ = std::move(places);
    gradient_ = std::move(gradient);
    energy_ = energy;
  }

  void count(std::span<const AskedPair> pairs, LeftOut& sums) const {
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const auto& [ends, reach, joined] = pairs[k];
      const double distance = (places_.col(ends.from) - places_.col(ends.to)).norm();
      const double near = chance_of_contact(distance, reach, model_);
      const double weight = 1.0 / chance_of_pair(joined, near, model_);
      sums.near[k] += weight * near;
      sums.weight[k] += weight;
    }
  }

 private:
  /// Finds the pairs that may come close in one trajectory of steps so long.
  void look_around(double step) {
    constexpr double kFastest = 6.0;  // deviations of a velocity, of both vertices together
    close_ = graph_.open_pairs(places_, model_.silent_from() + kFastest * kLeaps * step);
    energy_ = graph_.energy(places_, model_, close_, gradient_);
  }

  const ContactGraph& graph_;
  ContactModel model_;
  Random random_;
  Places<Dimension> places_, gradient_;
  std::vector<VertexPair> close_;
  double energy_ = 0.0;
  double step_ = 0.1;  // in widths
};

}  // namespace

template <int Dimension>
LeftOut sample_places(const ContactGraph& graph, const ContactModel& model,
                      const Places<Dimension>& start, std::span<const AskedPair> pairs,
                      std::uint64_t seed) {
  Sampler<Dimension> sampler(graph, model, start, seed);
  for (int level = 0; level < kLevels; ++level) {
    const double done = static_cast<double>(level) / kLevels;
    sampler.set_width(kWidest * std::pow(model.width / kWidest, done));
    for (int k = 0; k < kPerLevel; ++k) sampler.move();
  }
  LeftOut sums{std::vector<double>(pairs.size(), 0.0), std::vector<double>(pairs.size(), 0.0)};
  sampler.set_width(model.width);
  for (int k = 0; k < kLast; ++k) {
    sampler.move();
    if (k >= kLast / 3) sampler.count(pairs, sums);
  }
  return sums;
}

double sampling_steps() { return kLeaps * (kLevels * kPerLevel + kLast); }

template LeftOut sample_places<2>(const ContactGraph&, const ContactModel&, const Places<2>&,
                                  std::span<const AskedPair>, std::uint64_t);
template LeftOut sample_places<3>(const ContactGraph&, const ContactModel&, const Places<3>&,
                                  std::span<const AskedPair>, std::uint64_t);

}  // namespace isotherm::spectral::detail
