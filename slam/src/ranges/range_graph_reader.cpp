#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>

#include "io/pose_fields.hpp"
#include "isotherm/slam/ranges/range_graph_file.hpp"
#include "matrices/decompositions.hpp"

namespace isotherm::slam {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

bool next_record(TextReader& text) {
  while (text.next_line()) {
    if (!text.at_line_end() && !text.line().starts_with('#')) return true;
  }
  return false;
}

// Collects nodes by name.
template <class Pose>
class RangeGraphDraft {
 public:
  RangeGraph<Pose> graph;

  Index node(std::string_view name) {
    const auto [entry, added] = indices_.try_emplace(std::string(name), graph.node_count());
    if (added) {
      graph.names.push_back(entry->first);
      graph.positions.emplace_back();
      graph.placed.push_back(false);
      graph.is_point.push_back(true);  // until a step or a heading says otherwise
      graph.stamps.push_back(kNotKnown);
    }
    return entry->second;
  }

  void add_step(Index from, Index to, const Pose& T_from_to,
                const typename Pose::Matrix& covariance, std::uint64_t line) {
    graph.is_point[from] = graph.is_point[to] = false;
    graph.steps.push_back({from, to, T_from_to, covariance.inverse(), line});
  }

 private:
  std::unordered_map<std::string, Index> indices_;
};

double range_length(TextReader& text) {
  const double distance = text.number("a distance");
  if (distance < 0.0) text.fail("expected a distance >= 0");
  return distance;
}

double range_variance(TextReader& text) {
  const double variance = text.number("a variance");
  if (variance < 0.0) text.fail("expected a variance >= 0");
  return variance;
}

template <class Pose>
struct PyfgTags;
template <>
struct PyfgTags<Pose2> {
  static constexpr std::string_view kPose = "VERTEX_SE2";
  static constexpr std::string_view kPoint = "VERTEX_XY";
  static constexpr std::string_view kStep = "EDGE_SE2";
};
template <>
struct PyfgTags<Pose3> {
  static constexpr std::string_view kPose = "VERTEX_SE3:QUAT";
  static constexpr std::string_view kPoint = "VERTEX_XYZ";
  static constexpr std::string_view kStep = "EDGE_SE3:QUAT";
};

template <class Pose>
class PyfgGraphReader {
 public:
  PyfgGraphReader(TextReader& text, const ReadOptions& options, ReadReport& report)
      : text_(text), report_(report), fields_(text, options, report) {}

  RangeGraph<Pose> run() {
    do {
      read_record();
    } while (next_record(text_));
    fields_.finish();
    return std::move(draft_.graph);
  }

 private:
  using Tags = PyfgTags<Pose>;
  using Other = PyfgTags<std::conditional_t<Pose::kDim == 2, Pose3, Pose2>>;

  void read_record() {
    const std::string tag(text_.word());
    if (tag == Tags::kPose) {
      pose();
    } else if (tag == Tags::kPoint) {
      point();
    } else if (tag == std::string(Tags::kPose) + ":PRIOR") {
      pose_prior();
    } else if (tag == std::string(Tags::kPoint) + ":PRIOR") {
      point_prior();
    } else if (tag == Tags::kStep) {
      step();
    } else if (tag == "EDGE_RANGE") {
      range();
    } else if (tag == Other::kPose || tag == Other::kPoint || tag == Other::kStep) {
      text_.fail("record of another dimension than those before");
    } else if (std::isalpha(static_cast<unsigned char>(tag.front())) == 0) {
      text_.fail("expected a record tag such as EDGE_RANGE");
    } else {
      ++report_.skipped[tag];
      return;
    }
    text_.expect_line_end();
    ++report_.records[tag];
  }

  Pose pose_fields() {
    if constexpr (Pose::kDim == 2) {
      return fields_.planar();
    } else {
      return fields_.spatial();
    }
  }

  Pose point_fields() {
    typename Pose::Translation place;
    for (int i = 0; i < Pose::kDim; ++i) place[i] = text_.number("a coordinate");
    if constexpr (Pose::kDim == 2) {
      return {place, 0.0};
    } else {
      return {place, Eigen::Quaterniond::Identity()};
    }
  }

