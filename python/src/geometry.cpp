#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "graph.hpp"
#include "isotherm/geometry/curves/lap_line.hpp"
#include "isotherm/geometry/points/neighbour_graph.hpp"
#include "isotherm/geometry/points/point_alignment.hpp"
#include "isotherm/geometry/points/point_cloud.hpp"
#include "keywords.hpp"
#include "modules.hpp"

namespace isotherm::python {
namespace {

using namespace nanobind::literals;
using namespace geometry;

// The graph that `join(points, context)` makes, which keeps the points.
template <class Join>
Graph join_points(const char* name, nb::handle rows, nb::kwargs given, Join join) {
  Keywords keywords(name, std::move(given));
  const RunKeywords run = keywords.take_run();
  keywords.finish();
  return without_gil(run, nb::none(),
                     [points = columns_of(rows, "points"), join](const RunContext& context) {
                       spectral::WeightedGraph graph = join(points, context);
                       auto ids = counted_ids(graph.vertex_count());
                       return Graph{std::move(graph), std::move(ids), points};
                     });
}

Graph nearest(nb::handle points, int neighbours, nb::kwargs given) {
  return join_points("nearest_neighbour_graph", points, std::move(given),
                     [neighbours](const Eigen::MatrixXd& columns, const RunContext& context) {
                       return nearest_neighbour_graph(columns, neighbours, context);
                     });
}

Graph within(nb::handle points, double radius, nb::kwargs given) {
  return join_points("radius_graph", points, std::move(given),
                     [radius](const Eigen::MatrixXd& columns, const RunContext& context) {
                       return radius_graph(columns, radius, context);
                     });
}

nb::tuple read(nb::handle path) {
  auto file = read_points(path_of(path));
  const Eigen::MatrixXd rows = file.points.transpose();
  return nb::make_tuple(give(rows), give(std::move(file.ids)));
}

PointAlignment align(nb::handle from, nb::handle to) {
  const Eigen::MatrixXd source = columns_of(from, "from");
  const Eigen::MatrixXd target = columns_of(to, "to");
  return align_points(source, target);
}

nb::ndarray<nb::numpy, double, nb::shape<-1, -1>> apply(const PointAlignment& self,
                                                        nb::handle points) {
  const Eigen::MatrixXd columns = columns_of(points, "points", self.rotation.cols());
  const Eigen::MatrixXd moved = self.apply(columns).transpose();
  return give(moved);
}

template <int Dim>
std::vector<CurveDescriptor<Dim>> describe(const Input<double>& points,
                                           const std::vector<int>& vertices,
                                           const LapLineOptions& options, const RunKeywords& run) {
  using Point = typename Polyline<Dim>::Point;
  std::vector<Point> list(points.shape(0));
  for (std::size_t k = 0; k < list.size(); ++k) {
    list[k] = Eigen::Map<const Point>(points.data() + k * Dim);
  }
  return without_gil(
      run, nb::none(),
      [line = Polyline<Dim>(std::move(list)), vertices, options](const RunContext& context) {
        return lap_lines(line, vertices, options, context.threads, context.progress);
      });
}

using Descriptors = std::variant<std::vector<CurveDescriptor<2>>, std::vector<CurveDescriptor<3>>>;

Descriptors lap_lines_of(nb::handle points, nb::handle vertices, nb::kwargs given) {
  Keywords keywords("lap_lines", std::move(given));
  LapLineOptions options;
  keywords.take_fields(options);
  const RunKeywords run = keywords.take_run();
  keywords.finish();
  const auto rows = numbers<double>(points, "points", {kAny, kAny});
  const auto chosen = number_list<int>(vertices, "vertices");
  if (rows.shape(1) == 3) return describe<3>(rows, chosen, options, run);
  return describe<2>(numbers<double>(points, "points", {kAny, 2}), chosen, options, run);
}

template <int Dim>
void bind_descriptor(nb::module_& module, const char* name) {
  using Descriptor = CurveDescriptor<Dim>;
  nb::class_<Descriptor>(module, name,
                         "Offsets of a curve from a straight line through one of its vertices.")
      .def_ro("interval", &Descriptor::interval, "Metres between samples.")
      .def_ro("behind", &Descriptor::behind, "Samples before the vertex.")
      .def_ro("ahead", &Descriptor::ahead, "Samples after the vertex.")
      .def_prop_ro(
          "direction",
          [](const Descriptor& self) {
            return strided_view(self.direction.data(), Dim, sizeof(double), nb::find(self));
          },
          "Unit vector along the line.")
      .def_prop_ro(
          "offsets",
          [](const Descriptor& self) {
            constexpr std::size_t kRows = Dim - 1;
            return strided_rows(self.offsets.data(), static_cast<std::size_t>(self.offsets.cols()),
                                kRows, kRows * sizeof(double), nb::find(self));
          },
          "Metres from the line, one row a sample.")
      .def("reversed", &reversed<Dim>, "The same place when travelled the other way.")
      .def(
          "disparity",
          [](const Descriptor& self, const Descriptor& other) {
            const auto found = disparity(self, other);
            return nb::make_tuple(found.rms, found.samples);
          },
          "other"_a,
          nb::sig((std::string("def disparity(self, other: ") + name + ") -> tuple[float, int]")
                      .c_str()),
          "How unlike two descriptors are: root mean square in metres, and samples compared.");
}

void bind_alignment(nb::module_& module) {
  nb::class_<PointAlignment>(module, "PointAlignment",
                             "x -> rotation x + translation, which may be a reflection.")
      .def_prop_ro(
          "rotation",
          [](const PointAlignment& self) { return view(self.rotation, nb::find(self)); }, "d x d.")
      .def_prop_ro(
          "translation",
          [](const PointAlignment& self) { return view(self.translation, nb::find(self)); }, "d.")
      .def_ro("residual", &PointAlignment::residual, "Sum of the squared distances that remain.")
      .def_ro("certainty", &PointAlignment::certainty,
              "0 where the points leave a reflection undecided.")
      .def("apply", apply, "points"_a,
           nb::sig("def apply(self, points: numpy.typing.ArrayLike) -> "
                   "numpy.typing.NDArray[numpy.float64]"),
           "Where the points (n x d) go.");
  module.def("align_points", align, "source"_a, "target"_a,
             nb::sig("def align_points(source: numpy.typing.ArrayLike, target: "
                     "numpy.typing.ArrayLike) -> PointAlignment"),
             "The isometry that brings the points of `source` (n x d) nearest to those of "
             "`target`, row by row.");
}

}  // namespace

void bind_geometry(nb::module_& module) {
  bind_descriptor<2>(module, "CurveDescriptor2");
  bind_descriptor<3>(module, "CurveDescriptor3");
  bind_alignment(module);
  const auto run = run_keywords(RunTexts::threads);
  const std::string graph = "isotherm._core.spectral.Graph";
  define(module, "nearest_neighbour_graph", "points: numpy.typing.ArrayLike, neighbours: int", run,
         graph, "Join each point (n x d) to so many nearest ones.", nearest, "points"_a,
         "neighbours"_a);
  define(module, "radius_graph", "points: numpy.typing.ArrayLike, radius: float", run, graph,
         "Join points (n x d) at most so far from each other.", within, "points"_a, "radius"_a);
  define(module, "lap_lines", "points: numpy.typing.ArrayLike, vertices: numpy.typing.ArrayLike",
         keywords_of(LapLineOptions()) + run, "list[CurveDescriptor2] | list[CurveDescriptor3]",
         "Describe the curve through points (n x 2 or n x 3) around some of them.", lap_lines_of,
         "points"_a, "vertices"_a);
  module.def("read_points", read, "path"_a,
             nb::sig("def read_points(path: str | os.PathLike[str]) -> "
                     "tuple[numpy.typing.NDArray[numpy.float64], "
                     "numpy.typing.NDArray[numpy.uint64]]"),
             "Read points (n x d) and their numbers from rows of coordinates or a NumPy file.");
}

}  // namespace isotherm::python
