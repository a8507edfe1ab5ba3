#include "mutual_support.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>

namespace isotherm::slam::detail {
namespace {

// More partners than this tell nothing new; the nearest are taken.
constexpr std::size_t kMostPartners = 12;

// A loop stated from the earlier vertex to the later one.
template <class Pose>
struct Forward {
  Index from = 0;
  Index to = 0;
  UncertainPose<Pose> measured;
};

template <class Pose>
Forward<Pose> forward(const ReducedGraph<Pose>& graph, const Link<Pose>& loop, double scale) {
  const Index a = graph.vertex[loop.a];
  const Index b = graph.vertex[loop.b];
  const UncertainPose<Pose> measured{loop.T_a_b, loop.covariance * scale};
  if (a <= b) return {a, b, measured};
  return {b, a, inverse(measured)};
}

// Loops by cells of `window` x `window` vertices in the plane of (from, to).
class Cells {
 public:
  using Key = std::array<Index, 4>;  // chains and cell numbers of both ends

  Cells(Index window, std::size_t loops) : window_(window), key_(loops) {}

  void add(Index loop, Index from_chain, Index to_chain, Index from, Index to) {
    key_[loop] = {from_chain, to_chain, from / window_, to / window_};
    cells_[key_[loop]].push_back(loop);
  }

  template <class Visit>
  void for_each_near(Index loop, Visit visit) const {
    for (Index df = -1; df <= 1; ++df) {
      for (Index dt = -1; dt <= 1; ++dt) {
        Key key = key_[loop];
        key[2] += df;
        key[3] += dt;
        const auto found = cells_.find(key);
        if (found == cells_.end()) continue;
        for (const Index other : found->second) visit(other);
      }
    }
  }

 private:
  Index window_;
  std::vector<Key> key_;
  std::map<Key, std::vector<Index>> cells_;
};

template <class Pose>
class Comparison {
 public:
  Comparison(const ReducedGraph<Pose>& graph, const CovarianceScale& scale, Index window)
      : graph_(graph), scale_(scale), window_(window), cells_(window, graph.loops.size()) {
    for (const auto& loop : graph.loops) {
      loops_.push_back(forward(graph, loop, scale.loops));
      const auto& added = loops_.back();
      cells_.add(static_cast<Index>(loops_.size()) - 1, graph.odometry.chain(added.from),
                 graph.odometry.chain(added.to), added.from, added.to);
    }
  }

  // Partners that come later in the list, nearest first.
  std::vector<Index> partners(Index loop) const {
    std::vector<std::pair<Index, Index>> near;
    cells_.for_each_near(loop, [&](Index other) {
      if (other == loop) return;
      const Index df = std::abs(loops_[loop].from - loops_[other].from);
      const Index dt = std::abs(loops_[loop].to - loops_[other].to);
      if (std::max(df, dt) <= window_) near.emplace_back(df + dt, other);
    });
    const std::size_t count = std::min(near.size(), kMostPartners);
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
    std::vector<Index> result;
    for (std::size_t k = 0; k < count; ++k) result.push_back(near[k].second);
    return result;
  }

  Evidence compare(Index first, Index second, const MapVolume<Pose>& map) const {
    const auto& e = loops_[first];
    const auto& f = loops_[second];
    const auto predicted = compose(compose(along(f.from, e.from), e.measured), along(e.to, f.to));
    const typename Pose::Tangent r = (f.measured.T.inverse() * predicted.T).log();
    const typename Pose::Matrix j = residual_jacobian<Pose>(r);
    return weigh(r, f.measured.covariance + j * predicted.covariance * j.transpose(), map);
  }

 private:
  UncertainPose<Pose> along(Index from, Index to) const {
    auto path = graph_.odometry.relative(from, to);
    path.covariance *= scale_.odometry;
    return path;
  }

  const ReducedGraph<Pose>& graph_;
  CovarianceScale scale_;
  Index window_;
  std::vector<Forward<Pose>> loops_;
  Cells cells_;
};

}  // namespace

template <class Pose>
MutualSupport mutual_support(const ReducedGraph<Pose>& graph, const MapVolume<Pose>& map,
                             const CovarianceScale& scale, Index window, double gate) {
  const Comparison<Pose> comparison(graph, scale, window);
  std::vector<std::pair<Index, Index>> pairs;
  for (Index loop = 0; loop < static_cast<Index>(graph.loops.size()); ++loop) {
    for (const Index other : comparison.partners(loop)) {
      pairs.emplace_back(std::min(loop, other), std::max(loop, other));
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());

  MutualSupport support;
  for (const auto& [first, second] : pairs) {
    const Evidence evidence = comparison.compare(first, second, map);
    auto& kind = evidence.chi2 <= gate ? support.agreeing : support.contradicting;
    kind.push_back({first, second, evidence.log_ratio});
  }
  std::stable_sort(support.agreeing.begin(), support.agreeing.end(),
                   [](const Support& a, const Support& b) { return a.gain > b.gain; });
  return support;
}

template MutualSupport mutual_support(const ReducedGraph<Pose2>&, const MapVolume<Pose2>&,
                                      const CovarianceScale&, Index, double);
template MutualSupport mutual_support(const ReducedGraph<Pose3>&, const MapVolume<Pose3>&,
                                      const CovarianceScale&, Index, double);

}  // namespace isotherm::slam::detail
