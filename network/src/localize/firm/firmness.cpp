#include "localize/firm/firmness.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <Eigen/Geometry>

#include "isotherm/base/parallel.hpp"
#include "localize/evidence/crowd.hpp"
#include "localize/evidence/evidence.hpp"
#include "localize/evidence/multilateration.hpp"
#include "localize/evidence/star.hpp"
#include "localize/firm/found_bodies.hpp"
#include "localize/firm/hinge_parts.hpp"
#include "localize/fold/fold_axes.hpp"
#include "localize/fold/fold_trial.hpp"
#include "localize/fold/mirror_image.hpp"
#include "localize/patches/seeds.hpp"

namespace isotherm::network::detail {
namespace {

using Nodes = std::vector<Index>;

// Of what makes a place clearly the best, what one range may bring where a body spreads.
constexpr double kOneRange = 0.7;

// Sets of firm nodes at the places they have.
class Firmness {
 public:
  Firmness(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
           const LocalizeOptions& options, const Placement& placement)
      : problem_(problem),
        trusted_(trusted),
        gate_(gate),
        options_(options),
        placement_(placement),
        evidence_(learn_evidence(problem, trusted, gate, placement)),
        crowd_(problem, placement, evidence_.absence),
        clear_(-2.0 * std::log(options.mirror_chance)),
        sigma_(problem.typical_sigma),
        strict_{std::min(evidence_.limits.apart, kOneRange * clear_),
                std::min(evidence_.limits.close, kOneRange * clear_)} {}

  std::vector<bool> run() const {
    // Without anchors a simplex may be mirrored as it is.
    if (!problem_.anchored() && placed_count(placement_) <= problem_.dimension + 1) {
      return placement_.placed;
    }
    auto bodies = find_bodies();
    // By node, the bodies that it is in or next to.
    std::vector<std::vector<std::size_t>> touching(problem_.nodes);
    for (std::size_t k = 0; k < bodies.size(); ++k) note_body(k, bodies[k], touching);
    for (std::size_t base = 0; base < bodies.size(); ++base) {
      auto body = std::move(bodies[base]);
      bodies[base].clear();
      const auto before = static_cast<std::ptrdiff_t>(body.size());
      absorb(body, bodies, touching);
      note_body(base, {body.begin() + before, body.end()}, touching);
      bodies[base] = std::move(body);
    }
    if (problem_.anchored()) {
      auto frame = with(anchors());
      auto firm = spread(frame, anchors(), strict_, {});
      absorb(firm, bodies, touching);
      return complete(std::move(firm), bodies);
    }
    const auto largest =
        std::max_element(bodies.begin(), bodies.end(),
                         [](const Nodes& a, const Nodes& b) { return a.size() < b.size(); });
    if (largest == bodies.end()) return none().placed;
    auto firm = std::move(*largest);
    largest->clear();
    return complete(std::move(firm), bodies);
  }

 private:
  Nodes anchors() const { return nodes_that_are(problem_.is_anchor); }

  Nodes nodes_that_are(const std::vector<bool>& marked) const {
    Nodes nodes;
    for (Index v = 0; v < problem_.nodes; ++v) {
      if (marked[v]) nodes.push_back(v);
    }
    return nodes;
  }

  Placement none() const {
    return {placement_.positions, std::vector<bool>(placement_.placed.size(), false)};
  }

  Placement with(const Nodes& body) const {
    auto placement = none();
    for (const Index v : body) placement.placed[v] = true;
    return placement;
  }

  // With the nodes in none of the bodies that a single range puts in one place, and without
  // those that have two places among all the others, now that these are known. What is part of a
  // body comes and goes with it: node by node a part creeps over a hinge that it turns on.
  std::vector<bool> complete(Nodes body, const std::vector<Nodes>& bodies) const {
    std::vector<bool> bound(problem_.nodes, false);
    for (const auto& other : bodies) {
      for (const Index v : other) bound[v] = true;
    }
    auto firm = with(body);
    const auto all = spread(firm, std::move(body), evidence_.limits, bound);
    release_turning_parts(firm);
    release_folding_parts(firm);
    auto result = firm.placed;
    for (const Index v : all) {
      if (problem_.is_anchor[v] || !result[v]) continue;
      result[v] = has_one_place(firm, v, evidence_.limits);
    }
    return result;
  }

