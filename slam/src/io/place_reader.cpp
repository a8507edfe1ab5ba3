#include "io/place_reader.hpp"

#include <algorithm>
#include <cmath>

namespace isotherm::slam::detail {
namespace {

// A recognised place says that two poses are close, not how they look at each
// other: a standard deviation of one metre, and nothing about the heading.
Pose2::Matrix place_information() { return Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal(); }

class PlaceReader {
 public:
  explicit PlaceReader(TextReader& text) : text_(text) {
    file_.report.path = text.path();
    file_.paths = {text.path()};
    file_.report.format = "places";
  }

  PoseGraphFile run() {
    while (text_.next_line()) read_line();
    file_.report.lines = text_.line_number();
    if (times_.empty()) {
      throw ParseError({text_.path(), 0, 0}, "", "no odom2 line; expected velocities over time");
    }
    for (const auto& place : places_) add_loop(place);
    file_.graph = std::move(graph_);
    return std::move(file_);
  }

 private:
  struct Place {
    double from = 0.0;
    double to = 0.0;
    SourceLocation where;
  };

  void read_line() {
    const auto tag = text_.word();
    if (tag.empty()) return;
    if (tag == "odom2") {
      ++file_.report.records["odom2"];
      read_velocity();
      text_.expect_line_end();
    } else if (tag == "loop") {
      ++file_.report.records["loop"];
      read_place();
      text_.expect_line_end();
    } else if (tag.front() == '#') {
      file_.other_lines.emplace_back(text_.line());
    } else {
      text_.fail("expected odom2 or loop");
    }
  }

  // odom2 time vx vy turn_rate and the variances of the three: how the robot moved
  // since the time of the line before.
  void read_velocity() {
    const double time = text_.number("a time stamp");
    if (!times_.empty() && !(time > times_.back())) text_.fail("expected a later time stamp");
    Pose2::Tangent velocity;
    for (double& entry : velocity) entry = text_.number("a velocity");
    Pose2::Tangent variance;
    for (double& entry : variance) {
      entry = text_.number("a variance");
      if (!(entry > 0.0)) text_.fail("expected a variance > 0");
    }
    if (times_.empty()) {
      graph_.poses.emplace_back();
    } else {
      add_step(time - times_.back(), velocity, variance);
    }
    graph_.ids.push_back(times_.size());
    times_.push_back(time);
  }

  void add_step(double seconds, const Pose2::Tangent& velocity, const Pose2::Tangent& variance) {
    auto& step = graph_.constraints.emplace_back();
    step.to = graph_.vertex_count();
    step.from = step.to - 1;
    step.T_from_to = Pose2::exp(seconds * velocity);
    step.information = (seconds * seconds * variance).cwiseInverse().asDiagonal();
    step.line = text_.line_number();
    graph_.poses.push_back(graph_.poses.back() * step.T_from_to);
  }

  void read_place() {
    Place place;
    place.from = text_.number("a time stamp");
    place.where = text_.location();
    place.to = text_.number("a time stamp");
    const double similarity = text_.number("a similarity");
    if (similarity < 0.0 || similarity > 1.0) text_.fail("expected a similarity in [0, 1]");
    places_.push_back(place);
  }

  void add_loop(const Place& place) {
    Constraint<Pose2> loop;
    loop.from = nearest(place.from, place.where);
    loop.to = nearest(place.to, place.where);
    loop.information = place_information();
    loop.line = place.where.line;
    if (loop.from == loop.to) {
      file_.report.add_note(
          {"self edge", place.where, std::to_string(loop.to), "edge from a vertex to itself"});
    }
    graph_.constraints.push_back(loop);
  }

  // Places are stamped by another clock than odometry.
  Index nearest(double time, const SourceLocation& where) const {
    constexpr double kFarthest = 1.0;  // seconds
    const auto after = std::lower_bound(times_.begin(), times_.end(), time);
    auto best = after == times_.end() ? after - 1 : after;
    if (after != times_.begin() && time - *(after - 1) <= std::abs(*best - time)) best = after - 1;
    if (std::abs(*best - time) > kFarthest) {
      throw ParseError(where, "", "no odometry within a second of this time");
    }
    return static_cast<Index>(best - times_.begin());
  }

  TextReader& text_;
  PoseGraphFile file_;
  PoseGraph<Pose2> graph_;
  std::vector<double> times_;
  std::vector<Place> places_;
};

}  // namespace

PoseGraphFile read_places(TextReader& text) { return PlaceReader(text).run(); }

}  // namespace isotherm::slam::detail
