#include "io/incremental/jrl_factors.hpp"

#include <tuple>
#include <utility>

#include "io/incremental/gtsam_covariance.hpp"

namespace isotherm::slam::detail {
namespace {

std::vector<double> read_numbers(JsonReader& json, const char* what) {
  std::vector<double> numbers;
  json.array(what, [&] { numbers.push_back(json.number("a number")); });
  return numbers;
}

}  // namespace

JrlValue read_jrl_value(JsonReader& json) {
  JrlValue value;
  bool first = true;
  json.object("a value", [&](const std::string& name) {
    if (std::exchange(first, false)) value.where = json.location();
    if (name == "type") {
      value.type = json.string("a type");
    } else if (name == "x") {
      value.x = json.number("x");
    } else if (name == "y") {
      value.y = json.number("y");
    } else if (name == "theta") {
      value.theta = json.number("an angle in radians");
    } else if (name == "translation") {
      value.translation = read_numbers(json, "a translation");
    } else if (name == "rotation") {
      value.rotation = read_numbers(json, "a quaternion");
    } else {
      json.skip();
    }
  });
  return value;
}

JrlMeasurement read_jrl_measurement(JsonReader& json) {
  JrlMeasurement measurement;
  json.object("a measurement", [&](const std::string& name) {
    if (measurement.where.line == 0) measurement.where = json.location();
    if (name == "type") {
      measurement.type = json.string("a type");
    } else if (name == "key1") {
      measurement.from = json.unsigned_integer("a key");
    } else if (name == "key2") {
      measurement.to = json.unsigned_integer("a key");
    } else if (name == "measurement" && json.at_object()) {
      measurement.value = read_jrl_value(json);
    } else if (name == "covariance") {
      measurement.covariance_where = json.location();
      measurement.covariance = read_numbers(json, "a covariance");
    } else {
      json.skip();
    }
  });
  if (measurement.type.empty()) json.fail("a measurement without a type");
  return measurement;
}

template <>
Pose2 jrl_pose(const JrlValue& value, PoseRepairs& repairs) {
  if (!value.x || !value.y || !value.theta) {
    throw ParseError(value.where, "", "expected a Pose2 with x, y and theta");
  }
  return {*value.x, *value.y, repairs.wrapped(*value.theta, value.where)};
}

template <>
Pose3 jrl_pose(const JrlValue& value, PoseRepairs& repairs) {
  const auto& [t, q] = std::tie(value.translation, value.rotation);
  if (t.size() != 3 || q.size() != 4) {
    throw ParseError(value.where, "",
                     "expected a Pose3 with a translation of 3 numbers and a rotation of 4");
  }
  const Eigen::Quaterniond rotation(q[0], q[1], q[2], q[3]);
  return {{t[0], t[1], t[2]}, repairs.normalised(rotation, value.where, "")};
}

template <class Pose>
Constraint<Pose> jrl_constraint(const JrlMeasurement& measurement, PoseRepairs& repairs) {
  constexpr int kDof = Pose::kDof;
  if (!measurement.from || !measurement.to) {
    throw ParseError(measurement.where, "", "expected a measurement with key1 and key2");
  }
  if (measurement.value.where.line == 0) {
    throw ParseError(measurement.where, "", "expected a measurement with a pose");
  }
  if (measurement.covariance.size() != kDof * kDof) {
    throw ParseError(measurement.where, "",
                     "expected a covariance of " + std::to_string(kDof * kDof) + " numbers");
  }
  typename Pose::Matrix covariance;
  for (int k = 0; k < kDof * kDof; ++k) {
    covariance(k / kDof, k % kDof) = measurement.covariance[static_cast<std::size_t>(k)];
  }
  Constraint<Pose> constraint;
  constraint.T_from_to = jrl_pose<Pose>(measurement.value, repairs);
  constraint.information = information_from_gtsam(covariance);
  constraint.line = measurement.where.line;
  return constraint;
}

template Constraint<Pose2> jrl_constraint(const JrlMeasurement&, PoseRepairs&);
template Constraint<Pose3> jrl_constraint(const JrlMeasurement&, PoseRepairs&);

}  // namespace isotherm::slam::detail
