#include "edges/odds/two_groups.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace isotherm::spectral::detail {
namespace {

std::vector<double> sorted_copy(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

double count_from(const std::vector<double>& sorted, double value) {
  return static_cast<double>(sorted.end() - std::lower_bound(sorted.begin(), sorted.end(), value));
}

/// Above a quantile of the null scores there are few true ones: what is found there says how
/// many false ones there are: the least of several quantiles, each with half a standard deviation
/// of its count on top; with two of them above high quantiles, where few are found. None if more
/// are found above one than if all edges were false.
double estimate_false(const std::vector<double>& scores, const std::vector<double>& null_scores,
                      double most_false) {
  constexpr std::array kQuantiles = {0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95};
  constexpr double kHigh = 0.65;
  const auto null_count = static_cast<double>(null_scores.size());
  auto least = static_cast<double>(scores.size());
  for (const double quantile : kQuantiles) {
    const double from = null_scores[static_cast<std::size_t>(quantile * (null_count - 1.0))];
    const double found = count_from(scores, from);
    const double margin = quantile > kHigh ? 2.0 * std::sqrt(found + 1.0) : 0.5 * std::sqrt(found);
    // True edges score less than pairs: where edges do not, the score says something else.
    const double of_pairs = count_from(null_scores, from) / null_count;
    if (found - 2.0 * std::sqrt(found + 1.0) > of_pairs * static_cast<double>(scores.size())) {
      return 0.0;
    }
    least = std::min(least, (found + margin) * null_count / count_from(null_scores, from));
  }
  return least > most_false * static_cast<double>(scores.size()) ? 0.0 : least;
}

/// Scores that share one value of the regression.
struct Block {
  double last = 0.0;    // largest score in it
  double scores = 0.0;  // how many
  double nulls = 0.0;   // expected number of false ones among them

  bool suspicious_as(const Block& other) const {
    return nulls * other.scores >= other.nulls * scores;
  }
};

/// Appends a block of higher scores, and pools until the false share rises strictly with the score.
void pool(Block block, std::vector<Block>& blocks) {
  while (!blocks.empty() && blocks.back().suspicious_as(block)) {
    block.scores += blocks.back().scores;
    block.nulls += blocks.back().nulls;
    blocks.pop_back();
  }
  blocks.push_back(block);
}

std::vector<Block> regress(const std::vector<double>& scores,
                           const std::vector<double>& null_scores, double false_count) {
  const double weight = false_count / static_cast<double>(null_scores.size());
  std::vector<Block> blocks;
  std::size_t s = 0, f = 0;
  while (s < scores.size() || f < null_scores.size()) {
    const bool null_first =
        s == scores.size() || (f < null_scores.size() && null_scores[f] < scores[s]);
    Block block{null_first ? null_scores[f] : scores[s], 0.0, 0.0};
    for (; s < scores.size() && scores[s] == block.last; ++s) block.scores += 1.0;
    for (; f < null_scores.size() && null_scores[f] == block.last; ++f) block.nulls += weight;
    pool(block, blocks);
  }
  return blocks;
}

std::vector<double> truth_of(std::span<const double> scores, const std::vector<Block>& blocks) {
  std::vector<double> truth;
  for (const double score : scores) {
    const auto block = std::lower_bound(blocks.begin(), blocks.end(), score,
                                        [](const Block& b, double x) { return b.last < x; });
    truth.push_back(std::max(0.0, 1.0 - block->nulls / block->scores));
  }
  return truth;
}

}  // namespace

TwoGroups separate_groups(std::span<const double> scores, std::span<const double> null_scores,
                          double most_false) {
  TwoGroups groups;
  groups.truth.assign(scores.size(), 1.0);
  if (scores.empty() || null_scores.empty()) return groups;
  const auto sorted = sorted_copy(scores);
  const auto sorted_null = sorted_copy(null_scores);
  groups.false_count = estimate_false(sorted, sorted_null, most_false);
  if (groups.false_count == 0.0) return groups;
  groups.truth = truth_of(scores, regress(sorted, sorted_null, groups.false_count));
  return groups;
}

TwoGroups calibrate(std::span<const double> scores, std::span<const double> truth) {
  TwoGroups groups;
  auto order = by_suspicion(scores);
  std::ranges::reverse(order);
  std::vector<Block> blocks;
  for (std::size_t k = 0; k < order.size();) {
    Block block{scores[order[k]], 0.0, 0.0};
    for (; k < order.size() && scores[order[k]] == block.last; ++k) {
      block.scores += 1.0;
      block.nulls += 1.0 - truth[order[k]];
    }
    groups.false_count += block.nulls;
    pool(block, blocks);
  }
  groups.truth = truth_of(scores, blocks);
  return groups;
}

std::vector<Index> by_suspicion(std::span<const double> scores) {
  std::vector<Index> order(scores.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return scores[a] > scores[b]; });
  return order;
}

double rejection_threshold(std::span<const double> scores, const TwoGroups& groups, double chance) {
  const auto order = by_suspicion(scores);
  // The probability falls with the score, so that a score stands for it.
  const auto most = std::min(static_cast<std::size_t>(std::ceil(groups.false_count)), order.size());
  std::size_t rejected = 0;
  while (rejected < most && groups.truth[order[rejected]] < chance) ++rejected;
  if (rejected == 0) return std::numeric_limits<double>::infinity();
  return rejected < order.size() ? scores[order[rejected]] : 0.0;
}

double threshold_of_best_f(std::span<const double> scores, const TwoGroups& groups, double chance) {
  const auto order = by_suspicion(scores);
  double threshold = std::numeric_limits<double>::infinity(), best = 0.0, found = 0.0;
  for (std::size_t k = 0; k < order.size() && groups.truth[order[k]] < chance; ++k) {
    found += 1.0 - groups.truth[order[k]];
    const bool last = k + 1 == order.size();
    if (!last && scores[order[k + 1]] == scores[order[k]]) continue;
    const double f = 2.0 * found / (static_cast<double>(k + 1) + groups.false_count);
    if (f <= best) continue;
    best = f;
    threshold = last ? -std::numeric_limits<double>::infinity() : scores[order[k + 1]];
  }
  return threshold;
}

}  // namespace isotherm::spectral::detail
