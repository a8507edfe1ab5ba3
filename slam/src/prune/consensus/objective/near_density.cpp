#include "prune/consensus/objective/near_density.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <nanoflann.hpp>

#include "isotherm/base/random.hpp"
#include "isotherm/base/statistics.hpp"
#include "prune/consensus/constants.hpp"
#include "prune/consensus/estimate/log_normal.hpp"
#include "prune/consensus/objective/log_sum.hpp"
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

// f is normal around the median or has the shape of k, with even odds: measurements are often
// much alike, those of false loops above all, and some are not.
template <class Pose>
double NearDensity<Pose>::log_false_density(const Pose& measured) const {
  const Tangent wide = offset(measured);
  const double nearer = wide.squaredNorm() - wide.cwiseProduct(narrower_).squaredNorm();
  const double more = narrower_.array().log().sum() + 0.5 * nearer;  // log of normal over wide
  return inverse_deviation_.array().log().sum() - 0.5 * Pose::kDof * kLog2Pi - std::log(2.0) +
         log_sum(more, 0.0);
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

// In units of the deviations of k.
template <class Pose>
typename Pose::Tangent NearDensity<Pose>::offset(const Pose& T) const {
  Tangent d = (center_inverse_ * T).log();
  d.template head<Pose::kDim>() = T.translation() - center_;
  return d.cwiseProduct(inverse_deviation_);
}

// Poses near each other are rare on a large map: they are looked for, not drawn. As if half a
// pair more lay at the peak: so much is known where there is none.
template <class Pose>
std::array<double, kProposalClasses> NearDensity<Pose>::log_mean(
    const std::vector<Pose>& poses) const {
  using Points = Eigen::Matrix<double, Eigen::Dynamic, Pose::kDim>;
  std::vector<Pose> at;
  at.reserve(places_.size());
  Points points(static_cast<Eigen::Index>(places_.size()), Pose::kDim);
  for (const auto& place : places_) {
    at.push_back(poses[place.node] * place.T_node_vertex);
    points.row(static_cast<Eigen::Index>(at.size()) - 1) = at.back().translation();
  }
  const nanoflann::KDTreeEigenMatrixAdaptor<Points> tree(Pose::kDim, points);
  std::array<double, kProposalClasses> inside;
  inside.fill(0.5);
  std::array<double, kProposalClasses> pairs;
  pairs.fill(1.0);
  const nanoflann::SearchParams unsorted(0, 0.0F, false);
  std::vector<std::pair<Eigen::Index, double>> near;
  std::size_t weighed = 0;
  for (const std::size_t a : anchors_) {
    if (weighed > kMostWeighed) break;
    const typename Pose::Translation point = at[a].translation();
    tree.index->radiusSearch(point.data(), reach_ * reach_, near, unsorted);
    weighed += near.size();
    for (const auto& [found, square] : near) {
      const auto b = static_cast<std::size_t>(found);
      if (b == a) continue;
      const auto [from, to] = std::minmax(a, b);
      inside[class_of(from, to)] +=
          std::exp(-0.5 * offset(at[from].inverse() * at[to]).squaredNorm());
    }
    count_pairs(a, pairs);
  }
  std::array<double, kProposalClasses> result;
  for (std::size_t c = 0; c < kProposalClasses; ++c) {
    result[c] = std::log(inside[c] / pairs[c]);
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
