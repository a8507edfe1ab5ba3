#include "slam/pose_graph.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "graph.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/slam/graph/diagnose.hpp"
#include "isotherm/slam/graph/graph_summary.hpp"
#include "isotherm/slam/graph/odometry.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "modules.hpp"
#include "slam/pose_arrays.hpp"
#include "verdicts.hpp"

namespace isotherm::python {
namespace {

using namespace nanobind::literals;
using slam::AnyPoseGraph;
using slam::Constraint;
using slam::EdgeRoles;
using slam::Index;
using slam::PoseGraph;
using slam::VertexId;

template <class Pose>
using Constraints = std::vector<Constraint<Pose>>;

// The first constraint, or one that stands for none where there are none.
template <class Pose>
const Constraint<Pose>& first_of(const Constraints<Pose>& constraints) {
  static const Constraint<Pose> kNone = {};
  return constraints.empty() ? kNone : constraints.front();
}

template <class Visitor>
auto visit(const PoseGraphFile& self, Visitor&& visitor) {
  return std::visit(std::forward<Visitor>(visitor), self.graph);
}

// Made from arrays

std::vector<VertexId> ids_from(nb::handle ids, std::size_t vertices) {
  if (ids.is_none()) return counted_ids(static_cast<Index>(vertices));
  auto given = number_list<VertexId>(ids, "ids");
  const auto not_ascending =
      std::adjacent_find(given.begin(), given.end(), [](VertexId a, VertexId b) { return a >= b; });
  if (not_ascending != given.end()) throw InvalidArgument("ids", "must ascend without repeats");
  return given;
}

// Symmetric and finite; what they say is the user's.
template <class Pose>
void read_information(nb::handle value, Constraints<Pose>& constraints) {
  if (value.is_none()) return;
  constexpr std::int64_t kDof = Pose::kDof;
  const auto matrices = numbers<double>(value, "information", {kAny, kDof, kDof});
  require_length("information", matrices.shape(0), constraints.size());
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    auto& own = constraints[k].information;
    own = Eigen::Map<const typename Pose::Matrix>(matrices.data() + k * kDof * kDof);
    const bool finite = own.allFinite();
    if (finite && own.isApprox(own.transpose(), 1e-9)) continue;
    throw InvalidArgument("information", "of edge " + std::to_string(k) +
                                             (finite ? " is not symmetric" : " is not finite"));
  }
}

template <class Pose>
Constraints<Pose> constraints_from(nb::handle edges, nb::handle measurements,
                                   nb::handle information) {
  const auto ends = numbers<Index>(edges, "edges", {kAny, 2});
  const auto poses = poses_from<Pose>(measurements, "measurements");
  require_length("measurements", poses.size(), ends.shape(0));
  Constraints<Pose> constraints(poses.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    constraints[k].from = ends.data()[2 * k];
    constraints[k].to = ends.data()[2 * k + 1];
    constraints[k].T_from_to = poses[k];
  }
  read_information(information, constraints);
  return constraints;
}

template <class Pose>
std::size_t vertices_of(const Constraints<Pose>& constraints, const std::vector<Pose>& poses,
                        nb::handle ids) {
  if (!ids.is_none()) return 0;  // as many as there are ids
  if (!poses.empty()) return poses.size();
  Index largest = -1;
  for (const auto& c : constraints) largest = std::max({largest, c.from, c.to});
  return static_cast<std::size_t>(largest + 1);
}

template <class Pose>
void require_sound(const PoseGraph<Pose>& graph) {
  if (!graph.poses.empty()) require_length("poses", graph.poses.size(), graph.ids.size());
  const auto outside = [&graph](Index v) { return v < 0 || v >= graph.vertex_count(); };
  for (const auto& c : graph.constraints) {
    if (outside(c.from) || outside(c.to)) {
      throw InvalidArgument("edges", "name a vertex that the graph does not have");
    }
  }
  if (std::any_of(graph.fixed.begin(), graph.fixed.end(), outside)) {
    throw InvalidArgument("fixed", "names a vertex that the graph does not have");
  }
}

struct Given {
  nb::handle edges, measurements, information, poses, ids, fixed;
};

template <class Pose>
PoseGraphFile make(const Given& given) {
  PoseGraph<Pose> graph;
  if (!given.poses.is_none()) graph.poses = poses_from<Pose>(given.poses, "poses");
  graph.constraints = constraints_from<Pose>(given.edges, given.measurements, given.information);
  graph.ids = ids_from(given.ids, vertices_of(graph.constraints, graph.poses, given.ids));
  if (!given.fixed.is_none()) graph.fixed = number_list<Index>(given.fixed, "fixed");
  require_sound(graph);
  return {std::move(graph), {}, {}, {}};
}

PoseGraphFile make(const Given& given) {
  const bool space = pose_dimension(given.measurements, "measurements") == Pose3::kDim;
  return space ? make<Pose3>(given) : make<Pose2>(given);
}

template <class Pose>
PoseGraphFile with_poses_of(const PoseGraphFile& self, const PoseGraph<Pose>& graph,
                            nb::handle poses) {
  auto moved = graph;
  moved.poses = poses.is_none() ? std::vector<Pose>() : poses_from<Pose>(poses, "poses");
  require_sound(moved);
  return with_graph(self, std::move(moved));
}

// What they are, as arrays

std::optional<PoseRows> poses_of(const PoseGraphFile& self) {
  const auto owner = nb::find(self);
  return visit(self, [&owner](const auto& graph) -> std::optional<PoseRows> {
    if (graph.poses.empty() && !graph.ids.empty()) return std::nullopt;
    return pose_rows(graph.poses, owner);
  });
}

template <class Pose>
View2<Index> ends_of(const Constraints<Pose>& constraints, nb::handle owner) {
  return strided_rows(&first_of(constraints).from, constraints.size(), 2, sizeof(Constraint<Pose>),
                      owner);
}

template <class Pose>
View<double, nb::shape<-1, -1, -1>> information_of(const Constraints<Pose>& constraints,
                                                   nb::handle owner) {
  constexpr std::size_t kDof = Pose::kDof;
  constexpr auto kStep = static_cast<std::int64_t>(sizeof(Constraint<Pose>) / sizeof(double));
  return {first_of(constraints).information.data(),
          {constraints.size(), kDof, kDof},
          owner,
          {kStep, 1, static_cast<std::int64_t>(kDof)}};
}

nb::tuple role_arrays(const PoseGraphFile& self) {
  auto roles = roles_of(self.graph, nb::none());
  return nb::make_tuple(give(std::move(roles.odometry)), give(std::move(roles.candidates)));
}

nb::object edge_frame(nb::handle_t<PoseGraphFile> self) {
  const nb::object ends = nb::object(self.attr("ids"))[self.attr("edges")];
  const nb::object measured = self.attr("measurements");
  const bool space = nb::cast<int>(self.attr("dimension")) == Pose3::kDim;
  constexpr std::array<const char*, 3> kPlane = {"x", "y", "theta"};
  constexpr std::array<const char*, 7> kSpace = {"x", "y", "z", "qx", "qy", "qz", "qw"};
  const nb::dict columns;
  columns["from"] = ends.attr("T")[0];
  columns["to"] = ends.attr("T")[1];
  const std::size_t count = space ? kSpace.size() : kPlane.size();
  for (std::size_t c = 0; c < count; ++c) {
    columns[space ? kSpace[c] : kPlane[c]] = measured.attr("T")[c];
  }
  return data_frame(columns);
}

nb::dict summary_of(const PoseGraphFile& self) {
  const auto found = visit(self, [](const auto& graph) { return slam::summarize(graph); });
  nb::dict all;
  all["dimension"] = found.dimension;
  all["vertices"] = found.vertices;
  all["edges"] = found.edges;
  all["odometry"] = found.odometry;
  all["candidates"] = found.candidates;
  all["repeated_edges"] = found.repeated_edges;
  all["self_edges"] = found.self_edges;
  all["fixed"] = found.fixed;
  all["robots"] = found.robots;
  all["has_poses"] = found.has_poses;
  all["components"] = found.components;
  all["odometry_chains"] = found.odometry_chains;
  nb::dict suspicious;
  for (const auto& [kind, count] : found.suspicious) suspicious[kind.c_str()] = count;
  all["suspicious"] = suspicious;
  return all;
}

std::vector<nb::tuple> doubts_of(const PoseGraphFile& self) {
  std::vector<nb::tuple> all;
  visit(self, [&](const auto& graph) {
    for (const auto& doubt : slam::diagnose(graph, slam::edge_roles(graph))) {
      all.push_back(nb::make_tuple(doubt.kind, doubt.message));
    }
  });
  return all;
}

PoseRows chained(const PoseGraphFile& self) {
  return visit(self, [](const auto& graph) {
    return give_poses(slam::odometry_poses(graph, slam::edge_roles(graph)));
  });
}

std::string representation(const PoseGraphFile& self) {
  return visit(self, [](const auto& graph) {
    constexpr bool kPlane = std::is_same_v<std::decay_t<decltype(graph)>, PoseGraph<Pose2>>;
    return std::string("PoseGraph(") + (kPlane ? "2D, " : "3D, ") +
           std::to_string(graph.vertex_count()) + " poses, " +
           std::to_string(graph.constraint_count()) + " edges)";
  });
}

// Files

std::vector<std::string> paths_from(nb::handle paths) {
  const bool one = nb::isinstance<nb::str>(paths) || nb::isinstance<nb::bytes>(paths) ||
                   nb::hasattr(paths, "__fspath__");
  if (one) return {path_of(paths)};
  std::vector<std::string> all;
  for (const nb::handle path : nb::iter(paths)) all.push_back(path_of(path));
  if (all.empty()) throw InvalidArgument("paths", "are none");
  return all;
}

PoseGraphFile read(nb::handle paths, bool strict) {
  const auto all = paths_from(paths);
  const nb::gil_scoped_release released;
  return slam::read_pose_graphs(all, {.strict = strict});
}

void write(nb::handle path, const PoseGraphFile& graph) {
  const auto target = path_of(path);
  const nb::gil_scoped_release released;
  slam::write_g2o(target, graph);
}

void write_toro(nb::handle path, const PoseGraphFile& graph) {
  slam::write_toro(path_of(path), graph.graph);
}

void bind_making(nb::class_<PoseGraphFile>& bound) {
  bound.def(
      "__init__",
      [](PoseGraphFile* self, nb::handle edges, nb::handle measurements, nb::handle information,
         nb::handle poses, nb::handle ids, nb::handle fixed) {
        new (self) PoseGraphFile(make({edges, measurements, information, poses, ids, fixed}));
      },
      "edges"_a, "measurements"_a, "information"_a = nb::none(), nb::kw_only(),
      "poses"_a = nb::none(), "ids"_a = nb::none(), "fixed"_a = nb::none(),
      nb::sig("def __init__(self, edges: numpy.typing.ArrayLike, measurements: "
              "numpy.typing.ArrayLike, information: numpy.typing.ArrayLike | None = None, *, "
              "poses: numpy.typing.ArrayLike | None = None, ids: numpy.typing.ArrayLike | None = "
              "None, fixed: numpy.typing.ArrayLike | None = None) -> None"),
      "Edges m x 2 of vertices from 0; what each measures, m x 3 or m x 7; information m x 3 x 3 "
      "or "
      "m x 6 x 6 (identity where there is none); poses n x 3 or n x 7, if they are known; "
      "ascending ids n, by which neighbours in time are told (else 0, 1, ...); and the vertices "
      "that are held.");
  bound.def(
      "with_poses",
      [](const PoseGraphFile& self, nb::handle poses) {
        return visit(self, [&](const auto& graph) { return with_poses_of(self, graph, poses); });
      },
      "poses"_a.none(),
      nb::sig("def with_poses(self, poses: numpy.typing.ArrayLike | None) -> PoseGraph"),
      "The same graph with other poses, n x 3 or n x 7, or without any.");
}

void bind_vertices(nb::class_<PoseGraphFile>& bound) {
  bound
      .def_prop_ro(
          "ids",
          [](const PoseGraphFile& self) {
            const auto owner = nb::find(self);
            return visit(self, [&](const auto& graph) { return view(graph.ids, owner); });
          },
          "The number of each vertex, ascending, n.")
      .def_prop_ro("poses", poses_of, nb::rv_policy::automatic,
                   nb::sig("def poses(self) -> numpy.typing.NDArray[numpy.float64] | None"),
                   "n x 3 (x, y, theta) or n x 7 (x, y, z, qx, qy, qz, qw), if they are known.")
      .def_prop_ro(
          "fixed",
          [](const PoseGraphFile& self) {
            const auto owner = nb::find(self);
            return visit(self, [&](const auto& graph) { return view(graph.fixed, owner); });
          },
          "Vertices that are held.");
}

void bind_constraints(nb::class_<PoseGraphFile>& bound) {
  bound
      .def_prop_ro(
          "edges",
          [](const PoseGraphFile& self) {
            const auto owner = nb::find(self);
            return visit(self,
                         [&](const auto& graph) { return ends_of(graph.constraints, owner); });
          },
          "The vertices that each edge joins, positions among the ids, m x 2.")
      .def_prop_ro(
          "measurements",
          [](const PoseGraphFile& self) {
            const auto owner = nb::find(self);
            return visit(self, [&](const auto& graph) {
              const auto& all = graph.constraints;
              return pose_rows(&first_of(all).T_from_to, all.size(), sizeof(all[0]), owner);
            });
          },
          nb::rv_policy::automatic,
          "The pose of `to` in the frame of `from` as measured, m x 3 or m x 7.")
      .def_prop_ro(
          "information",
          [](const PoseGraphFile& self) {
            const auto owner = nb::find(self);
            return visit(
                self, [&](const auto& graph) { return information_of(graph.constraints, owner); });
          },
          "Inverse covariances, (translation, rotation), m x 3 x 3 or m x 6 x 6.")
      .def_prop_ro(
          "lines",
          [](const PoseGraphFile& self) {
            const auto owner = nb::find(self);
            return visit(self, [&](const auto& graph) {
              using One = std::decay_t<decltype(graph.constraints[0])>;
              return member_view(graph.constraints, &One::line, owner);
            });
          },
          "The line of each edge in its file; 0: none, m.");
}

void bind_facts(nb::class_<PoseGraphFile>& bound) {
  bound.def("__repr__", representation)
      .def("__len__",
           [](const PoseGraphFile& self) {
             return visit(self, [](const auto& graph) { return graph.ids.size(); });
           })
      .def_prop_ro(
          "dimension", [](const PoseGraphFile& self) { return self.graph.index() == 0 ? 2 : 3; },
          "2 or 3.")
      .def_prop_ro(
          "edge_count",
          [](const PoseGraphFile& self) {
            return visit(self, [](const auto& graph) { return graph.constraints.size(); });
          },
          "How many edges there are.")
      .def("roles", role_arrays,
           nb::sig("def roles(self) -> tuple[numpy.typing.NDArray[numpy.int32], "
                   "numpy.typing.NDArray[numpy.int32]]"),
           "Positions of the edges that are odometry, and of those that are candidates.")
      .def("summary", summary_of, nb::sig("def summary(self) -> dict[str, object]"),
           "What is in the graph, in numbers.")
      .def("doubts", doubts_of, nb::sig("def doubts(self) -> list[tuple[str, str]]"),
           "What is seldom meant and by which a map can be lost: kinds, and what was measured.")
      .def("odometry_poses", chained,
           nb::sig("def odometry_poses(self) -> numpy.typing.NDArray[numpy.float64]"),
           "Poses by chaining odometry, n x 3 or n x 7.")
      .def(
          "write", [](const PoseGraphFile& self, nb::handle path) { write(path, self); }, "path"_a,
          nb::sig("def write(self, path: str | os.PathLike[str]) -> None"), "Write g2o.");
  bind_read_report(bound, "the graph");
  bind_data_frame(bound, edge_frame, "from, to and measurement of each edge");
}

}  // namespace

