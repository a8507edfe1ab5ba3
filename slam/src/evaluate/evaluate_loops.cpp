#include "isotherm/slam/evaluate/evaluate_loops.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_map>
#include <utility>

#include "isotherm/base/error.hpp"

namespace isotherm::slam {
namespace {

using spectral::EdgeVerdict;
using spectral::EdgeVerdicts;
using spectral::Verdict;

std::string edge_name(std::int64_t edge) { return "edge " + std::to_string(edge); }

using VerdictByEdge = std::unordered_map<std::int64_t, const EdgeVerdict*>;

VerdictByEdge index_verdicts(const EdgeVerdicts& verdicts) {
  VerdictByEdge by_edge;
  for (const auto& verdict : verdicts) {
    if (!by_edge.emplace(verdict.edge, &verdict).second) {
      throw InvalidArgument("verdicts", edge_name(verdict.edge) + " occurs twice");
    }
  }
  return by_edge;
}

const EdgeVerdict& take_verdict(VerdictByEdge& by_edge, const EdgeLabel& label) {
  const auto found = by_edge.find(label.edge);
  if (found == by_edge.end()) {
    throw InvalidArgument("labels", edge_name(label.edge) + " has no verdict, or occurs twice");
  }
  const EdgeVerdict& verdict = *found->second;
  if (verdict.from != label.from || verdict.to != label.to) {
    throw InvalidArgument("labels", edge_name(label.edge) +
                                        " joins other vertices than in the verdicts; "
                                        "are both files from the same graph?");
  }
  if (std::isnan(verdict.score)) {
    throw InvalidArgument("verdicts", edge_name(label.edge) + " has a score that is not a number");
  }
  by_edge.erase(found);
  return verdict;
}

void tally(Verdict verdict, bool incorrect, LoopMetrics& metrics) {
  if (verdict == Verdict::prune) {
    ++(incorrect ? metrics.tp : metrics.fp);
    return;
  }
  ++(incorrect ? metrics.fn : metrics.tn);
  if (verdict == Verdict::ambiguous) ++metrics.ambiguous;
}

// The Mann-Whitney statistic, by ranks; `scores` holds (score, incorrect).
double area_under_curve(std::vector<std::pair<double, bool>> scores) {
  std::sort(scores.begin(), scores.end());
  double wins = 0.0;
  double correct_below = 0.0;
  double incorrect_total = 0.0;
  for (std::size_t first = 0; first < scores.size();) {
    std::size_t last = first;
    double correct_tied = 0.0;
    double incorrect_tied = 0.0;
    for (; last < scores.size() && scores[last].first == scores[first].first; ++last) {
      ++(scores[last].second ? incorrect_tied : correct_tied);
    }
    wins += incorrect_tied * (correct_below + 0.5 * correct_tied);
    correct_below += correct_tied;
    incorrect_total += incorrect_tied;
    first = last;
  }
  const double pairs = correct_below * incorrect_total;
  return pairs > 0.0 ? wins / pairs : std::numeric_limits<double>::quiet_NaN();
}

double ratio_or_one(std::int64_t part, std::int64_t whole) {
  return whole == 0 ? 1.0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

double LoopMetrics::precision() const { return ratio_or_one(tp, tp + fp); }

double LoopMetrics::recall() const { return ratio_or_one(tp, tp + fn); }

double LoopMetrics::f1() const {
  const double sum = precision() + recall();
  return sum > 0.0 ? 2.0 * precision() * recall() / sum : 0.0;
}

LoopMetrics evaluate_loops(const EdgeVerdicts& verdicts, const std::vector<EdgeLabel>& labels) {
  auto by_edge = index_verdicts(verdicts);
  LoopMetrics metrics;
  std::vector<std::pair<double, bool>> scores;
  for (const auto& label : labels) {
    const auto& verdict = take_verdict(by_edge, label);
    if (label.label == Label::ignore) {
      ++metrics.ignored;
      continue;
    }
    const bool incorrect = label.label == Label::incorrect;
    tally(verdict.verdict, incorrect, metrics);
    scores.emplace_back(verdict.score, incorrect);
  }
  if (!by_edge.empty()) {
    const auto first = std::min_element(by_edge.begin(), by_edge.end(),
                                        [](auto& a, auto& b) { return a.first < b.first; });
    throw InvalidArgument("labels", edge_name(first->first) + " has no label");
  }
  metrics.auc = area_under_curve(std::move(scores));
  return metrics;
}

}  // namespace isotherm::slam
