#include "edges/space/contact_graph.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace isotherm::spectral::detail {
namespace {

constexpr double kNear = 0.99;  // of the pairs that are near, so many have an edge
constexpr double kSame = 1e-6;  // keeps directions between vertices in one place finite

/// exp((d / reach - 1) / width), as far as numbers go.
double excess(double distance, double per_reach, double per_width) {
  constexpr double kFlat = 60.0;
  return std::exp(std::clamp((distance * per_reach - 1.0) * per_width, -kFlat, kFlat));
}

/// The energy of all terms, each of one distance.
template <int Dimension>
class Sum {
 public:
  Sum(const Places<Dimension>& places, Places<Dimension>& gradient)
      : places_(places), gradient_(gradient) {}

  double squared_distance(VertexPair pair) const {
    return (places_.col(pair.from) - places_.col(pair.to)).squaredNorm();
  }

  /// A factor seen / (1 + excess) of the probability, in one division.
  /// @param slope the derivative of log(factor) by the distance, but for the factor's denominators
  void add(VertexPair pair, double apart, double excess, double seen, double slope) {
    const double share = 1.0 / ((1.0 + excess) * seen * apart);
    multiply(seen * seen * apart * share);
    const Eigen::Matrix<double, Dimension, 1> pull =
        (slope * share) * (places_.col(pair.from) - places_.col(pair.to));
    gradient_.col(pair.from) -= pull;
    gradient_.col(pair.to) += pull;
  }

  double energy() const { return energy_ - std::log(product_); }

 private:
  /// One logarithm for many factors, as far as their product is no denormal number.
  void multiply(double factor) {
    constexpr double kLeast = 1e-200;
    product_ *= factor;
    if (product_ > kLeast) return;
    energy_ -= std::log(product_);
    product_ = 1.0;
  }

  const Places<Dimension>& places_;
  Places<Dimension>& gradient_;
  double energy_ = 0.0;
  double product_ = 1.0;
};

}  // namespace

double chance_of_contact(double distance, double reach, const ContactModel& model) {
  return kNear / (1.0 + excess(distance, 1.0 / reach, 1.0 / model.width));
}

double chance_of_pair(bool joined, double near, const ContactModel& model) {
  return joined ? near + model.astray : 1.0 - near;
}

ContactGraph::ContactGraph(const WeightedGraph& graph, std::span<const double> lengths)
    : vertex_count_(graph.vertex_count()),
      joined_(static_cast<std::size_t>(vertex_count_) * vertex_count_, 0) {
  for (Index e = 0; e < graph.edge_count(); ++e) {
    const auto& [from, to, weight] = graph.edge(e);
    if (from == to) continue;
    edges_.push_back({{from, to}, lengths[e]});
    joined_[from * vertex_count_ + to] = joined_[to * vertex_count_ + from] = 1;
  }
}

template <int Dimension>
std::vector<VertexPair> ContactGraph::open_pairs(const Places<Dimension>& places,
                                                 double distance) const {
  // Along the first axis, so that only what is near on it is looked at.
  std::vector<Index> order(static_cast<std::size_t>(vertex_count_));
  std::iota(order.begin(), order.end(), Index{0});
  std::ranges::sort(order, {}, [&](Index v) { return places(0, v); });
  const Places<Dimension> sorted = places(Eigen::all, order);
  std::vector<VertexPair> pairs;
  for (Index k = 0; k < vertex_count_; ++k) {
    const char* joined = joined_.data() + static_cast<std::size_t>(order[k]) * vertex_count_;
    const double end = sorted(0, k) + distance;
    for (Index other = k + 1; other < vertex_count_ && sorted(0, other) < end; ++other) {
      if ((sorted.col(k) - sorted.col(other)).squaredNorm() >= distance * distance) continue;
      if (joined[order[other]] == 0) pairs.push_back({order[k], order[other]});
    }
  }
  return pairs;
}

template <int Dimension>
double ContactGraph::energy(const Places<Dimension>& places, const ContactModel& model,
                            std::span<const VertexPair> close, Places<Dimension>& gradient) const {
  const double loose = 1.0 / (model.spread * model.spread);
  gradient = loose * places;
  Sum<Dimension> sum(places, gradient);
  const double certain = model.certain_up_to(), silent = model.silent_from();
  double heard_edges = 0.0, heard_pairs = 0.0;
  const double per_width = 1.0 / model.width;
  for (const auto& [ends, reach] : edges_) {
    const double squared = sum.squared_distance(ends), inside = certain * reach;
    if (squared < inside * inside) continue;
    const double apart = std::sqrt(squared + kSame), per_reach = 1.0 / reach;
    const double beyond = excess(apart, per_reach, per_width);
    const double seen = kNear + model.astray * (1.0 + beyond);
    sum.add(ends, apart, beyond, seen, -kNear * beyond * per_width * per_reach);
    ++heard_edges;
  }
  for (const auto& pair : close) {
    const double squared = sum.squared_distance(pair);
    if (squared >= silent * silent) continue;
    const double apart = std::sqrt(squared + kSame);
    const double beyond = excess(apart, 1.0, per_width);
    sum.add(pair, apart, beyond, 1.0 - kNear + beyond, kNear * beyond * per_width);
    ++heard_pairs;
  }
  // What is not heard counts for as much as where it begins to be.
  const double joined = chance_of_pair(true, chance_of_contact(certain, 1.0, model), model);
  const double open = chance_of_pair(false, chance_of_contact(silent, 1.0, model), model);
  return sum.energy() + heard_edges * std::log(joined) + heard_pairs * std::log(open) +
         0.5 * loose * places.squaredNorm();
}

template std::vector<VertexPair> ContactGraph::open_pairs<2>(const Places<2>&, double) const;
template std::vector<VertexPair> ContactGraph::open_pairs<3>(const Places<3>&, double) const;
template double ContactGraph::energy<2>(const Places<2>&, const ContactModel&,
                                        std::span<const VertexPair>, Places<2>&) const;
template double ContactGraph::energy<3>(const Places<3>&, const ContactModel&,
                                        std::span<const VertexPair>, Places<3>&) const;

}  // namespace isotherm::spectral::detail