  // Takes out the parts that may turn on a hinge.
  void release_turning_parts(Placement& firm) const {
    const auto everywhere = surroundings_of(nodes_that_are(firm.placed));
    std::set<Nodes> seen;
    for (Index v = 0; v < problem_.nodes; ++v) {
      if (!firm.placed[v]) continue;
      for (const auto& part : parts_behind(problem_, trusted_, firm.placed, v)) {
        if (!seen.insert(part).second) continue;
        for (const Index w : part) firm.placed[w] = problem_.is_anchor[w];
        if (!is_fixed(part, firm, everywhere)) continue;
        for (const Index w : part) firm.placed[w] = true;
      }
    }
  }

  // Takes out what is elsewhere in a mirror image of a part that fits nearly as well.
  void release_folding_parts(Placement& firm) const {
    std::vector<bool> among(problem_.nodes, true);
    Nodes released;
    do {
      released.clear();
      const Crowd crowd(problem_, firm, evidence_.absence);
      for (const auto& fold :
           find_folds(problem_, trusted_, evidence_.limits, options_, firm, among)) {
        const bool is_whole = std::all_of(fold.part.begin(), fold.part.end(),
                                          [&](Index v) { return firm.placed[v]; });
        if (!is_whole) continue;
        const auto outcome = try_fold(problem_, trusted_, gate_, evidence_, crowd, firm, fold);
        if (outcome.extra >= clear_) continue;
        for (const Index v : outcome.moved) firm.placed[v] = false;
        released.insert(released.end(), outcome.moved.begin(), outcome.moved.end());
      }
      among = lines_near(problem_, released);
    } while (!released.empty());
  }

  // Enters a body at its nodes and their neighbours.
  void note_body(std::size_t body, const Nodes& nodes,
                 std::vector<std::vector<std::size_t>>& touching) const {
    const auto note = [&](Index v) {
      if (touching[v].empty() || touching[v].back() != body) touching[v].push_back(body);
    };
    for (const Index v : nodes) {
      note(v);
      for (const auto& neighbour : problem_.pair_graph.neighbours(v)) note(neighbour.vertex);
    }
  }

  // Adds to one body those of `others` that are fixed to it, and what they bring, as long
  // as there are any; these become empty. Only bodies that touch what is new are looked at.
  void absorb(Nodes& body, std::vector<Nodes>& others,
              const std::vector<std::vector<std::size_t>>& touching) const {
    if (body.empty()) return;
    auto firm = with(body);
    std::vector<bool> touched(others.size(), false);
    const auto touch = [&](const Nodes& nodes) {
      for (const Index v : nodes) {
        for (const auto k : touching[v]) touched[k] = true;
      }
    };
    touch(body);
    auto surroundings = surroundings_of(body);
    for (bool any = true; any;) {
      any = false;
      for (std::size_t k = 0; k < others.size(); ++k) {
        if (!touched[k]) continue;
        touched[k] = false;
        auto& other = others[k];
        if (other.empty() || !is_fixed(other, firm, surroundings)) continue;
        Nodes fresh;
        for (const Index v : other) {
          if (!firm.placed[v]) fresh.push_back(v);
          firm.placed[v] = true;
        }
        const auto added = spread(firm, std::move(fresh), strict_, {});
        body.insert(body.end(), added.begin(), added.end());
        touch(added);
        surroundings.extend(surroundings_of(added));
        other.clear();
        any = true;
      }
    }
  }

  // Where it matters that nodes have no ranges to these.
  Eigen::AlignedBoxXd surroundings_of(const Nodes& nodes) const {
    Eigen::AlignedBoxXd box(problem_.dimension);
    for (const Index v : nodes) box.extend(placement_.positions.col(v));
    const Eigen::VectorXd margin =
        Eigen::VectorXd::Constant(problem_.dimension, evidence_.absence.reach());
    if (box.isEmpty()) return box;
    return {box.min() - margin, box.max() + margin};
  }

