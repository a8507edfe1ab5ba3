#include "edges/space/contact_graph.hpp"

#include <algorithm>
#include <cmath>

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

  double distance(VertexPair pair) const { return std::sqrt(squared_distance(pair) + kSame); }

  void add(VertexPair pair, double apart, const Term& term) {
    multiply(term.factor);
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
  std::vector<VertexPair> pairs;
  for (Index from = 0; from < vertex_count_; ++from) {
    const char* joined = joined_.data() + from * vertex_count_;
    for (Index to = 0; to < from; ++to) {
      const double squared = (places.col(from) - places.col(to)).squaredNorm();
      if (squared < distance * distance && joined[to] == 0) pairs.push_back({from, to});
    }
  }
  return pairs;
}

template <int Dimension>
double ContactGraph::energy(const Places<Dimension>& places, const ContactModel& model,
                            std::span<const VertexPair> close, Places<Dimension>& gradient) const {
  gradient.setZero(Dimension, places.cols());
  Sum<Dimension> sum(places, gradient);
  for (const auto& [ends, reach] : edges_) {
    const double distance = sum.distance(ends);
    sum.add(ends, distance, pair_term(true, Contact(distance, reach, model.width), model));
  }
  const double silent = model.silent_from() * model.silent_from();
  for (const auto& pair : close) {
    if (sum.squared_distance(pair) >= silent) continue;
    const double distance = sum.distance(pair);
    sum.add(pair, distance, pair_term(false, Contact(distance, 1.0, model.width), model));
  }
  return sum.energy();
}

template std::vector<VertexPair> ContactGraph::open_pairs<2>(const Places<2>&, double) const;
template std::vector<VertexPair> ContactGraph::open_pairs<3>(const Places<3>&, double) const;
template double ContactGraph::energy<2>(const Places<2>&, const ContactModel&,
                                        std::span<const VertexPair>, Places<2>&) const;
template double ContactGraph::energy<3>(const Places<3>&, const ContactModel&,
                                        std::span<const VertexPair>, Places<3>&) const;

}  // namespace isotherm::spectral::detail
