#include <cctype>
#include <map>
#include <string>
#include <utility>

#include "io/pose_fields.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/slam/io/trajectory_file.hpp"

namespace isotherm::slam {
namespace {

class TrajectoryReader {
 public:
  TrajectoryReader(TextReader& text, FileFormat format, const ReadOptions& options,
                   ReadReport& report)
      : text_(text), format_(format), report_(report), fields_(text, options, report) {}

  AnyTrajectory run() {
    text_.set_separator(',');
    if (format_ == FileFormat::points) return positions();
    if (format_ == FileFormat::planar) return rows<Pose2>();
    return rows<Pose3>();
  }

 private:
  template <class Pose>
  Trajectory<Pose> rows() {
    Trajectory<Pose> trajectory;
    while (next_row()) {
      if (trajectory.poses.empty()) stamped_ = first_row_has_stamp();
      if (stamped_) add_stamp(trajectory.timestamps);
      if constexpr (Pose::kDim == 2) {
        trajectory.poses.push_back(fields_.planar());
      } else {
        trajectory.poses.push_back(spatial_pose());
      }
      text_.expect_line_end();
    }
    fields_.finish();
    report_.records["pose"] = trajectory.poses.size();
    return trajectory;
  }

  // libRSF: `point2 time x y covariance...` and, for some or all times, `angle
  // time theta variance`.
  Trajectory<Pose2> positions() {
    Trajectory<Pose2> trajectory;
    std::map<double, double> headings;
    while (next_row()) {
      const auto tag = text_.word();
      if (tag == "point2") {
        add_stamp(trajectory.timestamps);
        const double x = text_.number("x");
        trajectory.poses.emplace_back(x, text_.number("y"), 0.0);
      } else if (tag == "angle") {
        const double stamp = text_.number("a time stamp");
        headings[stamp] = fields_.angle();
      } else {
        text_.fail("expected point2 or angle");
      }
      while (!text_.at_line_end()) text_.number("a covariance");
    }
    fields_.finish();
    report_.records["pose"] = trajectory.poses.size();
    set_headings(headings, trajectory);
    return trajectory;
  }

  void set_headings(const std::map<double, double>& headings, Trajectory<Pose2>& trajectory) {
    for (std::size_t k = 0; k < trajectory.poses.size(); ++k) {
      const auto found = headings.find(trajectory.timestamps[k]);
      if (found != headings.end()) {
        trajectory.poses[k] = {trajectory.poses[k].translation(), found->second};
      } else {
        report_.add_note({"heading not known",
                          {text_.path(), 0, 0},
                          format_number(trajectory.timestamps[k]),
                          "no heading for this time; set to 0"});
      }
    }
  }

  // Goes to the next line that is neither empty, a comment nor column names.
  bool next_row() {
    while (text_.next_line()) {
      if (text_.at_line_end() || text_.line().starts_with('#')) continue;
      const bool names = rows_ == 0 && format_ != FileFormat::points &&
                         std::isalpha(static_cast<unsigned char>(text_.line()[0])) != 0;
      ++rows_;
      if (!names) return true;
    }
    return false;
  }

  // KITTI rows come with and without a time stamp; every other format has one.
  bool first_row_has_stamp() {
    if (format_ != FileFormat::kitti) return true;
    int count = 0;
    TextReader row(text_.path(), text_.line());
    row.next_line();
    while (!row.word().empty()) ++count;
    return count == 13;
  }

  void add_stamp(std::vector<double>& stamps) {
    const double ticks_per_second = format_ == FileFormat::euroc ? 1e9 : 1.0;
    const double stamp = text_.number("a time stamp") / ticks_per_second;
    if (!stamps.empty() && stamp <= stamps.back()) {
      report_.add_note({"time stamp not increasing", text_.location(), format_number(stamp),
                        "time stamp is not later than the one before"});
    }
    stamps.push_back(stamp);
  }

  Pose3 spatial_pose() {
    if (format_ == FileFormat::kitti) return fields_.matrix();
    if (format_ == FileFormat::tum) return fields_.spatial();
    const double x = text_.number("x");
    const double y = text_.number("y");
    const double z = text_.number("z");
    const Pose3 pose({x, y, z}, fields_.quaternion(true));
    // Velocity and biases may follow; they are not part of a trajectory.
    while (!text_.at_line_end()) text_.number("a state");
    return pose;
  }

  TextReader& text_;
  FileFormat format_;
  ReadReport& report_;
  detail::PoseFields fields_;
  std::uint64_t rows_ = 0;
  bool stamped_ = false;
};

TrajectoryFile from_pose_graph(TextReader& reader, FileFormat format, const ReadOptions& options) {
  auto file = read_pose_graph(reader, format, options);
  TrajectoryFile result;
  result.report = std::move(file.report);
  std::visit([&](const auto& graph) { result.trajectory = trajectory_of(graph); }, file.graph);
  return result;
}

}  // namespace

TrajectoryFile read_trajectory(TextReader& reader, const ReadOptions& options) {
  return read_trajectory(reader, detect_format(reader), options);
}

TrajectoryFile read_trajectory(TextReader& reader, FileFormat format, const ReadOptions& options) {
  options.validate();
  if (content_of(format) == FileContent::pose_graph || format == FileFormat::pyfg) {
    return from_pose_graph(reader, format, options);
  }
  TrajectoryFile file;
  file.report.path = reader.path();
  file.report.format = enum_name(format);
  if (content_of(format) != FileContent::trajectory) {
    const std::string start = reader.peek().empty() ? "the file is empty" : "unknown format";
    throw ParseError({reader.path(), 0, 0}, "",
                     start +
                         "; expected a trajectory in TUM, KITTI or EuRoC format, rows of time "
                         "x y theta, or a pose graph");
  }
  file.trajectory = TrajectoryReader(reader, format, options, file.report).run();
  file.report.lines = reader.line_number();
  if (file.report.records["pose"] == 0) {
    throw ParseError({reader.path(), 0, 0}, "", "no pose");
  }
  return file;
}

TrajectoryFile read_trajectory(const std::string& path, const ReadOptions& options) {
  TextReader reader(path);
  return read_trajectory(reader, options);
}

std::vector<double> read_timestamps(const std::string& path) {
  TextReader reader(path);
  std::vector<double> times;
  while (reader.next_line()) {
    if (reader.at_line_end()) continue;
    times.push_back(reader.number("a time in seconds"));
  }
  return times;
}

}  // namespace isotherm::slam
