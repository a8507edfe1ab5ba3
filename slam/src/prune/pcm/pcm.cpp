#include "isotherm/slam/prune/pcm.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

#include "graph/candidate_verdicts.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/statistics.hpp"
#include "isotherm/slam/graph/information.hpp"
#include "isotherm/slam/graph/odometry.hpp"
#include "isotherm/slam/prune/odometry_chi2.hpp"
#include "optimize/minimize.hpp"
#include "prune/pcm/max_clique.hpp"

namespace isotherm::slam {
namespace {

using spectral::Verdict;

// Paths along odometry in constant time each: poses and covariances are kept from
// the start of each chain, in the chain's own frame, and a path is their
// difference. Cancellation costs about log10 of (chain length / path length)^2
// digits of the covariance, of which the test needs two.
template <class Pose>
class OdometryPaths {
 public:
  OdometryPaths(const PoseGraph<Pose>& graph, const EdgeRoles& roles) : chain_(graph, roles) {
    const Index n = graph.vertex_count();
    poses_.resize(static_cast<std::size_t>(n));
    sums_.assign(static_cast<std::size_t>(n), Pose::Matrix::Zero());
    for (Index v = 1; v < n; ++v) {
      if (chain_.chain(v) != chain_.chain(v - 1)) continue;
      const UncertainPose<Pose> step = chain_.relative(v - 1, v);
      poses_[v] = poses_[v - 1] * step.T;
      const typename Pose::Matrix adjoint = poses_[v].adjoint();
      sums_[v] = sums_[v - 1] + adjoint * step.covariance * adjoint.transpose();
    }
  }

  bool joined(Index a, Index b) const { return chain_.chain(a) == chain_.chain(b); }

  UncertainPose<Pose> between(Index from, Index to) const {
    const typename Pose::Matrix sum =
        from <= to ? sums_[to] - sums_[from] : sums_[from] - sums_[to];
    const typename Pose::Matrix adjoint = poses_[to].inverse().adjoint();
    return {poses_[from].between(poses_[to]), adjoint * sum * adjoint.transpose()};
  }

 private:
  OdometryChain<Pose> chain_;
  std::vector<Pose> poses_;
  std::vector<typename Pose::Matrix> sums_;
};

// Mahalanobis length of a cycle that ought to be the identity.
template <class Pose>
double cycle_chi2(const UncertainPose<Pose>& cycle) {
  const typename Pose::Tangent r = cycle.T.log();
  return r.dot(Eigen::LDLT<typename Pose::Matrix>(cycle.covariance).solve(r));
}

template <class Pose>
struct Loop {
  std::size_t candidate;
  Index from;
  Index to;
  UncertainPose<Pose> measured;

  // Of largest cliques there may be many, and the test of a pair is not quite symmetric:
  // what they are, not where they stand in the file, says which loop comes first.
  bool operator<(const Loop& other) const {
    if (from != other.from) return from < other.from;
    if (to != other.to) return to < other.to;
    const typename Pose::Tangent a = measured.T.log();
    const typename Pose::Tangent b = other.measured.T.log();
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  }
};

template <class Pose>
class PairCheck {
 public:
  PairCheck(const OdometryPaths<Pose>& odometry, double limit)
      : odometry_(odometry), limit_(limit) {}

  // first.from -> first.to -> second.to -> second.from -> first.from.
  bool agree(const Loop<Pose>& first, const Loop<Pose>& second) const {
    if (!odometry_.joined(first.to, second.to) || !odometry_.joined(second.from, first.from)) {
      return true;  // no cycle contradicts them
    }
    const auto forward = compose(first.measured, odometry_.between(first.to, second.to));
    const auto back = compose(inverse(second.measured), odometry_.between(second.from, first.from));
    return cycle_chi2(compose(forward, back)) <= limit_;
  }

 private:
  const OdometryPaths<Pose>& odometry_;
  double limit_;
};

// Loops that point back in time are turned round, so that all ends correspond.
template <class Pose>
Loop<Pose> oriented(std::size_t candidate, const Constraint<Pose>& constraint) {
  const UncertainPose<Pose> measured{
      constraint.T_from_to, covariance_from_information<Pose::kDof>(constraint.information)};
  if (constraint.from <= constraint.to) {
    return {candidate, constraint.from, constraint.to, measured};
  }
  return {candidate, constraint.to, constraint.from, inverse(measured)};
}

}  // namespace

void PcmOptions::validate() const { require_fields_in_range(*this); }

template <class Pose>
PcmResult pcm(const PoseGraph<Pose>& given, const EdgeRoles& roles, const PcmOptions& options,
              const RunContext& run) {
  options.validate();
  const PoseGraph<Pose> graph = detail::prepare(given).graph;
  PcmResult result;
  result.verdicts = detail::candidate_verdicts(graph, roles);

  const bool check_odometry = options.pcm_odometry_confidence < 1.0;
  const double odometry_limit =
      check_odometry ? chi_squared_quantile(options.pcm_odometry_confidence, Pose::kDof) : 0.0;
  const auto odometry_checks = odometry_chi2(graph, roles);
  std::vector<Loop<Pose>> loops;
  for (std::size_t c = 0; c < odometry_checks.size(); ++c) {
    if (check_odometry && odometry_checks[c].chi2 > odometry_limit) {
      auto& verdict = result.verdicts[c];
      verdict.verdict = Verdict::prune;
      verdict.score = odometry_checks[c].chi2;
      verdict.threshold = odometry_limit;
      verdict.stage = "odometry";
      continue;
    }
    loops.push_back(oriented(c, graph.constraints[roles.candidates[c]]));
  }
  std::sort(loops.begin(), loops.end());

  const auto count = static_cast<Index>(loops.size());
  const OdometryPaths<Pose> odometry(graph, roles);
  const PairCheck<Pose> check(odometry,
                              chi_squared_quantile(options.pcm_pair_confidence, Pose::kDof));
  detail::BitGraph agreement(count);
  for (Index a = 0; a < count; ++a) {
    if (run.progress &&
        !run.progress({"pcm", static_cast<std::uint64_t>(a), static_cast<std::uint64_t>(count)})) {
      throw Cancelled();
    }
    for (Index b = a + 1; b < count; ++b) {
      if (check.agree(loops[a], loops[b])) agreement.connect(a, b);
    }
  }

  const detail::Clique clique = detail::max_clique(agreement, options.pcm_clique_budget);
  result.proven = clique.proven;
  for (Index a = 0; a < count; ++a) {
    const auto disagreements =
        std::count_if(clique.members.begin(), clique.members.end(),
                      [&](Index member) { return member != a && !agreement.connected(a, member); });
    auto& verdict = result.verdicts[loops[a].candidate];
    const bool member = std::binary_search(clique.members.begin(), clique.members.end(), a);
    verdict.verdict = member ? Verdict::keep : Verdict::prune;
    verdict.score = static_cast<double>(disagreements) /
                    static_cast<double>(std::max<std::size_t>(clique.members.size(), 1));
    verdict.stage = "clique";
  }
  return result;
}

template PcmResult pcm(const PoseGraph<Pose2>&, const EdgeRoles&, const PcmOptions&,
                       const RunContext&);
template PcmResult pcm(const PoseGraph<Pose3>&, const EdgeRoles&, const PcmOptions&,
                       const RunContext&);

}  // namespace isotherm::slam
