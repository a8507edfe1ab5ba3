#include "isotherm/slam/simulate/simulate.hpp"

#include <string>
#include <utility>
#include <variant>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include "isotherm/slam/graph/odometry.hpp"
#include "isotherm/slam/simulate/corrupt.hpp"
#include "isotherm/slam/simulate/densify.hpp"
#include "keywords.hpp"
#include "modules.hpp"
#include "slam/labels.hpp"
#include "slam/pose_arrays.hpp"
#include "slam/pose_graph.hpp"

namespace isotherm::python {
namespace {

using namespace nanobind::literals;

const KeywordText kSeed = {"seed", "int", "0", "of the random choices"};

// Defines a function that makes a world of one kind.
template <class Options, class Make>
void define_world(nb::module_& module, const std::string& name, const std::string& summary,
                  Make make) {
  define(module, name.c_str(), "", keywords_of(Options()) + std::vector<KeywordText>{kSeed},
         "tuple[PoseGraph, numpy.typing.NDArray[numpy.float64]]",
         summary + " Gives the graph, whose poses are chained odometry, and the true poses.",
         [name, make](nb::kwargs given) {
           Keywords keywords(name, std::move(given));
           Options options;
           keywords.take_fields(options);
           keywords.take_into("seed", options.seed);
           keywords.finish();
           auto world = without_gil({}, nb::none(),
                                    [make, options](const RunContext&) { return make(options); });
           return nb::make_tuple(PoseGraphFile{std::move(world.graph), {}, {}, {}},
                                 give_poses(world.truth));
         });
}

// What the labels of false loops are measured against.
template <class Pose>
std::vector<Pose> true_poses(const slam::PoseGraph<Pose>& graph, nb::handle truth) {
  if (!truth.is_none()) return poses_from<Pose>(truth, "truth");
  if (!graph.poses.empty()) return graph.poses;
  return slam::odometry_poses(graph, slam::edge_roles(graph));
}

nb::tuple corrupt_graph(const PoseGraphFile& graph, nb::handle truth, nb::kwargs given) {
  Keywords keywords("corrupt", std::move(given));
  slam::CorruptOptions options;
  nb::object seed = keywords.take("seed");
  if (!seed.is_none()) detail::assign("seed", seed, options.seed);
  keywords.take_fields(options);
  keywords.finish();
  return std::visit(
      [&](const auto& own) {
        auto made = without_gil({}, nb::find(graph),
                                [&own, poses = true_poses(own, truth), options](const RunContext&) {
                                  return slam::corrupt(own, poses, options);
                                });
        return nb::make_tuple(with_graph(graph, std::move(made.graph)),
                              Labels{std::move(made.labels)});
      },
      graph.graph);
}

PoseGraphFile densify_graph(const PoseGraphFile& graph, nb::kwargs given) {
  Keywords keywords("densify", std::move(given));
  slam::DensifyOptions options;
  keywords.take_fields(options);
  keywords.finish();
  auto dense = without_gil({}, nb::find(graph), [&graph, options](const RunContext&) {
    return std::visit(
        [&options](const auto& own) -> slam::AnyPoseGraph {
          return slam::densify(own, slam::edge_roles(own), options);
        },
        graph.graph);
  });
  return with_graph(graph, std::move(dense));
}

}  // namespace

void bind_simulate(nb::module_& module) {
  define_world<slam::CityOptions>(module, "simulate_city",
                                  "A robot that drives along the streets of a city.",
                                  slam::simulate_city);
  define_world<slam::RingOptions>(module, "simulate_ring", "A robot that drives laps of a circle.",
                                  slam::simulate_ring);
  define_world<slam::SphereOptions>(module, "simulate_sphere",
                                    "A vehicle that spirals over a sphere.", slam::simulate_sphere);
  define_world<slam::Grid3dOptions>(module, "simulate_grid3d", "A vehicle in a city in space.",
                                    slam::simulate_grid3d);
  define(module, "corrupt", "graph: PoseGraph, truth: numpy.typing.ArrayLike | None = None",
         keywords_of(slam::CorruptOptions()) + std::vector<KeywordText>{kSeed},
         "tuple[PoseGraph, Labels]",
         "Add false loop closures to a graph whose loops are true. One of count, ratio and "
         "fraction says how many. Labels go by the true poses, or by the graph's own.",
         corrupt_graph, "graph"_a, "truth"_a = nb::none());
  define(module, "densify", "graph: PoseGraph", keywords_of(slam::DensifyOptions()), "PoseGraph",
         "Replicate loop closures in their neighbourhood.", densify_graph, "graph"_a);
}

}  // namespace isotherm::python
