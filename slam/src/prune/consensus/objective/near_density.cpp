#include "prune/consensus/objective/near_density.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <nanoflann.hpp>

#include "isotherm/base/random.hpp"
#include "isotherm/base/statistics.hpp"
#include "prune/consensus/constants.hpp"
#include "prune/consensus/estimate/log_normal.hpp"
#include "prune/consensus/pairs/loop_pair.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr std::size_t kMostPlaces = 20000;
constexpr std::size_t kMostWeighed = 50000;
constexpr double kDeviationOfMad = 1.4826;  // of a normal distribution
constexpr std::uint64_t kSeed = 1;

// Median squared steps of odometry, in translation and in rotation, along one axis.
template <class Pose>
typename Pose::Tangent median_step(const OdometryChain<Pose>& odometry) {
  std::vector<double> translations;
  std::vector<double> rotations;
  for (Index v = 1; v < odometry.vertex_count(); ++v) {
    if (odometry.chain(v) != odometry.chain(v - 1)) continue;
    const typename Pose::Tangent step = odometry.relative(v - 1, v).T.log();
    translations.push_back(step.template head<Pose::kDim>().squaredNorm());
    rotations.push_back(step.template tail<Pose::kDof - Pose::kDim>().squaredNorm());
  }
  typename Pose::Tangent square = Pose::Tangent::Zero();
  if (translations.empty()) return square;
  square.template head<Pose::kDim>().setConstant(quantile(std::move(translations), 0.5));
  square.template tail<Pose::kDof - Pose::kDim>().setConstant(quantile(std::move(rotations), 0.5));
  return square;
}

}  // namespace

template <class Pose>
NearDensity<Pose>::NearDensity(const ReducedGraph<Pose>& graph) {
  fit(graph);
  find_places(graph);
}

// Medians and median deviations, with the loops' own uncertainty. However well places are told
// apart, the nearest pose to one is up to a step of odometry away: as if one loop more had been
// off by that, since a few loops say little of how far others are.
template <class Pose>
void NearDensity<Pose>::fit(const ReducedGraph<Pose>& graph) {
  const auto loops = forward_loops(graph, {});
  const Tangent step = median_step(graph.odometry);
  const auto median_over = [&loops](auto value) {
    std::vector<double> values;
    values.reserve(loops.size());
    for (const auto& loop : loops) values.push_back(value(loop.measured));
    return quantile(std::move(values), 0.5);
  };
  Tangent turn = Tangent::Zero();
  for (int d = 0; d < Pose::kDim; ++d) {
    center_[d] = median_over([d](const auto& m) { return m.T.translation()[d]; });
  }
  for (int d = Pose::kDim; d < Pose::kDof; ++d) {
    turn[d] = median_over([d](const auto& m) { return m.T.log()[d]; });
  }
  center_inverse_ = Pose::exp(turn).inverse();
  inverse_deviation_.setOnes();  // until each is known
  reach_ = 0.0;
  for (int d = 0; d < Pose::kDof; ++d) {
    const double mad = median_over([&](const auto& m) { return std::abs(offset(m.T)[d]); });
    const auto count = static_cast<double>(loops.size());
    const double alike =
        (count * kDeviationOfMad * mad * kDeviationOfMad * mad + step[d]) / (count + 1.0) +
        median_over([d](const auto& m) { return m.covariance(d, d); });
    const double near = std::sqrt(alike + step[d]);
    inverse_deviation_[d] = 1.0 / near;
    narrower_[d] = near / std::sqrt(alike);
    if (d < Pose::kDim) reach_ = std::max(reach_, kReach * near);
  }
  reach_ += center_.norm();
}

template <class Pose>
void NearDensity<Pose>::find_places(const ReducedGraph<Pose>& graph) {
  const Index count = graph.odometry.vertex_count();
  stride_ = std::max(1.0, static_cast<double>(count) / kMostPlaces);
  std::size_t next = 0;  // first node after the vertex
  for (double at = 0.0; at < count; at += stride_) {
    const auto vertex = static_cast<Index>(at);
    while (next < graph.vertex.size() && graph.vertex[next] <= vertex) ++next;
    const Index chain = graph.odometry.chain(vertex);
    for (const std::size_t node : {next - 1, next}) {
      if (node >= graph.vertex.size() || graph.chain[node] != chain) continue;
      places_.push_back({vertex, static_cast<Index>(node),
                         graph.odometry.relative(graph.vertex[node], vertex).T});
      chain_.push_back(chain);
      break;
    }
  }
  Random random(kSeed);
  anchors_.resize(places_.size());
  std::iota(anchors_.begin(), anchors_.end(), 0);
  for (std::size_t k = anchors_.size(); k > 1; --k) {
    std::swap(anchors_[k - 1], anchors_[random.index(k)]);
  }
}

