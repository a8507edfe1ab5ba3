#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/pose_fields.hpp"
#include "isotherm/base/json_reader.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam::detail {

/// A value of a JRL file as it stands there: a pose, or something else.
struct JrlValue {
  std::string type;
  std::optional<double> x;
  std::optional<double> y;
  std::optional<double> theta;
  std::vector<double> translation;
  std::vector<double> rotation;  // w x y z
  SourceLocation where;
};

JrlValue read_jrl_value(JsonReader& json);

/// A measurement of a JRL file as it stands there.
struct JrlMeasurement {
  std::string type;
  std::optional<VertexId> from;
  std::optional<VertexId> to;
  JrlValue value;
  std::vector<double> covariance;
  SourceLocation where;
  SourceLocation covariance_where;
};

/// @throws ParseError if it has no type
JrlMeasurement read_jrl_measurement(JsonReader& json);

/// @throws ParseError if it is none
template <class Pose>
Pose jrl_pose(const JrlValue& value, PoseRepairs& repairs);

/// What is measured between two poses; its ends are not set.
/// @throws ParseError if something is missing
template <class Pose>
Constraint<Pose> jrl_constraint(const JrlMeasurement& measurement, PoseRepairs& repairs);

}  // namespace isotherm::slam::detail
