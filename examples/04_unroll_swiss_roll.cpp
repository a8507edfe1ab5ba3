// Measures distances along a rolled-up sheet through the graph of its points' nearest
// neighbours, as Isomap does: a few short circuits between the layers of the roll ruin
// them, and pruning restores them.
//
// usage: 04_unroll_swiss_roll [picture.svg]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <numbers>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include <isotherm/base/random.hpp>
#include <isotherm/geometry.hpp>
#include <isotherm/spectral.hpp>

namespace {

using namespace isotherm::spectral;

constexpr int kPoints = 2000;
constexpr int kShortCircuits = 40;

struct Roll {
  Eigen::MatrixXd points = Eigen::MatrixXd(3, kPoints);
  Eigen::MatrixXd sheet = Eigen::MatrixXd(2, kPoints);  // position when unrolled
};

Roll make_roll(isotherm::Random& random) {
  Roll roll;
  for (int k = 0; k < kPoints; ++k) {
    const double angle = 1.5 * std::numbers::pi * (1.0 + 2.0 * random.uniform());
    const double height = 21.0 * random.uniform();
    roll.points.col(k) << angle * std::cos(angle), height, angle * std::sin(angle);
    roll.sheet.col(k) << 0.5 * (angle * std::sqrt(1.0 + angle * angle) + std::asinh(angle)), height;
  }
  return roll;
}

// Joins points to the nearest one of the next layer, as noise or a radius too wide would.
WeightedGraph with_short_circuits(const WeightedGraph& graph, const Roll& roll,
                                  isotherm::Random& random) {
  std::vector<WeightedEdge> edges(graph.edges().begin(), graph.edges().end());
  for (int k = 0; k < kShortCircuits; ++k) {
    const auto from = static_cast<Index>(random.index(kPoints));
    Index to = from;
    double nearest = std::numeric_limits<double>::infinity();
    for (Index other = 0; other < kPoints; ++other) {
      const double length = (roll.points.col(from) - roll.points.col(other)).norm();
      if ((roll.sheet.col(from) - roll.sheet.col(other)).norm() > 20.0 && length < nearest) {
        nearest = length;
        to = other;
      }
    }
    edges.push_back({from, to, 1.0});
  }
  return {kPoints, std::move(edges)};
}

// Dijkstra, an edge being as long as it is in space.
std::vector<double> path_lengths(const WeightedGraph& graph, const Roll& roll, Index start) {
  std::vector<double> length(kPoints, std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  length[start] = 0.0;
  queue.push({0.0, start});
  while (!queue.empty()) {
    const auto [reached, vertex] = queue.top();
    queue.pop();
    if (reached > length[vertex]) continue;
    for (const auto& [other, edge] : graph.neighbours(vertex)) {
      const double via = reached + (roll.points.col(vertex) - roll.points.col(other)).norm();
      if (via >= length[other]) continue;
      length[other] = via;
      queue.push({via, other});
    }
  }
  return length;
}

// Mean of |path length - distance on the sheet| / distance over pairs that are far apart.
double distance_error(const WeightedGraph& graph, const Roll& roll) {
  double sum = 0.0;
  int count = 0;
  for (Index start = 0; start < kPoints; start += 100) {
    const auto length = path_lengths(graph, roll, start);
    for (Index other = 0; other < kPoints; ++other) {
      const double distance = (roll.sheet.col(start) - roll.sheet.col(other)).norm();
      if (distance < 10.0 || !std::isfinite(length[other])) continue;
      sum += std::abs(length[other] - distance) / distance;
      ++count;
    }
  }
  return sum / count;
}

// The sheet, unrolled; points in bands of path length from its left end.
void draw_sheet(std::ofstream& svg, const WeightedGraph& graph, const Roll& roll, double top,
                const std::string& title) {
  constexpr std::array kColours = {"#30123b", "#4662d8", "#35abf8", "#1be5b5", "#74fe5d",
                                   "#c9ef34", "#fbb938", "#f56918", "#c92903", "#7a0403"};
  Index start = 0;
  roll.sheet.row(0).minCoeff(&start);
  const auto length = path_lengths(graph, roll, start);
  std::array<std::string, kColours.size()> dots;
  for (Index v = 0; v < kPoints; ++v) {
    const auto band = static_cast<std::size_t>(std::clamp(length[v] / 10.0, 0.0, 9.0));
    dots[band] += "M" + std::to_string(std::lround(6.0 * roll.sheet(0, v) - 60.0)) + " " +
                  std::to_string(std::lround(top + 6.0 * roll.sheet(1, v))) + "h0";
  }
  svg << "<text x=\"10\" y=\"" << top - 8.0 << "\">" << title << "</text>\n";
  for (std::size_t band = 0; band < dots.size(); ++band) {
    svg << "<path stroke=\"" << kColours[band] << "\" d=\"" << dots[band] << "\"/>\n";
  }
}

}  // namespace

int main(int argc, char** argv) {
  isotherm::Random random(1);
  const Roll roll = make_roll(random);
  const auto clean = isotherm::geometry::nearest_neighbour_graph(roll.points, 7);
  const auto shorted = with_short_circuits(clean, roll, random);

  const auto result = judge_edges(shorted);
  std::vector<bool> keep;
  for (const auto& verdict : result.verdicts) keep.push_back(verdict.verdict != Verdict::prune);
  const auto pruned = filter_edges(shorted, keep);

  const auto found = std::count(keep.end() - kShortCircuits, keep.end(), false);
  std::printf("%d edges, %d short circuits: %d found; %d edges pruned in all\n",
              static_cast<int>(shorted.edge_count()), kShortCircuits, static_cast<int>(found),
              static_cast<int>(count(result.verdicts, Verdict::prune)));
  const double error_shorted = distance_error(shorted, roll);
  const double error_pruned = distance_error(pruned, roll);
  std::printf(
      "mean error of distances along the sheet: %.1f %% without short circuits,\n"
      "%.1f %% with them, %.1f %% after pruning\n",
      100.0 * distance_error(clean, roll), 100.0 * error_shorted, 100.0 * error_pruned);

  if (argc > 1) {
    std::ofstream svg(argv[1]);
    svg << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 590 330\" fill=\"none\" "
           "stroke-width=\"5\" stroke-linecap=\"round\">\n"
           "<g font-family=\"sans-serif\" font-size=\"14\">\n"
           "<style>text{fill:#444;stroke:none}</style>\n";
    draw_sheet(svg, shorted, roll, 28.0, "With short circuits: paths jump between layers");
    draw_sheet(svg, pruned, roll, 192.0, "Pruned: path length from the left end, in bands of 10");
    svg << "</g>\n</svg>\n";
  }
  return error_pruned < 0.5 * error_shorted ? 0 : 1;
}
