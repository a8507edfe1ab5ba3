#include "localize/initial_placement.hpp"

#include <algorithm>
#include <cmath>

#include "isotherm/geometry/point_alignment.hpp"
#include "isotherm/spectral/judge_edges.hpp"
#include "localize/patch.hpp"
#include "localize/robust_refine.hpp"
#include "localize/stitch.hpp"

namespace isotherm::geometry::detail {
namespace {

// Moves a part into the frame of the anchors in it. False if they leave a choice.
bool align_to_anchors(const RangeProblem& problem, const Placement& anchors, Placement& part) {
  std::vector<Index> shared;
  Placement inside = anchors;
  for (Index v = 0; v < problem.nodes; ++v) {
    inside.placed[v] = problem.is_anchor[v] && part.placed[v];
    if (inside.placed[v]) shared.push_back(v);
  }
  if (!anchors_span_space(problem, inside)) return false;
  const auto alignment =
      align_points(part.positions(Eigen::all, shared), anchors.positions(Eigen::all, shared));
  part.positions = alignment.apply(part.positions);
  return true;
}

// The parts that patches of one kind are stitched to, each refined on its own if the
// method is robust, in the frame of the anchors (without anchors, the largest only).
Placement place_by_patches(const RangeProblem& problem, const Placement& anchors,
                           const std::vector<bool>& trusted, PatchExtent extent, double gate,
                           const LocalizeOptions& options) {
  auto free = problem;
  free.is_anchor.assign(problem.nodes, false);
  Placement all = anchors;
  for (const auto& part : stitch(free, make_patches(free, trusted, extent, options))) {
    Placement own;
    own.positions.setZero(problem.dimension, problem.nodes);
    own.placed.assign(problem.nodes, false);
    for (std::size_t k = 0; k < part.nodes.size(); ++k) {
      own.placed[part.nodes[k]] = true;
      own.positions.col(part.nodes[k]) = part.positions.col(k);
    }
    if (options.method == LocalizeMethod::robust) refine_robustly(free, own, gate, options);
    if (problem.anchored() && !align_to_anchors(problem, anchors, own)) continue;
    for (const Index v : part.nodes) {
      if (all.placed[v]) continue;
      all.placed[v] = true;
      all.positions.col(v) = own.positions.col(v);
    }
    if (!problem.anchored()) break;
  }
  return all;
}

std::ptrdiff_t agreeing_ranges(const RangeProblem& problem, const Placement& placement,
                               double gate) {
  const auto within = ranges_within(problem, placement, gate);
  return std::count(within.begin(), within.end(), true);
}

}  // namespace

std::vector<bool> trusted_pairs(const RangeProblem& problem, const LocalizeOptions& options) {
  std::vector<bool> trusted(problem.pairs.size(), true);
  // Heat says nothing about a network that is one neighbourhood.
  if (!options.heat_pruning || options.method != LocalizeMethod::robust ||
      problem.nodes <= options.patch_size) {
    return trusted;
  }
  const auto judged = spectral::judge_edges(
      problem.pair_graph,
      {.chance = options.heat_chance, .threads = options.threads, .progress = options.progress});
  for (const auto& verdict : judged.verdicts) {
    trusted[verdict.edge] = verdict.verdict != spectral::Verdict::prune;
  }
  return trusted;
}

Placement place_initially(const RangeProblem& problem, const Placement& anchors,
                          const std::vector<bool>& trusted, double gate,
                          const LocalizeOptions& options) {
  // A start with which this part of the ranges agree needs no rival.
  constexpr double kGood = 0.95;
  auto small = place_by_patches(problem, anchors, trusted, PatchExtent::neighbours, gate, options);
  const auto with_small = agreeing_ranges(problem, small, gate);
  const auto all = static_cast<double>(problem.ranges.size());
  if (options.method != LocalizeMethod::robust || problem.nodes <= options.patch_size ||
      static_cast<double>(with_small) >= kGood * all) {
    return small;
  }
  auto large = place_by_patches(problem, anchors, trusted, PatchExtent::grown, gate, options);
  return agreeing_ranges(problem, large, gate) > with_small ? large : small;
}

}  // namespace isotherm::geometry::detail
