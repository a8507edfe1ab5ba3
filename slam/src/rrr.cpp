#include "isotherm/slam/rrr.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include <Eigen/Cholesky>

#include "candidate_verdicts.hpp"
#include "find_root.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/statistics.hpp"
#include "isotherm/slam/information.hpp"
#include "isotherm/slam/initialize.hpp"
#include "isotherm/slam/odometry.hpp"
#include "minimize.hpp"

namespace isotherm::slam {
namespace {

using spectral::EdgeVerdicts;
using spectral::Verdict;

using Cluster = std::vector<Index>;  // positions in roles.candidates

struct Consistency {
  double chi2 = 0.0;
  double limit = 0.0;

  bool holds() const { return chi2 <= limit; }
  double ratio() const { return chi2 / limit; }
};

template <class Pose>
class Rrr {
 public:
  Rrr(const PoseGraph<Pose>& graph, const EdgeRoles& roles, const RrrOptions& options,
      const ProgressCallback& progress)
      : graph_(graph),
        roles_(roles),
        options_(options),
        progress_(progress),
        odometry_(graph, roles),
        loop_limit_(chi_squared_quantile(options.rrr_confidence, Pose::kDof)),
        verdicts_(candidate_verdicts(graph, roles)) {
    for (auto& verdict : verdicts_) verdict.threshold = loop_limit_;
  }

  EdgeVerdicts run() && {
    std::vector<Cluster> clusters;
    for (const Cluster& cluster : cluster_loops(graph_, roles_, options_.rrr_cluster_gap)) {
      Cluster consistent = within_cluster(cluster);
      if (!consistent.empty()) clusters.push_back(std::move(consistent));
      report(clusters.size());
    }
    between_clusters(clusters);
    return std::move(verdicts_);
  }

 private:
  const Constraint<Pose>& loop(Index candidate) const {
    return graph_.constraints[roles_.candidates[candidate]];
  }

  Consistency test(double chi2, std::size_t constraints) const {
    const int dof = static_cast<int>(constraints) * Pose::kDof;
    return {chi2, chi_squared_quantile(options_.rrr_confidence, dof)};
  }

  void report(std::size_t done) const {
    if (progress_ && !progress_({"rrr", done, 0})) throw Cancelled();
  }

  void reject(Index candidate, const Consistency& why, const char* stage) {
    auto& verdict = verdicts_[candidate];
    verdict.verdict = Verdict::prune;
    verdict.score = why.chi2;
    verdict.threshold = why.limit;
    verdict.stage = stage;
  }

  // chi-squared of every constraint of `small` after optimisation.
  Eigen::VectorXd optimised_chi2(const PoseGraph<Pose>& small, std::vector<Pose>& poses) const {
    NormalEquations<Pose> equations(small);
    const EdgeCost least_squares = [](Index, double chi2) { return KernelValue{chi2, 1.0}; };
    minimize(equations, least_squares,
             {OptimizeAlgorithm::gauss_newton, options_.rrr_iterations, 1e-4, {}}, poses);
    return equations.chi2(poses);
  }

  // Only the ends of the given loops, joined by contracted odometry.
  PoseGraph<Pose> contract(const Cluster& loops) const {
    std::vector<Index> ends;
    for (const Index candidate : loops) {
      ends.push_back(loop(candidate).from);
      ends.push_back(loop(candidate).to);
    }
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    PoseGraph<Pose> small;
    for (const Index end : ends) small.ids.push_back(graph_.ids[end]);
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
      if (odometry_.chain(ends[k]) != odometry_.chain(ends[k + 1])) continue;
      const auto path = odometry_.relative(ends[k], ends[k + 1]);
      Constraint<Pose> step;
      step.from = static_cast<Index>(k);
      step.to = step.from + 1;
      step.T_from_to = path.T;
      step.information =
          Eigen::LDLT<typename Pose::Matrix>(path.covariance).solve(Pose::Matrix::Identity());
      step.information = (0.5 * (step.information + step.information.transpose())).eval();
      small.constraints.push_back(step);
    }
    for (const Index candidate : loops) {
      Constraint<Pose> copy = loop(candidate);
      copy.from =
          static_cast<Index>(std::lower_bound(ends.begin(), ends.end(), copy.from) - ends.begin());
      copy.to =
          static_cast<Index>(std::lower_bound(ends.begin(), ends.end(), copy.to) - ends.begin());
      small.constraints.push_back(copy);
    }
    return small;
  }

