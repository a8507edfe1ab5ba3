#include "simulate/lattice_walk.hpp"

#include <array>

namespace isotherm::slam::detail {
namespace {

// Quarter turns to the left and right (about the third axis), down and up (about
// the second).
std::array<Eigen::Matrix3i, 4> quarter_turns() {
  std::array<Eigen::Matrix3i, 4> turns;
  turns[0] << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  turns[1] = turns[0].transpose();
  turns[2] << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  turns[3] = turns[2].transpose();
  return turns;
}

Eigen::Vector3i ahead(const Eigen::Vector3i& cell, const Eigen::Matrix3i& frame) {
  return cell + frame.col(0);
}

}  // namespace

std::vector<LatticeStop> lattice_walk(std::int64_t stops, const LatticeStreets& streets,
                                      Random& random) {
  static const auto kTurns = quarter_turns();
  const std::uint64_t turns = streets.up_and_down ? 4 : 2;
  const int block = static_cast<int>(streets.block);

  std::vector<LatticeStop> walk;
  walk.reserve(static_cast<std::size_t>(stops));
  LatticeStop stop{Eigen::Vector3i::Zero(), Eigen::Matrix3i::Identity()};
  for (std::int64_t k = 0; k < stops; ++k) {
    if (k > 0) stop.cell = ahead(stop.cell, stop.frame);
    const bool crossing = stop.cell.unaryExpr([&](int x) { return x % block; }).isZero();
    if (crossing) {
      Eigen::Matrix3i frame;
      do {
        const auto choice = random.index(2 * turns);
        frame = stop.frame;
        if (choice >= turns) frame *= kTurns[choice - turns];
      } while (ahead(stop.cell, frame).cwiseAbs().maxCoeff() > streets.limit);
      stop.frame = frame;
    }
    walk.push_back(stop);
  }
  return walk;
}

}  // namespace isotherm::slam::detail