PoseGraphFile with_graph(const PoseGraphFile& file, AnyPoseGraph graph) {
  return {std::move(graph), file.report, file.other_lines, file.paths};
}

EdgeRoles roles_of(const AnyPoseGraph& graph, nb::handle trusted) {
  return std::visit(
      [&trusted](const auto& own) {
        if (trusted.is_none()) return slam::edge_roles(own);
        std::vector<bool> chosen(own.constraints.size(), false);
        for (const Index edge : number_list<Index>(trusted, "trusted")) {
          if (edge < 0 || edge >= own.constraint_count()) {
            throw InvalidArgument("trusted", "names an edge that the graph does not have");
          }
          chosen[static_cast<std::size_t>(edge)] = true;
        }
        EdgeRoles roles;
        for (Index edge = 0; edge < own.constraint_count(); ++edge) {
          (chosen[static_cast<std::size_t>(edge)] ? roles.odometry : roles.candidates)
              .push_back(edge);
        }
        return roles;
      },
      graph);
}

spectral::VertexNames names_of(const AnyPoseGraph& graph) {
  const bool lettered = std::visit(
      [](const auto& own) {
        return std::any_of(own.ids.begin(), own.ids.end(),
                           [](VertexId id) { return !slam::robot_letter(id).empty(); });
      },
      graph);
  return lettered ? slam::vertex_name : spectral::VertexNames();
}