  // Whether a body has one place among firm nodes: no mirror image fits nearly as well.
  bool is_fixed(const Nodes& body, const Placement& firm,
                const Eigen::AlignedBoxXd& surroundings) const {
    auto inside = body;
    std::sort(inside.begin(), inside.end());
    TiedBody tied;
    auto& ties = tied.ties;
    std::vector<Index> outside;
    for (const Index v : body) {
      if (firm.placed[v]) {
        ties.push_back(shared(v));
        continue;
      }
      outside.push_back(v);
      tied.points.push_back(placement_.positions.col(v));
      for (const auto& [vertex, edge] : problem_.pair_graph.neighbours(v)) {
        if (!trusted_[edge] || !firm.placed[vertex]) continue;
        if (std::binary_search(inside.begin(), inside.end(), vertex)) continue;
        const auto& pair = problem_.pairs[edge];
        ties.push_back({placement_.positions.col(v), placement_.positions.col(vertex),
                        pair.distance, pair.sigma, evidence_.limits});
      }
    }
    return holds(tied, [&](const std::vector<Point>& places) {
      double cost = 0.0;
      for (std::size_t k = 0; k < places.size(); ++k) {
        if (!surroundings.contains(places[k])) continue;
        cost += crowd_.absence_cost(outside[k], places[k], firm.placed);
      }
      return cost;
    });
  }

  // Of a node that is part of both bodies.
  Tie shared(Index v) const {
    // The place of an anchor cannot be at fault, only the ranges that tie it to the body.
    const double limit =
        (problem_.is_anchor[v] ? problem_.dimension + 1 : 1) * evidence_.limits.apart;
    const Point place = placement_.positions.col(v);
    return {place, place, 0.0, sigma_, {limit, limit}};
  }

  // Whether two bodies that have these nodes in common are one.
  bool fix_body(const Nodes& common) const {
    TiedBody body;
    for (const Index v : common) body.ties.push_back(shared(v));
    return holds(body, {});
  }

  bool holds(const TiedBody& body, const PointsCost& points_cost) const {
    const int d = problem_.dimension;
    int held = 0;  // coordinates, as far as ranges agree
    double cost = 0.0;
    for (const auto& tie : body.ties) {
      cost += tie.cost();
      if (tie.cost() <= std::min(gate_, 0.999 * tie.limit())) held += tie.distance == 0.0 ? d : 1;
    }
    if (held <= d * (d + 1) / 2 + 1) return false;
    if (points_cost) cost += points_cost(body.points);
    return !has_mirror_image(body, cost + clear_, points_cost);
  }

  // What can be reached from each clique, the largest first.
  std::vector<Nodes> find_bodies() const {
    FoundBodies found(problem_.nodes);
    for (const auto& seed : consistent_cliques(problem_, agreeing_pairs(), gate_, options_)) {
      if (found.cover(seed.members)) continue;
      auto firm = with(seed.members);
      found.begin_body();
      found.end_body(spread(firm, seed.members, strict_, {}, &found));
    }
    auto bodies = std::move(found).take();
    std::stable_sort(bodies.begin(), bodies.end(),
                     [](const Nodes& a, const Nodes& b) { return a.size() > b.size(); });
    return bodies;
  }

  std::vector<bool> agreeing_pairs() const {
    std::vector<bool> agree(problem_.pairs.size(), false);
    for (std::size_t p = 0; p < agree.size(); ++p) {
      const auto& pair = problem_.pairs[p];
      agree[p] = trusted_[p] && is_placed(placement_, pair) &&
                 squared_deviation(placement_, pair) <= gate_;
    }
    return agree;
  }

