#include "isotherm/spectral/edges/multiscale_heat.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "distributed/graph/graph_state.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/spectral/heat/heat_scales.hpp"

namespace isotherm::spectral::distributed {
namespace {

constexpr double kNoThreshold = std::numeric_limits<double>::infinity();

/// What is left of the graph, and of its candidates, from scale to scale.
class Algorithm1 {
 public:
  Algorithm1(const Graph& graph, const std::vector<bool>& candidate,
             const MultiscaleHeatOptions& options, const RunContext& run)
      : graph_(graph),
        candidate_(candidate),
        options_(options),
        run_(run),
        edges_(graph.edges()),
        keep_(edges_.size(), true) {
    result_.verdicts.resize(edges_.size());
  }

  MultiscaleHeat run() && {
    const auto scales = options_.scales.empty() ? found_scales() : options_.scales;
    if (options_.konst.size() != 1 && options_.konst.size() != scales.size()) {
      throw InvalidArgument("konst", "must have one entry, or one per scale");
    }
    for (std::size_t s = 0; s < scales.size(); ++s) {
      prune_at(scales[s], options_.konst.size() == 1 ? options_.konst.front() : options_.konst[s]);
    }
    return std::move(result_);
  }

 private:
  const detail::Comm& comm() const { return graph_.state().comm(); }

  std::vector<double> found_scales() const {
    EigenOptions smallest;
    smallest.count = 1;
    smallest.null_vectors = false;
    smallest.tolerance = 1e-6;
    smallest.check_inertia = false;
    smallest.progress = run_.progress;
    const auto eigen = smallest_eigenpairs(graph_, LaplacianKind::combinatorial, smallest);
    return automatic_scales(eigen.count() > 0 ? eigen.values[0] : 0.0);
  }

  std::vector<double> distances_at(double scale, const std::vector<std::size_t>& remaining) {
    std::vector<VertexPair> pairs;
    for (const auto edge : remaining) pairs.push_back({edges_[edge].from, edges_[edge].to});
    const auto left = graph_.filtered(keep_);
    const auto heat = heat_distances(left, pairs, std::vector<double>{scale},
                                     {.tolerance = options_.tolerance, .progress = run_.progress});
    result_.unconverged += heat.unconverged;
    result_.widest_bracket = std::max(result_.widest_bracket, heat.widest);
    return heat.column(0);
  }

  /// Count, mean and sum of squared deviations over all ranks of those that `take` says.
  struct Moments {
    double count = 0.0;
    double mean = 0.0;
    double squares = 0.0;
  };
  template <class Take>
  Moments moments(const std::vector<double>& values, Take take) const {
    std::vector<double> sums = {0.0, 0.0};
    for (const double value : values) {
      if (!take(value)) continue;
      sums[0] += 1.0;
      sums[1] += value;
    }
    detail::sum_each(comm(), sums);
    Moments all{sums[0], sums[0] > 0.0 ? sums[1] / sums[0] : 0.0, 0.0};
    for (const double value : values) {
      if (take(value)) all.squares += (value - all.mean) * (value - all.mean);
    }
    all.squares = detail::sum(comm(), all.squares);
    return all;
  }

  /// By mean and deviation, as find_threshold() has it.
  HeatRound round_at(double scale, double konst, const std::vector<double>& distances) const {
    const auto all = moments(distances, [](double) { return true; });
    HeatRound round{scale, kNoThreshold, 0.0, konst, static_cast<std::int64_t>(all.count), 0};
    if (all.count == 0.0) return round;
    const double threshold = all.mean + konst * std::sqrt(all.squares / all.count);
    const auto low = moments(distances, [&](double value) { return value <= threshold; });
    const auto high = moments(distances, [&](double value) { return value > threshold; });
    if (all.squares > 0.0) round.separation = 1.0 - (low.squares + high.squares) / all.squares;
    // The mean of equal distances may be rounded to less than each.
    if (scale > 0.0) round.threshold = threshold;
    return round;
  }

  void prune_at(double scale, double konst) {
    std::vector<std::size_t> remaining;
    for (std::size_t k = 0; k < edges_.size(); ++k) {
      if (candidate_[k] && keep_[k]) remaining.push_back(k);
    }
    const auto distances = distances_at(scale, remaining);
    auto round = round_at(scale, konst, distances);
    for (std::size_t k = 0; k < remaining.size(); ++k) decide(remaining[k], distances[k], round);
    std::int64_t pruned = 0;
    for (const auto edge : remaining) pruned += keep_[edge] ? 0 : 1;
    round.pruned = detail::sum(comm(), pruned);
    result_.rounds.push_back(round);
  }

  void decide(std::size_t edge, double distance, const HeatRound& round) {
    auto& verdict = result_.verdicts[edge];
    double score = distance > 0.0 ? kNoThreshold : 0.0;
    if (round.threshold > 0.0) score = distance / round.threshold;
    verdict.pruned = distance > round.threshold;
    keep_[edge] = !verdict.pruned;
    if (verdict.pruned || verdict.stage.empty() || score > verdict.score) {
      verdict.score = score;
      verdict.stage = "t=" + format_number(round.scale);
    }
  }

  const Graph& graph_;
  const std::vector<bool>& candidate_;
  const MultiscaleHeatOptions& options_;
  const RunContext& run_;
  std::vector<FileOrderEdge> edges_;
  std::vector<bool> keep_;
  MultiscaleHeat result_;
};

}  // namespace

MultiscaleHeat multiscale_heat(const Graph& graph, const std::vector<bool>& candidate,
                               const MultiscaleHeatOptions& options, const RunContext& run) {
  const auto edge_count = graph.edges().size();
  graph.session().together([&] {
    options.validate();
    if (options.threshold != ThresholdRule::mean_sigma) {
      throw InvalidArgument("threshold", "of several ranks can only be mean-sigma");
    }
    if (candidate.size() != edge_count) {
      throw InvalidArgument("candidate", "must have one entry an edge");
    }
  });
  return Algorithm1(graph, candidate, options, run).run();
}

}  // namespace isotherm::spectral::distributed
