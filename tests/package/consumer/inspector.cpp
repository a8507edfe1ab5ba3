// usage: inspector make|check
//
// Writes the files that the other programs read, with false edges that are known, or checks
// what they made of them; in the current folder.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <string>

#include <isotherm/network.hpp>
#include <isotherm/slam.hpp>
#include <isotherm/spectral.hpp>

namespace {

using namespace isotherm;

constexpr int kFalseLoops = 30;
constexpr int kSide = 12;  // of the square grid of points
constexpr int kFalseEdges = 6;

bool expect(bool holds, const char* what) {
  if (!holds) std::fprintf(stderr, "not so: %s\n", what);
  return holds;
}

network::SimulatedNetwork sensors() {
  return network::simulate_network({.nodes = 60, .anchors = 8, .degree = 18.0, .noise = 0.01});
}

template <class Pose>
void make_poses(const std::string& name, const slam::Simulation<Pose>& made) {
  const auto bad = slam::corrupt(made.graph, made.truth, {.count = kFalseLoops, .seed = 1});
  slam::write_g2o(name + ".g2o", bad.graph);
}

void make_grid() {
  std::vector<spectral::WeightedEdge> edges;
  std::vector<std::uint64_t> ids;
  std::ofstream points("points.csv");
  for (int v = 0; v < kSide * kSide; ++v) {
    ids.push_back(static_cast<std::uint64_t>(v));
    points << v % kSide << "," << v / kSide << "\n";
    if (v % kSide + 1 < kSide) edges.push_back({v, v + 1, 1.0});
    if (v + kSide < kSide * kSide) edges.push_back({v, v + kSide, 1.0});
  }
  for (int k = 0; k < kFalseEdges; ++k) edges.push_back({k * 13, kSide * kSide - 1 - k * 9, 1.0});
  spectral::write_edge_csv("graph.csv", {kSide * kSide, edges}, ids);
}

void make() {
  make_poses("plane", slam::simulate_city({.poses = 300, .measurements = {.loops = 120}}));
  make_poses("space", slam::simulate_sphere({.poses = 300, .measurements = {.loops = 120}}));
  make_grid();
  const auto made = sensors();
  network::write_range_csv("ranges.csv", made.network);
  std::ofstream anchors("anchors.csv");
  for (const auto v : made.network.landmarks) {
    anchors << made.network.names[v] << "," << made.truth(0, v) << "," << made.truth(1, v) << "\n";
  }
}

template <class Pose>
bool check_poses(const std::string& name) {
  const auto before = slam::read_pose_graph(name + ".g2o");
  const auto after = slam::read_pose_graph(name + "-pruned.g2o");
  const auto verdicts = spectral::read_verdicts(name + ".csv");
  const auto pruned = spectral::count(verdicts, spectral::Verdict::prune);
  const auto ambiguous = spectral::count(verdicts, spectral::Verdict::ambiguous);
  const auto lost =
      slam::as<Pose>(before).constraint_count() - slam::as<Pose>(after).constraint_count();
  return expect(verdicts.size() == 120u + kFalseLoops, "a verdict for every loop") &&
         expect(std::abs(pruned + ambiguous - kFalseLoops) <= 3, "the false loops were found") &&
         expect(lost == pruned + ambiguous, "they are not in the output");
}

bool check_grid() {
  const auto before = spectral::read_graph("graph.csv").graph.edge_count();
  const auto after = spectral::read_graph("kept.csv").graph.edge_count();
  const auto verdicts = spectral::read_verdicts("neighbours.csv");
  return expect(std::abs(before - after - kFalseEdges) <= 2, "the false edges were found") &&
         expect(verdicts.size() >= kSide * kSide * 7 / 2, "every neighbour was judged");
}

bool check_sensors() {
  const auto made = sensors();
  const auto found = network::read_positions("positions.csv");
  const auto column_of = found.column_of();
  double worst = 0.0;
  for (spectral::Index v = 0; v < made.network.node_count(); ++v) {
    const auto column = column_of.find(made.network.names[v]);
    if (column == column_of.end()) continue;
    worst = std::max(worst, (found.positions.col(column->second) - made.truth.col(v)).norm());
  }
  return expect(column_of.size() > 50, "most nodes were found") &&
         expect(worst < 0.2 * made.radius, "they are where they should be");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "make") == 0) {
    make();
    return 0;
  }
  const bool plane = check_poses<slam::Pose2>("plane");
  const bool space = check_poses<slam::Pose3>("space");
  const bool grid = check_grid();
  const bool nodes = check_sensors();
  return plane && space && grid && nodes ? 0 : 1;
}
