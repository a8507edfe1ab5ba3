#include "edges/space/contact_graph.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace isotherm::spectral::detail {
namespace {

constexpr double kMissing = 0.01;  // of the pairs that are near, so many have no edge
constexpr double kSame = 1e-6;     // keeps directions between vertices in one place finite

/// rho(d), and its derivative.
struct Contact {
  double chance, slope;

  Contact(double distance, double reach, double width) {
    constexpr double kFlat = 60.0;
    const double beyond = std::clamp((distance / reach - 1.0) / width, -kFlat, kFlat);
    const double inside = 1.0 / (1.0 + std::exp(beyond));
    chance = (1.0 - kMissing) * inside;
    slope = -chance * (1.0 - inside) / (width * reach);
  }
};

/// A factor of the probability, and the derivative of its logarithm by the distance.
struct Term {
  double factor, slope;
};

Term pair_term(bool joined, const Contact& contact, const ContactModel& model) {
  const double chance = chance_of_pair(joined, contact.chance, model);
  return {chance, (joined ? contact.slope : -contact.slope) / chance};
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

  /// @param most what the factor is divided by
  void add(VertexPair pair, double apart, const Term& term, double most) {
    multiply(term.factor / most);
    const Eigen::Matrix<double, Dimension, 1> pull =
        (term.slope / apart) * (places_.col(pair.from) - places_.col(pair.to));
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
  return Contact(distance, reach, model.width).chance;
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
  std::vector<VertexPair> pairs;
  for (auto first = order.begin(); first != order.end(); ++first) {
    const char* joined = joined_.data() + static_cast<std::size_t>(*first) * vertex_count_;
    const double end = places(0, *first) + distance;
    for (auto other = first + 1; other != order.end() && places(0, *other) < end; ++other) {
      const double squared = (places.col(*first) - places.col(*other)).squaredNorm();
      if (squared < distance * distance && joined[*other] == 0) pairs.push_back({*first, *other});
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
  // What an edge and a pair without one count for where they say next to nothing.
  const double joined = chance_of_pair(true, chance_of_contact(certain, 1.0, model), model);
  const double open = chance_of_pair(false, chance_of_contact(silent, 1.0, model), model);
  for (const auto& [ends, reach] : edges_) {
    const double squared = sum.squared_distance(ends), inside = certain * reach;
    if (squared < inside * inside) continue;
    const double distance = std::sqrt(squared + kSame);
    sum.add(ends, distance, pair_term(true, Contact(distance, reach, model.width), model), joined);
  }
  for (const auto& pair : close) {
    const double squared = sum.squared_distance(pair);
    if (squared >= silent * silent) continue;
    const double distance = std::sqrt(squared + kSame);
    sum.add(pair, distance, pair_term(false, Contact(distance, 1.0, model.width), model), open);
  }
  return sum.energy() + 0.5 * loose * places.squaredNorm();
}

template std::vector<VertexPair> ContactGraph::open_pairs<2>(const Places<2>&, double) const;
template std::vector<VertexPair> ContactGraph::open_pairs<3>(const Places<3>&, double) const;
template double ContactGraph::energy<2>(const Places<2>&, const ContactModel&,
                                        std::span<const VertexPair>, Places<2>&) const;
template double ContactGraph::energy<3>(const Places<3>&, const ContactModel&,
                                        std::span<const VertexPair>, Places<3>&) const;

}  // namespace isotherm::spectral::detail
