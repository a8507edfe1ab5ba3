#include "isotherm/slam/prune/consensus.hpp"

#include <optional>

#include "graph/candidate_verdicts.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/slam/graph/information.hpp"
#include "prune/consensus/pairs/near_pairs.hpp"
#include "prune/consensus/search/search.hpp"

namespace isotherm::slam {

void ConsensusOptions::validate() const { require_fields_in_range(*this); }

template <class Pose>
std::vector<Index> unusable_odometry(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  std::vector<Index> unusable;
  for (const Index k : roles.odometry) {
    if (!is_usable_information<Pose::kDof>(graph.constraints[k].information)) unusable.push_back(k);
  }
  return unusable;
}

template <class Pose>
ConsensusResult consensus(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                          const ConsensusOptions& options, const RunContext& run) {
  options.validate();
  ConsensusResult result;
  result.verdicts = candidate_verdicts(graph, roles);
  if (roles.candidates.empty()) return result;
  const auto reduced = detail::reduce(graph, roles);
  const auto pairs = detail::near_pairs(reduced, options.window);
  // False loops among the accepted ones would widen the covariances, and let more in: the
  // file is taken at its word as long as that explains what is accepted, or proves more.
  std::optional<detail::Search<Pose>> search;
  search.emplace(reduced, pairs, options, run, false);
  search->run();
  search->report(result);
  if (options.calibrate && search->asks_for_wider()) {
    const auto proven = search->count_proven();
    search.emplace(reduced, pairs, options, run, true);
    search->run();
    if (search->count_proven() > proven) search->report(result);
  }
  return result;
}

template std::vector<Index> unusable_odometry(const PoseGraph<Pose2>&, const EdgeRoles&);
template std::vector<Index> unusable_odometry(const PoseGraph<Pose3>&, const EdgeRoles&);
template ConsensusResult consensus(const PoseGraph<Pose2>&, const EdgeRoles&,
                                   const ConsensusOptions&, const RunContext&);
template ConsensusResult consensus(const PoseGraph<Pose3>&, const EdgeRoles&,
                                   const ConsensusOptions&, const RunContext&);

}  // namespace isotherm::slam
