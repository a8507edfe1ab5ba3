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

// When nothing else is left.
constexpr Demand kLastResort = {1, 0.6, true};

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
        stale_(problem.nodes, true),
        tried_(problem.nodes, false),
        losses_(problem.nodes, 0) {
    size_ = settled_size_ = placed_count(placement_);
  }

  const Placement& placement() const { return placement_; }

  void run(std::ptrdiff_t limit) {
    constexpr double kPart = 1.2;
    while (size_ < limit) {
      const bool grown = step();
      if (!grown && size_ == settled_size_) return;
      if (!grown || static_cast<double>(size_) > kPart * static_cast<double>(settled_size_))
        settle();
    }
  }

 private:
  // The surest way of growing that there is; false if there is none.
  bool step() { return by_waves() || look_ahead() || wave(kLastResort); }

  bool by_waves() {
    return std::any_of(kDemands.begin(), kDemands.end(),
                       [&](const Demand& demand) { return wave(demand); });
  }

  // Looks again at the nodes without a place whose surroundings have changed.
  void update_offers() {
    constexpr int kMostLosses = 2;
    std::vector<Index> nodes;
    for (Index v = 0; v < problem_.nodes; ++v) {
      if (!stale_[v]) continue;
      stale_[v] = false;
      offers_[v].reset();
      if (!placement_.placed[v] && losses_[v] <= kMostLosses) nodes.push_back(v);
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
    recent_.push_back(node);
    ++size_;
    for (const auto& [vertex, edge] : problem_.pair_graph.neighbours(node)) {
      stale_[vertex] = true;
      tried_[vertex] = false;
    }
    stale_[node] = true;
  }

  // Grows from both places of a node that has two, and takes the one from which clearly
  // more ranges agree. True if there is such a node.
  bool look_ahead() {
    constexpr double kClear = 2.0;  // gates
    std::vector<Index> nodes;
    for (Index v = 0; v < problem_.nodes; ++v) {
      if (offers_[v] && !tried_[v]) nodes.push_back(v);
    }
    std::sort(nodes.begin(), nodes.end(), [&](Index a, Index b) { return is_clearer(a, b); });
    for (const Index v : nodes) {
      const auto best = trial(v, offers_[v]->places.position);
      const auto rival = trial(v, offers_[v]->places.rival);
      const double gain = best.credit() - rival.credit();
      if (std::abs(gain) < kClear * gate_ ||
          std::max(best.credit(), rival.credit()) < kClear * gate_) {
        tried_[v] = true;
        continue;
      }
      adopt(gain > 0.0 ? best : rival);
      return true;
    }
    return false;
  }

  // What grows within a few waves when a node is put there.
  Growth trial(Index node, const Point& position) const {
    constexpr std::ptrdiff_t kMost = 24;
    Growth growth = *this;
    growth.recent_.clear();
    growth.place(node, position);
    while (growth.size_ < size_ + kMost && growth.by_waves()) {
    }
    return growth;
  }

  // By how much, in chi-squared, the pairs of the nodes placed last explain more than
  // these had to be given.
  double credit() const {
    double sum = 0.0;
    std::vector<bool> counted(problem_.pairs.size(), false);
    for (const Index v : recent_) {
      sum -= problem_.dimension * gate_;
      for (const auto& [vertex, edge] : problem_.pair_graph.neighbours(v)) {
        if (!trusted_[edge] || !placement_.placed[vertex] || counted[edge]) continue;
        counted[edge] = true;
        sum += std::max(0.0, gate_ - squared_deviation(placement_, problem_.pairs[edge]));
      }
    }
    return sum;
  }

  void adopt(const Growth& growth) {
    for (const Index v : growth.recent_) place(v, growth.placement_.positions.col(v));
  }

  void settle() {
    constexpr int kIterations = 8;
    const double width = std::sqrt(gate_);
    refine(problem_, ranges_in_reach(problem_, trusted_, placement_, width), placement_,
           {.width = width, .max_iterations = kIterations, .progress = options_.progress});
    drop_contradicted();
    crowd_.rebuild(placement_);
    settled_size_ = size_;
    stale_.assign(problem_.nodes, true);
  }

  void drop_contradicted() {
    std::vector<Index> dropped;
    for (Index v = 0; v < problem_.nodes; ++v) {
      if (!placement_.placed[v] || problem_.is_anchor[v]) continue;
      const auto network = star(problem_, placement_, v, trusted_);
      if (!is_most(agreeing(network, gate_), network)) dropped.push_back(v);
    }
    for (const Index v : dropped) {
      placement_.placed[v] = false;
      ++losses_[v];
      --size_;
    }
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
  std::vector<bool> tried_;                   // whose two places led to nothing
  std::vector<int> losses_;                   // how often a node lost its place
  std::vector<Index> recent_;
  std::ptrdiff_t size_ = 0;
  std::ptrdiff_t settled_size_ = 0;  // when the map was last refined
};

}  // namespace

void grow(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
          const Evidence& evidence, const LocalizeOptions& options, Placement& placement,
          Index limit) {
  Growth growth(problem, trusted, gate, evidence, options, placement);
  growth.run(limit);
  placement = growth.placement();
}

}  // namespace isotherm::network::detail
