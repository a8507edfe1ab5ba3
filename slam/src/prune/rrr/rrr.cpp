#include "isotherm/slam/prune/rrr.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>

#include <Eigen/Cholesky>

#include "graph/candidate_verdicts.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/statistics.hpp"
#include "isotherm/slam/graph/information.hpp"
#include "isotherm/slam/graph/odometry.hpp"
#include "isotherm/slam/optimize/initialize.hpp"
#include "optimize/robust_minimize.hpp"

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
      const RunContext& run)
      : graph_(graph),
        roles_(roles),
        options_(options),
        run_(run),
        odometry_(graph, roles),
        loop_limit_(chi_squared_quantile(options.rrr_confidence, Pose::kDof)),
        verdicts_(detail::candidate_verdicts(graph, roles)),
        accepted_(roles.candidates.size(), false),
        start_(start()),
        poses_(start_) {
    for (auto& verdict : verdicts_) verdict.threshold = loop_limit_;
  }

  EdgeVerdicts run() && {
    const auto clusters = cluster_loops(graph_, roles_, options_.rrr_cluster_gap);
    if (options_.rrr_split) grow(consistent(fitting_parts(clusters)));
    grow(consistent(clusters));
    if (options_.rrr_split) grow(single_loops());
    for (std::size_t k = 0; k < accepted_.size(); ++k) decide(static_cast<Index>(k));
    return std::move(verdicts_);
  }

 private:
  static Initialization start_of(const RrrOptions& options) {
    return options.initialization == Initialization::automatic ? Initialization::switchable
                                                               : options.initialization;
  }

  // A switch falls below one half where a loop fails its test.
  std::vector<Pose> start() const {
    const Initialization method = start_of(options_);
    return method == Initialization::switchable
               ? detail::switchable_poses(graph_, roles_, loop_limit_, run_.progress)
               : initial_poses(graph_, roles_, method);
  }

  // Whether the start knows more than odometry. If not, it is chained anew for every
  // optimisation: parts that odometry does not join hang on the loops that are in.
  bool informed() const { return start_of(options_) != Initialization::odometry; }

  const Constraint<Pose>& loop(Index candidate) const {
    return graph_.constraints[roles_.candidates[candidate]];
  }

  Consistency test(double chi2, std::size_t constraints) const {
    const int dof = static_cast<int>(constraints) * Pose::kDof;
    return {chi2, chi_squared_quantile(options_.rrr_confidence, dof)};
  }

  void report(std::size_t done) const {
    if (run_.progress && !run_.progress({"rrr", done, 0})) throw Cancelled();
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
    detail::NormalEquations<Pose> equations(small);
    const detail::EdgeCost least_squares = [](Index, double chi2) {
      return KernelValue{chi2, 1.0};
    };
    detail::minimize(
        equations, least_squares,
        {OptimizeAlgorithm::gauss_newton, options_.rrr_iterations, 1e-4, run_.progress}, poses);
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
    for (const Index end : ends) {
      small.ids.push_back(graph_.ids[end]);
      small.poses.push_back(start_[end]);
    }
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

  // What of every cluster agrees within it.
  std::vector<Cluster> consistent(const std::vector<Cluster>& clusters) {
    std::vector<Cluster> parts;
    for (const Cluster& cluster : clusters) {
      Cluster part = within_cluster(cluster);
      if (!part.empty()) parts.push_back(std::move(part));
      report(parts.size());
    }
    return parts;
  }

  // Algorithm 2 of the paper: the loops of a cluster that agree.
  Cluster within_cluster(const Cluster& cluster) {
    const PoseGraph<Pose> small = contract(cluster);
    auto poses = initial_poses(small, edge_roles(small),
                               informed() ? Initialization::file : Initialization::odometry);
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

  // The whole graph with odometry and the given loops: leaves the estimate in
  // poses_; chi-squared by constraint, zero for the others.
  std::vector<double> chi2_with(const std::vector<bool>& loops) {
    std::vector<bool> keep(graph_.constraints.size(), false);
    for (const Index k : roles_.odometry) keep[k] = true;
    for (std::size_t c = 0; c < loops.size(); ++c) keep[roles_.candidates[c]] = loops[c];
    const PoseGraph<Pose> part = filter_constraints(graph_, keep);
    poses_ = informed() ? start_ : initial_poses(part, edge_roles(part), Initialization::odometry);
    const Eigen::VectorXd chi2 = optimised_chi2(part, poses_);
    std::vector<double> by_constraint(graph_.constraints.size(), 0.0);
    Index at = 0;
    for (std::size_t k = 0; k < keep.size(); ++k) {
      if (keep[k]) by_constraint[k] = chi2[at++];
    }
    report(static_cast<std::size_t>(std::count(loops.begin(), loops.end(), true)));
    return by_constraint;
  }

  Consistency test(const Cluster& cluster, const std::vector<double>& chi2) const {
    double sum = 0.0;
    for (const Index candidate : cluster) sum += chi2[roles_.candidates[candidate]];
    return test(sum, cluster.size());
  }

  Consistency whole_graph(const std::vector<bool>& loops, const std::vector<double>& chi2) const {
    const auto accepted = std::count(loops.begin(), loops.end(), true);
    return test(std::accumulate(chi2.begin(), chi2.end(), 0.0),
                roles_.odometry.size() + static_cast<std::size_t>(accepted));
  }

  // Algorithm 3: the largest part of `tried` that agrees with what is accepted and
  // itself, found by putting back the most inconsistent cluster, one at a time.
  std::vector<const Cluster*> agree(std::vector<const Cluster*> tried) {
    while (!tried.empty()) {
      std::vector<bool> together = accepted_;
      for (const Cluster* cluster : tried) {
        for (const Index candidate : *cluster) together[candidate] = true;
      }
      const auto chi2 = chi2_with(together);
      const auto worst =
          std::max_element(tried.begin(), tried.end(), [&](const Cluster* a, const Cluster* b) {
            return test(*a, chi2).ratio() < test(*b, chi2).ratio();
          });
      const Consistency why = test(**worst, chi2);
      if (why.holds() && whole_graph(together, chi2).holds()) return tried;
      for (const Index candidate : **worst) last_test(candidate, why);
      tried.erase(worst);
    }
    return {};
  }

  void last_test(Index candidate, const Consistency& why) {
    if (accepted_[candidate]) return;
    verdicts_[candidate].score = why.chi2;
    verdicts_[candidate].threshold = why.limit;
    verdicts_[candidate].stage = "inter-cluster";
  }

  // Algorithm 4: accepts what agrees of `clusters`, until nothing is added.
  void grow(const std::vector<Cluster>& clusters) {
    std::vector<bool> rejected(clusters.size(), false);
    while (true) {
      estimate();
      std::vector<const Cluster*> tried = candidates(clusters, rejected);
      if (tried.empty()) return;
      const auto agreed = agree(tried);
      for (const Cluster* cluster : agreed) {
        for (const Index candidate : *cluster) accepted_[candidate] = true;
      }
      if (agreed.empty()) {
        for (const Cluster* cluster : tried) rejected[cluster - clusters.data()] = true;
      } else {
        rejected.assign(clusters.size(), false);
      }
    }
  }

  // Poses from odometry and what is accepted; until something is, the start if it
  // knows more.
  void estimate() {
    if (any_accepted() || !informed()) {
      chi2_with(accepted_);
    } else {
      poses_ = start_;
    }
  }

  bool any_accepted() const {
    return std::find(accepted_.begin(), accepted_.end(), true) != accepted_.end();
  }

  // Clusters to be decided that fit the estimate. Drift can hide every loop from
  // odometry: then all get their chance.
  std::vector<const Cluster*> candidates(const std::vector<Cluster>& clusters,
                                         const std::vector<bool>& rejected) const {
    const auto undecided = [this](Index k) { return !accepted_[k]; };
    std::vector<const Cluster*> open;
    std::vector<const Cluster*> fitting;
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      if (rejected[c] || std::ranges::none_of(clusters[c], undecided)) continue;
      open.push_back(&clusters[c]);
      if (fits_estimate(clusters[c])) fitting.push_back(&clusters[c]);
    }
    return fitting.empty() && !any_accepted() && !informed() ? open : fitting;
  }

  // A loop that is not accepted yet fits, or all loops do together.
  bool fits_estimate(const Cluster& cluster) const {
    double sum = 0.0;
    for (const Index candidate : cluster) {
      if (!accepted_[candidate] && fits_estimate(candidate)) return true;
      sum += chi2_at_estimate(candidate);
    }
    return test(sum, cluster.size()).holds();
  }

  // Of every cluster the loops that fit the start.
  std::vector<Cluster> fitting_parts(const std::vector<Cluster>& clusters) const {
    std::vector<Cluster> parts;
    for (const Cluster& cluster : clusters) {
      Cluster part;
      std::ranges::copy_if(cluster, std::back_inserter(part),
                           [this](Index k) { return fits_estimate(k); });
      if (!part.empty()) parts.push_back(std::move(part));
    }
    return parts;
  }

  // Every loop that is not accepted, for itself.
  std::vector<Cluster> single_loops() const {
    std::vector<Cluster> singles;
    for (std::size_t k = 0; k < accepted_.size(); ++k) {
      if (!accepted_[k]) singles.push_back({static_cast<Index>(k)});
    }
    return singles;
  }

  double chi2_at_estimate(Index candidate) const {
    const auto& constraint = loop(candidate);
    const auto r = residual(constraint, poses_[constraint.from], poses_[constraint.to]);
    return r.dot(constraint.information * r);
  }

  bool fits_estimate(Index candidate) const { return chi2_at_estimate(candidate) < loop_limit_; }

  void decide(Index candidate) {
    auto& verdict = verdicts_[candidate];
    const bool kept = accepted_[candidate];
    const bool tested = verdict.score > verdict.threshold;
    verdict.verdict = kept ? Verdict::keep : Verdict::prune;
    if (kept || verdict.stage.empty()) verdict.stage = "inter-cluster";
    if (kept || !tested) {
      verdict.score = chi2_at_estimate(candidate);
      verdict.threshold = kept ? std::max(loop_limit_, verdict.score) : loop_limit_;
    }
  }

  const PoseGraph<Pose>& graph_;
  const EdgeRoles& roles_;
  const RrrOptions& options_;
  const RunContext& run_;
  OdometryChain<Pose> odometry_;
  double loop_limit_;
  EdgeVerdicts verdicts_;
  std::vector<bool> accepted_;  // one a candidate
  std::vector<Pose> start_;
  std::vector<Pose> poses_;  // the estimate
};

}  // namespace

void RrrOptions::validate() const { require_fields_in_range(*this); }

template <class Pose>
EdgeVerdicts rrr(const PoseGraph<Pose>& graph, const EdgeRoles& roles, const RrrOptions& options,
                 const RunContext& run) {
  options.validate();
  const auto prepared = detail::prepare(graph);
  return Rrr<Pose>(prepared.graph, roles, options, run).run();
}

template EdgeVerdicts rrr(const PoseGraph<Pose2>&, const EdgeRoles&, const RrrOptions&,
                          const RunContext&);
template EdgeVerdicts rrr(const PoseGraph<Pose3>&, const EdgeRoles&, const RrrOptions&,
                          const RunContext&);

}  // namespace isotherm::slam
