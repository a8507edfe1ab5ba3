#include "isotherm/network/simulate/simulate_network.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <unordered_set>
#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/base/random.hpp"
#include "isotherm/geometry/points/neighbour_graph.hpp"

namespace isotherm::network {
namespace {

void require(bool good, const char* field, const char* expected) {
  if (!good) throw InvalidArgument(field, expected);
}

// The radius of a disc or ball that holds `degree` of `nodes` uniform points.
double radius_of(const NetworkOptions& options) {
  if (options.radius > 0.0) return options.radius;
  const double share = options.degree / static_cast<double>(options.nodes);
  return options.dimension == 2 ? std::sqrt(share / std::numbers::pi)
                                : std::cbrt(share / (4.0 / 3.0 * std::numbers::pi));
}

class Simulator {
 public:
  explicit Simulator(const NetworkOptions& options) : options_(options), random_(options.seed) {}

  SimulatedNetwork run() {
    place_nodes();
    measure_neighbours();
    bias_some();
    invent_some();
    shuffle();
    return std::move(result_);
  }

 private:
  void place_nodes() {
    auto& network = result_.network;
    const auto count = static_cast<Eigen::Index>(options_.nodes);
    network.dimension = options_.dimension;
    result_.truth.resize(options_.dimension, count);
    network.positions.setConstant(options_.dimension, count,
                                  std::numeric_limits<double>::quiet_NaN());
    for (Eigen::Index v = 0; v < count; ++v) {
      for (int i = 0; i < options_.dimension; ++i) result_.truth(i, v) = random_.uniform();
      network.names.push_back(std::to_string(v));
      if (v >= options_.anchors) continue;
      network.positions.col(v) = result_.truth.col(v);
      network.landmarks.push_back(static_cast<Index>(v));
    }
    result_.radius = radius_of(options_);
  }

  void add(Index from, Index to, double distance, double sigma, RangeOrigin origin) {
    if (random_.index(2) == 0) std::swap(from, to);
    RangeMeasurement range;
    range.from = from;
    range.to = to;
    range.distance = distance;
    range.variance = sigma * sigma;
    result_.network.ranges.push_back(range);
    result_.origins.push_back(origin);
  }

  double distance(Index a, Index b) const {
    return (result_.truth.col(a) - result_.truth.col(b)).norm();
  }

  void measure_neighbours() {
    const auto neighbours = geometry::radius_graph(result_.truth, result_.radius);
    for (const auto& [from, to, weight] : neighbours.edges()) {
      const double sigma = options_.noise * distance(from, to);
      add(from, to, std::abs(random_.normal(distance(from, to), sigma)), sigma,
          RangeOrigin::measured);
    }
    measured_ = result_.network.ranges.size();
  }

  // How many of all ranges in the end a fraction of them is.
  std::size_t share(double fraction) const {
    const double all = static_cast<double>(measured_) / (1.0 - options_.false_fraction);
    return static_cast<std::size_t>(std::llround(fraction * all));
  }

  void bias_some() {
    const std::size_t wanted = std::min(share(options_.biased_fraction), measured_);
    for (std::size_t done = 0; done < wanted;) {
      const auto k = static_cast<std::size_t>(random_.index(measured_));
      if (result_.origins[k] == RangeOrigin::biased) continue;
      result_.origins[k] = RangeOrigin::biased;
      result_.network.ranges[k].distance += random_.uniform(0.25, 1.0) * result_.radius;
      ++done;
    }
  }

  void invent_some() {
    const auto count = static_cast<std::uint64_t>(options_.nodes);
    const auto pair_key = [count](Index a, Index b) {
      const auto [low, high] = std::minmax(a, b);
      return static_cast<std::uint64_t>(low) * count + static_cast<std::uint64_t>(high);
    };
    std::unordered_set<std::uint64_t> taken;
    for (const auto& range : result_.network.ranges) taken.insert(pair_key(range.from, range.to));
    const std::size_t free = count * (count - 1) / 2 - taken.size();
    const std::size_t wanted = std::min(share(options_.false_fraction), free);
    for (std::size_t done = 0; done < wanted;) {
      const auto a = static_cast<Index>(random_.index(count));
      const auto b = static_cast<Index>(random_.index(count));
      if (a == b || !taken.insert(pair_key(a, b)).second) continue;
      const double length = result_.radius * invented_share();
      add(a, b, length, options_.noise * length, RangeOrigin::invented);
      ++done;
    }
  }

  // Lengths spread like those of true ranges: as the distance of a uniform point.
  double invented_share() { return std::pow(random_.uniform(), 1.0 / options_.dimension); }

  void shuffle() {
    auto& ranges = result_.network.ranges;
    for (std::size_t k = ranges.size(); k > 1; --k) {
      const auto other = static_cast<std::size_t>(random_.index(k));
      std::swap(ranges[k - 1], ranges[other]);
      std::swap(result_.origins[k - 1], result_.origins[other]);
    }
  }

  const NetworkOptions& options_;
  Random random_;
  SimulatedNetwork result_;
  std::size_t measured_ = 0;
};

}  // namespace

void NetworkOptions::validate() const {
  require_fields_in_range(*this);
  require(anchors <= nodes, "anchors", "must be at most the number of nodes");
  require(false_fraction + biased_fraction <= 1.0, "biased_fraction",
          "must leave room for the false ranges");
}

SimulatedNetwork simulate_network(const NetworkOptions& options) {
  options.validate();
  return Simulator(options).run();
}

}  // namespace isotherm::network
