#include "localize/fold/loose_parts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <unordered_map>
#include <utility>

#include <Eigen/Geometry>

#include "localize/constants.hpp"
#include "localize/evidence/star.hpp"

namespace isotherm::network::detail {
namespace {

using Nodes = std::vector<Index>;

constexpr std::size_t kLeastRigid = 3;  // nodes of a part

// Pairs that fit a place in the plane, at any: one more is needed.
constexpr std::size_t kMotions = 3;

// Grows rigid parts of a map, one after the other.
class LooseSearch {
 public:
  LooseSearch(const MapTask& task, const Placement& placement)
      : problem_(task.problem),
        most_(largest_part(problem_, placement)),
        seen_(problem_.nodes, false) {
    for (std::size_t p = 0; p < problem_.pairs.size(); ++p) {
      const auto& pair = problem_.pairs[p];
      const bool tells = task.trusted[p] && is_placed(placement, pair);
      fits_.push_back(tells && task.fits(placement, pair));
      if (tells && !fits_.back()) unfit_.push_back(pair);
    }
  }

  std::vector<Nodes> parts() {
    std::vector<Nodes> found;
    for (const auto& pair : unfit_) {
      for (const Index end : {pair.from, pair.to}) {
        if (seen_[end]) continue;
        if (auto part = part_with(end)) found.push_back(std::move(*part));
      }
    }
    return found;
  }

 private:
  // Nothing where it belongs to what is large, or to nothing rigid.
  std::optional<Nodes> part_with(Index node) {
    for (const auto& [vertex, edge] : problem_.pair_graph.neighbours(node)) {
      if (!fits_[edge]) continue;
      auto part = grown({node, vertex});
      if (part.size() < kLeastRigid) continue;
      for (const Index v : part) seen_[v] = true;
      if (!turns(part)) return std::nullopt;
      std::sort(part.begin(), part.end());
      return part;
    }
    return std::nullopt;
  }

  bool turns(const Nodes& part) const {
    return static_cast<Index>(part.size()) <= most_ &&
           std::ranges::none_of(part, [&](Index v) { return problem_.is_anchor[v]; });
  }

  // As long as it turns.
  Nodes grown(Nodes part) const {
    std::unordered_map<Index, int> ties;  // two: in the part
    for (const Index v : part) ties[v] = 2;
    for (std::size_t k = 0; k < part.size() && turns(part); ++k) {
      for (const auto& [vertex, edge] : problem_.pair_graph.neighbours(part[k])) {
        if (!fits_[edge]) continue;
        int& count = ties[vertex];
        if (count < 2 && ++count == 2) part.push_back(vertex);
      }
    }
    return part;
  }

  const RangeProblem& problem_;
  Index most_;                    // nodes of a part
  std::vector<bool> fits_;        // pairs
  std::vector<RangePair> unfit_;  // the trusted ones that do not, of placed nodes
  std::vector<bool> seen_;        // nodes of parts that were grown
};

// A part beside what it is tied to.
class LoosePart {
 public:
  LoosePart(const MapTask& task, const Evidence& evidence, const Placement& placement, Nodes part)
      : placement_(placement), part_(std::move(part)) {
    middle_ = placement.positions(Eigen::all, part_).rowwise().mean();
    for (const Index v : part_) {
      const Eigen::Vector2d from_middle = placement.positions.col(v) - middle_;
      task.visit_neighbours(placement, v, [&](Index vertex, Index edge) {
        if (std::ranges::binary_search(part_, vertex)) return;
        const auto& pair = task.problem.pairs[edge];
        ties_.push_back({arm_of(pair, evidence, placement.positions.col(vertex)), from_middle});
      });
    }
  }

  bool is_tied() const { return ties_.size() > kMotions; }

  // Where it fits best, mirrored or not.
  std::optional<PartMove> best(bool mirrored) const {
    constexpr int kTurns = 360;
    std::optional<PartMove> found;
    double least = 0.0;
    for (int k = 0; k < kTurns; ++k) {
      const Eigen::Matrix2d turn = turned(2.0 * std::numbers::pi * k / kTurns, mirrored);
      const auto place = multilaterate(star(turn, std::numbers::pi / kTurns));
      if (!place || (found && place->cost >= least)) continue;
      least = place->cost;
      found = PartMove{part_, placement_.positions(Eigen::all, part_)};
      for (auto p : found->positions.colwise()) p = (place->position + turn * (p - middle_)).eval();
    }
    return found;
  }

 private:
  struct Tie {
    Arm arm;                      // to the other node
    Eigen::Vector2d from_middle;  // that of the part's
  };

  static Eigen::Matrix2d turned(double angle, bool mirrored) {
    Eigen::Matrix2d turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
    if (mirrored) turn.col(1) *= -1.0;
    return turn;
  }

  // What its ties say of its middle, being turned so, or by a little more or less.
  Star star(const Eigen::Matrix2d& turn, double little) const {
    Star result;
    for (const Tie& tie : ties_) {
      auto& arm = result.arms.emplace_back(tie.arm);
      arm.end -= turn * tie.from_middle;
      arm.sigma = std::hypot(arm.sigma, little * tie.from_middle.norm());
    }
    return result;
  }

  const Placement& placement_;
  Nodes part_;
  Eigen::Vector2d middle_;
  std::vector<Tie> ties_;
};

}  // namespace

std::vector<PartMove> loose_parts(const MapTask& task, const Evidence& evidence,
                                  const Placement& placement) {
  if (task.problem.dimension != 2) return {};
  std::vector<LoosePart> parts;
  for (auto& part : LooseSearch(task, placement).parts()) {
    LoosePart loose(task, evidence, placement, std::move(part));
    if (loose.is_tied()) parts.push_back(std::move(loose));
  }
  std::vector<std::optional<PartMove>> found(2 * parts.size());
  task.in_parallel(found.size(), "parts",
                   [&](std::int64_t k) { found[k] = parts[k / 2].best(k % 2 == 1); });
  std::vector<PartMove> moves;
  for (auto& move : found) {
    if (move) moves.push_back(std::move(*move));
  }
  return moves;
}

}  // namespace isotherm::network::detail
