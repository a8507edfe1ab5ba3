#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "graph.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/text_reader.hpp"
#include "isotherm/network/io/position_file.hpp"
#include "isotherm/network/io/range_file.hpp"
#include "isotherm/network/localize/localize.hpp"
#include "isotherm/network/simulate/simulate_network.hpp"
#include "keywords.hpp"
#include "modules.hpp"
#include "pages.hpp"
#include "verdicts.hpp"

namespace isotherm::python {
namespace {

using namespace nanobind::literals;
using namespace network;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// Ranges with what was noticed in their file. Never changes once it is made.
struct Network : RangeNetwork {
  ReadReport report;
};

std::vector<std::string> names_from(nb::handle names, Index count) {
  if (!names.is_none()) {
    std::vector<std::string> given;
    for (const nb::handle name : nb::iter(names))
      given.push_back(nb::cast<std::string>(nb::str(name)));
    return given;
  }
  std::vector<std::string> numbered;
  for (Index k = 0; k < count; ++k) numbered.push_back(std::to_string(k));
  return numbered;
}

std::vector<double> variances_from(nb::handle sigmas, std::size_t count) {
  if (sigmas.is_none()) return std::vector<double>(count, 0.0);
  auto values = number_list<double>(sigmas, "sigmas");
  require_length("sigmas", values.size(), count);
  for (double& value : values) {
    if (!(value >= 0.0) || !std::isfinite(value)) {
      throw InvalidArgument("sigmas", "must be finite and not negative");
    }
    value *= value;
  }
  return values;
}

void require_nodes(const RangeNetwork& network) {
  const Index count = network.node_count();
  for (const auto& range : network.ranges) {
    if (range.from < 0 || range.from >= count || range.to < 0 || range.to >= count) {
      throw InvalidArgument("edges", "join a node that the network does not have");
    }
  }
}

Network make(nb::handle edges, nb::handle ranges, nb::handle sigmas, nb::handle names,
             int dimension) {
  require_in_range("dimension", dimension, closed(2, 3));
  const auto ends = numbers<Index>(edges, "edges", {kAny, 2});
  const auto distances = numbers<double>(ranges, "ranges", {kAny});
  require_length("ranges", distances.size(), ends.shape(0));
  const auto variances = variances_from(sigmas, distances.size());
  Network made;
  made.dimension = dimension;
  Index count = 0;
  for (std::size_t k = 0; k < distances.size(); ++k) {
    RangeMeasurement range;
    range.from = ends.data()[2 * k];
    range.to = ends.data()[2 * k + 1];
    range.distance = distances.data()[k];
    range.variance = variances[k];
    made.ranges.push_back(range);
    count = std::max({count, range.from + 1, range.to + 1});
  }
  made.names = names_from(names, count);
  made.positions = Eigen::MatrixXd::Constant(dimension, made.node_count(), kUnknown);
  require_nodes(made);
  return made;
}

Network with_anchors(const Network& self, nb::handle names, nb::handle positions) {
  NamedPositions anchors;
  anchors.names = names_from(names, 0);
  anchors.positions = columns_of(positions, "positions");
  require_length("positions", static_cast<std::size_t>(anchors.positions.cols()),
                 anchors.names.size());
  require_in_range("positions", anchors.dimension(), closed(2, 3));
  Network anchored = self;
  set_anchors(anchored, anchors);
  return anchored;
}

View2<Index> edges_of(const Network& self) {
  static_assert(offsetof(RangeMeasurement, to) == offsetof(RangeMeasurement, from) + sizeof(Index));
  const Index* const first = self.ranges.empty() ? nullptr : &self.ranges[0].from;
  return strided_rows(first, self.ranges.size(), 2, sizeof(RangeMeasurement), nb::find(self));
}

nb::object range_frame(nb::handle_t<Network> self) {
  const auto& network = nb::cast<const Network&>(self);
  std::vector<std::string> from;
  std::vector<std::string> to;
  for (const auto& range : network.ranges) {
    from.push_back(network.names[range.from]);
    to.push_back(network.names[range.to]);
  }
  const nb::dict columns;
  columns["from"] = from;
  columns["to"] = to;
  columns["range"] = member_view(network.ranges, &RangeMeasurement::distance, self);
  columns["variance"] = member_view(network.ranges, &RangeMeasurement::variance, self);
  return data_frame(columns);
}

// Where the nodes are, with the network that they are of.
struct Localized : LocalizeResult {
  nb::object of;  // a Network
  LocalizeOptions options;
};

const Network& network_of(const Localized& self) { return nb::cast<const Network&>(self.of); }

// Verdict files have numbers for vertices: the names, where all of them are numbers.
bool number_ends(spectral::EdgeVerdicts& rows, const RangeNetwork& network) {
  std::vector<std::uint64_t> ids(network.names.size());
  for (std::size_t k = 0; k < ids.size(); ++k) {
    if (!parse_unsigned(network.names[k], ids[k])) return false;
  }
  for (auto& row : rows) {
    row.from = ids[row.from];
    row.to = ids[row.to];
  }
  return true;
}

Verdicts named_verdicts(const Localized& self) {
  Verdicts all{self.verdicts};
  if (!number_ends(all.rows, network_of(self))) {
    all.names = [names = network_of(self).names](std::uint64_t node) { return names[node]; };
  }
  return all;
}

Localized locate(nb::handle_t<Network> network, nb::kwargs given) {
  Keywords keywords("localize", std::move(given));
  LocalizeOptions options;
  keywords.take_fields(options);
  const RunKeywords run = keywords.take_run();
  keywords.finish();
  const auto& of = nb::cast<const Network&>(network);
  auto result = without_gil(run, nb::borrow(network),
                            [&of, own = options](const RunContext& context) mutable {
                              own.threads = context.threads;
                              own.progress = context.progress;
                              return localize(of, own);
                            });
  return {std::move(result), nb::borrow(network), options};
}

std::vector<std::string> node_states(const Localized& self) {
  std::vector<std::string> names;
  for (const auto status : self.nodes) names.emplace_back(enum_name(status));
  return names;
}

// d x d a node; NaN for those without a position, 0 for anchors.
nb::ndarray<nb::numpy, double, nb::shape<-1, -1, -1>> covariances(const Localized& self) {
  const auto d = static_cast<std::size_t>(self.positions.rows());
  std::vector<double> all(self.nodes.size() * d * d, kUnknown);
  for (std::size_t k = 0; k < self.nodes.size(); ++k) {
    double* const first = all.data() + k * d * d;
    if (self.nodes[k] == NodeStatus::anchor) {
      std::fill_n(first, d * d, 0.0);
    } else if (self.covariances[k].size() > 0) {
      std::copy_n(self.covariances[k].data(), d * d, first);
    }
  }
  const std::size_t nodes = self.nodes.size();
  return give<double, nb::shape<-1, -1, -1>>(std::move(all), {nodes, d, d});
}

nb::object node_frame(nb::handle_t<Localized> self) {
  const auto& result = nb::cast<const Localized&>(self);
  constexpr const char* kAxes[] = {"x", "y", "z"};
  const auto d = static_cast<std::size_t>(result.positions.rows());
  const nb::dict columns;
  columns["node"] = network_of(result).names;
  for (std::size_t axis = 0; axis < d; ++axis) {
    columns[kAxes[axis]] =
        strided_view(result.positions.data() + axis, result.nodes.size(), d * sizeof(double), self);
  }
  columns["status"] = node_states(result);
  return data_frame(columns);
}

std::string page(const Localized& self, nb::handle truth) {
  const auto& network = network_of(self);
  return page_of(nb::find(self), network, network.report.path, self.options, self, truth);
}

std::string notebook_page(const Localized& self) {
  return framed(network_of(self).names.size(), in_words(self.verdicts),
                [&self] { return page(self, nb::none()); });
}

nb::tuple simulate(nb::kwargs given) {
  Keywords keywords("simulate_network", std::move(given));
  NetworkOptions options;
  keywords.take_fields(options);
  keywords.take_into("seed", options.seed);
  keywords.finish();
  auto made = without_gil({}, nb::none(),
                          [options](const RunContext&) { return simulate_network(options); });
  std::vector<std::int8_t> origins;
  for (const auto origin : made.origins) origins.push_back(static_cast<std::int8_t>(origin));
  const Eigen::MatrixXd truth = made.truth.transpose();
  return nb::make_tuple(Network{std::move(made.network), {}}, give(truth),
                        give(std::move(origins)));
}

void bind_making(nb::class_<Network>& bound) {
  bound
      .def(
          "__init__",
          [](Network* self, nb::handle edges, nb::handle ranges, nb::handle sigmas,
             nb::handle names,
             int dimension) { new (self) Network(make(edges, ranges, sigmas, names, dimension)); },
          "edges"_a, "ranges"_a, "sigmas"_a = nb::none(), nb::kw_only(), "names"_a = nb::none(),
          "dimension"_a = 2,
          nb::sig("def __init__(self, edges: numpy.typing.ArrayLike, ranges: "
                  "numpy.typing.ArrayLike, sigmas: numpy.typing.ArrayLike | None = None, *, names: "
                  "collections.abc.Iterable[object] | None = None, dimension: int = 2) -> None"),
          "The nodes that each range joins (m x 2), its length and standard deviation (m, metres; "
          "0: not known), the nodes' names and the dimension of space, 2 or 3.")
      .def("with_anchors", with_anchors, "names"_a, "positions"_a,
           nb::sig("def with_anchors(self, names: collections.abc.Iterable[object], positions: "
                   "numpy.typing.ArrayLike) -> Network"),
           "The network with these nodes, and no others, at known positions (k x d).");
}

void bind_contents(nb::class_<Network>& bound) {
  bound
      .def("__repr__",
           [](const Network& self) {
             return "Network(" + std::to_string(self.names.size()) + " nodes, " +
                    std::to_string(self.ranges.size()) + " ranges, " +
                    std::to_string(self.landmarks.size()) + " anchors)";
           })
      .def("__len__", [](const Network& self) { return self.names.size(); })
      .def_ro("names", &Network::names, "What the nodes are called.")
      .def_ro("dimension", &Network::dimension, "2 or 3.")
      .def_prop_ro("edges", edges_of, "The nodes that each range joins, m x 2.")
      .def_prop_ro(
          "ranges",
          [](const Network& self) {
            return member_view(self.ranges, &RangeMeasurement::distance, nb::find(self));
          },
          "Metres, m.")
      .def_prop_ro(
          "variances",
          [](const Network& self) {
            return member_view(self.ranges, &RangeMeasurement::variance, nb::find(self));
          },
          "Square metres, m; 0: not known.")
      .def_prop_ro(
          "positions", [](const Network& self) { return rows_of(self.positions, nb::find(self)); },
          "Where the nodes are said to be, n x d; NaN where that is not known.")
      .def_prop_ro(
          "anchors", [](const Network& self) { return view(self.landmarks, nb::find(self)); },
          "Nodes that do not move.");
  bind_read_report(bound, "the network");
  bind_data_frame(bound, range_frame, "from, to, range and variance");
}

void bind_network(nb::module_& module) {
  nb::class_<Network> bound(
      module, "Network",
      "Nodes of a sensor network and the ranges measured between them. Nodes are "
      "numbered from 0; a network never changes.");
  bind_making(bound);
  bind_contents(bound);
}

void bind_result(nb::module_& module) {
  nb::class_<Localized> bound(module, "Localized", "Where the nodes of a network are.");
  bound
      .def_prop_ro(
          "positions",
          [](const Localized& self) { return rows_of(self.positions, nb::find(self)); },
          "n x d; NaN where there is no unique place.")
      .def_prop_ro("covariances", covariances, nb::rv_policy::automatic,
                   "n x d x d; NaN without a position, 0 for anchors.")
      .def_prop_ro("states", node_states, "'anchor', 'localised', or why a node has no position.")
      .def_prop_ro("verdicts", named_verdicts, "A decision for each range, in order.")
      .def_prop_ro(
          "status", [](const Localized& self) { return std::string(enum_name(self.status)); },
          "'converged', 'not-converged' or 'no-start'.")
      .def_ro("network", &Localized::of, nb::sig("def network(self, /) -> Network"),
              "The network that they are of.")
      .def_ro("anchored", &LocalizeResult::anchored,
              "False: positions are known up to an isometry.")
      .def_ro("noise_factor", &LocalizeResult::noise_factor,
              "By which given standard deviations were multiplied.")
      .def_ro("sigma", &LocalizeResult::sigma, "Found for ranges that came without.")
      .def_ro("chi2", &LocalizeResult::chi2, "Of the kept ranges.")
      .def_ro("dof", &LocalizeResult::dof, "Kept ranges less unknowns.")
      .def_ro("seconds", &LocalizeResult::seconds, "Wall time.")
      .def(
          "report", [](const Localized& self, nb::handle truth) { return page(self, truth); },
          "truth"_a = nb::none(),
          nb::sig("def report(self, truth: numpy.typing.ArrayLike | None = None) -> str"),
          "The page that explains the result, as HTML that needs nothing else; with the true "
          "positions, "
          "their errors, too.")
      .def("_repr_html_", notebook_page)
      .def(
          "write",
          [](const Localized& self, nb::handle path) {
            write_positions(path_of(path), network_of(self), self);
          },
          "path"_a, nb::sig("def write(self, path: str | os.PathLike[str]) -> None"),
          "Write rows of node, position, status, deviation and covariance, as CSV.");
  bind_data_frame(bound, node_frame, "node, position and status");
}

Network read(nb::handle path, bool strict, bool file_anchors) {
  auto file = read_ranges(path_of(path), {.strict = strict});
  if (!file_anchors) file.network.landmarks.clear();
  return {std::move(file.network), std::move(file.report)};
}

nb::tuple read_named(nb::handle path) {
  const auto file = read_positions(path_of(path));
  const Eigen::MatrixXd rows = file.positions.transpose();
  return nb::make_tuple(file.names, give(rows));
}

void write_ranges(nb::handle path, const Network& network) {
  write_range_csv(path_of(path), network);
}

}  // namespace

void bind_networks(nb::module_& module) {
  bind_network(module);
  bind_result(module);
  const std::string path = "path: str | os.PathLike[str]";
  module.def("read_ranges", read, "path"_a, nb::kw_only(), "strict"_a = false,
             "file_anchors"_a = false,
             nb::sig(("def read_ranges(" + path +
                      ", *, strict: bool = False, file_anchors: bool = False) -> Network")
                         .c_str()),
             "Read ranges in any format. Landmarks whose position the file has are anchors with "
             "file_anchors.");
  module.def("read_positions", read_named, "path"_a,
             nb::sig(("def read_positions(" + path +
                      ") -> tuple[list[str], numpy.typing.NDArray[numpy.float64]]")
                         .c_str()),
             "Read names and positions (n x d) from rows of node, x, y and z.");
  module.def("write_ranges", write_ranges, "path"_a, "network"_a,
             nb::sig(("def write_ranges(" + path + ", network: Network) -> None").c_str()),
             "Write rows of from, to, range and sigma.");
  define(module, "localize", "network: Network",
         keywords_of(LocalizeOptions()) + run_keywords(RunTexts::threads), "Localized",
         "Find the nodes of a network from its ranges, with a verdict on each range.", locate,
         "network"_a);
  const KeywordText seed = {"seed", "int", "0", "of the random choices"};
  define(module, "simulate_network", "",
         keywords_of(NetworkOptions()) + std::vector<KeywordText>{seed},
         "tuple[Network, numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int8]]",
         "A network at random, its true positions (n x d), and what each range is: 0 measured, 1 "
         "biased, 2 false.",
         simulate);
}

}  // namespace isotherm::python
