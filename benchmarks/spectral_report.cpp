// Runs the spectral engine on one pose graph and prints timings as JSON;
// benchmarks/spectral.py compares them with other programs.
//
// usage: spectral_report GRAPH [--tolerance X] [--eigenpairs K] [--dump PREFIX] [--repeat N]
//   GRAPH is a pose graph file, or city:POSES:LOOPS for a simulated one.
#include <algorithm>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iostream>
#include <string>
#include <variant>

#include <nlohmann/json.hpp>

#include "cholmod_timing.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/slam/prune/induce.hpp"
#include "isotherm/slam/simulate/simulate.hpp"
#include "isotherm/spectral/eigen/eigen_decomposition.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"
#include "isotherm/spectral/resistance/effective_resistance.hpp"

namespace {

using namespace isotherm;
using namespace isotherm::spectral;
using Json = nlohmann::ordered_json;

const std::vector<double> kScales = {100, 70, 10, 5, 1, 0.1, 0.001};

struct Arguments {
  std::string graph;
  std::string dump;
  double tolerance = 1e-6;
  int eigenpairs = 0;
  int repeat = 3;
};

Arguments parse(int count, char** values) {
  Arguments arguments;
  arguments.graph = values[1];
  for (int k = 2; k + 1 < count; k += 2) {
    const std::string name = values[k];
    if (name == "--tolerance") arguments.tolerance = std::stod(values[k + 1]);
    if (name == "--eigenpairs") arguments.eigenpairs = std::stoi(values[k + 1]);
    if (name == "--repeat") arguments.repeat = std::stoi(values[k + 1]);
    if (name == "--dump") arguments.dump = values[k + 1];
  }
  return arguments;
}

struct Problem {
  WeightedGraph graph;
  std::vector<VertexPair> loops;
};

template <class Pose>
Problem induce_problem(const slam::PoseGraph<Pose>& poses) {
  const auto roles = slam::edge_roles(poses);
  auto induced = slam::induce(poses, roles);
  Problem problem{std::move(induced.graph), {}};
  for (const auto candidate : roles.candidates) {
    const auto edge = induced.constraint_edge[candidate];
    if (edge < 0) continue;
    problem.loops.push_back({problem.graph.edge(edge).from, problem.graph.edge(edge).to});
  }
  return problem;
}

Problem load(const std::string& name) {
  if (!name.starts_with("city:")) {
    return std::visit([](const auto& poses) { return induce_problem(poses); },
                      slam::read_pose_graph(name).graph);
  }
  const auto colon = name.find(':', 5);
  slam::CityOptions options;
  options.poses = std::stol(name.substr(5, colon - 5));
  options.measurements.loops = std::stol(name.substr(colon + 1));
  return induce_problem(slam::simulate_city(options).graph);
}

/// Shortest wall-clock and processor times of several runs.
struct Timing {
  double wall = 1e300;
  double processor = 1e300;
};

template <class Run>
Timing best_of(int repeat, Run run) {
  Timing best;
  for (int k = 0; k < repeat; ++k) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t processor = std::clock();
    run();
    best.wall = std::min(best.wall, isotherm_bench::seconds_since(start));
    best.processor =
        std::min(best.processor, static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC);
  }
  return best;
}

/// The process's own peak; what it was forked from does not count.
long peak_memory_kb() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    long value = 0;
    if (word == "VmHWM:" && status >> value) return value;
  }
  return 0;
}

bool same_bytes(const HeatDistanceResult& first, const HeatDistanceResult& second) {
  return std::memcmp(first.values.data(), second.values.data(),
                     first.values.size() * sizeof(CertifiedValue)) == 0;
}

Json heat_report(const Problem& problem, const Arguments& arguments, HeatDistanceResult& heat) {
  const HeatDistanceOptions options{.tolerance = arguments.tolerance};
  const Timing timing = best_of(arguments.repeat, [&] {
    heat = heat_distances(problem.graph, problem.loops, kScales, options);
  });
  auto single = options;
  single.threads = 1;
  HeatDistanceResult alone;
  const Timing single_timing =
      best_of(1, [&] { alone = heat_distances(problem.graph, problem.loops, kScales, single); });
  double steps = 0.0;
  for (const int taken : heat.steps) steps += taken;
  return {{"seconds", timing.wall},
          {"processor_seconds", timing.processor},
          {"seconds_one_thread", single_timing.wall},
          {"same_bytes_for_any_thread_count", same_bytes(heat, alone)},
          {"unconverged", heat.unconverged},
          {"widest_bracket", heat.widest},
          {"mean_steps", steps / static_cast<double>(std::max<std::size_t>(1, heat.steps.size()))},
          {"reasons", heat.reasons}};
}

