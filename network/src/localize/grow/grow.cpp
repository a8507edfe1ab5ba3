#include "localize/grow/grow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "isotherm/base/parallel.hpp"
#include "localize/evidence/crowd.hpp"
#include "localize/evidence/multilateration.hpp"
#include "localize/evidence/star.hpp"
#include "localize/refine/refine.hpp"
#include "localize/refine/robust_refine.hpp"

namespace isotherm::network::detail {
namespace {

// What a place must have to count.
struct Demand {
  int spare = 0;       // pairs that agree, beyond the d that make a place
  double clear = 0.0;  // by how many gates the next best place is worse
  bool one_by_one = false;
};

// From sure to just enough.
constexpr std::array<Demand, 3> kDemands = {{{3, 2.0, false}, {2, 1.5, true}, {1, 1.0, true}}};

// The two best places of a node as things stand.
struct Offer {
  Multilateration places;
  int agree = 0;

  double margin() const { return places.rival_cost - places.cost; }
};

class Growth {
 public:
  Growth(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
         const Evidence& evidence, const LocalizeOptions& options, Placement placement)
      : problem_(problem),
        trusted_(trusted),
        gate_(gate),
        evidence_(evidence),
        options_(options),
        placement_(std::move(placement)),
        crowd_(problem, placement_, evidence.absence),
        offers_(problem.nodes),
        stale_(problem.nodes, true) {
    size_ = settled_size_ = placed_count(placement_);
  }

  const Placement& placement() const { return placement_; }

  void run() {
    constexpr double kPart = 1.2;
    for (;;) {
      const bool grown = step();
      if (!grown && size_ == settled_size_) return;
      if (!grown || static_cast<double>(size_) > kPart * static_cast<double>(settled_size_))
        settle();
    }
  }

 private:
  // The surest way of growing that there is; false if there is none.
  bool step() {
    return std::any_of(kDemands.begin(), kDemands.end(),
                       [&](const Demand& demand) { return wave(demand); });
  }

  // Looks again at the nodes without a place whose surroundings have changed.
  void update_offers() {
    std::vector<Index> nodes;
    for (Index v = 0; v < problem_.nodes; ++v) {
      if (!stale_[v]) continue;
      stale_[v] = false;
      offers_[v].reset();
      if (!placement_.placed[v]) nodes.push_back(v);
    }
    parallel_for(static_cast<std::int64_t>(nodes.size()), options_.threads, options_.progress,
                 "growth", [&](std::int64_t k) { offers_[nodes[k]] = offer_for(nodes[k]); });
  }

  std::optional<Offer> offer_for(Index node) const {
    auto network = star(problem_, placement_, node, trusted_);
    if (network.fixed < problem_.dimension) return std::nullopt;
    crowd_.add_strangers(network, node, placement_.placed);
    auto places = multilaterate(network, evidence_.limits);
    if (!places) return std::nullopt;
    network.positions.col(network.fixed) = places->position;
    const int agree = agreeing(network, gate_);
    if (!is_most(agree, network)) return std::nullopt;
    return Offer{std::move(*places), agree};
  }

  static bool is_most(int agree, const SmallNetwork& network) {
    return 2 * agree > static_cast<int>(network.ranges.size());
  }

  bool meets(const Offer& offer, const Demand& demand) const {
    return offer.agree >= problem_.dimension + demand.spare &&
           offer.margin() >= demand.clear * gate_;
  }

  // Places all nodes that meet the demand, or the clearest one of them. True if any.
  bool wave(const Demand& demand) {
    update_offers();
    std::vector<Index> nodes;
    for (Index v = 0; v < problem_.nodes; ++v) {
      if (!offers_[v] || !meets(*offers_[v], demand)) continue;
      if (!demand.one_by_one || nodes.empty()) {
        nodes.push_back(v);
      } else if (is_clearer(v, nodes.front())) {
        nodes.front() = v;
      }
    }
    for (const Index v : nodes) place(v, offers_[v]->places.position);
    return !nodes.empty();
  }

  bool is_clearer(Index a, Index b) const {
    const auto key = [&](Index v) { return std::pair(offers_[v]->agree, offers_[v]->margin()); };
    return key(a) > key(b);
  }

  void place(Index node, const Point& position) {
    placement_.positions.col(node) = position;
    placement_.placed[node] = true;
    crowd_.insert(node, position);
    ++size_;
    for (const auto& neighbour : problem_.pair_graph.neighbours(node)) {
      stale_[neighbour.vertex] = true;
    }
    stale_[node] = true;
  }

  void settle() {
    constexpr int kIterations = 8;
    const double width = std::sqrt(gate_);
    refine(problem_, ranges_in_reach(problem_, trusted_, placement_, width), placement_,
           {.width = width, .max_iterations = kIterations, .progress = options_.progress});
    crowd_.rebuild(placement_);
    settled_size_ = size_;
    stale_.assign(problem_.nodes, true);
  }

  const RangeProblem& problem_;
  const std::vector<bool>& trusted_;
  double gate_;
  const Evidence& evidence_;
  const LocalizeOptions& options_;
  Placement placement_;
  Crowd crowd_;
  std::vector<std::optional<Offer>> offers_;  // one a node
  std::vector<bool> stale_;                   // whose offer has to be made anew
  std::ptrdiff_t size_ = 0;
  std::ptrdiff_t settled_size_ = 0;  // when the map was last refined
};

}  // namespace

void grow(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
          const Evidence& evidence, const LocalizeOptions& options, Placement& placement) {
  Growth growth(problem, trusted, gate, evidence, options, placement);
  growth.run();
  placement = growth.placement();
}

}  // namespace isotherm::network::detail
