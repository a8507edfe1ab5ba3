#include "prune/consensus/objective/near_density.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <nanoflann.hpp>

#include "isotherm/base/random.hpp"
#include "isotherm/base/statistics.hpp"
#include "prune/consensus/constants.hpp"
#include "prune/consensus/estimate/log_normal.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr std::size_t kMostPlaces = 20000;
constexpr std::size_t kMostWeighed = 50000;
constexpr std::size_t kMostAround = 500;    // loops
constexpr Index kMostStrides = 10;          // to either side of them
constexpr double kDeviationOfMad = 1.4826;  // of a normal distribution
constexpr std::uint64_t kSeed = 1;

// Variance of anything up to half a mean step of odometry either way, of translation and of
// rotation along one axis.
template <class Pose>
typename Pose::Tangent half_step_variance(const OdometryChain<Pose>& odometry) {
  double translation = 0.0;
  double rotation = 0.0;
  double count = 0.0;
  for (Index v = 1; v < odometry.vertex_count(); ++v) {
    if (odometry.chain(v) != odometry.chain(v - 1)) continue;
    const typename Pose::Tangent step = odometry.relative(v - 1, v).T.log();
    translation += step.template head<Pose::kDim>().norm();
    rotation += step.template tail<Pose::kDof - Pose::kDim>().norm();
    count += 1.0;
  }
  typename Pose::Tangent mean = Pose::Tangent::Zero();
  if (count == 0.0) return mean;
  mean.template head<Pose::kDim>().setConstant(translation / count);
  mean.template tail<Pose::kDof - Pose::kDim>().setConstant(rotation / count);
  return mean.cwiseAbs2() / 12.0;
}

// Those of up to so many vertices before and after, from it, by odometry.
template <class Pose>
std::vector<Pose> poses_around(const OdometryChain<Pose>& odometry, Index vertex, Index window) {
  std::vector<Pose> poses;
  const Index stride = std::max<Index>(1, window / kMostStrides);
  const Index last = std::min(vertex + window, odometry.vertex_count() - 1);
  for (Index v = std::max<Index>(vertex - window, 0); v <= last; v += stride) {
    if (odometry.chain(v) == odometry.chain(vertex)) {
      poses.push_back(odometry.relative(vertex, v).T);
    }
  }
  return poses;
}

}  // namespace

// Where places are on a map.
template <class Pose>
struct NearDensity<Pose>::Places {
  using Points = Eigen::Matrix<double, Eigen::Dynamic, Pose::kDim>;

  Places(const std::vector<Place>& places, const std::vector<Pose>& map)
      : poses(poses_of(places, map)), points(points_of(poses)), tree(Pose::kDim, points) {}

  static std::vector<Pose> poses_of(const std::vector<Place>& places,
                                    const std::vector<Pose>& map) {
    std::vector<Pose> poses;
    poses.reserve(places.size());
    for (const auto& place : places) poses.push_back(map[place.node] * place.T_node_vertex);
    return poses;
  }

  static Points points_of(const std::vector<Pose>& poses) {
    Points points(static_cast<Eigen::Index>(poses.size()), Pose::kDim);
    for (std::size_t p = 0; p < poses.size(); ++p) {
      points.row(static_cast<Eigen::Index>(p)) = poses[p].translation();
    }
    return points;
  }

  std::vector<Pose> poses;
  Points points;
  nanoflann::KDTreeEigenMatrixAdaptor<Points> tree;
};

template <class Pose>
NearDensity<Pose>::NearDensity(const ReducedGraph<Pose>& graph) {
  fit(graph);
  find_places(graph);
}

template <class Pose>
void NearDensity<Pose>::fit(const ReducedGraph<Pose>& graph) {
  const auto loops = forward_loops(graph, {});
  const Tangent nearest = half_step_variance(graph.odometry);
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
    turn[d] = median_over([d](const auto& m) { return m.T.rotation_log()[d - Pose::kDim]; });
  }
  center_inverse_ = Pose::exp(turn).inverse();
  for (int d = 0; d < Pose::kDof; ++d) {
    const double differ =
        kDeviationOfMad * median_over([&](const auto& m) { return std::abs(offset(m.T)[d]); });
    const double stated = median_over([d](const auto& m) { return m.covariance(d, d); });
    deviation_[d] = std::sqrt(differ * differ + stated + nearest[d]);
  }
  log_peak_ = -deviation_.array().log().sum() - 0.5 * Pose::kDof * kLog2Pi;
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

// From the median.
template <class Pose>
typename Pose::Tangent NearDensity<Pose>::offset(const Pose& T) const {
  Tangent d;
  d << T.translation() - center_, (center_inverse_ * T).rotation_log();
  return d;
}