  // The upper triangle by rows.
  template <int Size>
  Eigen::Matrix<double, Size, Size> covariance_fields() {
    Eigen::Matrix<double, Size, Size> covariance;
    const auto where = text_.location();
    for (int i = 0; i < Size; ++i) {
      for (int j = i; j < Size; ++j) {
        covariance(i, j) = covariance(j, i) = text_.number("an entry of the covariance");
      }
    }
    const Eigen::LLT<Eigen::Matrix<double, Size, Size>> cholesky(covariance);
    if (cholesky.info() != Eigen::Success) {
      throw ParseError(where, "", "expected a covariance that is positive definite");
    }
    return covariance;
  }

  void place(Index node, const Pose& where) {
    if (draft_.graph.placed[node]) text_.fail("vertex already given");
    draft_.graph.placed[node] = true;
    draft_.graph.positions[node] = where;
  }

  void pose() {
    const double time = text_.number("a time stamp");
    const Index node = draft_.node(text_.word("a name"));
    draft_.graph.stamps[node] = time;
    draft_.graph.is_point[node] = false;
    place(node, pose_fields());
  }

  // A landmark may have a time stamp, or none.
  Index point_name() {
    auto name = text_.word("a time stamp or a name");
    double time = 0.0;
    if (parse_number(name, time)) name = text_.word("a name");
    return draft_.node(name);
  }

  void point() {
    const Index node = point_name();
    place(node, point_fields());
  }

  void pose_prior() {
    text_.number("a time stamp");
    AbsolutePose<Pose> prior;
    prior.node = draft_.node(text_.word("a name"));
    prior.T_world_node = pose_fields();
    prior.information = covariance_fields<Pose::kDof>().inverse();
    draft_.graph.priors.push_back(prior);
  }

  void point_prior() {
    AbsolutePose<Pose> prior;
    prior.node = point_name();
    prior.T_world_node = point_fields();
    prior.information.template topLeftCorner<Pose::kDim, Pose::kDim>() =
        covariance_fields<Pose::kDim>().inverse();
    draft_.graph.priors.push_back(prior);
  }

  void step() {
    text_.number("a time stamp");
    const Index from = draft_.node(text_.word("the name of the first pose"));
    const Index to = draft_.node(text_.word("the name of the second pose"));
    if (from == to) text_.fail("expected another pose than the first");
    const Pose T_from_to = pose_fields();
    draft_.add_step(from, to, T_from_to, covariance_fields<Pose::kDof>(), text_.line_number());
  }

  void range() {
    network::RangeMeasurement measurement;
    measurement.timestamp = text_.number("a time stamp");
    measurement.from = draft_.node(text_.word("the name of the first node"));
    measurement.to = draft_.node(text_.word("the name of the second node"));
    if (measurement.from == measurement.to) text_.fail("expected another node than the first");
    measurement.distance = range_length(text_);
    measurement.variance = range_variance(text_);
    measurement.line = text_.line_number();
    draft_.graph.ranges.push_back(measurement);
  }

  TextReader& text_;
  ReadReport& report_;
  detail::PoseFields fields_;
  RangeGraphDraft<Pose> draft_;
};

// Differential drive odometry and ranges to beacons, each with its time.
class LibrsfGraphReader {
 public:
  LibrsfGraphReader(TextReader& text, ReadReport& report) : text_(text), report_(report) {}

  RangeGraph<Pose2> run() {
    do {
      const std::string tag(text_.word());
      if (tag == "odom2diff") {
        step();
      } else if (tag == "range2") {
        range();
      } else {
        ++report_.skipped[tag];
        continue;
      }
      ++report_.records[tag];
    } while (next_record(text_));
    attach_ranges();
    return std::move(draft_.graph);
  }

