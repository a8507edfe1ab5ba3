#include "isotherm/slam/evaluate/labels.hpp"

#include <algorithm>

#include "isotherm/base/error.hpp"

namespace isotherm::slam {
namespace {

Label judge(double translation_error, double rotation_error, const LabelOptions& options) {
  if (rotation_error > options.max_rotation_error) return Label::incorrect;
  if (translation_error > options.max_translation_error + options.ignore_band) {
    return Label::incorrect;
  }
  if (translation_error > options.max_translation_error - options.ignore_band) {
    return Label::ignore;
  }
  return Label::correct;
}

}  // namespace

void LabelOptions::validate() const { require_fields_in_range(*this); }

template <class Pose>
std::vector<EdgeLabel> label_candidates(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                        const std::vector<std::optional<Pose>>& truth,
                                        const LabelOptions& options) {
  options.validate();
  if (truth.size() != graph.ids.size()) {
    throw InvalidArgument("truth", "must have one entry per vertex");
  }
  std::vector<EdgeLabel> labels;
  labels.reserve(roles.candidates.size());
  for (const Index k : roles.candidates) {
    const auto& constraint = graph.constraints[k];
    EdgeLabel row{k, graph.ids[constraint.from], graph.ids[constraint.to], Label::ignore};
    const auto& from = truth[constraint.from];
    const auto& to = truth[constraint.to];
    if (from && to) {
      const Pose error = constraint.T_from_to.between(from->between(*to));
      row.label = judge(error.translation().norm(), error.rotation_angle(), options);
    }
    labels.push_back(row);
  }
  return labels;
}

std::int64_t count(const std::vector<EdgeLabel>& labels, Label label) {
  return std::count_if(labels.begin(), labels.end(),
                       [label](const EdgeLabel& row) { return row.label == label; });
}

template std::vector<EdgeLabel> label_candidates(const PoseGraph<Pose2>&, const EdgeRoles&,
                                                 const std::vector<std::optional<Pose2>>&,
                                                 const LabelOptions&);
template std::vector<EdgeLabel> label_candidates(const PoseGraph<Pose3>&, const EdgeRoles&,
                                                 const std::vector<std::optional<Pose3>>&,
                                                 const LabelOptions&);

}  // namespace isotherm::slam
