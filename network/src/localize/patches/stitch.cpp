#include "localize/patches/stitch.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/SVD>

#include "isotherm/geometry/points/point_alignment.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"
#include "isotherm/spectral/sparse/damped_step.hpp"
#include "localize/patches/smallest_eigenvectors.hpp"

namespace isotherm::network::detail {
namespace {

constexpr int kReweightings = 3;
constexpr double kWeakest = 0.02;  // trust below which two patches are not joined

// Two patches with the isometry between their frames.
struct Joint {
  Index from = 0;  // patches by their central nodes
  Index to = 0;
  Eigen::MatrixXd rotation;  // of `to` into the frame of `from`
  double trust = 0.0;        // in [0, 1]
};

Joint join(const std::vector<Patch>& patches, Index from, Index to) {
  const auto& a = patches[from];
  const auto& b = patches[to];
  std::vector<int> in_a;
  std::vector<int> in_b;
  for (std::size_t k = 0; k < a.members.size(); ++k) {
    const int other = b.find(a.members[k]);
    if (other < 0) continue;
    in_a.push_back(static_cast<int>(k));
    in_b.push_back(other);
  }
  Joint joint{from, to, {}, 0.0};
  if (static_cast<Eigen::Index>(in_a.size()) <= a.positions.rows()) return joint;
  const auto fit =
      geometry::align_points(b.positions(Eigen::all, in_b), a.positions(Eigen::all, in_a));
  joint.rotation = fit.rotation;
  // What tells a rotation from a reflection, against what does not fit.
  if (fit.certainty > 0.0) {
    const double clear = fit.certainty / (fit.certainty + 4.0 * fit.residual);
    joint.trust = clear * clear;
  }
  return joint;
}

std::vector<Joint> find_joints(const RangeProblem& problem, const std::vector<Patch>& patches) {
  std::vector<Joint> joints;
  for (const auto& pair : problem.pairs) {
    if (patches[pair.from].empty() || patches[pair.to].empty()) continue;
    auto joint = join(patches, pair.from, pair.to);
    if (joint.trust > kWeakest) joints.push_back(std::move(joint));
  }
  return joints;
}

// The nearest orthogonal matrix.
Eigen::MatrixXd orthogonal(const Eigen::MatrixXd& matrix) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

// The patches of one part, and what joins them; joints name places in `centres`.
struct PatchGroup {
  std::vector<Index> centres;
  std::vector<Joint> joints;
};

std::vector<PatchGroup> group(const RangeProblem& problem, const std::vector<Patch>& patches) {
  auto joints = find_joints(problem, patches);
  std::vector<spectral::WeightedEdge> edges;
  for (const auto& joint : joints) edges.push_back({joint.from, joint.to, 1.0});
  const auto components =
      spectral::connected_components(spectral::WeightedGraph(problem.nodes, edges));
  std::vector<PatchGroup> groups(components.count);
  std::vector<Index> place(problem.nodes, 0);
  for (Index v = 0; v < problem.nodes; ++v) {
    if (patches[v].empty()) continue;
    auto& centres = groups[components.label[v]].centres;
    place[v] = static_cast<Index>(centres.size());
    centres.push_back(v);
  }
  for (auto& joint : joints) {
    auto& target = groups[components.label[joint.from]];
    joint.from = place[joint.from];
    joint.to = place[joint.to];
    target.joints.push_back(std::move(joint));
  }
  std::erase_if(groups, [](const PatchGroup& g) { return g.centres.empty(); });
  return groups;
}

template <class Joined>
std::vector<std::pair<Index, Index>> ends_of(const std::vector<Joined>& joined) {
  std::vector<std::pair<Index, Index>> ends;
  for (const auto& each : joined) ends.emplace_back(each.from, each.to);
  return ends;
}

// Z minimising sum trust |Z_from - R Z_to|^2 over orthonormal columns, a d x d block
// a patch, rounded to orthogonal blocks.
std::vector<Eigen::MatrixXd> solve_rotations(const PatchGroup& group, int d,
                                             const std::vector<double>& trust) {
  const auto patches = static_cast<Index>(group.centres.size());
  spectral::BlockCholesky laplacian(d, patches, ends_of(group.joints));
  for (std::size_t k = 0; k < group.joints.size(); ++k) {
    const auto& joint = group.joints[k];
    const Eigen::MatrixXd diagonal = trust[k] * Eigen::MatrixXd::Identity(d, d);
    laplacian.add_diagonal(joint.from, diagonal);
    laplacian.add_diagonal(joint.to, diagonal);
    laplacian.add_pair(k, -trust[k] * joint.rotation);
  }
  const Eigen::MatrixXd vectors = smallest_eigenvectors(laplacian, d);
  std::vector<Eigen::MatrixXd> blocks;
  for (Index p = 0; p < patches; ++p) {
    blocks.push_back(orthogonal(vectors.middleRows(p * d, d)));
  }
  return blocks;
}

// Rotations of each patch's frame into the common one.
std::vector<Eigen::MatrixXd> synchronise(const PatchGroup& group, int d) {
  std::vector<double> trust;
  for (const auto& joint : group.joints) trust.push_back(joint.trust);
  if (group.centres.size() == 1) return {Eigen::MatrixXd::Identity(d, d)};
  auto blocks = solve_rotations(group, d, trust);
  for (int round = 0; round < kReweightings; ++round) {
    for (std::size_t k = 0; k < group.joints.size(); ++k) {
      constexpr double kSquaredAngle = 0.1;  // radians squared, of a joint half believed
      const auto& joint = group.joints[k];
      const double off = (blocks[joint.from] - joint.rotation * blocks[joint.to]).squaredNorm();
      trust[k] = joint.trust / std::pow(1.0 + off / kSquaredAngle, 2);
    }
    blocks = solve_rotations(group, d, trust);
  }
  for (auto& block : blocks) block.transposeInPlace();
  return blocks;
}

// What patches say about the way from one node to another.
struct Step {
  Index from = 0;  // places among the nodes of the part
  Index to = 0;
  Eigen::VectorXd way;
};

Eigen::MatrixXd solve_positions(const std::vector<Step>& steps, const std::vector<double>& weights,
                                Index nodes, int d) {
  using One = Eigen::Matrix<double, 1, 1>;
  spectral::BlockCholesky laplacian(1, nodes, ends_of(steps));
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(nodes, d);
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const auto& [from, to, way] = steps[k];
    const One weight = One::Constant(weights[k]);
    laplacian.add_diagonal(from, weight);
    laplacian.add_diagonal(to, weight);
    laplacian.add_pair(k, -weight);
    right.row(to) += weights[k] * way.transpose();
    right.row(from) -= weights[k] * way.transpose();
  }
  // The first node is pinned: only differences are known.
  laplacian.add_diagonal(0, One::Ones());
  return spectral::solve_least_damped(laplacian, right).transpose();
}

StitchedPart place_members(const PatchGroup& group, const std::vector<Patch>& patches, int d) {
  const auto rotations = synchronise(group, d);
  StitchedPart part;
  for (const Index centre : group.centres) {
    const auto& members = patches[centre].members;
    part.nodes.insert(part.nodes.end(), members.begin(), members.end());
  }
  std::sort(part.nodes.begin(), part.nodes.end());
  part.nodes.erase(std::unique(part.nodes.begin(), part.nodes.end()), part.nodes.end());
  const auto place = [&](Index node) {
    return static_cast<Index>(std::lower_bound(part.nodes.begin(), part.nodes.end(), node) -
                              part.nodes.begin());
  };

  std::vector<Step> steps;
  for (std::size_t p = 0; p < group.centres.size(); ++p) {
    const Index centre = group.centres[p];
    const auto& patch = patches[centre];
    const int self = patch.find(centre);
    for (std::size_t k = 0; k < patch.members.size(); ++k) {
      if (static_cast<int>(k) == self) continue;
      steps.push_back({place(centre), place(patch.members[k]),
                       rotations[p] * (patch.positions.col(k) - patch.positions.col(self))});
    }
  }
  std::vector<double> weights(steps.size(), 1.0);
  const auto count = static_cast<Index>(part.nodes.size());
  part.positions = solve_positions(steps, weights, count, d);
  for (int round = 0; round < kReweightings; ++round) {
    std::vector<double> misses;
    for (const auto& [from, to, way] : steps) {
      misses.push_back((part.positions.col(to) - part.positions.col(from) - way).norm());
    }
    const double usual = lower_median(misses);
    for (std::size_t k = 0; k < steps.size(); ++k) {
      if (usual > 0.0) weights[k] = 1.0 / std::pow(1.0 + std::pow(misses[k] / (3.0 * usual), 2), 2);
    }
    part.positions = solve_positions(steps, weights, count, d);
  }
  return part;
}

}  // namespace

std::vector<StitchedPart> stitch(const RangeProblem& problem, const std::vector<Patch>& patches) {
  std::vector<StitchedPart> parts;
  for (const auto& patch_group : group(problem, patches)) {
    parts.push_back(place_members(patch_group, patches, problem.dimension));
  }
  std::stable_sort(parts.begin(), parts.end(), [](const StitchedPart& a, const StitchedPart& b) {
    return a.nodes.size() > b.nodes.size();
  });
  return parts;
}

}  // namespace isotherm::network::detail
