#include "isotherm/slam/graph/trusted_edges.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "isotherm/base/csv.hpp"

namespace isotherm::slam {
namespace {

using Ends = std::pair<VertexId, VertexId>;

Ends sorted(VertexId a, VertexId b) { return {std::min(a, b), std::max(a, b)}; }

template <class Pose>
std::map<Ends, std::vector<Index>> constraints_by_ends(const PoseGraph<Pose>& graph) {
  std::map<Ends, std::vector<Index>> found;
  for (Index k = 0; k < graph.constraint_count(); ++k) {
    const auto& constraint = graph.constraints[k];
    found[sorted(graph.ids[constraint.from], graph.ids[constraint.to])].push_back(k);
  }
  return found;
}

}  // namespace

template <class Pose>
EdgeRoles read_trusted_edges(const std::string& path, const PoseGraph<Pose>& graph) {
  CsvReader csv(path);
  std::vector<bool> trusted(graph.constraints.size(), false);
  std::map<Ends, std::vector<Index>> by_ends;
  while (csv.next_row()) {
    const bool by_number =
        csv.has_header() ? csv.find_column("edge").has_value() : csv.field_count() == 1;
    if (by_number) {
      const auto column = csv.column("edge", 0);
      const auto edge = csv.unsigned_integer(column, "edge");
      if (edge >= trusted.size()) csv.fail(column, "the graph has no such edge");
      trusted[edge] = true;
      continue;
    }
    if (by_ends.empty()) by_ends = constraints_by_ends(graph);
    const auto column = csv.column("from", 0);
    const auto found = by_ends.find(sorted(csv.unsigned_integer(column, "from"),
                                           csv.unsigned_integer(csv.column("to", 1), "to")));
    if (found == by_ends.end()) csv.fail(column, "the graph has no edge between these vertices");
    for (const Index k : found->second) trusted[k] = true;
  }
  EdgeRoles roles;
  for (Index k = 0; k < graph.constraint_count(); ++k) {
    (trusted[k] ? roles.odometry : roles.candidates).push_back(k);
  }
  return roles;
}

template EdgeRoles read_trusted_edges(const std::string&, const PoseGraph<Pose2>&);
template EdgeRoles read_trusted_edges(const std::string&, const PoseGraph<Pose3>&);

}  // namespace isotherm::slam
