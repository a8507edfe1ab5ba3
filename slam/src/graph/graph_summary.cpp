#include "isotherm/slam/graph/graph_summary.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "isotherm/base/statistics.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/slam/graph/information.hpp"
#include "isotherm/slam/graph/odometry.hpp"
#include "isotherm/slam/graph/repeats.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"
#include "matrices/decompositions.hpp"

namespace isotherm::slam {
namespace {

// A step or an information matrix that differs from the median of its kind by
// more than this factor (in length; in standard deviation) is suspicious.
constexpr double kOutlyingStep = 30.0;
constexpr double kOutlyingSigma = 100.0;
// Smallest eigenvalue, after scaling to a unit diagonal, of a matrix that is
// called singular.
constexpr double kSingular = 1e-12;

struct Sigmas {
  double translation = 0.0;
  double rotation = 0.0;
};

template <class Pose>
Sigmas sigmas(const typename Pose::Matrix& information) {
  const typename Pose::Matrix covariance = covariance_from_information<Pose::kDof>(information);
  constexpr int kRotations = Pose::kDof - Pose::kDim;
  const auto variances = covariance.diagonal();
  return {std::sqrt(variances.template head<Pose::kDim>().mean()),
          std::sqrt(variances.template tail<kRotations>().mean())};
}

// Condition number of the matrix scaled to a unit diagonal; infinite if singular.
template <class Matrix>
double scaled_condition(const Matrix& m) {
  if (m.diagonal().minCoeff() <= 0.0) return INFINITY;
  if (m.isDiagonal(0.0)) return 1.0;
  const Eigen::Matrix<double, Matrix::RowsAtCompileTime, 1> scale =
      m.diagonal().cwiseSqrt().cwiseInverse();
  const Matrix scaled = scale.asDiagonal() * m * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(scaled, Eigen::EigenvaluesOnly);
  const double smallest = eigen.eigenvalues()[0];
  if (!(smallest > kSingular)) return INFINITY;
  return eigen.eigenvalues()[Matrix::RowsAtCompileTime - 1] / smallest;
}

template <class Matrix>
bool less_entrywise(const Matrix* a, const Matrix* b) {
  return std::lexicographical_compare(a->data(), a->data() + a->size(), b->data(),
                                      b->data() + b->size());
}

template <class Pose>
class Summarizer {
 public:
  explicit Summarizer(const PoseGraph<Pose>& graph) : graph_(graph), roles_(edge_roles(graph)) {}

  GraphSummary run() {
    count_vertices();
    count_edges();
    find_repeats();
    find_components();
    summary_.odometry_information = health(roles_.odometry, "odometry");
    summary_.candidate_information = health(roles_.candidates, "candidate");
    find_long_steps();
    measure_drift();
    return std::move(summary_);
  }

 private:
  void suspect(const std::string& kind, std::uint64_t line, std::string message) {
    if (summary_.suspicious[kind]++ < GraphSummary::kKeptPerKind) {
      summary_.suspicions.push_back({kind, line, std::move(message)});
    }
  }

  const Constraint<Pose>& constraint(Index k) const { return graph_.constraints[k]; }

  std::string ends(const Constraint<Pose>& edge) const {
    return vertex_name(graph_.ids[edge.from]) + " -> " + vertex_name(graph_.ids[edge.to]);
  }

  void count_vertices() {
    summary_.dimension = Pose::kDim;
    summary_.vertices = graph_.ids.size();
    summary_.fixed = graph_.fixed.size();
    summary_.has_poses = !graph_.poses.empty();
    std::set<std::uint64_t> robots;
    for (Index v = 0; v < graph_.vertex_count(); ++v) robots.insert(graph_.robot(v));
    summary_.robots = robots.size();
  }

  void count_edges() {
    summary_.edges = graph_.constraints.size();
    summary_.odometry = roles_.odometry.size();
    summary_.candidates = roles_.candidates.size();
    for (const auto& edge : graph_.constraints) {
      const VertexId from = graph_.ids[edge.from];
      const VertexId to = graph_.ids[edge.to];
      if (std::max(from, to) - std::min(from, to) == 1) ++summary_.consecutive_edges;
      if (from == to) {
        ++summary_.self_edges;
        suspect("self edge", edge.line, "edge from vertex " + vertex_name(from) + " to itself");
      }
    }
    summary_.other_edges = summary_.edges - summary_.consecutive_edges;
  }

  void find_repeats() {
    for (const auto& repeat : exact_repeats(graph_)) {
      ++summary_.exact_repeats;
      suspect("repeated edge", constraint(repeat.edge).line,
              "edge " + ends(constraint(repeat.edge)) + " says again what line " +
                  std::to_string(constraint(repeat.original).line) +
                  " says; both count as one measurement");
    }
    std::vector<Index> order(graph_.constraints.size());
    std::iota(order.begin(), order.end(), 0);
    const auto pair_of = [this](Index k) {
      return std::minmax(constraint(k).from, constraint(k).to);
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return pair_of(a) < pair_of(b); });
    for (std::size_t i = 1; i < order.size(); ++i) {
      if (pair_of(order[i - 1]) != pair_of(order[i])) continue;
      ++summary_.repeated_edges;
      suspect("repeated pair", constraint(order[i]).line,
              "edge " + ends(constraint(order[i])) + " repeats the pair of line " +
                  std::to_string(constraint(order[i - 1]).line));
    }
  }

