#include "io/graph_draft.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <string>

#include "io/incremental/place_vertices.hpp"
#include "io/information_check.hpp"
#include "io/robot_files.hpp"
#include "isotherm/slam/graph/repeats.hpp"

namespace isotherm::slam::detail {
namespace {

template <class Pose>
class Finisher {
 public:
  Finisher(GraphDraft<Pose> draft, const std::vector<std::string>& paths,
           const ReadOptions& options, ReadReport& report)
      : draft_(std::move(draft)), paths_(paths), options_(options), report_(report) {}

  PoseGraph<Pose> run(const std::vector<FixedVertex>& fixed) {
    check_size();
    sort_vertices();
    join_vertices();
    collect_ids();
    resolve_ends();
    tell_robots_apart(graph_, owners_, draft_.ends_of_files);
    place_vertices();
    repair_information();
    resolve_fixed(fixed);
    if (paths_.size() > 1) leave_out_repeats();
    return std::move(graph_);
  }

 private:
  using Vertex = typename GraphDraft<Pose>::Vertex;

  SourceLocation at(const Vertex& vertex) const { return {paths_[vertex.file], vertex.line, 0}; }

  SourceLocation at(Index constraint, std::uint64_t column = 0) const {
    const auto file = file_of(constraint, draft_.ends_of_files);
    return {paths_[file], graph_.constraints[constraint].line, column};
  }

  // Positions are 32-bit; the ends of all edges must fit as well.
  void check_size() const {
    constexpr std::size_t kMost = std::numeric_limits<Index>::max() / 3;
    if (draft_.vertices.size() > kMost || draft_.constraints.size() > kMost) {
      throw ParseError({report_.path, 0, 0}, "", "more than " + std::to_string(kMost) + " records");
    }
  }

  // Each file may have an order of its own.
  void sort_vertices() {
    auto& vertices = draft_.vertices;
    const auto out_of_place = std::adjacent_find(
        vertices.begin(), vertices.end(),
        [](const auto& a, const auto& b) { return a.file == b.file && b.id < a.id; });
    if (out_of_place != vertices.end()) {
      const auto& second = *std::next(out_of_place);
      report_.add_repair(options_, {"vertices sorted", at(second), std::to_string(second.id),
                                    "vertex id out of place after " +
                                        vertex_name(out_of_place->id) + "; sorted by id"});
    }
    std::stable_sort(vertices.begin(), vertices.end(),
                     [](const auto& a, const auto& b) { return a.id < b.id; });
    const auto repeated = std::adjacent_find(
        vertices.begin(), vertices.end(),
        [](const auto& a, const auto& b) { return a.id == b.id && a.file == b.file; });
    if (repeated != vertices.end()) {
      const auto& second = *std::next(repeated);
      throw ParseError(at(second), std::to_string(second.id),
                       "vertex already given at line " + std::to_string(repeated->line));
    }
  }

  // A vertex of several files is that of the first.
  void join_vertices() {
    const auto same = [this](const Vertex& kept, const Vertex& other) {
      if (kept.id != other.id) return false;
      if (!kept.pose.between(other.pose).log().isZero(1e-6)) {
        report_.add_note({"vertex with two poses", at(other), std::to_string(other.id),
                          "vertex " + vertex_name(other.id) + " has another pose than in " +
                              paths_[kept.file] + ", which is taken"});
      }
      return true;
    };
    auto& vertices = draft_.vertices;
    vertices.erase(std::unique(vertices.begin(), vertices.end(), same), vertices.end());
  }

  bool has_vertex_line(VertexId id) const {
    const auto& vertices = draft_.vertices;
    // Most files number their vertices without gaps.
    if (!vertices.empty()) {
      const VertexId offset = id - vertices.front().id;
      if (offset < vertices.size() && vertices[offset].id == id) return true;
    }
    return std::binary_search(vertices.begin(), vertices.end(), Vertex{id, 0, {}, 0},
                              [](const auto& a, const auto& b) { return a.id < b.id; });
  }

