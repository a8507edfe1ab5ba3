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
    turn[d] = median_over([d](const auto& m) { return m.T.rotation_log()[d - Pose::kDim]; });
  }
  center_inverse_ = Pose::exp(turn).inverse();
  auto& [alike, near] = kernels_;
  for (int d = 0; d < Pose::kDof; ++d) {
    const double mad = median_over([&](const auto& m) { return std::abs(offset(m.T)[d]); });
    const auto count = static_cast<double>(loops.size());
    const double square =
        (count * kDeviationOfMad * mad * kDeviationOfMad * mad + step[d]) / (count + 1.0) +
        median_over([d](const auto& m) { return m.covariance(d, d); });
    alike.deviation[d] = std::sqrt(square);
    near.deviation[d] = std::sqrt(square + step[d]);
  }
  for (Kernel& kernel : kernels_) {
    kernel.log_peak = -kernel.deviation.array().log().sum() - 0.5 * Pose::kDof * kLog2Pi;
  }
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
double NearDensity<Pose>::log_nearer(const Pose& z, const Tangent& residual, bool forward) const {
  const Pose h = z * Pose::exp(residual);
  return forward ? log_at(h) - log_at(z) : log_at(h.inverse()) - log_at(z.inverse());
}

// But for a constant.
template <class Pose>
double NearDensity<Pose>::log_at(const Pose& T) const {
  const Tangent off = offset(T);
  const auto log_part = [&off](const Kernel& kernel) {
    const double square = off.cwiseQuotient(kernel.deviation).squaredNorm();
    return kernel.log_peak - 0.5 * (kTailDof + Pose::kDof) * std::log1p(square / kTailDof);
  };
  return log_sum(log_part(kernels_[0]), log_part(kernels_[1]));
}

template <class Pose>
double NearDensity<Pose>::Kernel::over_peak(const Tangent& off) const {
  return std::exp(-0.5 * off.cwiseQuotient(deviation).squaredNorm());
}

template <class Pose>
double NearDensity<Pose>::Kernel::squared_reach() const {
  const double reach = kReach * deviation.template head<Pose::kDim>().maxCoeff();
  return reach * reach;
}

// Poses near each other are rare on a large map: they are looked for, not drawn, from every
// `stride`th anchor to later places.
template <class Pose>
void NearDensity<Pose>::count_near(const Places& on, std::size_t first, std::size_t stride,
                                   std::array<Count, 2>& counts) const {
  const nanoflann::SearchParams unsorted(0, 0.0F, false);
  std::vector<std::pair<Eigen::Index, double>> near;
  std::array<std::size_t, 2> weighed{};
  for (std::size_t next = first; next < anchors_.size(); next += stride) {
    const std::size_t a = anchors_[next];
    std::array<double, 2> reach{};  // squared; none where enough have been weighed
    for (std::size_t k = 0; k < reach.size(); ++k) {
      if (weighed[k] > kMostWeighed / stride) continue;
      reach[k] = kernels_[k].squared_reach();
      count_pairs(a, counts[k].pairs);
    }
    const double farthest = std::ranges::max(reach);
    if (farthest == 0.0) break;
    const typename Pose::Translation middle = on.poses[a] * center_;
    on.tree.index->radiusSearch(middle.data(), farthest, near, unsorted);
    const Pose T_a_world = on.poses[a].inverse();
    for (const auto& [found, square] : near) {
      for (std::size_t k = 0; k < reach.size(); ++k) weighed[k] += square < reach[k];
      const auto b = static_cast<std::size_t>(found);
      if (b <= a) continue;
      const Tangent off = offset(T_a_world * on.poses[b]);
      for (std::size_t k = 0; k < reach.size(); ++k) {
        if (square < reach[k]) counts[k].near[class_of(a, b)] += kernels_[k].over_peak(off);
      }
    }
  }
}

// Of each map other anchors. As if half a pair more were as near as loops are (the mean of a normal
// density under itself is its peak over the root of 2^d): so much is known where there is none.
template <class Pose>
std::array<double, kProposalClasses> NearDensity<Pose>::log_mean(
    const std::vector<std::vector<Pose>>& maps) const {
  std::array<Count, 2> counts;
  for (auto& [near, pairs] : counts) {
    near.fill(0.5 * std::exp2(-0.5 * Pose::kDof));
    pairs.fill(1.0);
  }
  for (std::size_t m = 0; m < maps.size(); ++m) {
    const Places on(places_, maps[m]);
    count_near(on, m, maps.size(), counts);
  }
  std::array<double, kProposalClasses> result;
  for (std::size_t c = 0; c < kProposalClasses; ++c) {
    const auto log_part = [&](std::size_t k) {
      return kernels_[k].log_peak + std::log(counts[k].near[c] / counts[k].pairs[c]);
    };
    result[c] = log_sum(log_part(0), log_part(1)) - std::log(2.0);
  }
  return result;
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
