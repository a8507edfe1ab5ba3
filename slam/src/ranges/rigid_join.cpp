#include "ranges/rigid_join.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "isotherm/base/statistics.hpp"
#include "matrices/decompositions.hpp"

namespace isotherm::slam::detail {
namespace {

using std::numbers::pi;

constexpr std::size_t kMostRanges = 240;  // that are looked at: enough for any six numbers
constexpr std::size_t kScored = 60;       // of these, for a start
constexpr double kMedianOfNormal = 0.6745;

// How many turns are tried, and meetings for each of them. A turn between two of these is within
// reach of the steps that follow.
template <class Pose>
struct Tries {
  std::size_t turns = Pose::kDim == 2 ? 36 : 400;
  std::size_t meetings = Pose::kDim == 2 ? 24 : 12;
  std::size_t refined = Pose::kDim == 2 ? 24 : 48;
};

template <class Pose>
using BodyRanges = std::vector<BodyRange<Pose>>;

template <class Pose>
BodyRanges<Pose> thinned(const BodyRanges<Pose>& ranges, std::size_t most) {
  if (ranges.size() <= most) return ranges;
  BodyRanges<Pose> some;
  for (std::size_t k = 0; k < most; ++k) some.push_back(ranges[k * ranges.size() / most]);
  return some;
}

Pose2 turn_of(std::size_t k, std::size_t turns, Random&, const Pose2&) {
  return {0.0, 0.0, 2.0 * pi * static_cast<double>(k) / static_cast<double>(turns)};
}

// Uniform on all rotations (Shoemake 1992).
Pose3 turn_of(std::size_t, std::size_t, Random& random, const Pose3&) {
  const double u = random.uniform();
  const double a = random.uniform(0.0, 2.0 * pi);
  const double b = random.uniform(0.0, 2.0 * pi);
  const double s = std::sqrt(1.0 - u);
  const double c = std::sqrt(u);
  return {Eigen::Vector3d::Zero(),
          Eigen::Quaterniond(c * std::cos(b), s * std::sin(a), s * std::cos(a), c * std::sin(b))};
}

// Where circles meet; the nearest there is to that where they do not.
std::vector<Eigen::Vector2d> meetings(const std::array<Eigen::Vector2d, 2>& centres,
                                      const std::array<double, 2>& radii) {
  const Eigen::Vector2d across = centres[1] - centres[0];
  const double apart = across.norm();
  if (!(apart > 0.0)) return {};
  const Eigen::Vector2d x = across / apart;
  const double along = (radii[0] * radii[0] - radii[1] * radii[1] + apart * apart) / (2.0 * apart);
  const double height = std::sqrt(std::max(0.0, radii[0] * radii[0] - along * along));
  const Eigen::Vector2d foot = centres[0] + along * x;
  const Eigen::Vector2d aside(-height * x.y(), height * x.x());
  return {foot + aside, foot - aside};
}

std::vector<Eigen::Vector3d> meetings(const std::array<Eigen::Vector3d, 3>& centres,
                                      const std::array<double, 3>& radii) {
  const Eigen::Vector3d first = centres[1] - centres[0];
  const Eigen::Vector3d second = centres[2] - centres[0];
  const double d = first.norm();
  if (!(d > 0.0)) return {};
  const Eigen::Vector3d x = first / d;
  const double i = x.dot(second);
  const Eigen::Vector3d across = second - i * x;
  const double j = across.norm();
  if (!(j > 1e-9 * d)) return {};
  const Eigen::Vector3d y = across / j;
  const double px = (radii[0] * radii[0] - radii[1] * radii[1] + d * d) / (2.0 * d);
  const double py =
      (radii[0] * radii[0] - radii[2] * radii[2] + i * i + j * j) / (2.0 * j) - i / j * px;
  const double height = std::sqrt(std::max(0.0, radii[0] * radii[0] - px * px - py * py));
  const Eigen::Vector3d foot = centres[0] + px * x + py * y;
  return {foot + height * x.cross(y), foot - height * x.cross(y)};
}

Pose2 with_place(const Pose2& turn, const Eigen::Vector2d& place) { return {place, turn.angle()}; }
Pose3 with_place(const Pose3& turn, const Eigen::Vector3d& place) {
  return {place, turn.rotation()};
}

template <class Pose>
double join_error(const BodyRange<Pose>& range, const Pose& T_a_b) {
  return range.distance - (range.a - T_a_b * range.b).norm();
}

// `width` times the stated one.
template <class Pose>
double join_cost(const BodyRanges<Pose>& ranges, const Pose& T_a_b, double width) {
  double cost = 0.0;
  for (const auto& range : ranges) {
    const double z = join_error(range, T_a_b) / (width * range.sigma);
    cost += std::log1p(z * z) + std::log(pi * width * range.sigma);
  }
  return cost;
}

// d(T b) by the rotation part of T exp(xi).
Eigen::Matrix<double, 2, 3> place_by_tangent(const Pose2& T, const Eigen::Vector2d& b) {
  Eigen::Matrix<double, 2, 3> inner;
  inner << 1.0, 0.0, -b.y(), 0.0, 1.0, b.x();
  return T.rotation_matrix() * inner;
}
Eigen::Matrix<double, 3, 6> place_by_tangent(const Pose3& T, const Eigen::Vector3d& b) {
  Eigen::Matrix<double, 3, 6> inner;
  inner << Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero();
  inner(0, 4) = b.z();
  inner(0, 5) = -b.y();
  inner(1, 3) = -b.z();
  inner(1, 5) = b.x();
  inner(2, 3) = b.y();
  inner(2, 4) = -b.x();
  return T.rotation_matrix() * inner;
}

// One reweighted step; false if it gains nothing.
template <class Pose>
bool join_step(const BodyRanges<Pose>& ranges, bool is_point, double width, double& damping,
               JoinMode<Pose>& mode) {
  typename Pose::Matrix hessian = Pose::Matrix::Zero();
  typename Pose::Tangent gradient = Pose::Tangent::Zero();
  for (const auto& range : ranges) {
    const typename Pose::Translation apart = range.a - mode.T_a_b * range.b;
    const double length = apart.norm();
    if (!(length > 0.0)) continue;
    typename Pose::Tangent derivative =
        place_by_tangent(mode.T_a_b, range.b).transpose() * (apart / length);
    if (is_point) derivative.template tail<Pose::kDof - Pose::kDim>().setZero();
    const double sigma = width * range.sigma;
    const double error = range.distance - length;
    const double weight = 2.0 / (sigma * sigma + error * error);
    hessian += weight * derivative * derivative.transpose();
    gradient += weight * error * derivative;
  }
  if (is_point) hessian.diagonal().template tail<Pose::kDof - Pose::kDim>().setOnes();
  for (; damping < 1e6; damping *= 10.0) {
    typename Pose::Matrix damped = hessian;
    damped.diagonal() += damping * hessian.diagonal();
    damped.diagonal().array() += 1e-12 * hessian.diagonal().maxCoeff();
    const typename Pose::Tangent step = damped.llt().solve(-gradient);
    if (!step.allFinite()) continue;
    const Pose moved = mode.T_a_b * Pose::exp(step);
    const double cost = join_cost(ranges, moved, width);
    if (!(cost < mode.cost)) continue;
    const bool much = mode.cost - cost > 1e-4;
    mode = {moved, cost};
    damping = std::max(1e-9, 0.1 * damping);
    return much;
  }
  return false;
}

template <class Pose>
void settle_mode(const BodyRanges<Pose>& ranges, bool is_point, double width,
                 JoinMode<Pose>& mode) {
  constexpr int kMostSteps = 40;
  double damping = 1e-3;
  mode.cost = join_cost(ranges, mode.T_a_b, width);
  for (int i = 0; i < kMostSteps; ++i) {
    if (!join_step(ranges, is_point, width, damping, mode)) return;
  }
}

// The best starts, by a few of the ranges.
template <class Pose>
std::vector<JoinMode<Pose>> join_starts(const BodyRanges<Pose>& ranges, bool is_point,
                                        Random& random) {
  constexpr std::size_t kDim = Pose::kDim;
  Tries<Pose> tries;
  if (is_point) {
    tries.meetings *= 10;
    tries.turns = 1;
  }
  const auto scored = thinned(ranges, kScored);
  std::vector<JoinMode<Pose>> starts;
  for (std::size_t k = 0; k < tries.turns; ++k) {
    const Pose turn = is_point ? Pose() : turn_of(k, tries.turns, random, Pose());
    for (std::size_t i = 0; i < tries.meetings; ++i) {
      std::array<typename Pose::Translation, kDim> centres;
      std::array<double, kDim> radii{};
      for (std::size_t j = 0; j < kDim; ++j) {
        const auto& range = ranges[random.index(ranges.size())];
        centres[j] = range.a - turn * range.b;
        radii[j] = range.distance;
      }
      for (const auto& place : meetings(centres, radii)) {
        const Pose start = with_place(turn, place);
        starts.push_back({start, join_cost(scored, start, 1.0)});
      }
    }
  }
  const auto few = std::min(starts.size(), tries.refined);
  std::partial_sort(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(few), starts.end(),
                    [](const auto& x, const auto& y) { return x.cost < y.cost; });
  starts.resize(few);
  return starts;
}

// How far apart two modes put the points of the second body, root mean square.
template <class Pose>
double mode_distance(const BodyRanges<Pose>& ranges, const Pose& x, const Pose& y) {
  double sum = 0.0;
  for (const auto& range : ranges) sum += (x * range.b - y * range.b).squaredNorm();
  return std::sqrt(sum / static_cast<double>(ranges.size()));
}

template <class Pose>
double typical_width(const BodyRanges<Pose>& ranges, const Pose& T_a_b) {
  std::vector<double> deviations;
  for (const auto& range : ranges) {
    deviations.push_back(std::abs(join_error(range, T_a_b)) / range.sigma);
  }
  return std::max(1.0, median(std::move(deviations)) / kMedianOfNormal);
}

template <class Pose>
std::vector<JoinMode<Pose>> distinct(const BodyRanges<Pose>& ranges,
                                     std::vector<JoinMode<Pose>> modes, double width) {
  std::ranges::stable_sort(modes, {}, &JoinMode<Pose>::cost);
  double sigma = 0.0;
  for (const auto& range : ranges) sigma += width * range.sigma;
  sigma /= static_cast<double>(ranges.size());
  std::vector<JoinMode<Pose>> result;
  for (const auto& mode : modes) {
    const bool known = std::ranges::any_of(result, [&](const auto& better) {
      return mode_distance(ranges, mode.T_a_b, better.T_a_b) < 3.0 * sigma;
    });
    if (!known) result.push_back(mode);
  }
  return result;
}

}  // namespace

template <class Pose>
std::vector<JoinMode<Pose>> join_modes(const std::vector<BodyRange<Pose>>& all, bool is_point,
                                       Random& random) {
  if (all.size() < static_cast<std::size_t>(Pose::kDim)) return {};
  const auto ranges = thinned(all, kMostRanges);
  auto modes = join_starts(ranges, is_point, random);
  for (auto& mode : modes) settle_mode(ranges, is_point, 1.0, mode);
  if (modes.empty()) return modes;
  const auto& best = *std::ranges::min_element(modes, {}, &JoinMode<Pose>::cost);
  const double width = typical_width(ranges, best.T_a_b);
  for (auto& mode : modes) settle_mode(ranges, is_point, width, mode);
  return distinct(ranges, std::move(modes), width);
}

template <class Pose>
Pose mirror_image(const std::vector<BodyRange<Pose>>& ranges, const Pose& point) {
  using Translation = typename Pose::Translation;
  Translation centre = Translation::Zero();
  for (const auto& range : ranges) centre += range.a / static_cast<double>(ranges.size());
  Eigen::Matrix<double, Pose::kDim, Pose::kDim> spread;
  spread.setZero();
  for (const auto& range : ranges) spread += (range.a - centre) * (range.a - centre).transpose();
  Eigen::SelfAdjointEigenSolver<decltype(spread)> axes;
  axes.computeDirect(spread);  // in closed form: it is a start, and takes far less to compile
  const Translation normal = axes.eigenvectors().col(0);  // of the least eigenvalue
  const Translation place = point.translation();
  return with_place(point, place - 2.0 * normal.dot(place - centre) * normal);
}

template <class Pose>
double unexplained_cost(const std::vector<BodyRange<Pose>>& ranges, double longest) {
  return static_cast<double>(std::min(ranges.size(), kMostRanges)) * std::log(longest);
}

template std::vector<JoinMode<Pose2>> join_modes(const std::vector<BodyRange<Pose2>>&, bool,
                                                 Random&);
template std::vector<JoinMode<Pose3>> join_modes(const std::vector<BodyRange<Pose3>>&, bool,
                                                 Random&);
template Pose2 mirror_image(const std::vector<BodyRange<Pose2>>&, const Pose2&);
template Pose3 mirror_image(const std::vector<BodyRange<Pose3>>&, const Pose3&);
template double unexplained_cost(const std::vector<BodyRange<Pose2>>&, double);
template double unexplained_cost(const std::vector<BodyRange<Pose3>>&, double);

}  // namespace isotherm::slam::detail
