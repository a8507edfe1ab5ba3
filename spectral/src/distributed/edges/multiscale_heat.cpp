#include "isotherm/spectral/edges/multiscale_heat.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "distributed/graph/graph_state.hpp"
#include "edges/algorithm1.hpp"
#include "isotherm/spectral/heat/heat_scales.hpp"

namespace isotherm::spectral::distributed {
namespace {

/// This rank's part of the graph, without edges that are pruned, and of its candidates.
class OneRank {
 public:
  OneRank(const Graph& graph, const std::vector<std::size_t>& candidates, double tolerance,
          const RunContext& run)
      : graph_(graph),
        candidates_(candidates),
        tolerance_(tolerance),
        run_(run),
        edges_(graph.edges()),
        keep_(edges_.size(), true) {}

  std::vector<double> scales() const {
    EigenOptions smallest;
    smallest.count = 1;
    smallest.null_vectors = false;
    smallest.tolerance = 1e-6;
    smallest.check_inertia = false;
    smallest.progress = run_.progress;
    const auto eigen = smallest_eigenpairs(graph_, LaplacianKind::combinatorial, smallest);
    return automatic_scales(eigen.count() > 0 ? eigen.values[0] : 0.0);
  }

  HeatDistanceResult distances(double scale, const std::vector<std::size_t>& remaining) const {
    std::vector<VertexPair> pairs;
    for (const auto candidate : remaining) {
      const auto& edge = edges_[candidates_[candidate]];
      pairs.push_back({edge.from, edge.to});
    }
    return heat_distances(graph_.filtered(keep_), pairs, std::vector<double>{scale},
                          {.tolerance = tolerance_, .progress = run_.progress});
  }

  /// Mean and deviation are sums over ranks; the other rules look at all distances at once.
  Threshold threshold(const std::vector<double>& distances, const std::vector<std::size_t>&,
                      const ThresholdOptions& rule) const {
    if (rule.rule == ThresholdRule::mean_sigma) return by_deviation(distances, rule.konst);
    return find_threshold(detail::concatenate(comm(), distances), rule);
  }

  std::int64_t total(std::int64_t mine) const { return detail::sum(comm(), mine); }

  void remove(std::size_t candidate) { keep_[candidates_[candidate]] = false; }

 private:
  const detail::Comm& comm() const { return graph_.state().comm(); }

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

  Threshold by_deviation(const std::vector<double>& distances, double konst) const {
    const auto all = moments(distances, [](double) { return true; });
    if (all.count == 0.0) return {std::numeric_limits<double>::infinity(), 0.0, true};
    Threshold threshold;
    threshold.value = all.mean + konst * std::sqrt(all.squares / all.count);
    const auto low = moments(distances, [&](double value) { return value <= threshold.value; });
    const auto high = moments(distances, [&](double value) { return value > threshold.value; });
    if (all.squares > 0.0) threshold.separation = 1.0 - (low.squares + high.squares) / all.squares;
    return threshold;
  }

  const Graph& graph_;
  const std::vector<std::size_t>& candidates_;
  double tolerance_;
  const RunContext& run_;
  std::vector<FileOrderEdge> edges_;
  std::vector<bool> keep_;
};

}  // namespace

MultiscaleHeat multiscale_heat(const Graph& graph, const std::vector<bool>& candidate,
                               const MultiscaleHeatOptions& options, const RunContext& run) {
  const auto edge_count = graph.edges().size();
  graph.session().together([&] {
    options.validate();
    if (candidate.size() != edge_count) {
      throw InvalidArgument("candidate", "must have one entry an edge");
    }
  });
  std::vector<std::size_t> candidates;
  for (std::size_t k = 0; k < edge_count; ++k) {
    if (candidate[k]) candidates.push_back(k);
  }
  auto result = spectral::detail::Algorithm1(OneRank(graph, candidates, options.tolerance, run),
                                             candidates.size(), options)
                    .run();
  std::vector<MultiscaleVerdict> verdicts(edge_count);
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    verdicts[candidates[c]] = std::move(result.verdicts[c]);
  }
  result.verdicts = std::move(verdicts);
  result.distances.clear();
  return result;
}

}  // namespace isotherm::spectral::distributed
