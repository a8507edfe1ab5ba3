#include "report/build/pose_graph_report.hpp"
#include "isotherm/base/words.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <variant>

#include <fmt/format.h>

#include "isotherm/slam/graph/trajectory.hpp"
#include "isotherm/slam/optimize/optimize.hpp"
#include "isotherm/slam/prune/induce.hpp"
#include "isotherm/slam/prune/odometry_chi2.hpp"
#include "report/build/candidate_columns.hpp"
#include "report/build/prune_words.hpp"
#include "report/build/report_layout.hpp"
#include "report/build/spectral_report.hpp"
#include "report/build/truth_alignment.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;

template <class Pose>
class Explainer {
 public:
  Explainer(const PoseGraph<Pose>& graph, const PipelineResult<PoseGraph<Pose>>& result,
            const PruneRun<Pose>& run, const RunContext& context)
      : graph_(graph),
        roles_(result.roles),
        decisions_(result.decisions),
        map_(result.pruned.poses),
        optimized_(*result.optimized),
        run_(run),
        context_(context) {}

  Report explain() && {
    start();
    add_candidates();
    add_layout("before",
               graph_.poses.empty() ? "Before: the chain of odometry, with all loops"
                                    : "Before: poses as in the file, with all loops",
               trajectory_of(graph_).poses);
    add_layout("after", "After: optimised without the pruned loops", map_);
    add_path();
    add_spectral();
    add_words();
    return std::move(report_);
  }

 private:
  void start() {
    report_.kind = ReportKind::pose_graph;
    report_.title = run_.title;
    report_.dimension = Pose::kDim;
    report_.unit = "m";
    report_.nouns = {"pose", "poses", "loop", "loops", "odometry"};
    report_.options = options_to_json(run_.options.prune);
    report_.warnings = decisions_.warnings;
    if (!graph_.ids.empty() && !robot_letter(graph_.ids.back()).empty()) {
      for (const auto id : graph_.ids) report_.node_names.push_back(vertex_name(id));
    } else {
      report_.node_ids = graph_.ids;
    }
    add_robots();
    for (const Index k : roles_.odometry) {
      report_.trusted.push_back(static_cast<std::int32_t>(graph_.constraints[k].from));
      report_.trusted.push_back(static_cast<std::int32_t>(graph_.constraints[k].to));
    }
    report_.rounds = report_rounds(decisions_);
  }

  void add_robots() {
    if (run_.robots.size() < 2) return;
    std::map<std::uint64_t, std::int32_t> position;
    for (const auto& robot : run_.robots) {
      position.emplace(robot.number, static_cast<std::int32_t>(report_.robot_names.size()));
      report_.robot_names.push_back(robot.name.empty() ? "no robot" : robot.name);
    }
    for (Index v = 0; v < graph_.vertex_count(); ++v) {
      report_.robots.push_back(position.at(graph_.robot(v)));
    }
  }

  void add_candidates() {
    auto& all = report_.candidates;
    all = report_candidates(decisions_.verdicts, [this](const spectral::EdgeVerdict& verdict) {
      const auto& constraint = graph_.constraints[verdict.edge];
      return CandidateSource{static_cast<std::int32_t>(constraint.from),
                             static_cast<std::int32_t>(constraint.to), constraint.line};
    });
    add_chi2();
    if (!decisions_.consensus.details.empty()) add_consensus();
  }

  void add_chi2() {
    ReportColumn alone{"chi2_odometry",
                       "χ² odometry",
                       "",
                       "Chi-squared of the loop against odometry alone; none where no odometry "
                       "joins its ends.",
                       {},
                       true};
    for (const auto& check : odometry_chi2(graph_, roles_)) {
      alone.values.push_back(check.connected ? static_cast<float>(check.chi2)
                                             : std::numeric_limits<float>::quiet_NaN());
    }
    ReportColumn after{"chi2_map",
                       "χ² map",
                       "",
                       "Chi-squared of the loop in the optimised map, whether it is part of it "
                       "or not.",
                       {},
                       true};
    for (const Index k : roles_.candidates) {
      const auto& constraint = graph_.constraints[k];
      const auto r = residual(constraint, map_[constraint.from], map_[constraint.to]);
      after.values.push_back(static_cast<float>(r.dot(constraint.information * r)));
    }
    report_.candidates.columns.push_back(std::move(alone));
    report_.candidates.columns.push_back(std::move(after));
  }

  void add_consensus() {
    auto& all = report_.candidates;
    ReportColumn probability{"probability", "probability", "", "Of the loop being true.", {},
                             false};
    for (const auto& verdict : decisions_.verdicts) {
      probability.values.push_back(static_cast<float>(verdict.probability));
    }
    ReportColumn evidence{"evidence",
                          "evidence",
                          "",
                          "Log of how much likelier the measurements make a true loop than a "
                          "false one.",
                          {},
                          false};
    all.conflict_offsets.push_back(0);
    for (const auto& detail : decisions_.consensus.details) {
      evidence.values.push_back(static_cast<float>(detail.evidence));
      for (const Index loop : detail.conflicts) {
        all.conflicts.push_back(static_cast<std::uint32_t>(loop));
      }
      all.conflict_offsets.push_back(static_cast<std::uint32_t>(all.conflicts.size()));
    }
    all.columns.push_back(std::move(probability));
    all.columns.push_back(std::move(evidence));
  }

