#include "graph/doubtful_measurements.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <string>

#include <Eigen/Core>

#include "isotherm/base/words.hpp"
#include "isotherm/slam/graph/information.hpp"
#include "isotherm/slam/graph/odometry.hpp"
#include "matrices/decompositions.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr std::size_t kMostLoops = 300;  // those over the shortest stretches of odometry
constexpr int kFewestFits = 5;
// So many times more loops must speak for another reading, by which most of all must fit:
// false loops fit one reading or another by chance.
constexpr int kClearly = 4;
// Standard deviations within which a loop counts as fitting: files are often optimistic.
constexpr double kWidth = 6.0;

// How measurements may have been meant.
template <class Pose>
struct Reading {
  const char* kind;
  const char* saying;
  std::function<Pose(const Pose&)> of_odometry;
  std::function<Pose(const Pose&)> of_loops;
};

Pose2 from_degrees(const Pose2& pose) {
  return {pose.translation(), pose.angle() * std::numbers::pi / 180.0};
}

template <class Pose>
std::vector<Reading<Pose>> readings() {
  const auto as_stated = [](const Pose& pose) { return pose; };
  const auto inverted = [](const Pose& pose) { return pose.inverse(); };
  std::vector<Reading<Pose>> all = {
      {"swapped ends", "with the ends of loops swapped", as_stated, inverted},
      {"swapped ends", "with the ends of odometry swapped", inverted, as_stated},
      {"swapped ends", "with the ends of all edges swapped", inverted, inverted}};
  if constexpr (Pose::kDim == 2) {
    all.push_back({"angles in degrees", "with angles in degrees", from_degrees, from_degrees});
  }
  return all;
}

template <class Pose>
class Fits {
 public:
  Fits(const PoseGraph<Pose>& graph, const EdgeRoles& roles) : graph_(graph), roles_(roles) {
    const OdometryChain<Pose> chain(graph, roles);
    for (const Index k : roles.candidates) {
      const auto& loop = graph.constraints[k];
      if (loop.from == loop.to || chain.chain(loop.from) != chain.chain(loop.to)) continue;
      if (!loop.information.isZero(0.0)) loops_.push_back(k);
    }
    const auto span = [&](Index k) {
      return std::abs(graph.constraints[k].from - graph.constraints[k].to);
    };
    std::stable_sort(loops_.begin(), loops_.end(),
                     [&](Index a, Index b) { return span(a) < span(b); });
    if (loops_.size() > kMostLoops) loops_.resize(kMostLoops);
    stated_ = fitting(chain, [](const Pose& pose) { return pose; });
  }

  std::size_t tested() const { return loops_.size(); }
  std::size_t as_stated() const { return static_cast<std::size_t>(stated_.count()); }

  struct Balance {
    int stated = 0;  // loops that fit only as they are
    int read = 0;    // only if they are read so
    int all = 0;     // if they are read so
  };
  Balance with(const Reading<Pose>& reading) const {
    PoseGraph<Pose> other = graph_;
    for (const Index k : roles_.odometry) {
      other.constraints[k].T_from_to = reading.of_odometry(graph_.constraints[k].T_from_to);
    }
    const Flags read = fitting(OdometryChain<Pose>(other, roles_), reading.of_loops);
    return {static_cast<int>((stated_ && !read).count()),
            static_cast<int>((read && !stated_).count()), static_cast<int>(read.count())};
  }

 private:
  using Flags = Eigen::Array<bool, Eigen::Dynamic, 1>;

  Flags fitting(const OdometryChain<Pose>& chain,
                const std::function<Pose(const Pose&)>& read_loop) const {
    Flags fits(static_cast<Eigen::Index>(loops_.size()));
    for (std::size_t i = 0; i < loops_.size(); ++i) {
      const auto& loop = graph_.constraints[loops_[i]];
      const auto predicted = chain.relative(loop.from, loop.to);
      const typename Pose::Tangent error = read_loop(loop.T_from_to).between(predicted.T).log();
      const typename Pose::Matrix covariance =
          predicted.covariance + covariance_from_information<Pose::kDof>(loop.information);
      const double chi2 = error.dot(covariance.llt().solve(error));
      fits[static_cast<Eigen::Index>(i)] = chi2 < kWidth * kWidth * Pose::kDof;
    }
    return fits;
  }

  const PoseGraph<Pose>& graph_;
  const EdgeRoles& roles_;
  std::vector<Index> loops_;
  Flags stated_;
};

}  // namespace

template <class Pose>
std::vector<Doubt> doubt_measurements(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  if (roles.odometry.empty() || roles.candidates.empty()) return {};
  const Fits<Pose> fits(graph, roles);
  if (10 * fits.as_stated() >= 9 * fits.tested()) return {};
  Doubt best;
  int most = kFewestFits;
  for (const auto& reading : readings<Pose>()) {
    const auto [stated, read, all] = fits.with(reading);
    const bool most_fit = 3 * static_cast<std::size_t>(all) >= 2 * fits.tested();
    if (read < most || read <= kClearly * stated || !most_fit) continue;
    most = read + 1;
    best = {reading.kind, std::to_string(read) + " of " + counted(fits.tested(), "loop") +
                              " over short stretches fit odometry only " + reading.saying + ", " +
                              std::to_string(stated) + " only as they are"};
  }
  if (best.kind.empty()) return {};
  return {best};
}

template std::vector<Doubt> doubt_measurements(const PoseGraph<Pose2>&, const EdgeRoles&);
template std::vector<Doubt> doubt_measurements(const PoseGraph<Pose3>&, const EdgeRoles&);

}  // namespace isotherm::slam::detail