  // Moves the vertices into the graph, with room for those only edges name.
  void collect_ids() {
    std::vector<VertexId> missing;
    for (const auto& [from, to] : draft_.end_ids) {
      if (!has_vertex_line(from)) missing.push_back(from);
      if (!has_vertex_line(to)) missing.push_back(to);
    }
    std::sort(missing.begin(), missing.end());
    missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
    missing.shrink_to_fit();

    if (draft_.vertices.empty()) {
      owners_.assign(missing.size(), kNoFile);
      graph_.ids = std::move(missing);
      return;
    }
    const std::size_t count = draft_.vertices.size() + missing.size();
    graph_.ids.reserve(count);
    graph_.poses.reserve(count);
    owners_.reserve(count);
    auto next = missing.begin();
    const auto add_missing = [&] {
      missing_.push_back(graph_.vertex_count());
      graph_.ids.push_back(*next++);
      graph_.poses.emplace_back();
      owners_.push_back(kNoFile);
    };
    for (const auto& vertex : draft_.vertices) {
      while (next != missing.end() && *next < vertex.id) add_missing();
      graph_.ids.push_back(vertex.id);
      graph_.poses.push_back(vertex.pose);
      owners_.push_back(vertex.file);
    }
    while (next != missing.end()) add_missing();
    draft_.vertices = {};
  }

  Index position(VertexId id) const {
    const VertexId offset = id - graph_.ids.front();
    if (offset < graph_.ids.size() && graph_.ids[offset] == id) return static_cast<Index>(offset);
    return *graph_.find(id);
  }

  void resolve_ends() {
    graph_.constraints = std::move(draft_.constraints);
    for (std::size_t k = 0; k < graph_.constraints.size(); ++k) {
      graph_.constraints[k].from = position(draft_.end_ids[k].first);
      graph_.constraints[k].to = position(draft_.end_ids[k].second);
    }
    draft_.end_ids = {};
  }

  // Gives poses to the vertices that have no line of their own.
  void place_vertices() {
    if (missing_.empty()) return;
    std::vector<bool> placed(graph_.ids.size(), true);
    for (const Index vertex : missing_) placed[vertex] = false;
    detail::place_vertices(graph_, std::move(placed),
                           [this](Index vertex, std::optional<Index> edge) {
                             edge ? tell_placed(vertex, *edge) : tell_at_origin(vertex);
                           });
  }

  void tell_placed(Index vertex, Index edge) {
    report_.add_repair(options_, {"vertex placed", at(edge), vertex_name(graph_.ids[vertex]),
                                  "vertex has no line of its own; placed by this edge"});
  }

  void tell_at_origin(Index vertex) {
    report_.add_repair(options_,
                       {"vertex placed",
                        {report_.path, 0, 0},
                        vertex_name(graph_.ids[vertex]),
                        "vertex has no line of its own and no edge leads to it from one that has; "
                        "placed at the origin"});
  }

  // Replaces matrices that are not positive semi-definite by that of the edge
  // whose determinant is the median among the good ones of the same kind.
  void repair_information() {
    if (draft_.indefinite.empty()) return;
    std::vector<bool> good(graph_.constraints.size(), true);
    for (const auto& suspect : draft_.indefinite) good[suspect.constraint] = false;
    const auto roles = edge_roles(graph_);
    std::vector<bool> is_odometry(graph_.constraints.size(), false);
    for (const Index k : roles.odometry) is_odometry[k] = true;
    const auto odometry = median_edge(roles.odometry, good);
    const auto candidate = median_edge(roles.candidates, good);

    for (const auto& [k, column, token] : draft_.indefinite) {
      const auto own = is_odometry[k] ? odometry : candidate;
      const auto source = own ? own : (is_odometry[k] ? candidate : odometry);
      auto& constraint = graph_.constraints[k];
      const std::string kind = is_odometry[k] ? "odometry" : "loop";
      if (!source) {
        throw ParseError(at(static_cast<Index>(k), column), token,
                         "information matrix is not positive semi-definite, and no edge has one "
                         "that could stand in");
      }
      report_.add_repair(options_,
                         {"information replaced", at(static_cast<Index>(k), column), token,
                          "information matrix of this " + kind +
                              " edge is not positive semi-definite; replaced by the "
                              "median, from line " +
                              std::to_string(graph_.constraints[*source].line)});
      constraint.information = graph_.constraints[*source].information;
    }
  }

  std::optional<Index> median_edge(const std::vector<Index>& edges,
                                   const std::vector<bool>& good) const {
    std::vector<std::pair<double, Index>> by_determinant;
    for (const Index k : edges) {
      if (good[k])
        by_determinant.emplace_back(log_determinant(graph_.constraints[k].information), k);
    }
    if (by_determinant.empty()) return std::nullopt;
    const auto median = by_determinant.begin() + (by_determinant.size() - 1) / 2;
    std::nth_element(by_determinant.begin(), median, by_determinant.end());
    return median->second;
  }

  void resolve_fixed(const std::vector<FixedVertex>& fixed) {
    for (const auto& entry : fixed) {
      const auto found = graph_.find(entry.id);
      if (!found) {
        throw ParseError(entry.where, std::to_string(entry.id), "fixed vertex does not exist");
      }
      graph_.fixed.push_back(*found);
    }
    std::sort(graph_.fixed.begin(), graph_.fixed.end());
    graph_.fixed.erase(std::unique(graph_.fixed.begin(), graph_.fixed.end()), graph_.fixed.end());
  }