// In units of the wider deviations.
template <class Pose>
typename Pose::Tangent NearDensity<Pose>::offset(const Pose& T) const {
  Tangent d = (center_inverse_ * T).log();
  d.template head<Pose::kDim>() = T.translation() - center_;
  return d.cwiseProduct(inverse_deviation_);
}

// f over that of the wider normal distribution at its peak.
template <class Pose>
double NearDensity<Pose>::shape(const Tangent& offset) const {
  return 0.5 * (std::exp(-0.5 * offset.squaredNorm()) +
                narrower_.prod() * std::exp(-0.5 * offset.cwiseProduct(narrower_).squaredNorm()));
}

template <class Pose>
std::vector<Pose> NearDensity<Pose>::places_on(const std::vector<Pose>& map) const {
  std::vector<Pose> at;
  at.reserve(places_.size());
  for (const auto& place : places_) at.push_back(map[place.node] * place.T_node_vertex);
  return at;
}

// Poses near each other are rare on a large map: they are looked for, not drawn. Of the anchors
// every `stride`th, from the first.
template <class Pose>
void NearDensity<Pose>::count_near(const std::vector<Pose>& at, std::size_t first,
                                   std::size_t stride, Count& count) const {
  using Points = Eigen::Matrix<double, Eigen::Dynamic, Pose::kDim>;
  Points points(static_cast<Eigen::Index>(at.size()), Pose::kDim);
  for (std::size_t p = 0; p < at.size(); ++p) {
    points.row(static_cast<Eigen::Index>(p)) = at[p].translation();
  }
  const nanoflann::KDTreeEigenMatrixAdaptor<Points> tree(Pose::kDim, points);
  const nanoflann::SearchParams unsorted(0, 0.0F, false);
  std::vector<std::pair<Eigen::Index, double>> near;
  std::size_t weighed = 0;
  for (std::size_t next = first; next < anchors_.size(); next += stride) {
    if (weighed > kMostWeighed / stride) break;
    const std::size_t a = anchors_[next];
    const typename Pose::Translation point = at[a].translation();
    tree.index->radiusSearch(point.data(), reach_ * reach_, near, unsorted);
    weighed += near.size();
    for (const auto& [found, square] : near) {
      const auto b = static_cast<std::size_t>(found);
      if (b == a) continue;
      const auto [from, to] = std::minmax(a, b);
      count.near[class_of(from, to)] += shape(offset(at[from].inverse() * at[to]));
    }
    count_pairs(a, count.pairs);
  }
}

// Of each map other anchors. As if half a pair more lay at the peak: so much is known where there
// is none.
template <class Pose>
std::array<double, kProposalClasses> NearDensity<Pose>::log_mean(
    const std::vector<std::vector<Pose>>& maps) const {
  Count count;
  count.near.fill(0.5 * shape(Tangent::Zero()));
  count.pairs.fill(1.0);
  for (std::size_t m = 0; m < maps.size(); ++m) {
    count_near(places_on(maps[m]), m, maps.size(), count);
  }
  const double log_peak = inverse_deviation_.array().log().sum() - 0.5 * Pose::kDof * kLog2Pi;
  std::array<double, kProposalClasses> result;
  for (std::size_t c = 0; c < kProposalClasses; ++c) {
    result[c] = log_peak + std::log(count.near[c] / count.pairs[c]);
  }
  return result;
}

template <class Pose>
std::size_t NearDensity<Pose>::class_of(std::size_t from, std::size_t to) const {
  return chain_[from] == chain_[to] ? span_class(places_[to].vertex - places_[from].vertex)
                                    : kSpanClasses;
}

// Of each class, how many places make a pair with `anchor`.
template <class Pose>
void NearDensity<Pose>::count_pairs(std::size_t anchor,
                                    std::array<double, kProposalClasses>& pairs) const {
  const auto [first, last] = std::equal_range(chain_.begin(), chain_.end(), chain_[anchor]);
  const auto begin = static_cast<double>(first - chain_.begin());
  const auto end = static_cast<double>(last - chain_.begin());
  pairs[kSpanClasses] += static_cast<double>(chain_.size()) - (end - begin);
  const double before = static_cast<double>(anchor) - begin;
  const double after = end - 1.0 - static_cast<double>(anchor);
  for (std::size_t c = 1; c < kSpanClasses; ++c) {
    const double least = std::ldexp(1.0, static_cast<int>(c) - 1) / stride_;
    const double most = std::max(std::ldexp(1.0, static_cast<int>(c)) / stride_, least + 1.0);
    if (least > std::max(before, after)) break;
    for (const double side : {before, after}) {
      pairs[c] += std::max(0.0, std::min(side + 1.0, most) - least);
    }
  }
}

template class NearDensity<Pose2>;
template class NearDensity<Pose3>;

}  // namespace isotherm::slam::detail