  void find_components() {
    std::vector<spectral::WeightedEdge> all;
    std::vector<spectral::WeightedEdge> odometry;
    for (const auto& edge : graph_.constraints) all.push_back({edge.from, edge.to, 1.0});
    for (const Index k : roles_.odometry) {
      odometry.push_back({constraint(k).from, constraint(k).to, 1.0});
    }
    const spectral::WeightedGraph structure(graph_.vertex_count(), std::move(all));
    const auto components = spectral::connected_components(structure);
    std::vector<std::uint64_t> sizes(components.count, 0);
    for (const Index label : components.label) ++sizes[label];
    summary_.components = sizes.size();
    summary_.largest_component = sizes.empty() ? 0 : *std::max_element(sizes.begin(), sizes.end());
    for (Index v = 0; v < graph_.vertex_count(); ++v) {
      if (structure.neighbours(v).empty()) ++summary_.isolated_vertices;
    }
    const spectral::WeightedGraph chains(graph_.vertex_count(), std::move(odometry));
    summary_.odometry_chains = spectral::connected_components(chains).count;
    if (summary_.components > 1) {
      suspect("not connected", 0,
              "the graph falls into " + std::to_string(summary_.components) + " parts");
    }
    if (summary_.odometry_chains > summary_.robots) {
      suspect("broken odometry", 0,
              "odometry falls into " + std::to_string(summary_.odometry_chains) + " chains");
    }
  }

  InformationHealth health(const std::vector<Index>& edges, const std::string& kind) {
    InformationHealth result;
    result.edges = edges.size();
    if (edges.empty()) return result;
    std::vector<double> translations;
    std::vector<double> rotations;
    std::vector<const typename Pose::Matrix*> matrices;
    for (const Index k : edges) {
      const auto& information = constraint(k).information;
      matrices.push_back(&information);
      const auto [translation, rotation] = sigmas<Pose>(information);
      translations.push_back(translation);
      rotations.push_back(rotation);
      if (!information.isDiagonal(0.0)) ++result.off_diagonal;
      const double condition = scaled_condition(information);
      if (std::isinf(condition)) {
        ++result.singular;
        suspect("singular information", constraint(k).line,
                "information of " + kind + " edge " + ends(constraint(k)) + " is singular");
      } else {
        result.worst_condition = std::max(result.worst_condition, condition);
      }
    }
    result.median_translation_sigma = median(translations);
    result.median_rotation_sigma = median(rotations);
    std::sort(matrices.begin(), matrices.end(), less_entrywise<typename Pose::Matrix>);
    result.distinct = static_cast<std::uint64_t>(
        std::unique(matrices.begin(), matrices.end(),
                    [](const auto* a, const auto* b) { return *a == *b; }) -
        matrices.begin());
    for (std::size_t i = 0; i < edges.size(); ++i) {
      check_sigma(edges[i], kind, "translation", translations[i], result.median_translation_sigma);
      check_sigma(edges[i], kind, "rotation", rotations[i], result.median_rotation_sigma);
    }
    return result;
  }

  void check_sigma(Index k, const std::string& kind, const std::string& part, double sigma,
                   double typical) {
    const bool outlying = sigma > kOutlyingSigma * typical || sigma * kOutlyingSigma < typical;
    if (!outlying) return;
    suspect("outlying information", constraint(k).line,
            kind + " edge " + ends(constraint(k)) + " has a " + part + " sigma of " +
                format_number(sigma) + ", the median is " + format_number(typical));
  }

  void find_long_steps() {
    std::vector<double> lengths;
    for (const Index k : roles_.odometry) {
      lengths.push_back(constraint(k).T_from_to.translation().norm());
    }
    if (lengths.empty()) return;
    const double typical = median(lengths);
    if (typical == 0.0) return;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      if (lengths[i] <= kOutlyingStep * typical) continue;
      const auto& edge = constraint(roles_.odometry[i]);
      suspect("long odometry step", edge.line,
              "odometry " + ends(edge) + " moves " + format_number(lengths[i]) +
                  " m, the median is " + format_number(typical) + " m");
    }
  }

  void measure_drift() {
    if (graph_.poses.empty()) return;
    OdometryDrift drift;
    for (const Index k : roles_.odometry) {
      drift.path_length += constraint(k).T_from_to.translation().norm();
    }
    const auto chained = odometry_poses(graph_, roles_);
    double sum = 0.0;
    for (std::size_t v = 0; v < chained.size(); ++v) {
      const double distance = (chained[v].translation() - graph_.poses[v].translation()).norm();
      sum += distance;
      if (distance > drift.max_distance) {
        drift.max_distance = distance;
        drift.max_vertex = graph_.ids[v];
      }
      drift.end_distance = distance;
    }
    drift.mean_distance = sum / static_cast<double>(chained.size());
    drift.end_rotation = chained.back().between(graph_.poses.back()).rotation_angle();
    summary_.drift = drift;
  }

  const PoseGraph<Pose>& graph_;
  EdgeRoles roles_;
  GraphSummary summary_;
};

}  // namespace

template <class Pose>
GraphSummary summarize(const PoseGraph<Pose>& graph) {
  return Summarizer<Pose>(graph).run();
}

template GraphSummary summarize(const PoseGraph<Pose2>&);
template GraphSummary summarize(const PoseGraph<Pose3>&);

}  // namespace isotherm::slam
