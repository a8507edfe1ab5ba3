#include "isotherm/slam/io/candidate_list.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <string_view>

#include "isotherm/base/csv.hpp"

namespace isotherm::slam {
namespace {

constexpr std::array<std::string_view, 3> kPlanar = {"x", "y", "theta"};
constexpr std::array<std::string_view, 7> kSpatial = {"x", "y", "z", "qx", "qy", "qz", "qw"};

bool has_column_names(TextReader& reader) {
  const auto start = reader.peek();
  const auto first = start.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  return first != std::string_view::npos && std::isalpha(static_cast<unsigned char>(start[first]));
}

class NamedPairs {
 public:
  explicit NamedPairs(TextReader reader) : csv_(std::move(reader)) {}

  std::vector<PlacePair> run() {
    std::map<VertexId, std::uint64_t> asked;
    std::vector<PlacePair> pairs;
    while (csv_.next_row()) {
      if (pairs.empty()) find_transform();
      PlacePair pair;
      pair.from = csv_.unsigned_integer(csv_.column("from", 0), "from");
      pair.to = csv_.unsigned_integer(csv_.column("to", 1), "to");
      pair.rank = asked[pair.from]++;
      pair.line = csv_.line_number();
      for (const auto name : transform_) {
        pair.transform.push_back(csv_.number(csv_.column(name, 0), name));
      }
      check_rotation(pair);
      pairs.push_back(std::move(pair));
    }
    return pairs;
  }

 private:
  void find_transform() {
    const bool planar = csv_.find_column("theta").has_value();
    if (planar) {
      transform_.assign(kPlanar.begin(), kPlanar.end());
    } else if (csv_.find_column("qw")) {
      transform_.assign(kSpatial.begin(), kSpatial.end());
    }
  }

  void check_rotation(const PlacePair& pair) const {
    if (transform_.size() != kSpatial.size()) return;
    const Eigen::Map<const Eigen::Vector4d> q(pair.transform.data() + 3);
    if (std::abs(q.norm() - 1.0) > 1e-2)
      csv_.fail(*csv_.find_column("qx"), "expected a unit quaternion");
  }

  CsvReader csv_;
  std::vector<std::string_view> transform_;  // columns; empty if not known
};

std::vector<PlacePair> read_lists(TextReader& text) {
  text.set_separator(',');
  std::vector<PlacePair> pairs;
  while (text.next_line()) {
    if (text.at_line_end() || text.line().starts_with('#')) continue;
    const VertexId query = text.unsigned_integer("the number of a pose");
    for (std::uint64_t rank = 0; !text.at_line_end(); ++rank) {
      const VertexId candidate = text.unsigned_integer("the number of a pose that looks like it");
      pairs.push_back({query, candidate, rank, text.line_number(), {}});
    }
  }
  return pairs;
}

Pose2 transform_of(const PlacePair& pair, const Pose2&) {
  return {pair.transform[0], pair.transform[1], wrap_angle(pair.transform[2])};
}

Pose3 transform_of(const PlacePair& pair, const Pose3&) {
  const auto& t = pair.transform;
  return {{t[0], t[1], t[2]}, Eigen::Quaterniond(t[6], t[3], t[4], t[5]).normalized()};
}

template <class Pose>
typename Pose::Matrix information(double sigma, double turn_sigma) {
  typename Pose::Tangent roots;  // 1 / deviation, whose squares are rounder than 1 / variance
  roots.template head<Pose::kDim>().setConstant(1.0 / sigma);
  roots.template tail<Pose::kDof - Pose::kDim>().setConstant(turn_sigma > 0.0 ? 1.0 / turn_sigma
                                                                              : 0.0);
  return roots.cwiseAbs2().asDiagonal();
}

}  // namespace

std::vector<PlacePair> read_place_pairs(const std::string& path) {
  TextReader reader(path);
  auto pairs = has_column_names(reader) ? NamedPairs(std::move(reader)).run() : read_lists(reader);
  if (pairs.empty()) {
    throw ParseError({path, 0, 0}, "",
                     "no pair; expected rows of a pose and those that look like it, or columns "
                     "from,to");
  }
  return pairs;
}

template <class Pose>
std::uint64_t add_place_pairs(PoseGraph<Pose>& graph, const std::vector<PlacePair>& pairs,
                              const PlaceOptions& options, const std::string& path) {
  options.validate();
  const auto position = [&](const PlacePair& pair, VertexId id) {
    const auto found = graph.find(id);
    if (found) return *found;
    throw ParseError({path, pair.line, 0}, vertex_name(id), "odometry has no such pose");
  };
  std::uint64_t left_out = 0;
  for (const auto& pair : pairs) {
    Constraint<Pose> loop;
    loop.from = position(pair, pair.from);
    loop.to = position(pair, pair.to);
    const bool near = std::abs(loop.from - loop.to) < options.min_gap;
    const bool late = options.top > 0 && pair.rank >= static_cast<std::uint64_t>(options.top);
    if (near || late) {
      ++left_out;
      continue;
    }
    const bool known = !pair.transform.empty();
    if (known && pair.transform.size() != (Pose::kDim == 2 ? kPlanar.size() : kSpatial.size())) {
      throw ParseError({path, pair.line, 0}, "",
                       Pose::kDim == 2 ? "expected x,y,theta: odometry is in the plane"
                                       : "expected x,y,z,qx,qy,qz,qw: odometry is in space");
    }
    if (known) loop.T_from_to = transform_of(pair, Pose());
    loop.information =
        known ? information<Pose>(options.transform_sigma, options.transform_turn_sigma)
              : information<Pose>(options.sigma, options.turn_sigma);
    loop.line = pair.line;
    loop.link = LinkKind::loop;
    graph.constraints.push_back(loop);
  }
  return left_out;
}

template std::uint64_t add_place_pairs(PoseGraph<Pose2>&, const std::vector<PlacePair>&,
                                       const PlaceOptions&, const std::string&);
template std::uint64_t add_place_pairs(PoseGraph<Pose3>&, const std::vector<PlacePair>&,
                                       const PlaceOptions&, const std::string&);

}  // namespace isotherm::slam
