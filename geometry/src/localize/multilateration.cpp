#include "localize/multilateration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/QR>

namespace isotherm::geometry::detail {
namespace {

constexpr int kMostSubsets = 120;
constexpr std::size_t kRefined = 6;  // candidates that are worth a refinement

struct Candidate {
  Eigen::VectorXd position;
  double cost = 0.0;
};

// The one or two points at the given distances from d points: two that mirror each
// other in their hyperplane, or its nearest point where the spheres do not meet.
void intersect(const Eigen::MatrixXd& centres, const Eigen::VectorXd& distances,
               std::vector<Eigen::VectorXd>& found) {
  const auto d = centres.rows();
  const Eigen::VectorXd origin = centres.col(0);
  const Eigen::MatrixXd spokes = (centres.rightCols(d - 1).colwise() - origin);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(spokes);
  if (qr.rank() < d - 1) return;
  // Within the hyperplane: 2 spoke . x = distance0^2 - distance^2 + spoke^2.
  const Eigen::VectorXd right =
      0.5 * (spokes.colwise().squaredNorm().transpose().array() + distances[0] * distances[0] -
             distances.tail(d - 1).array().square())
                .matrix();
  const Eigen::VectorXd foot = spokes.transpose().completeOrthogonalDecomposition().solve(right);
  const Eigen::MatrixXd basis = qr.householderQ() * Eigen::MatrixXd::Identity(d, d);
  const double squared = distances[0] * distances[0] - foot.squaredNorm();
  const double height = std::sqrt(std::max(0.0, squared));
  found.push_back(origin + foot + height * basis.col(d - 1));
  if (height > 0.0) found.push_back(origin + foot - height * basis.col(d - 1));
}

// Calls use(subset) for subsets of d out of `count`, all of them or an even sample.
template <class Use>
void for_subsets(int count, int d, Use use) {
  std::vector<std::vector<int>> all;
  for (int a = 0; a < count; ++a) {
    for (int b = a + 1; b < count; ++b) {
      if (d == 2) all.push_back({a, b});
      for (int c = b + 1; d == 3 && c < count; ++c) all.push_back({a, b, c});
    }
  }
  const std::size_t stride = (all.size() + kMostSubsets - 1) / kMostSubsets;
  for (std::size_t k = 0; k < all.size(); k += std::max<std::size_t>(1, stride)) use(all[k]);
}

std::vector<Candidate> candidates(const SmallNetwork& network, double limit) {
  // Of many ranges the shortest few decide; all of them count in the cost.
  constexpr std::size_t kMostRanges = 24;
  const int d = static_cast<int>(network.positions.rows());
  auto ranges = network.ranges;
  const auto kept = std::min(kMostRanges, ranges.size());
  const std::size_t stride = (ranges.size() + kMostRanges - 1) / kMostRanges;
  for (std::size_t k = 0; k < kept; ++k)
    ranges[k] = ranges[std::min(k * stride, ranges.size() - 1)];
  ranges.resize(kept);

  std::vector<Eigen::VectorXd> points;
  Eigen::MatrixXd centres(d, d);
  Eigen::VectorXd distances(d);
  const int self = static_cast<int>(network.positions.cols()) - 1;
  for_subsets(static_cast<int>(kept), d, [&](const std::vector<int>& subset) {
    for (int i = 0; i < d; ++i) {
      const auto& range = ranges[subset[i]];
      centres.col(i) = network.positions.col(range.from == self ? range.to : range.from);
      distances[i] = range.distance;
    }
    intersect(centres, distances, points);
  });

  std::vector<Candidate> result;
  auto trial = network;
  for (const auto& point : points) {
    trial.positions.col(self) = point;
    result.push_back({point, truncated_cost(trial, limit)});
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  return result;
}

}  // namespace

std::optional<Multilateration> multilaterate(SmallNetwork network, double limit) {
  constexpr int kIterations = 12;
  const auto self = network.positions.cols() - 1;
  network.fixed = static_cast<int>(self);
  std::vector<double> sigmas;
  for (const auto& range : network.ranges) sigmas.push_back(range.sigma);
  if (sigmas.empty()) return std::nullopt;
  std::nth_element(sigmas.begin(), sigmas.begin() + sigmas.size() / 2, sigmas.end());
  // Places nearer to each other than this are one.
  const double apart = 4.0 * sigmas[sigmas.size() / 2];

  std::vector<Candidate> seeds;
  for (const auto& candidate : candidates(network, limit)) {
    const bool fresh = std::none_of(seeds.begin(), seeds.end(), [&](const Candidate& seed) {
      return (seed.position - candidate.position).norm() < apart;
    });
    if (fresh) seeds.push_back(candidate);
    if (seeds.size() == kRefined) break;
  }
  for (auto& seed : seeds) {
    network.positions.col(self) = seed.position;
    fit_robustly(network, std::sqrt(limit), kIterations);
    const double cost = truncated_cost(network, limit);
    if (cost < seed.cost) seed = {network.positions.col(self), cost};
  }
  if (seeds.empty()) return std::nullopt;
  const auto best =
      std::min_element(seeds.begin(), seeds.end(),
                       [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  Multilateration result{best->position, best->cost, std::numeric_limits<double>::infinity()};
  for (const auto& seed : seeds) {
    if ((seed.position - best->position).norm() < apart) continue;
    result.rival_cost = std::min(result.rival_cost, seed.cost);
  }
  return result;
}

}  // namespace isotherm::geometry::detail
