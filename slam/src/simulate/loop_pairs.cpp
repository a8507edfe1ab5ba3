#include "simulate/loop_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>

namespace isotherm::slam::detail {
namespace {

// A loop closure joins poses at least this many steps apart.
constexpr Index kLoopGap = 10;

// Places by cubic cells with sides of the search radius, so that everything close
// to a place lies in the 27 cells around it.
class PlaceGrid {
 public:
  PlaceGrid(const std::vector<Eigen::Vector3d>& places, double radius)
      : places_(places), radius_(radius) {
    for (std::size_t k = 0; k < places.size(); ++k) {
      cells_[key(cell(places[k]))].push_back(static_cast<Index>(k));
    }
  }

  // Places that `later` may close a loop with, ascending.
  std::vector<Index> partners(Index later) const {
    std::vector<Index> close;
    const Eigen::Array3i middle = cell(places_[later]);
    for (int k = 0; k < 27; ++k) {
      const Eigen::Array3i offset(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      const auto found = cells_.find(key(middle + offset));
      if (found == cells_.end()) continue;
      for (const Index earlier : found->second) {
        if (earlier + kLoopGap > later) break;  // ascending
        if (is_close(earlier, later)) close.push_back(earlier);
      }
    }
    std::sort(close.begin(), close.end());
    // Two cells may share a key in a world of more than 2^21 cells a side.
    close.erase(std::unique(close.begin(), close.end()), close.end());
    return close;
  }

 private:
  Eigen::Array3i cell(const Eigen::Vector3d& place) const {
    return (place.array() / radius_).floor().cast<int>();
  }

  static std::uint64_t key(const Eigen::Array3i& cell) {
    constexpr std::uint64_t kMask = (1u << 21) - 1;
    const auto part = [&](int axis) { return static_cast<std::uint64_t>(cell[axis]) & kMask; };
    return part(0) << 42 | part(1) << 21 | part(2);
  }

  bool is_close(Index a, Index b) const {
    // Rounding must not decide about places on a lattice.
    return (places_[a] - places_[b]).norm() <= radius_ * (1.0 + 1e-9);
  }

  const std::vector<Eigen::Vector3d>& places_;
  double radius_;
  std::unordered_map<std::uint64_t, std::vector<Index>> cells_;
};

}  // namespace

std::vector<LoopPair> loop_pairs(const std::vector<Eigen::Vector3d>& places, std::int64_t wanted,
                                 double radius, Random& random) {
  const PlaceGrid grid(places, radius);
  std::vector<LoopPair> pairs;
  std::unordered_set<std::uint64_t> taken;
  // Draws that hit a place without partners, or a pair twice, are thrown away; the
  // bound stops the search where the path offers too few pairs.
  const std::int64_t most_draws = 50 * wanted + 1000;
  for (std::int64_t draw = 0; draw < most_draws && static_cast<std::int64_t>(pairs.size()) < wanted;
       ++draw) {
    const auto later = static_cast<Index>(random.index(places.size()));
    const auto close = grid.partners(later);
    if (close.empty()) continue;
    const Index earlier = close[random.index(close.size())];
    const std::uint64_t key =
        static_cast<std::uint64_t>(earlier) << 32 | static_cast<std::uint64_t>(later);
    if (taken.insert(key).second) pairs.push_back({earlier, later});
  }
  std::sort(pairs.begin(), pairs.end(), [](const LoopPair& a, const LoopPair& b) {
    return a.to != b.to ? a.to < b.to : a.from < b.from;
  });
  return pairs;
}

}  // namespace isotherm::slam::detail
