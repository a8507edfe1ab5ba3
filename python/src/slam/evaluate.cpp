#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "isotherm/slam/evaluate/evaluate_loops.hpp"
#include "isotherm/slam/evaluate/ground_truth.hpp"
#include "isotherm/slam/evaluate/trajectory_metrics.hpp"
#include "isotherm/slam/io/trajectory_file.hpp"
#include "keywords.hpp"
#include "modules.hpp"
#include "slam/labels.hpp"
#include "slam/pose_arrays.hpp"
#include "slam/pose_graph.hpp"
#include "verdicts.hpp"

namespace isotherm::python {
namespace {

using namespace nanobind::literals;
using namespace slam;

std::vector<std::string> label_texts(const Labels& labels) {
  std::vector<std::string> texts;
  for (const auto& row : labels.rows) texts.emplace_back(enum_name(row.label));
  return texts;
}

View2<std::uint64_t> label_ends(const Labels& labels) {
  const std::uint64_t* const first = labels.rows.empty() ? nullptr : &labels.rows[0].from;
  return strided_rows(first, labels.rows.size(), 2, sizeof(EdgeLabel), nb::find(labels));
}

nb::object label_frame(nb::handle_t<Labels> self) {
  const auto& labels = nb::cast<const Labels&>(self);
  const nb::dict columns;
  columns["edge"] = member_view(labels.rows, &EdgeLabel::edge, self);
  columns["from"] = member_view(labels.rows, &EdgeLabel::from, self);
  columns["to"] = member_view(labels.rows, &EdgeLabel::to, self);
  columns["label"] = label_texts(labels);
  return data_frame(columns);
}

Labels label_graph(const PoseGraphFile& graph, nb::handle truth, nb::kwargs given) {
  Keywords keywords("label", std::move(given));
  LabelOptions options;
  keywords.take_fields(options);
  keywords.finish();
  return std::visit(
      [&](const auto& own) {
        using Pose = std::decay_t<decltype(own.constraints[0].T_from_to)>;
        const auto known = known_poses_from<Pose>(truth, "truth");
        return Labels{label_candidates(own, edge_roles(own), known, options)};
      },
      graph.graph);
}

PoseRows truth_of(const PoseGraphFile& graph, nb::handle path, nb::handle timestamps,
                  double max_gap, const std::string& axes, bool partial) {
  GroundTruthSource source;
  source.path = path_of(path);
  if (!timestamps.is_none()) source.timestamps = path_of(timestamps);
  source.max_gap = max_gap;
  source.axes = enum_value<Axes>("axes", axes);
  source.partial = partial;
  return std::visit(
      [&source](const auto& own) { return give_poses(read_ground_truth(own, source)); },
      graph.graph);
}

// Poses that have a true one, whichever dimension they have.
template <class Metric>
auto compare(nb::handle estimate, nb::handle truth, Metric metric) {
  if (pose_dimension(estimate, "estimate") == Pose3::kDim) {
    return metric(pair_poses(poses_from<Pose3>(estimate, "estimate"),
                             known_poses_from<Pose3>(truth, "truth")));
  }
  return metric(
      pair_poses(poses_from<Pose2>(estimate, "estimate"), known_poses_from<Pose2>(truth, "truth")));
}

ErrorStatistics absolute_error(nb::handle estimate, nb::handle truth,
                               const std::string& alignment) {
  const auto by = enum_value<Alignment>("alignment", alignment);
  return compare(estimate, truth,
                 [by](const auto& pairs) { return absolute_trajectory_error(pairs, by); });
}

RelativeError relative_error(nb::handle estimate, nb::handle truth, nb::kwargs given) {
  Keywords keywords("relative_pose_error", std::move(given));
  RelativeErrorOptions options;
  keywords.take_fields(options);
  keywords.finish();
  return compare(estimate, truth,
                 [&options](const auto& pairs) { return relative_pose_error(pairs, options); });
}

nb::tuple read_poses(nb::handle path, bool strict) {
  auto file = read_trajectory(path_of(path), {.strict = strict});
  return std::visit(
      [](auto& trajectory) {
        nb::object times = nb::none();
        if (!trajectory.timestamps.empty()) {
          times = nb::cast(give(std::move(trajectory.timestamps)));
        }
        return nb::make_tuple(give_poses(trajectory.poses), times);
      },
      file.trajectory);
}

template <class Pose>
AnyTrajectory trajectory_from(nb::handle poses, nb::handle timestamps) {
  Trajectory<Pose> trajectory;
  trajectory.poses = poses_from<Pose>(poses, "poses");
  if (!timestamps.is_none()) {
    trajectory.timestamps = number_list<double>(timestamps, "timestamps");
  }
  return trajectory;
}

void write_poses(nb::handle path, nb::handle poses, nb::handle timestamps,
                 const std::string& format) {
  const bool space = pose_dimension(poses, "poses") == Pose3::kDim;
  write_trajectory(
      path_of(path),
      space ? trajectory_from<Pose3>(poses, timestamps) : trajectory_from<Pose2>(poses, timestamps),
      enum_value<FileFormat>("format", format));
}

void bind_labels(nb::module_& module) {
  nb::class_<Labels> bound(module, "Labels",
                           "What ground truth says about the candidates of a graph.");
  bound.def("__len__", [](const Labels& self) { return self.rows.size(); })
      .def_prop_ro(
          "edge",
          [](const Labels& self) {
            return member_view(self.rows, &EdgeLabel::edge, nb::find(self));
          },
          "Positions among the edges of the graph.")
      .def_prop_ro("ends", label_ends, "The ids that each joins, m x 2.")
      .def_prop_ro("label", label_texts, "'correct', 'incorrect' or 'ignore'.")
      .def(
          "write",
          [](const Labels& self, nb::handle path) { write_labels(path_of(path), self.rows); },
          "path"_a, nb::sig("def write(self, path: str | os.PathLike[str]) -> None"),
          "Write a label file, as CSV.");
  bind_data_frame(bound, label_frame, "edge, from, to and label");
  module.def(
      "read_labels", [](nb::handle path) { return Labels{read_labels(path_of(path))}; }, "path"_a,
      nb::sig("def read_labels(path: str | os.PathLike[str]) -> Labels"), "Read a label file.");
  define(module, "label", "graph: PoseGraph, truth: numpy.typing.ArrayLike",
         keywords_of(LabelOptions()), "Labels",
         "Label every candidate by the true poses of its ends (n x 3 or n x 7; NaN where not "
         "known).",
         label_graph, "graph"_a, "truth"_a);
}

void bind_metrics(nb::module_& module) {
  nb::class_<LoopMetrics>(module, "LoopMetrics",
                          "How good pruning was; a positive is an edge that was pruned.")
      .def_ro("tp", &LoopMetrics::tp, "Incorrect edges that were pruned.")
      .def_ro("fp", &LoopMetrics::fp, "Correct edges that were pruned.")
      .def_ro("fn", &LoopMetrics::fn, "Incorrect edges that were not.")
      .def_ro("tn", &LoopMetrics::tn, "Correct edges that were not.")
      .def_ro("ambiguous", &LoopMetrics::ambiguous, "How many of fn and tn are ambiguous.")
      .def_ro("ignored", &LoopMetrics::ignored, "Edges that count nowhere.")
      .def_ro("auc", &LoopMetrics::auc,
              "Chance that an incorrect edge has a higher score than a correct one.")
      .def_prop_ro("precision", &LoopMetrics::precision, "tp / (tp + fp); 1 if none was pruned.")
      .def_prop_ro("recall", &LoopMetrics::recall, "tp / (tp + fn); 1 if none is incorrect.")
      .def_prop_ro("f1", &LoopMetrics::f1, "Harmonic mean of precision and recall.");
  nb::class_<ErrorStatistics>(module, "ErrorStatistics", "Errors in numbers.")
      .def_ro("pairs", &ErrorStatistics::pairs, "How many errors.")
      .def_ro("mean", &ErrorStatistics::mean, "Mean.")
      .def_ro("rmse", &ErrorStatistics::rmse, "Root of the mean square.")
      .def_ro("median", &ErrorStatistics::median, "Median.")
      .def_ro("max", &ErrorStatistics::max, "Largest.")
      .def_ro("min", &ErrorStatistics::min, "Smallest.")
      .def_ro("std", &ErrorStatistics::std, "Standard deviation.");
  nb::class_<RelativeError>(module, "RelativeError", "How far motions are from the true ones.")
      .def_ro("translation", &RelativeError::translation, "Metres.")
      .def_ro("rotation", &RelativeError::rotation, "Radians.");
  module.def(
      "evaluate_loops",
      [](const Verdicts& verdicts, const Labels& labels) {
        return evaluate_loops(verdicts.rows, labels.rows);
      },
      "verdicts"_a, "labels"_a,
      nb::sig("def evaluate_loops(verdicts: isotherm._core.spectral.Verdicts, labels: Labels) -> "
              "LoopMetrics"),
      "Compare verdicts with labels of the same edges.");
}

const std::string kTwoTrajectories =
    "estimate: numpy.typing.ArrayLike, truth: numpy.typing.ArrayLike";

void bind_trajectories(nb::module_& module) {
  const std::string path = "path: str | os.PathLike[str]";
  module.def("absolute_trajectory_error", absolute_error, "estimate"_a, "truth"_a,
             "alignment"_a = "se",
             nb::sig(("def absolute_trajectory_error(" + kTwoTrajectories +
                      ", alignment: typing.Literal['first', 'se', 'none'] = 'se') -> "
                      "ErrorStatistics")
                         .c_str()),
             "Distances of estimated positions from the true ones, after an alignment. Poses are n "
             "x 3 or n x 7; NaN where no truth is known.");
  define(module, "relative_pose_error", kTwoTrajectories, keywords_of(RelativeErrorOptions()),
         "RelativeError", "How far each motion over `delta` poses is from the true one.",
         relative_error, "estimate"_a, "truth"_a);
  module.def("read_trajectory", read_poses, "path"_a, nb::kw_only(), "strict"_a = false,
             nb::sig(("def read_trajectory(" + path +
                      ", *, strict: bool = False) -> tuple[numpy.typing.NDArray[numpy.float64], "
                      "numpy.typing.NDArray[numpy.float64] | None]")
                         .c_str()),
             "Read poses and, if the file has them, their times.");
  module.def("write_trajectory", write_poses, "path"_a, "poses"_a, "timestamps"_a = nb::none(),
             nb::kw_only(), "format"_a = "tum",
             nb::sig(("def write_trajectory(" + path +
                      ", poses: numpy.typing.ArrayLike, timestamps: numpy.typing.ArrayLike | None "
                      "= None, *, format: typing.Literal['tum', 'kitti', 'euroc', 'planar'] = "
                      "'tum') -> None")
                         .c_str()),
             "Write poses; where the format needs times and there are none, pose k has time k.");
  module.def("read_ground_truth", truth_of, "graph"_a, "path"_a, "timestamps"_a = nb::none(),
             nb::kw_only(), "max_gap"_a = 0.0, "axes"_a = "automatic", "partial"_a = false,
             nb::sig(("def read_ground_truth(graph: PoseGraph, " + path +
                      ", timestamps: str | os.PathLike[str] | None = None, *, max_gap: float = "
                      "0.0, axes: typing.Literal['automatic', 'vehicle', 'camera'] = 'automatic', "
                      "partial: bool = False) -> numpy.typing.NDArray[numpy.float64]")
                         .c_str()),
             "The true pose of every vertex, n x 3 or n x 7; NaN where there is none.");
}

}  // namespace

void bind_evaluate(nb::module_& module) {
  bind_labels(module);
  bind_metrics(module);
  bind_trajectories(module);
}

}  // namespace isotherm::python
