#include "io/incremental/jrl_reader.hpp"

#include <algorithm>
#include <cstdint>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "io/incremental/jrl_factors.hpp"
#include "io/information_check.hpp"

namespace isotherm::slam::detail {
namespace {

// A robot, an entry of its log, and a measurement there.
using FactorId = std::tuple<std::string, std::uint64_t, std::uint64_t>;

template <class Pose>
struct Factor {
  FactorId id;
  std::uint64_t stamp = 0;
  std::pair<VertexId, VertexId> ends;
  std::uint64_t column = 0;  // of its covariance, where that is on the same line
  Constraint<Pose> constraint;
};

class JrlReader {
 public:
  JrlReader(const std::string& path, std::string_view text, const ReadOptions& options)
      : json_(path, text), repairs_(options, draft_.report) {
    draft_.report.path = path;
    draft_.report.format = "jrl";
    draft_.paths = {path};
  }

  FileDraft run() {
    bool has_measurements = false;
    json_.object("a JRL file, an object", [&](const std::string& name) {
      has_measurements = has_measurements || name == "measurements";
      read_member(name);
    });
    json_.expect_end();
    if (!has_measurements) fail("expected a JRL file; this one has no measurements");
    if (planar_.empty() && spatial_.empty()) {
      fail("no BetweenFactorPose2 and no BetweenFactorPose3 in a JRL file");
    }
    repairs_.finish();
    draft_.report.lines = json_.location().line;
    hand_over(planar_, draft_.planar);
    hand_over(spatial_, draft_.spatial);
    return std::move(draft_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw ParseError({draft_.report.path, 0, 0}, "", problem);
  }

  void read_member(const std::string& name) {
    if (name == "measurements") {
      json_.object("the measurements of each robot",
                   [this](const std::string& robot) { read_log(robot); });
    } else if (name == "initialization") {
      read_values(&GraphDraft<Pose2>::vertices, &GraphDraft<Pose3>::vertices);
    } else if (name == "groundtruth") {
      read_values(&GraphDraft<Pose2>::truth, &GraphDraft<Pose3>::truth);
    } else if (name == "outlier_factors") {
      says_what_is_true_ = true;
      read_factor_ids(outliers_);
    } else if (name == "potential_outlier_factors") {
      read_factor_ids(loops_);
    } else {
      json_.skip();
    }
  }

  void read_log(const std::string& robot) {
    std::uint64_t entry = 0;
    json_.array("the entries of a robot", [&] { read_entry(robot, entry++); });
  }

  // Its time may stand behind what was measured then.
  void read_entry(const std::string& robot, std::uint64_t entry) {
    std::uint64_t stamp = 0;
    const std::size_t planar = planar_.size();
    const std::size_t spatial = spatial_.size();
    json_.object("an entry", [&](const std::string& name) {
      std::uint64_t measurement = 0;
      if (name == "stamp") {
        stamp = json_.unsigned_integer("a time stamp");
      } else if (name == "measurements") {
        json_.array("the measurements of an entry", [&] {
          read_measurement({robot, entry, measurement++});
        });
      } else {
        json_.skip();
      }
    });
    for (auto k = planar; k < planar_.size(); ++k) planar_[k].stamp = stamp;
    for (auto k = spatial; k < spatial_.size(); ++k) spatial_[k].stamp = stamp;
  }

  void read_measurement(FactorId id) {
    const auto measurement = read_jrl_measurement(json_);
    const auto& type = measurement.type;
    if (type == "BetweenFactorPose2") {
      add(planar_, std::move(id), measurement);
    } else if (type == "BetweenFactorPose3") {
      add(spatial_, std::move(id), measurement);
    } else if (!type.starts_with("PriorFactorPose")) {  // where the first pose lies is free
      leave_out(measurement);
      return;
    }
    if (!planar_.empty() && !spatial_.empty()) {
      throw ParseError(measurement.where, type, "poses in the plane and in space in one file");
    }
    ++draft_.report.records[type];
  }

  void leave_out(const JrlMeasurement& measurement) {
    constexpr std::size_t kMostTypes = 100;
    auto& skipped = draft_.report.skipped;
    const bool known = skipped.size() < kMostTypes || skipped.contains(measurement.type);
    const std::string type = known ? measurement.type : "(other)";
    if (skipped[type]++ > 0) return;
    draft_.report.add_note(
        {"unused " + type, measurement.where, type, "measurement of a kind that is not used"});
  }

  template <class Pose>
  void add(std::vector<Factor<Pose>>& factors, FactorId id, const JrlMeasurement& measurement) {
    auto& factor = factors.emplace_back();
    factor.constraint = jrl_constraint<Pose>(measurement, repairs_);
    factor.id = std::move(id);
    factor.ends = {*measurement.from, *measurement.to};
    const auto& where = measurement.covariance_where;
    factor.column = where.line == factor.constraint.line ? where.column : 0;
  }

  using Planar = std::vector<GraphDraft<Pose2>::Vertex> GraphDraft<Pose2>::*;
  using Spatial = std::vector<GraphDraft<Pose3>::Vertex> GraphDraft<Pose3>::*;

  // Of each robot, by key. What is no pose is left out.
  void read_values(Planar planar, Spatial spatial) {
    json_.object("the values of each robot", [&](const std::string&) {
      json_.object("values by key", [&](const std::string& name) {
        VertexId id = 0;
        if (!parse_unsigned(name, id)) json_.fail("expected a key, an integer in [0, 2^64)");
        const auto value = read_jrl_value(json_);
        const std::uint64_t line = value.where.line;
        if (value.type == "Pose2") {
          (draft_.planar.*planar).push_back({id, line, jrl_pose<Pose2>(value, repairs_)});
        } else if (value.type == "Pose3") {
          (draft_.spatial.*spatial).push_back({id, line, jrl_pose<Pose3>(value, repairs_)});
        }
      });
    });
  }

  // Pairs of entry and measurement, of each robot.
  void read_factor_ids(std::set<FactorId>& ids) {
    json_.object("factors of each robot", [&](const std::string& robot) {
      json_.array("factors", [&] {
        std::vector<std::uint64_t> pair;
        json_.array("an entry and a measurement",
                    [&] { pair.push_back(json_.unsigned_integer("an index")); });
        if (pair.size() != 2) json_.fail("expected an entry and a measurement");
        ids.emplace(robot, pair[0], pair[1]);
      });
    });
  }

  template <class Pose>
  void hand_over(std::vector<Factor<Pose>>& factors, GraphDraft<Pose>& draft) const {
    std::ranges::stable_sort(factors, {}, &Factor<Pose>::stamp);
    for (auto& factor : factors) {
      const bool outlier = outliers_.contains(factor.id);
      if (!loops_.empty()) {
        const bool loop = outlier || loops_.contains(factor.id);
        factor.constraint.link = loop ? LinkKind::loop : LinkKind::odometry;
      }
      if (!is_positive_semidefinite(factor.constraint.information)) {
        draft.indefinite.push_back({draft.constraints.size(), factor.column, ""});
      }
      draft.constraints.push_back(std::move(factor.constraint));
      draft.end_ids.push_back(factor.ends);
      if (says_what_is_true_) draft.correct.push_back(!outlier);
    }
    factors.clear();
    // Keys stand in the order of their digits, and robots may tell of each other's poses.
    auto& vertices = draft.vertices;
    std::ranges::stable_sort(vertices, {}, [](const auto& vertex) { return vertex.id; });
    const auto same = [](const auto& a, const auto& b) { return a.id == b.id; };
    vertices.erase(std::unique(vertices.begin(), vertices.end(), same), vertices.end());
  }

  JsonReader json_;
  FileDraft draft_;
  PoseRepairs repairs_;
  std::vector<Factor<Pose2>> planar_;
  std::vector<Factor<Pose3>> spatial_;
  std::set<FactorId> loops_;  // that may be outliers
  std::set<FactorId> outliers_;
  bool says_what_is_true_ = false;
};

}  // namespace

bool is_jrl(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '{';
}

FileDraft read_jrl(const std::string& path, std::string_view text, const ReadOptions& options) {
  return JrlReader(path, text, options).run();
}

FileDraft read_jrl(TextReader& text, const ReadOptions& options) {
  constexpr std::size_t kPiece = std::size_t{1} << 16;
  std::string whole;
  std::size_t more = kPiece;
  while (more == kPiece) {
    const std::size_t end = whole.size();
    whole.resize(end + kPiece);
    more = text.bytes(std::span(whole).subspan(end));
    whole.resize(end + more);
  }
  return read_jrl(text.path(), whole, options);
}

}  // namespace isotherm::slam::detail
