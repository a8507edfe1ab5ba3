// Runs one machine's spectral engine on one graph file and prints its time and memory as JSON.
//
// usage: engine_report GRAPH embed DIMENSIONS
//        engine_report GRAPH heat PAIRS TOLERANCE SCALE...
#include <algorithm>
#include <chrono>
#include <iostream>
#include <string>
#include <vector>

#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "isotherm/spectral/eigen/embed.hpp"
#include "isotherm/spectral/graph/graph_file.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"

namespace {

using namespace isotherm::spectral;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Json heat(const GraphFile& file, const std::vector<std::string>& words) {
  std::vector<VertexPair> pairs;
  const auto asked = read_graph(words[2]);
  for (const auto& edge : asked.graph.edges()) {
    const auto position = [&](Index vertex) {
      const auto place = std::lower_bound(file.ids.begin(), file.ids.end(), asked.ids[vertex]);
      return static_cast<Index>(place - file.ids.begin());
    };
    pairs.push_back({position(edge.from), position(edge.to)});
  }
  std::vector<double> scales;
  for (std::size_t k = 4; k < words.size(); ++k) scales.push_back(std::stod(words[k]));
  const auto result = heat_distances(file.graph, pairs, scales, {.tolerance = std::stod(words[3])});
  return {{"seconds", result.seconds}, {"unconverged", result.unconverged}};
}

Json run(const std::vector<std::string>& words) {
  const auto start = Clock::now();
  auto file = read_graph(words[0]);
  merge_directions(file);
  const double reading = seconds_since(start);
  Json json;
  if (words[1] == "embed") {
    const auto result = embed(file.graph, {.dimensions = std::stoi(words[2])});
    json = {{"seconds", result.eigen.seconds},
            {"converged", result.eigen.status == EigenStatus::converged}};
  } else {
    json = heat(file, words);
  }
  json["reading"] = reading;
  json["all"] = seconds_since(start);
  struct rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  json["megabytes"] = usage.ru_maxrss / 1000;
  return json;
}

}  // namespace

int main(int count, char** values) {
  std::cout << run({values + 1, values + count}).dump() << '\n';
}