  // What two robots share stands in the files of both.
  void leave_out_repeats() {
    const auto repeats = exact_repeats(graph_);
    if (repeats.empty()) return;
    std::vector<bool> keep(graph_.constraints.size(), true);
    for (const auto& [edge, original] : repeats) {
      keep[edge] = false;
      const auto first = at(original);
      report_.add_note({"repeated edge", at(edge), "",
                        "edge repeats line " + std::to_string(first.line) + " of " + first.path +
                            " to the last digit; counted once"});
    }
    graph_ = filter_constraints(graph_, keep);
  }

  GraphDraft<Pose> draft_;
  const std::vector<std::string>& paths_;
  const ReadOptions& options_;
  ReadReport& report_;
  PoseGraph<Pose> graph_;
  std::vector<Index> missing_;         // vertices without a line, where others have one
  std::vector<std::uint32_t> owners_;  // the file that each vertex belongs to
};

template <class Value>
void move_to(std::vector<Value>& all, std::vector<Value>& more) {
  if (all.empty()) return all.swap(more);
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

template <class Pose>
void append(GraphDraft<Pose>& draft, GraphDraft<Pose>& next, std::uint32_t file) {
  const std::size_t before = draft.constraints.size();
  draft.ends_of_files.push_back(before);
  for (auto& vertex : next.vertices) vertex.file = file;
  for (auto& suspect : next.indefinite) suspect.constraint += before;
  move_to(draft.vertices, next.vertices);
  move_to(draft.constraints, next.constraints);
  move_to(draft.end_ids, next.end_ids);
  move_to(draft.indefinite, next.indefinite);
  move_to(draft.truth, next.truth);
}

void append(ReadReport& report, ReadReport& next) {
  const auto add = [](auto& counts, const auto& more) {
    for (const auto& [kind, times] : more) counts[kind] += times;
  };
  report.path += ", " + next.path;
  if (report.format != next.format) report.format += ", " + next.format;
  report.lines += next.lines;
  add(report.records, next.records);
  add(report.skipped, next.skipped);
  add(report.repairs, next.repairs);
  add(report.notes, next.notes);
  move_to(report.diagnostics, next.diagnostics);
}

// The true poses in order of id; of one that is told several times the first.
template <class Pose>
std::optional<AnyPoseGraph> truth_of(std::vector<typename GraphDraft<Pose>::Vertex> vertices) {
  if (vertices.empty()) return std::nullopt;
  std::ranges::stable_sort(vertices, {}, [](const auto& vertex) { return vertex.id; });
  PoseGraph<Pose> truth;
  for (const auto& vertex : vertices) {
    if (!truth.ids.empty() && truth.ids.back() == vertex.id) continue;
    truth.ids.push_back(vertex.id);
    truth.poses.push_back(vertex.pose);
  }
  return truth;
}

}  // namespace

void append(FileDraft& draft, FileDraft next) {
  if (draft.planar.empty() != next.planar.empty()) {
    throw ParseError({next.report.path, 0, 0}, "",
                     std::string("has poses in ") + (next.planar.empty() ? "space" : "the plane") +
                         ", unlike " + draft.report.path);
  }
  const auto file = static_cast<std::uint32_t>(draft.paths.size());
  append(draft.planar, next.planar, file);
  append(draft.spatial, next.spatial, file);
  move_to(draft.fixed, next.fixed);
  move_to(draft.other_lines, next.other_lines);
  move_to(draft.paths, next.paths);
  append(draft.report, next.report);
}

PoseGraphFile finish(FileDraft draft, const ReadOptions& options) {
  PoseGraphFile file;
  file.report = std::move(draft.report);
  file.other_lines = std::move(draft.other_lines);
  file.truth = draft.spatial.empty() ? truth_of<Pose2>(std::move(draft.planar.truth))
                                     : truth_of<Pose3>(std::move(draft.spatial.truth));
  const auto finished = [&](auto& graph) {
    return Finisher(std::move(graph), draft.paths, options, file.report).run(draft.fixed);
  };
  if (draft.paths.size() == 1) {
    file.correct = std::move(draft.spatial.empty() ? draft.planar.correct : draft.spatial.correct);
  }
  if (draft.spatial.empty()) {
    file.graph = finished(draft.planar);
  } else {
    file.graph = finished(draft.spatial);
  }
  file.paths = std::move(draft.paths);
  return file;
}

}  // namespace isotherm::slam::detail