  // Adds the nodes that are firm thanks to those in `firm`, of which `fresh` are new, and
  // so on; not those that are `bound`. Bodies `found` before come as a whole with nodes that fix
  // them. All of them.
  Nodes spread(Placement& firm, Nodes fresh, const Limits& limits, const std::vector<bool>& bound,
               FoundBodies* found = nullptr) const {
    Nodes all;
    while (!fresh.empty()) {
      for (const Index v : fresh) firm.placed[v] = true;
      all.insert(all.end(), fresh.begin(), fresh.end());
      if (found != nullptr) {
        const auto joined =
            found->join(fresh, firm.placed, [&](const Nodes& shared) { return fix_body(shared); });
        // Whoever has new neighbours among those that joined has others among the rest.
        const auto& fewer = joined.size() < all.size() ? joined : all;
        if (!joined.empty()) fresh.insert(fresh.end(), fewer.begin(), fewer.end());
        all.insert(all.end(), joined.begin(), joined.end());
      }
      fresh = made_firm(firm, fresh, limits, bound);
    }
    return all;
  }

  // The neighbours of fresh nodes that have one place among the firm ones.
  Nodes made_firm(const Placement& firm, const Nodes& fresh, const Limits& limits,
                  const std::vector<bool>& bound) const {
    constexpr std::size_t kFew = 32;  // not worth waking other threads for
    Nodes near;
    for (const Index v : fresh) {
      for (const auto& [vertex, edge] : problem_.pair_graph.neighbours(v)) {
        if (!trusted_[edge] || !placement_.placed[vertex] || firm.placed[vertex]) continue;
        if (bound.empty() || !bound[vertex]) near.push_back(vertex);
      }
    }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    std::vector<char> has_one(near.size(), 0);
    const int threads = near.size() < kFew ? 1 : options_.threads;
    parallel_for(
        static_cast<std::int64_t>(near.size()), threads, options_.progress, "determinacy",
        [&](std::int64_t k) { has_one[k] = has_one_place(firm, near[k], limits) ? 1 : 0; });
    Nodes made;
    for (std::size_t k = 0; k < near.size(); ++k) {
      if (has_one[k] != 0) made.push_back(near[k]);
    }
    return made;
  }

  // Whether the node's place among the firm ones is clearly the best.
  bool has_one_place(const Placement& firm, Index node, const Limits& limits) const {
    auto network = star(problem_, firm, node, trusted_);
    if (network.fixed <= problem_.dimension || is_in_the_way(node)) return false;
    crowd_.add_strangers(network, node, firm.placed);
    const auto found = multilaterate(network, limits);
    if (!found || found->rival_cost - found->cost < clear_) return false;
    network.positions.col(network.fixed) = placement_.positions.col(node);
    const int agree = agreeing(network, gate_);
    // Such a node belongs with those that are not firm, rather: d + 1 ranges, one of them false,
    // agree somewhere by chance.
    if (hangs_elsewhere(firm, node) && agree <= problem_.dimension + 1) return false;
    return 2 * agree > static_cast<int>(network.ranges.size()) &&
           place_cost(network, limits) - found->cost < 0.5 * clear_;
  }

  // Whether most of the node's ranges lead to nodes that are not firm.
  bool hangs_elsewhere(const Placement& firm, Index node) const {
    int here = 0;
    int elsewhere = 0;
    for (const auto& [vertex, edge] : problem_.pair_graph.neighbours(node)) {
      if (trusted_[edge]) ++(firm.placed[vertex] ? here : elsewhere);
    }
    return elsewhere > here;
  }

  // Whether the node stands among others that it should have ranges to: it, or these, lie on
  // the wrong side of a fold.
  bool is_in_the_way(Index node) const {
    return crowd_.absence_cost(node, placement_.positions.col(node), placement_.placed) > clear_;
  }

  const RangeProblem& problem_;
  const std::vector<bool>& trusted_;
  double gate_;
  const LocalizeOptions& options_;
  const Placement& placement_;
  Evidence evidence_;
  Crowd crowd_;
  double clear_;
  double sigma_;   // of a usual range
  Limits strict_;  // with which no single range decides
};

}  // namespace

std::vector<bool> firm_nodes(const RangeProblem& problem, const std::vector<bool>& trusted,
                             double gate, const LocalizeOptions& options,
                             const Placement& placement) {
  return Firmness(problem, trusted, gate, options, placement).run();
}

}  // namespace isotherm::network::detail