  // Algorithm 2 of the paper: the loops of a cluster that agree.
  Cluster within_cluster(const Cluster& cluster) {
    const PoseGraph<Pose> small = contract(cluster);
    auto poses = initial_poses(small, edge_roles(small), Initialization::odometry);
    const Eigen::VectorXd chi2 = optimised_chi2(small, poses);
    const Consistency whole = test(chi2.sum(), roles_.odometry.size() + cluster.size());
    const Index first = small.constraint_count() - static_cast<Index>(cluster.size());
    Cluster consistent;
    for (std::size_t k = 0; k < cluster.size(); ++k) {
      const Consistency own{chi2[first + static_cast<Index>(k)], loop_limit_};
      if (!whole.holds()) {
        reject(cluster[k], whole, "cluster");
      } else if (!own.holds()) {
        reject(cluster[k], own, "intra-cluster");
      } else {
        consistent.push_back(cluster[k]);
      }
    }
    return consistent;
  }

  // The whole graph with odometry and the loops of the given clusters; chi-squared
  // of those loops in order, and the sum over everything at the end.
  std::vector<double> chi2_with(const std::vector<const Cluster*>& clusters) {
    std::vector<bool> keep(graph_.constraints.size(), false);
    for (const Index k : roles_.odometry) keep[k] = true;
    std::size_t loops = 0;
    for (const Cluster* cluster : clusters) {
      for (const Index candidate : *cluster) keep[roles_.candidates[candidate]] = true;
      loops += cluster->size();
    }
    const PoseGraph<Pose> part = filter_constraints(graph_, keep);
    poses_ = initial_poses(part, edge_roles(part), Initialization::odometry);
    const Eigen::VectorXd chi2 = optimised_chi2(part, poses_);
    std::vector<double> by_constraint(graph_.constraints.size(), 0.0);
    Index at = 0;
    for (std::size_t k = 0; k < keep.size(); ++k) {
      if (keep[k]) by_constraint[k] = chi2[at++];
    }
    report(loops);
    return by_constraint;
  }

  double sum_over(const Cluster& cluster, const std::vector<double>& chi2) const {
    double sum = 0.0;
    for (const Index candidate : cluster) sum += chi2[roles_.candidates[candidate]];
    return sum;
  }

  Consistency whole_graph(const std::vector<const Cluster*>& clusters,
                          const std::vector<double>& chi2) const {
    std::size_t constraints = roles_.odometry.size();
    for (const Cluster* cluster : clusters) constraints += cluster->size();
    return test(std::accumulate(chi2.begin(), chi2.end(), 0.0), constraints);
  }

  // Algorithm 3: the largest part of `tried` that agrees with `good` and itself,
  // found by putting back the most inconsistent cluster, one at a time.
  std::vector<std::size_t> agree(const std::vector<Cluster>& clusters,
                                 const std::vector<std::size_t>& good,
                                 std::vector<std::size_t> tried) {
    while (!tried.empty()) {
      std::vector<const Cluster*> together;
      for (const std::size_t c : good) together.push_back(&clusters[c]);
      for (const std::size_t c : tried) together.push_back(&clusters[c]);
      const auto chi2 = chi2_with(together);
      const auto consistency = [&](std::size_t c) {
        return test(sum_over(clusters[c], chi2), clusters[c].size());
      };
      const auto worst =
          std::max_element(tried.begin(), tried.end(), [&](std::size_t a, std::size_t b) {
            return consistency(a).ratio() < consistency(b).ratio();
          });
      const Consistency why = consistency(*worst);
      if (why.holds() && whole_graph(together, chi2).holds()) return tried;
      for (const Index candidate : clusters[*worst]) last_test(candidate, why);
      tried.erase(worst);
    }
    return {};
  }

  void last_test(Index candidate, const Consistency& why) {
    verdicts_[candidate].score = why.chi2;
    verdicts_[candidate].threshold = why.limit;
  }

  // Algorithm 4.
  void between_clusters(const std::vector<Cluster>& clusters) {
    std::vector<std::size_t> good;
    std::vector<bool> is_good(clusters.size(), false);
    std::vector<bool> rejected(clusters.size(), false);
    while (true) {
      std::vector<const Cluster*> accepted;
      for (const std::size_t c : good) accepted.push_back(&clusters[c]);
      chi2_with(accepted);  // leaves the estimate in poses_
      std::vector<std::size_t> tried;
      for (std::size_t c = 0; c < clusters.size(); ++c) {
        if (!is_good[c] && !rejected[c] && any_loop_fits(clusters[c])) tried.push_back(c);
      }
      // Drift can hide every loop from odometry alone: then all get their chance.
      if (tried.empty() && good.empty()) tried = not_rejected(rejected);
      if (tried.empty()) break;
      const auto agreed = agree(clusters, good, tried);
      if (agreed.empty()) {
        for (const std::size_t c : tried) rejected[c] = true;
        continue;
      }
      for (const std::size_t c : agreed) is_good[c] = true;
      good.insert(good.end(), agreed.begin(), agreed.end());
      rejected.assign(clusters.size(), false);
    }
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      for (const Index candidate : clusters[c]) decide(candidate, is_good[c]);
    }
  }