template <class Pose>
double NearDensity<Pose>::log_nearer(const Pose& z, const Tangent& residual, bool forward,
                                     double tail_dof) const {
  const Pose h = z * Pose::exp(residual);
  return log_at(forward ? h : h.inverse(), kTailDof) - log_at(forward ? z : z.inverse(), tail_dof);
}

// Over its peak.
template <class Pose>
double NearDensity<Pose>::log_at(const Pose& T, double tail_dof) const {
  const double square = offset(T).cwiseQuotient(deviation_).squaredNorm();
  return -0.5 * (tail_dof + Pose::kDof) * std::log1p(square / tail_dof);
}

// Poses near each other are rare on a large map: they are looked for, not drawn, from every
// `stride`th anchor to later places.
template <class Pose>
void NearDensity<Pose>::count_near(const Places& on, std::size_t first, std::size_t stride,
                                   Count& count) const {
  const nanoflann::SearchParams unsorted(0, 0.0F, false);
  const double reach = kReach * deviation_.template head<Pose::kDim>().maxCoeff();
  std::vector<std::pair<Eigen::Index, double>> near;
  std::size_t weighed = 0;
  for (std::size_t next = first; next < anchors_.size() && weighed <= kMostWeighed / stride;
       next += stride) {
    const std::size_t a = anchors_[next];
    count_pairs(a, count.pairs);
    const typename Pose::Translation middle = on.poses[a] * center_;
    on.tree.index->radiusSearch(middle.data(), reach * reach, near, unsorted);
    weighed += near.size();
    const Pose T_a_world = on.poses[a].inverse();
    for (const auto& [found, square] : near) {
      const auto b = static_cast<std::size_t>(found);
      if (b <= a) continue;
      const Tangent off = offset(T_a_world * on.poses[b]).cwiseQuotient(deviation_);
      count.near[class_of(a, b)] += std::exp(-0.5 * off.squaredNorm());
    }
  }
}

// Of each map other anchors. As if half a pair more were as near as loops are (the mean of a normal
// density under itself is its peak over the root of 2^d): so much is known where there is none.
template <class Pose>
std::array<double, kProposalClasses> NearDensity<Pose>::log_mean(
    const std::vector<std::vector<Pose>>& maps) const {
  Count count;
  count.near.fill(0.5 * std::exp2(-0.5 * Pose::kDof));
  count.pairs.fill(1.0);
  for (std::size_t m = 0; m < maps.size(); ++m) {
    count_near(Places(places_, maps[m]), m, maps.size(), count);
  }
  std::array<double, kProposalClasses> result;
  for (std::size_t c = 0; c < kProposalClasses; ++c) {
    result[c] = log_peak_ + std::log(count.near[c] / count.pairs[c]);
  }
  return result;
}

// As if half a pair more were near, as above.
template <class Pose>
double NearDensity<Pose>::log_mean_around(const ReducedGraph<Pose>& graph,
                                          const std::vector<Index>& loops, Index window) const {
  double near = 0.5 * std::exp2(-0.5 * Pose::kDof);
  double pairs = 1.0;
  const std::size_t every = std::max<std::size_t>(1, loops.size() / kMostAround);
  for (std::size_t k = 0; k < loops.size(); k += every) {
    const auto loop = forward_loop(graph, graph.loops[loops[k]], {});
    const auto others = poses_around(graph.odometry, loop.to, window);
    for (const Pose& one : poses_around(graph.odometry, loop.from, window)) {
      const Pose measured = one.inverse() * loop.measured.T;
      for (const Pose& other : others) {
        near += std::exp(-0.5 * offset(measured * other).cwiseQuotient(deviation_).squaredNorm());
        pairs += 1.0;
      }
    }
  }
  return log_peak_ + std::log(near / pairs);
}

template <class Pose>
std::size_t NearDensity<Pose>::class_of(std::size_t from, std::size_t to) const {
  return chain_[from] == chain_[to] ? span_class(places_[to].vertex - places_[from].vertex)
                                    : kSpanClasses;
}

// Of each class, how many later places make a pair with `anchor`.
template <class Pose>
void NearDensity<Pose>::count_pairs(std::size_t anchor,
                                    std::array<double, kProposalClasses>& pairs) const {
  const auto end =
      static_cast<double>(std::ranges::upper_bound(chain_, chain_[anchor]) - chain_.begin());
  pairs[kSpanClasses] += static_cast<double>(chain_.size()) - end;
  const double after = end - 1.0 - static_cast<double>(anchor);
  for (std::size_t c = 1; c < kSpanClasses; ++c) {
    const double least = std::ldexp(1.0, static_cast<int>(c) - 1) / stride_;
    const double most = std::max(std::ldexp(1.0, static_cast<int>(c)) / stride_, least + 1.0);
    if (least > after) break;
    pairs[c] += std::max(0.0, std::min(after + 1.0, most) - least);
  }
}

template class NearDensity<Pose2>;
template class NearDensity<Pose3>;

}  // namespace isotherm::slam::detail