  void add_layout(const std::string& key, const std::string& label,
                  const std::vector<Pose>& poses) {
    Eigen::MatrixXd rows(poses.size(), Eigen::Index{Pose::kDim});
    for (std::size_t k = 0; k < poses.size(); ++k) {
      rows.row(static_cast<Eigen::Index>(k)) = poses[k].translation().transpose();
    }
    auto layout = report_layout(key, label, rows);
    if (!run_.truth.empty()) add_truth(layout, poses);
    report_.layouts.push_back(std::move(layout));
  }

  void add_truth(ReportLayout& layout, const std::vector<Pose>& poses) {
    auto comparison = compare_with_truth(poses, run_.truth, layout.origin);
    if (!comparison) return;
    layout.truth = std::move(comparison->truth);
    layout.errors = std::move(comparison->errors);
    errors_.push_back(comparison->statistics);
  }

  void add_path() {
    double travelled = 0.0;
    for (std::size_t k = 0; k < map_.size(); ++k) {
      if (k > 0) travelled += (map_[k].translation() - map_[k - 1].translation()).norm();
      report_.path.push_back(static_cast<float>(travelled));
    }
  }

  void add_spectral() {
    const auto* own = std::get_if<HeatPruneOptions>(&run_.options.prune);
    if (own == nullptr) {
      leave_out_spectral(report_);
      return;
    }
    const HeatPruneOptions& heat = *own;
    const auto induced = induce(graph_, roles_, heat.induction, context_);
    auto scales = heat.scales;
    if (scales.empty()) {
      for (const auto& round : decisions_.rounds) scales.push_back(round.scale);
    }
    const SpectralReportOptions options{
        .scales = std::move(scales), .threads = context_.threads, .progress = context_.progress};
    std::vector<spectral::VertexPair> pairs;
    for (const Index k : roles_.candidates) {
      pairs.push_back({graph_.constraints[k].from, graph_.constraints[k].to});
    }
    report_.spectrum = report_spectrum(induced.graph, options);
    report_.heat = report_heat(induced.graph, pairs, report_.candidates.verdict, options);
    const std::string weights =
        fmt::format(" Odometry weighs {}, loops by {}.", heat.induction.odometry_weight,
                    enum_name(heat.induction.weights));
    report_.heat.note += weights;
    report_.spectrum.note += weights;
    for (const auto& round : decisions_.rounds) report_.heat.thresholds.push_back(round.threshold);
  }

  void add_words() {
    const auto& asked = run_.options.prune;
    report_.summary = {
        {"What came in", words_of_input()},
        {"What was decided",
         words_of_decisions(decisions_, report_.nouns, run_.options.keep_ambiguous)},
        {"The result", words_of_map()},
        {"How sure", words_of_certainty(decisions_, asked, report_.nouns)},
        {"Options",
         options_in_words(report_.options, options_to_json(prune_method(method_name(asked))))}};
    report_.truth_note = words_of_truth();
    if (optimized_.status != OptimizeStatus::converged) {
      report_.warnings.push_back(fmt::format("the optimisation of the map ended with status {}",
                                             enum_name(optimized_.status)));
    }
  }

  std::string words_of_input() const {
    return fmt::format("{}: {} in {}, {} and {}.", run_.title, counted(graph_.ids.size(), "pose"),
                       Pose::kDim == 2 ? "the plane" : "space",
                       counted(roles_.odometry.size(), "odometry edge"),
                       counted(roles_.candidates.size(), "loop closure"));
  }

  std::string words_of_map() const {
    const auto& map = optimized_;
    std::string text = fmt::format(
        "The map was optimised in {}; {} of it have a chi-squared of "
        "{:.4g} in all.",
        counted(map.iterations, "iteration"), counted(map.chi2.size(), "constraint"),
        map.chi2.sum());
    if (errors_.size() == 2) {
      text += fmt::format(
          " Its trajectory is {:.3g} m RMSE from the truth ({:.3g} m on average, "
          "{:.3g} m at most); before, it was {:.3g} m RMSE.",
          errors_[1].rmse, errors_[1].mean, errors_[1].max, errors_[0].rmse);
    }
    return text;
  }

  std::string words_of_truth() const {
    if (run_.truth.empty()) return "No ground truth was given (--ground-truth FILE).";
    if (errors_.empty()) return "The ground truth has no pose for any vertex.";
    return fmt::format(
        "Distance of {} poses from their true positions, after the rigid motion "
        "that makes it least (ATE).",
        errors_.back().pairs);
  }

  const PoseGraph<Pose>& graph_;
  const EdgeRoles& roles_;
  const PruneResult& decisions_;
  const std::vector<Pose>& map_;
  const OptimizeSummary& optimized_;
  const PruneRun<Pose>& run_;
  const RunContext& context_;
  std::vector<ErrorStatistics> errors_;  // before and after, if there is truth
  Report report_;
};

}  // namespace

template <class Pose>
Report pose_graph_report(const PoseGraph<Pose>& graph,
                         const PipelineResult<PoseGraph<Pose>>& result, const PruneRun<Pose>& run,
                         const RunContext& context) {
  if (!result.optimized) throw InvalidArgument("optimize", "a report needs the optimised map");
  return Explainer<Pose>(graph, result, run, context).explain();
}

template Report pose_graph_report(const PoseGraph<Pose2>&, const PipelineResult<PoseGraph<Pose2>>&,
                                  const PruneRun<Pose2>&, const RunContext&);
template Report pose_graph_report(const PoseGraph<Pose3>&, const PipelineResult<PoseGraph<Pose3>>&,
                                  const PruneRun<Pose3>&, const RunContext&);

}  // namespace isotherm::apps