  static std::vector<std::size_t> not_rejected(const std::vector<bool>& rejected) {
    std::vector<std::size_t> rest;
    for (std::size_t c = 0; c < rejected.size(); ++c) {
      if (!rejected[c]) rest.push_back(c);
    }
    return rest;
  }

  double chi2_at_estimate(Index candidate) const {
    const auto& constraint = loop(candidate);
    const auto r = residual(constraint, poses_[constraint.from], poses_[constraint.to]);
    return r.dot(constraint.information * r);
  }

  bool any_loop_fits(const Cluster& cluster) const {
    return std::any_of(cluster.begin(), cluster.end(), [this](Index candidate) {
      return chi2_at_estimate(candidate) < loop_limit_;
    });
  }

  void decide(Index candidate, bool good) {
    auto& verdict = verdicts_[candidate];
    verdict.stage = "inter-cluster";
    verdict.verdict = good ? Verdict::keep : Verdict::prune;
    const bool tested = verdict.score > verdict.threshold;
    if (good || !tested) {
      verdict.score = chi2_at_estimate(candidate);
      verdict.threshold = good ? std::max(loop_limit_, verdict.score) : loop_limit_;
    }
  }

  const PoseGraph<Pose>& graph_;
  const EdgeRoles& roles_;
  const RrrOptions& options_;
  const ProgressCallback& progress_;
  OdometryChain<Pose> odometry_;
  double loop_limit_;
  EdgeVerdicts verdicts_;
  std::vector<Pose> poses_;
};

}  // namespace

void RrrOptions::validate() const {
  if (rrr_cluster_gap < 1) throw InvalidArgument("rrr_cluster_gap", "must be at least 1");
  if (!(rrr_confidence > 0.0 && rrr_confidence < 1.0)) {
    throw InvalidArgument("rrr_confidence", "must be in (0, 1)");
  }
  if (rrr_iterations < 1) throw InvalidArgument("rrr_iterations", "must be at least 1");
}

template <class Pose>
std::vector<std::vector<Index>> cluster_loops(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                              int gap) {
  const auto count = static_cast<Index>(roles.candidates.size());
  struct Ends {
    Index low;
    Index high;
  };
  std::vector<Ends> ends;
  for (const Index k : roles.candidates) {
    const auto& constraint = graph.constraints[k];
    ends.push_back(
        {std::min(constraint.from, constraint.to), std::max(constraint.from, constraint.to)});
  }
  std::vector<Index> by_low(static_cast<std::size_t>(count));
  std::iota(by_low.begin(), by_low.end(), 0);
  std::sort(by_low.begin(), by_low.end(), [&](Index a, Index b) {
    return std::pair(ends[a].low, a) < std::pair(ends[b].low, b);
  });
  std::vector<Index> parent(static_cast<std::size_t>(count));
  std::iota(parent.begin(), parent.end(), 0);
  for (std::size_t a = 0; a < by_low.size(); ++a) {
    for (std::size_t b = a + 1; b < by_low.size(); ++b) {
      const Ends& first = ends[by_low[a]];
      const Ends& second = ends[by_low[b]];
      if (second.low - first.low > gap) break;
      if (std::abs(second.high - first.high) > gap) continue;
      const Index x = find_root(parent, by_low[a]);
      const Index y = find_root(parent, by_low[b]);
      parent[std::max(x, y)] = std::min(x, y);
    }
  }
  std::vector<std::vector<Index>> clusters;
  std::vector<Index> cluster_of(static_cast<std::size_t>(count), -1);
  for (Index c = 0; c < count; ++c) {
    Index& cluster = cluster_of[find_root(parent, c)];
    if (cluster < 0) {
      cluster = static_cast<Index>(clusters.size());
      clusters.emplace_back();
    }
    clusters[cluster].push_back(c);
  }
  return clusters;
}

template <class Pose>
EdgeVerdicts rrr(const PoseGraph<Pose>& graph, const EdgeRoles& roles, const RrrOptions& options,
                 const ProgressCallback& progress) {
  options.validate();
  const auto prepared = prepare(graph);
  return Rrr<Pose>(prepared.graph, roles, options, progress).run();
}

template std::vector<std::vector<Index>> cluster_loops(const PoseGraph<Pose2>&, const EdgeRoles&,
                                                       int);
template std::vector<std::vector<Index>> cluster_loops(const PoseGraph<Pose3>&, const EdgeRoles&,
                                                       int);
template EdgeVerdicts rrr(const PoseGraph<Pose2>&, const EdgeRoles&, const RrrOptions&,
                          const ProgressCallback&);
template EdgeVerdicts rrr(const PoseGraph<Pose3>&, const EdgeRoles&, const RrrOptions&,
                          const ProgressCallback&);

}  // namespace isotherm::slam
