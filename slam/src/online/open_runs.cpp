#include "online/open_runs.hpp"

#include <algorithm>
#include <string>

#include "isotherm/base/error.hpp"
#include "prune/consensus/log_sum.hpp"

namespace isotherm::slam::detail {
namespace {

// Log weights of a loop being false and true.
struct Weights {
  double no = 0.0;
  double yes = 0.0;
};

}  // namespace

void OpenRuns::add(const Member& member) {
  if (contains(member.edge)) throw InvalidArgument("edge", "is there already");
  Node node{.member = member};
  const auto own = static_cast<Index>(nodes_.size());
  if (member.before != kNone) {
    const auto parent = positions_.find(member.before);
    if (parent == positions_.end()) throw InvalidArgument("before", "is not there");
    node.parent = parent->second;
    node.run = nodes_[node.parent].run;
  } else {
    node.run = static_cast<Index>(runs_.size());
    runs_.emplace_back();
  }
  runs_[node.run].push_back(own);
  positions_.emplace(member.edge, own);
  nodes_.push_back(node);
}

// Upwards, what the loops behind one say of it; downwards, what all others say of each.
std::vector<std::pair<Index, double>> OpenRuns::log_odds(Index edge) const {
  const auto found = positions_.find(edge);
  if (found == positions_.end()) return {};
  const auto& run = runs_[nodes_[found->second].run];
  const auto place = [&run](Index position) {
    return std::ranges::lower_bound(run, position) - run.begin();
  };
  std::vector<Weights> below(run.size());   // of each, with all that comes behind it
  std::vector<Weights> upward(run.size());  // the same for the state of the one before it
  for (std::size_t k = run.size(); k-- > 0;) {
    const Node& node = nodes_[run[k]];
    if (node.parent == kNone) break;
    upward[k] = {log_sum(labels_.log_next(false, false) + below[k].no,
                         labels_.log_next(false, true) + below[k].yes + node.member.own),
                 log_sum(labels_.log_next(true, false) + below[k].no,
                         labels_.log_next(true, true) + below[k].yes + node.with_parent())};
    Weights& parent = below[static_cast<std::size_t>(place(node.parent))];
    parent.no += upward[k].no;
    parent.yes += upward[k].yes;
  }
  std::vector<Weights> all(run.size());
  std::vector<std::pair<Index, double>> odds;
  for (std::size_t k = 0; k < run.size(); ++k) {
    const Node& node = nodes_[run[k]];
    if (node.parent == kNone) {
      all[k] = {labels_.log_share(LabelCounts::kFirst, false) + below[k].no,
                labels_.log_share(LabelCounts::kFirst, true) + below[k].yes + node.member.own};
    } else {
      const Weights& parent = all[static_cast<std::size_t>(place(node.parent))];
      const Weights rest{parent.no - upward[k].no, parent.yes - upward[k].yes};
      all[k] = {
          below[k].no + log_sum(rest.no + labels_.log_next(false, false),
                                rest.yes + labels_.log_next(true, false)),
          below[k].yes + log_sum(rest.no + labels_.log_next(false, true) + node.member.own,
                                 rest.yes + labels_.log_next(true, true) + node.with_parent())};
    }
    odds.emplace_back(node.member.edge, all[k].yes - all[k].no);
  }
  return odds;
}

}  // namespace isotherm::slam::detail