Json resistance_report(const Problem& problem, const Arguments& arguments) {
  ResistanceResult resistance;
  isotherm_bench::CholmodTiming cholmod{1e300, 1e300};
  const Timing timing =
      best_of(arguments.repeat, [&] { resistance = edge_resistances(problem.graph); });
  for (int k = 0; k < arguments.repeat; ++k) {
    const auto other = isotherm_bench::time_cholmod(problem.graph);
    cholmod.analyse = std::min(cholmod.analyse, other.analyse);
    cholmod.factorise = std::min(cholmod.factorise, other.factorise);
  }
  double foster = 0.0;
  for (std::size_t e = 0; e < resistance.values.size(); ++e) {
    foster += resistance.values[e] * problem.graph.edges()[e].weight;
  }
  const double spanning = problem.graph.vertex_count() - connected_components(problem.graph).count;
  return {{"seconds", timing.wall},
          {"processor_seconds", timing.processor},
          {"cholmod_analyse_seconds", cholmod.analyse},
          {"cholmod_factorise_seconds", cholmod.factorise},
          {"residual", resistance.residual},
          {"foster_relative_error", foster / spanning - 1.0}};
}

Json eigen_report(const Problem& problem, const Arguments& arguments) {
  const Laplacian laplacian(problem.graph);
  EigenDecomposition eigen;
  const Timing timing = best_of(std::min(2, arguments.repeat), [&] {
    eigen = smallest_eigenpairs(laplacian, {.count = arguments.eigenpairs});
  });
  return {{"seconds", timing.wall},
          {"count", eigen.count()},
          {"status", static_cast<int>(eigen.status)},
          {"largest_residual_over_norm", eigen.residuals.maxCoeff() / eigen.norm},
          {"orthogonality", eigen.orthogonality},
          {"inertia_count", eigen.inertia_count},
          {"largest_value", eigen.values[eigen.count() - 1]}};
}

void dump(const std::string& prefix, const Problem& problem, const HeatDistanceResult& heat) {
  std::string edges, values;
  for (const auto& edge : problem.graph.edges()) {
    edges += std::to_string(edge.from) + "," + std::to_string(edge.to) + "," +
             format_number(edge.weight) + "\n";
  }
  for (std::size_t k = 0; k < heat.pairs.size(); ++k) {
    values += std::to_string(heat.pairs[k].from) + "," + std::to_string(heat.pairs[k].to);
    for (std::size_t s = 0; s < kScales.size(); ++s) {
      values += "," + format_number(heat.at(k, s).value);
    }
    values += "\n";
  }
  for (const auto& [name, text] : {std::pair(".edges.csv", edges), {".heat.csv", values}}) {
    OutputFile file(prefix + name);
    file.write(text);
    file.commit();
  }
}

}  // namespace

int main(int count, char** values) {
  if (count < 2) {
    std::cerr << "usage: spectral_report GRAPH [--tolerance X] [--eigenpairs K] [--dump PREFIX] "
                 "[--repeat N]\n";
    return 2;
  }
  const auto arguments = parse(count, values);
  const auto problem = load(arguments.graph);
  HeatDistanceResult heat;
  Json report = {{"graph", arguments.graph},
                 {"vertices", problem.graph.vertex_count()},
                 {"edges", problem.graph.edge_count()},
                 {"loops", problem.loops.size()},
                 {"scales", kScales},
                 {"tolerance", arguments.tolerance}};
  report["heat"] = heat_report(problem, arguments, heat);
  report["resistance"] = resistance_report(problem, arguments);
  if (arguments.eigenpairs > 0) report["eigen"] = eigen_report(problem, arguments);
  report["peak_memory_mb"] = peak_memory_kb() / 1024;
  if (!arguments.dump.empty()) dump(arguments.dump, problem, heat);
  std::cout << report.dump(2) << "\n";
  return 0;
}
