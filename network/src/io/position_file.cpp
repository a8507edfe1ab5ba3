#include "isotherm/network/io/position_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "isotherm/base/csv.hpp"
#include "isotherm/base/text_writer.hpp"

namespace isotherm::network {
namespace {

constexpr std::array<std::string_view, 3> kAxes = {"x", "y", "z"};

void append_fields(std::string& row, const Eigen::VectorXd& values) {
  for (const double value : values) {
    row += ',';
    append_number(row, value);
  }
}

std::string header(int dimension) {
  std::string line = "node";
  for (int i = 0; i < dimension; ++i) (line += ',') += kAxes[i];
  return line;
}

std::string covariance_header(int dimension) {
  std::string line;
  for (int i = 0; i < dimension; ++i) {
    for (int j = i; j < dimension; ++j) ((line += ",c") += kAxes[i]) += kAxes[j];
  }
  return line;
}

bool has_position(const CsvReader& csv, std::size_t status_column) {
  const auto status = csv.text(status_column, "a status");
  return status == enum_name(NodeStatus::anchor) || status == enum_name(NodeStatus::localised);
}

}  // namespace

std::unordered_map<std::string, Eigen::Index> NamedPositions::column_of() const {
  std::unordered_map<std::string, Eigen::Index> columns;
  for (std::size_t k = 0; k < names.size(); ++k) {
    columns.emplace(names[k], static_cast<Eigen::Index>(k));
  }
  return columns;
}

NamedPositions read_positions(const std::string& path) {
  CsvReader csv(path);
  const auto node = csv.column("node", 0);
  const std::array<std::size_t, 2> plane = {csv.column("x", 1), csv.column("y", 2)};
  const auto named_z = csv.find_column("z");
  const auto status = csv.find_column("status");
  std::vector<double> numbers;
  NamedPositions result;
  std::unordered_set<std::string> seen;
  int dimension = 0;
  while (csv.next_row()) {
    if (dimension == 0) {
      dimension = named_z || (!csv.has_header() && csv.field_count() > 3) ? 3 : 2;
    }
    if (status && !has_position(csv, *status)) continue;
    std::string name(csv.text(node, "the name of a node"));
    if (!seen.insert(name).second) csv.fail(node, "node already given");
    result.names.push_back(std::move(name));
    for (const auto column : plane) numbers.push_back(csv.number(column, "a coordinate"));
    if (dimension == 3) numbers.push_back(csv.number(named_z.value_or(3), "a coordinate"));
  }
  if (dimension == 0) {
    throw ParseError({path, 0, 0}, "", "no position; expected rows of node,x,y or node,x,y,z");
  }
  result.positions = Eigen::Map<const Eigen::MatrixXd>(
      numbers.data(), dimension, static_cast<Eigen::Index>(result.names.size()));
  return result;
}

void write_positions(const std::string& path, const NamedPositions& positions) {
  OutputFile file(path);
  file.write(header(positions.dimension()) + "\n");
  for (std::size_t k = 0; k < positions.names.size(); ++k) {
    std::string row = positions.names[k];
    append_fields(row, positions.positions.col(static_cast<Eigen::Index>(k)));
    file.write(row + "\n");
  }
  file.commit();
}

void write_positions(const std::string& path, const RangeNetwork& network,
                     const LocalizeResult& result) {
  const auto d = static_cast<int>(result.positions.rows());
  OutputFile file(path);
  file.write(header(d) + ",status,sigma" + covariance_header(d) + "\n");
  for (Index v = 0; v < network.node_count(); ++v) {
    const auto status = result.nodes[v];
    Eigen::MatrixXd covariance = result.covariances[v];
    if (status == NodeStatus::anchor) covariance.setZero(d, d);
    if (covariance.size() == 0) {
      covariance.setConstant(d, d, std::numeric_limits<double>::quiet_NaN());
    }
    std::string row = network.names[v];
    append_fields(row, result.positions.col(v));
    (row += ',') += enum_name(status);
    row += ',';
    append_number(row, std::sqrt(covariance.trace()));
    for (int i = 0; i < d; ++i) append_fields(row, covariance.row(i).tail(d - i).transpose());
    file.write(row + "\n");
  }
  file.commit();
}

std::vector<std::string> set_anchors(RangeNetwork& network, const NamedPositions& anchors) {
  std::unordered_map<std::string, Index> index_of;
  for (Index v = 0; v < network.node_count(); ++v) index_of.emplace(network.names[v], v);
  std::vector<std::string> added;
  network.landmarks.clear();
  for (const auto& name : anchors.names) {
    const auto [entry, is_new] = index_of.try_emplace(name, network.node_count());
    if (is_new) {
      network.names.push_back(name);
      added.push_back(name);
    }
    network.landmarks.push_back(entry->second);
  }
  network.dimension = anchors.dimension();
  network.positions.setConstant(anchors.dimension(), network.node_count(),
                                std::numeric_limits<double>::quiet_NaN());
  network.positions(Eigen::all, network.landmarks) = anchors.positions;
  std::sort(network.landmarks.begin(), network.landmarks.end());
  return added;
}

}  // namespace isotherm::network