void bind_pose_graphs(nb::module_& module) {
  nb::class_<PoseGraphFile> bound(
      module, "PoseGraph",
      "Poses and the measurements between them, in the plane or in space. Vertices are in the "
      "order of their ids, edges in that of the file. A graph never changes, and its arrays "
      "cannot be written.");
  bind_making(bound);
  bind_vertices(bound);
  bind_constraints(bound);
  bind_facts(bound);

  const std::string path = "path: str | os.PathLike[str]";
  module.def("read_pose_graph", read, "paths"_a, nb::kw_only(), "strict"_a = false,
             nb::sig("def read_pose_graph(paths: str | os.PathLike[str] | "
                     "collections.abc.Iterable[str | os.PathLike[str]], *, strict: bool = False) "
                     "-> PoseGraph"),
             "Read a pose graph in any format that the command reads; several files as one graph.");
  module.def("write_g2o", write, "path"_a, "graph"_a,
             nb::sig(("def write_g2o(" + path + ", graph: PoseGraph) -> None").c_str()),
             "Write g2o; a name in .gz is compressed.");
  module.def("write_toro", write_toro, "path"_a, "graph"_a,
             nb::sig(("def write_toro(" + path + ", graph: PoseGraph) -> None").c_str()),
             "Write TORO.");
}

}  // namespace isotherm::python
