#include "isotherm/slam/prune/heat_prune.hpp"

#include <cmath>
#include <limits>

#include "graph/candidate_verdicts.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"

namespace isotherm::slam {
namespace {

using spectral::EdgeVerdicts;
using spectral::Threshold;
using spectral::ThresholdRule;
using spectral::Verdict;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double konst_at(const HeatPruneOptions& options, std::size_t scale) {
  return options.konst.size() == 1 ? options.konst.front() : options.konst[scale];
}

// The state of Algorithm 1 between two scales.
template <class Pose>
class Pruner {
 public:
  Pruner(const PoseGraph<Pose>& graph, const EdgeRoles& roles, const HeatPruneOptions& options,
         const RunContext& run)
      : roles_(roles),
        options_(options),
        run_(run),
        induced_(induce(graph, roles, options.induction, run)) {
    keep_.assign(induced_.graph.edge_count(), true);
    result_.verdicts = candidate_verdicts(graph, roles);
    for (std::size_t c = 0; c < roles_.candidates.size(); ++c) {
      const Index edge = edge_of(c);
      result_.weights.push_back(edge < 0 ? 0.0 : induced_.graph.edge(edge).weight);
      result_.verdicts[c].threshold = 1.0;
      if (edge < 0) decide(c, std::numeric_limits<double>::infinity(), "induction");
    }
  }

  HeatPruneResult run() && {
    for (std::size_t s = 0; s < options_.scales.size(); ++s) prune_at(s);
    return std::move(result_);
  }

 private:
  Index edge_of(std::size_t candidate) const {
    return induced_.constraint_edge[roles_.candidates[candidate]];
  }

  bool remains(std::size_t candidate) const {
    return result_.verdicts[candidate].verdict == Verdict::keep;
  }

  void decide(std::size_t candidate, double score, const std::string& stage) {
    auto& verdict = result_.verdicts[candidate];
    verdict.verdict = Verdict::prune;
    verdict.score = score;
    verdict.stage = stage;
    if (edge_of(candidate) >= 0) keep_[edge_of(candidate)] = false;
  }

  std::vector<std::size_t> remaining_candidates() const {
    std::vector<std::size_t> remaining;
    for (std::size_t c = 0; c < roles_.candidates.size(); ++c) {
      if (remains(c)) remaining.push_back(c);
    }
    return remaining;
  }

  std::vector<double> distances_at(double scale, const std::vector<std::size_t>& remaining) {
    std::vector<spectral::VertexPair> pairs;
    for (const std::size_t c : remaining) {
      const auto& edge = induced_.graph.edge(edge_of(c));
      pairs.push_back({edge.from, edge.to});
    }
    const auto graph = spectral::filter_edges(induced_.graph, keep_);
    const auto heat = spectral::heat_distances(
        graph, pairs, std::vector<double>{scale},
        {.tolerance = options_.tolerance, .threads = run_.threads, .progress = run_.progress});
    result_.unconverged += heat.unconverged;
    result_.widest_bracket = std::max(result_.widest_bracket, heat.widest);
    return heat.column(0);
  }

  Threshold threshold_at(std::size_t scale, const std::vector<double>& distances) const {
    auto threshold = spectral::find_threshold(
        distances, {.rule = options_.threshold, .konst = konst_at(options_, scale)});
    const bool adapts = options_.threshold != ThresholdRule::mean_sigma;
    if (adapts && threshold.separation < options_.min_separation) {
      threshold.value = std::numeric_limits<double>::infinity();
    }
    return threshold;
  }

  void prune_at(std::size_t s) {
    const double scale = options_.scales[s];
    const auto remaining = remaining_candidates();
    const auto distances = distances_at(scale, remaining);
    const auto threshold = threshold_at(s, distances);
    const std::string stage = "t=" + format_number(scale);

    HeatRound round{scale,
                    threshold.value,
                    threshold.separation,
                    0.0,
                    static_cast<std::int64_t>(remaining.size()),
                    0};
    if (options_.threshold == ThresholdRule::mean_sigma) round.konst = konst_at(options_, s);
    std::vector<double> all(roles_.candidates.size(), kNaN);
    for (std::size_t k = 0; k < remaining.size(); ++k) {
      const std::size_t c = remaining[k];
      all[c] = distances[k];
      const double score = relative_to(distances[k], threshold.value);
      if (distances[k] > threshold.value) {
        decide(c, score, stage);
        ++round.pruned;
      } else if (result_.verdicts[c].stage.empty() || score > result_.verdicts[c].score) {
        result_.verdicts[c].score = score;
        result_.verdicts[c].stage = stage;
      }
    }
    result_.rounds.push_back(round);
    result_.distances.push_back(std::move(all));
  }

  static double relative_to(double distance, double threshold) {
    if (threshold > 0.0) return distance / threshold;
    return distance > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
  }

  const EdgeRoles& roles_;
  const HeatPruneOptions& options_;
  const RunContext& run_;
  InducedGraph induced_;
  std::vector<bool> keep_;  // per edge of the induced graph
  HeatPruneResult result_;
};

}  // namespace

void HeatPruneOptions::validate() const {
  require_fields_in_range(*this);
  for (std::size_t k = 1; k < scales.size(); ++k) {
    if (scales[k] >= scales[k - 1]) throw InvalidArgument("scales", "must be descending");
  }
  if (konst.size() != 1 && konst.size() != scales.size()) {
    throw InvalidArgument("konst", "must have one entry, or one per scale");
  }
  induction.validate();
}

HeatPruneOptions datta2016() {
  HeatPruneOptions options;
  options.threshold = ThresholdRule::mean_sigma;
  options.induction.curve.comparison = CurveComparison::lap_line;
  return options;
}

template <class Pose>
HeatPruneResult heat_prune(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                           const HeatPruneOptions& options, const RunContext& run) {
  options.validate();
  return Pruner<Pose>(graph, roles, options, run).run();
}

template HeatPruneResult heat_prune(const PoseGraph<Pose2>&, const EdgeRoles&,
                                    const HeatPruneOptions&, const RunContext&);
template HeatPruneResult heat_prune(const PoseGraph<Pose3>&, const EdgeRoles&,
                                    const HeatPruneOptions&, const RunContext&);

}  // namespace isotherm::slam
