#include "isotherm/slam/evaluate/evaluate_online.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <unordered_map>

#include "isotherm/base/error.hpp"

namespace isotherm::slam {
namespace {

using spectral::Verdict;

std::unordered_map<std::int64_t, Label> labels_by_edge(const std::vector<EdgeLabel>& labels) {
  std::unordered_map<std::int64_t, Label> by_edge;
  for (const auto& label : labels) {
    if (!by_edge.emplace(label.edge, label.label).second) {
      throw InvalidArgument("labels", "edge " + std::to_string(label.edge) + " occurs twice");
    }
  }
  return by_edge;
}

// What became of one loop so far.
struct Course {
  bool is_true = false;
  Verdict verdict = Verdict::ambiguous;
  std::int64_t came = 0;     // poses at its first verdict
  std::int64_t settled = 0;  // at its last
};

void count(const Course& loop, std::int64_t by, OnlineStep& step) {
  const bool kept = loop.verdict == Verdict::keep;
  if (kept) (loop.is_true ? step.kept_true : step.kept_false) += by;
  if (!kept && loop.is_true) step.missed += by;
}

// Each step holds until the next one.
void take_means(std::int64_t edges, OnlineMetrics& metrics) {
  double precision = 0.0;
  double recall = 0.0;
  double time = 0.0;
  for (auto step = metrics.steps.begin(); step != metrics.steps.end(); ++step) {
    const auto next = std::next(step);
    const std::int64_t until = next == metrics.steps.end() ? edges : next->at;
    const auto held = static_cast<double>(std::max<std::int64_t>(until - step->at, 0));
    precision += held * step->precision();
    recall += held * step->recall();
    time += held;
  }
  if (time == 0.0) return;
  metrics.mean_precision = precision / time;
  metrics.mean_recall = recall / time;
}

void take_ends(const std::map<std::int64_t, Course>& loops, OnlineMetrics& metrics) {
  for (const auto& [edge, loop] : loops) {
    if (loop.verdict == Verdict::ambiguous) {
      ++metrics.undecided;
    } else if ((loop.verdict == Verdict::keep) == loop.is_true) {
      ++metrics.right;
      metrics.delays.push_back(loop.settled - loop.came);
    } else {
      ++metrics.wrong;
    }
  }
  std::ranges::sort(metrics.delays);
}

double share(std::int64_t part, std::int64_t rest) {
  const std::int64_t whole = part + rest;
  return whole == 0 ? 1.0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

double OnlineStep::precision() const { return share(kept_true, kept_false); }

double OnlineStep::recall() const { return share(kept_true, missed); }

std::vector<TimedVerdict> decided_at_even_odds(std::vector<TimedVerdict> verdicts) {
  for (auto& told : verdicts) {
    if (told.probability) told.verdict = *told.probability > 0.5 ? Verdict::keep : Verdict::prune;
  }
  return verdicts;
}

OnlineMetrics evaluate_online(const std::vector<TimedVerdict>& verdicts,
                              const std::vector<EdgeLabel>& labels, std::int64_t edges) {
  const auto label_of = labels_by_edge(labels);
  OnlineMetrics metrics;
  std::map<std::int64_t, Course> loops;
  std::set<std::int64_t> ignored;
  std::int64_t last = 0;
  for (const auto& told : verdicts) {
    if (told.at < last) throw InvalidArgument("verdicts", "must stand in order of time");
    last = told.at;
    const auto label = label_of.find(told.edge);
    if (label == label_of.end() || label->second == Label::ignore) {
      ignored.insert(told.edge);
      continue;
    }
    const bool is_true = label->second == Label::correct;
    auto [at, first] = loops.try_emplace(told.edge, Course{is_true, told.verdict, told.poses, 0});
    OnlineStep step = metrics.steps.empty() ? OnlineStep{} : metrics.steps.back();
    if (!first) count(at->second, -1, step);
    at->second.verdict = told.verdict;
    at->second.settled = told.poses;
    count(at->second, 1, step);
    step.at = told.at;
    step.poses = told.poses;
    if (!metrics.steps.empty() && metrics.steps.back().at == told.at) metrics.steps.pop_back();
    metrics.steps.push_back(step);
  }
  metrics.ignored = static_cast<std::int64_t>(ignored.size());
  take_means(edges, metrics);
  take_ends(loops, metrics);
  return metrics;
}

}  // namespace isotherm::slam