 private:
  // The velocities hold since the step before; what came before the first is not known, so that it
  // takes no time. libRSF's own factor has turns to the left where the second wheel is faster, and
  // wheels twice the stated length apart: its data sets are so, whatever their descriptions say.
  void step() {
    const double time = text_.number("a time stamp");
    const double first = text_.number("the velocity of a wheel");
    const double second = text_.number("the velocity of the other wheel");
    const double sideways = text_.number("a velocity sideways");
    const double arm = text_.number("half the distance between wheels");
    if (!(arm > 0.0)) text_.fail("expected a distance > 0");
    Eigen::Vector3d variance;
    for (double& value : variance) {
      value = text_.number("a variance");
      if (!(value > 0.0)) text_.fail("expected a variance > 0");
    }
    text_.expect_line_end();
    const Index to = draft_.node(std::to_string(draft_.graph.node_count()));
    draft_.graph.stamps[to] = time;
    draft_.graph.is_point[to] = false;
    if (!pose_at_.emplace(time, to).second) text_.fail("two steps at one time");
    if (to == 0) return;
    const double passed = time - draft_.graph.stamps[to - 1];
    if (!(passed > 0.0)) text_.fail("expected a later time than that of the step before");
    const Pose2 moved = Pose2::exp(
        passed * Eigen::Vector3d(0.5 * (first + second), sideways, 0.5 * (second - first) / arm));
    // Of the two wheels: mean and difference.
    Eigen::Matrix3d of_wheels;
    of_wheels << 0.5, 0.5, 0.0, 0.0, 0.0, 1.0, -0.5 / arm, 0.5 / arm, 0.0;
    const Eigen::Matrix3d jacobian = passed * of_wheels;
    draft_.add_step(to - 1, to, moved, jacobian * variance.asDiagonal() * jacobian.transpose(),
                    text_.line_number());
  }

  struct BeaconRange {
    network::RangeMeasurement measurement;
    std::string beacon;
    Eigen::Vector2d place;
    SourceLocation where;
  };

  void range() {
    BeaconRange range;
    range.measurement.timestamp = text_.number("a time stamp");
    range.where = text_.location();
    range.measurement.distance = range_length(text_);
    range.measurement.variance = range_variance(text_);
    range.place.x() = text_.number("the x of the anchor");
    range.place.y() = text_.number("the y of the anchor");
    range.beacon = "L";
    range.beacon += text_.word("the id of the anchor");
    while (!text_.at_line_end()) text_.number("a signal strength");
    range.measurement.line = text_.line_number();
    ranges_.push_back(range);
  }

  // Steps may come behind the ranges of their time.
  void attach_ranges() {
    for (auto& range : ranges_) {
      const auto pose = pose_at_.find(range.measurement.timestamp);
      if (!pose_at_.empty() && pose == pose_at_.end()) {
        throw ParseError(range.where, "", "a range at a time without odometry");
      }
      const Index beacon = draft_.node(range.beacon);
      draft_.graph.placed[beacon] = true;
      draft_.graph.positions[beacon] = Pose2(range.place, 0.0);
      if (pose_at_.empty()) continue;
      range.measurement.from = pose->second;
      range.measurement.to = beacon;
      draft_.graph.ranges.push_back(range.measurement);
    }
  }

  TextReader& text_;
  ReadReport& report_;
  RangeGraphDraft<Pose2> draft_;
  std::map<double, Index> pose_at_;
  std::vector<BeaconRange> ranges_;
};

// PyFG files have one dimension; the first records with one tell.
bool is_spatial(std::string_view text) {
  const auto planar = std::min(text.find("SE2"), text.find("_XY "));
  const auto spatial = std::min(text.find("SE3"), text.find("_XYZ"));
  return spatial < planar;
}

}  // namespace

RangeGraphFile read_range_graph(TextReader& reader, const ReadOptions& options) {
  options.validate();
  RangeGraphFile file;
  file.report.path = reader.path();
  const bool spatial = is_spatial(reader.peek());
  if (next_record(reader)) {
    const auto line = reader.line();
    if (line.starts_with("range2") || line.starts_with("odom2diff")) {
      file.report.format = "librsf";
      file.graph = LibrsfGraphReader(reader, file.report).run();
    } else {
      file.report.format = "pyfg";
      if (spatial) {
        file.graph = PyfgGraphReader<Pose3>(reader, options, file.report).run();
      } else {
        file.graph = PyfgGraphReader<Pose2>(reader, options, file.report).run();
      }
    }
  }
  file.report.lines = reader.line_number();
  return file;
}

RangeGraphFile read_range_graph(const std::string& path, const ReadOptions& options) {
  TextReader reader(path);
  return read_range_graph(reader, options);
}

}  // namespace isotherm::slam
