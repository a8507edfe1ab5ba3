#include "localize/refine/range_information.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>
#include <Eigen/SparseCholesky>

namespace isotherm::network::detail {
namespace {

// Regularisation, as a part of the largest diagonal entry: far below what ranges
// say, far above rounding.
constexpr double kRegularisation = 1e-11;

}  // namespace

RangeInformation::RangeInformation(const RangeProblem& problem, const std::vector<bool>& use,
                                   const Placement& placement, bool unit_weights)
    : problem_(problem), use_(use), placement_(placement), unit_weights_(unit_weights) {
  const int d = problem.dimension;
  first_row_.assign(problem.nodes, -1);
  for (Index v = 0; v < problem.nodes; ++v) {
    if (!placement.placed[v] || problem.is_anchor[v]) continue;
    first_row_[v] = static_cast<Index>(unknown_nodes_.size()) * d;
    unknown_nodes_.push_back(v);
  }
  std::vector<Eigen::Triplet<double, Index>> entries;
  const auto add_block = [&](Index a, Index b, const Block& block) {
    if (a < 0 || b < 0) return;
    for (int i = 0; i < d; ++i) {
      for (int j = 0; j < d; ++j) {
        if (a + i >= b + j) entries.emplace_back(a + i, b + j, block(i, j));
      }
    }
  };
  for (const Index v : unknown_nodes_) add_block(row(v), row(v), Block::Zero(d, d));
  for (std::size_t k = 0; k < problem.ranges.size(); ++k) {
    const auto& range = problem.ranges[k];
    if (!use[k] || !between_placed(k)) continue;
    const Point u = direction(range.from, range.to);
    const Block block = information(k) * u * u.transpose();
    const Index a = row(range.from);
    const Index b = row(range.to);
    add_block(a, a, block);
    add_block(b, b, block);
    add_block(std::max(a, b), std::min(a, b), -block);
  }
  if (!problem.anchored()) hold_frame(entries);
  const auto size = static_cast<Index>(unknown_nodes_.size()) * d;
  matrix_.resize(size, size);
  matrix_.setFromTriplets(entries.begin(), entries.end());
}

bool RangeInformation::between_placed(std::size_t k) const {
  return placement_.placed[problem_.ranges[k].from] && placement_.placed[problem_.ranges[k].to];
}

double RangeInformation::residual(std::size_t k) const {
  const auto& range = problem_.ranges[k];
  return range.distance -
         (placement_.positions.col(range.from) - placement_.positions.col(range.to)).norm();
}

double RangeInformation::information(std::size_t k) const {
  return unit_weights_ ? 1.0 : 1.0 / (problem_.sigmas[k] * problem_.sigmas[k]);
}

Point RangeInformation::direction(Index from, Index to) const {
  const Point arm = placement_.positions.col(from) - placement_.positions.col(to);
  const double length = arm.norm();
  if (length > 0.0) return arm / length;
  return Point::Unit(problem_.dimension, 0);
}

// A node and d others that all have used ranges to each other, the node with the most
// neighbours first; fewer if there is no such simplex.
std::vector<Index> RangeInformation::frame_nodes() const {
  const auto& graph = problem_.pair_graph;
  std::vector<bool> pair_used(problem_.pairs.size(), false);
  for (std::size_t k = 0; k < problem_.ranges.size(); ++k) {
    if (use_[k]) pair_used[problem_.pair_of[k]] = true;
  }
  const auto neighbours = [&](Index node) {
    std::vector<Index> found;
    for (const auto& [vertex, edge] : graph.neighbours(node)) {
      if (pair_used[edge] && first_row_[vertex] >= 0) found.push_back(vertex);
    }
    std::sort(found.begin(), found.end());
    return found;
  };
  std::vector<Index> order = unknown_nodes_;
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    return graph.neighbours(a).size() > graph.neighbours(b).size();
  });
  std::vector<Index> best;
  for (const Index start : order) {
    std::vector<Index> simplex = {start};
    std::vector<Index> common = neighbours(start);
    while (!common.empty() && static_cast<int>(simplex.size()) <= problem_.dimension) {
      // The farthest of the common neighbours gives the widest base.
      const auto far = std::max_element(common.begin(), common.end(), [&](Index a, Index b) {
        const auto from = placement_.positions.col(simplex.front());
        return (placement_.positions.col(a) - from).norm() <
               (placement_.positions.col(b) - from).norm();
      });
      const Index next = *far;
      simplex.push_back(next);
      std::vector<Index> remaining;
      const auto others = neighbours(next);
      std::set_intersection(common.begin(), common.end(), others.begin(), others.end(),
                            std::back_inserter(remaining));
      common = std::move(remaining);
    }
    if (simplex.size() > best.size()) best = simplex;
    if (static_cast<int>(best.size()) > problem_.dimension) break;
  }
  return best;
}

// Orthonormal rigid motions of some nodes: translations and infinitesimal rotations.
Eigen::MatrixXd RangeInformation::rigid_motions(const std::vector<Index>& nodes) const {
  const int d = problem_.dimension;
  const auto count = static_cast<Eigen::Index>(nodes.size());
  const Eigen::MatrixXd points = placement_.positions(Eigen::all, nodes);
  const Eigen::MatrixXd centred = points.colwise() - points.rowwise().mean();
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(d * count, d + d * (d - 1) / 2);
  for (Eigen::Index k = 0; k < count; ++k) {
    motions.block(d * k, 0, d, d).setIdentity();
    int column = d;
    for (int i = 0; i < d; ++i) {
      for (int j = i + 1; j < d; ++j, ++column) {
        motions(d * k + i, column) = -centred(j, k);
        motions(d * k + j, column) = centred(i, k);
      }
    }
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(motions);
  return qr.householderQ() * Eigen::MatrixXd::Identity(motions.rows(), qr.rank());
}

void RangeInformation::hold_frame(std::vector<Eigen::Triplet<double, Index>>& entries) const {
  const auto nodes = frame_nodes();
  if (nodes.empty()) return;
  const int d = problem_.dimension;
  const Eigen::MatrixXd motions = rigid_motions(nodes);
  double scale = 0.0;
  for (std::size_t k = 0; k < problem_.ranges.size(); ++k) {
    if (use_[k]) scale = std::max(scale, information(k));
  }
  const Eigen::MatrixXd penalty = scale * motions * motions.transpose();
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    for (std::size_t b = 0; b < nodes.size(); ++b) {
      for (int i = 0; i < d; ++i) {
        for (int j = 0; j < d; ++j) {
          const Index r = row(nodes[a]) + i;
          const Index c = row(nodes[b]) + j;
          if (r >= c) {
            entries.emplace_back(r, c,
                                 penalty(static_cast<Eigen::Index>(a) * d + i,
                                         static_cast<Eigen::Index>(b) * d + j));
          }
        }
      }
    }
  }
}

spectral::SparseMatrix RangeInformation::regularised(double relative) const {
  spectral::SparseMatrix matrix = matrix_;
  const double largest = matrix.rows() > 0 ? matrix.diagonal().maxCoeff() : 0.0;
  const double amount = relative * (largest > 0.0 ? largest : 1.0);
  for (Index i = 0; i < unknowns(); ++i) matrix.coeffRef(i, i) += amount;
  return matrix;
}

std::vector<Eigen::MatrixXd> RangeInformation::diagonal_blocks(
    const spectral::SparseMatrix& matrix) const {
  const int d = problem_.dimension;
  std::vector<spectral::VertexPair> wanted;
  for (const Index v : unknown_nodes_) {
    for (int i = 0; i < d; ++i) {
      for (int j = 0; j <= i; ++j) wanted.push_back({row(v) + i, row(v) + j});
    }
  }
  const auto values = spectral::inverse_entries(matrix, wanted).values;
  std::vector<Eigen::MatrixXd> blocks(problem_.nodes);
  std::size_t next = 0;
  for (const Index v : unknown_nodes_) {
    blocks[v].resize(d, d);
    for (int i = 0; i < d; ++i) {
      for (int j = 0; j <= i; ++j) blocks[v](i, j) = blocks[v](j, i) = values[next++];
    }
  }
  return blocks;
}

std::vector<double> RangeInformation::predicted_variances() const {
  // Beyond so many variances a range is hopeless, however well its ends are known.
  constexpr double kHopeless = 100.0;
  const auto matrix = regularised(kRegularisation);
  const auto blocks = diagonal_blocks(matrix);
  const auto own_variance = [&](Index node, const Point& u) {
    return row(node) < 0 ? 0.0 : u.dot(blocks[node] * u);
  };
  std::vector<double> variances(problem_.ranges.size(), 0.0);
  std::vector<std::size_t> exact;
  for (std::size_t k = 0; k < problem_.ranges.size(); ++k) {
    if (!between_placed(k)) continue;
    const auto& range = problem_.ranges[k];
    const Point u = direction(range.from, range.to);
    const double a = own_variance(range.from, u);
    const double b = own_variance(range.to, u);
    // Exact where one end is known. Else a bound, which keeps hopeless ranges between
    // far nodes out of the pattern of the factorisation.
    variances[k] = std::pow(std::sqrt(a) + std::sqrt(b), 2);
    if (row(range.from) < 0 || row(range.to) < 0) continue;
    const double own = 1.0 / information(k);
    const bool hopeless =
        unit_weights_ || std::pow(residual(k), 2) > kHopeless * (variances[k] + own);
    if (use_[k] || !hopeless) {
      exact.push_back(k);
      variances[k] = a + b;
    }
  }
  subtract_cross_terms(matrix, exact, variances);
  return variances;
}

// Takes twice u' C_ab u off the variances of the ranges in `exact`.
void RangeInformation::subtract_cross_terms(const spectral::SparseMatrix& matrix,
                                            const std::vector<std::size_t>& exact,
                                            std::vector<double>& variances) const {
  const int d = problem_.dimension;
  std::vector<spectral::VertexPair> wanted;
  for (const auto k : exact) {
    const auto& range = problem_.ranges[k];
    for (int i = 0; i < d; ++i) {
      for (int j = 0; j < d; ++j) wanted.push_back({row(range.from) + i, row(range.to) + j});
    }
  }
  const auto values = spectral::inverse_entries(matrix, wanted).values;
  std::size_t next = 0;
  for (const auto k : exact) {
    const auto& range = problem_.ranges[k];
    const Point u = direction(range.from, range.to);
    double cross = 0.0;
    for (int i = 0; i < d; ++i) {
      for (int j = 0; j < d; ++j) cross += u[i] * u[j] * values[next++];
    }
    variances[k] = std::max(0.0, variances[k] - 2.0 * cross);
  }
}

std::vector<RangeCheck> RangeInformation::check_ranges() const {
  const auto variances = predicted_variances();
  std::vector<RangeCheck> checks(problem_.ranges.size());
  for (std::size_t k = 0; k < checks.size(); ++k) {
    auto& check = checks[k];
    check.checked = between_placed(k);
    if (!check.checked) continue;
    const double own = 1.0 / information(k);
    // The residual of a used range has the variance own - variance, and its
    // leave-one-out residual is larger by own / (own - variance).
    check.redundancy =
        use_[k] ? std::clamp(1.0 - variances[k] / own, 0.0, 1.0) : own / (own + variances[k]);
    if (!check.is_tested()) continue;
    const double spread = use_[k] ? own * check.redundancy : own + variances[k];
    check.deviation = residual(k) / std::sqrt(spread);
    check.chi2 = check.deviation * check.deviation;
  }
  return checks;
}

std::vector<Eigen::MatrixXd> RangeInformation::covariances() const {
  const auto matrix = regularised(kRegularisation);
  auto blocks = diagonal_blocks(matrix);
  if (problem_.anchored() || unknown_nodes_.empty()) return blocks;
  // C+ = P C P with P = I - G G', G being the orthonormal rigid motions.
  const int d = problem_.dimension;
  const Eigen::MatrixXd motions = rigid_motions(unknown_nodes_);
  const Eigen::SimplicialLDLT<spectral::SparseMatrix, Eigen::Lower> factor(matrix);
  const Eigen::MatrixXd moved = factor.solve(motions);        // C G
  const Eigen::MatrixXd inner = motions.transpose() * moved;  // G' C G
  for (std::size_t k = 0; k < unknown_nodes_.size(); ++k) {
    const auto g = motions.middleRows(static_cast<Eigen::Index>(k) * d, d);
    const auto cg = moved.middleRows(static_cast<Eigen::Index>(k) * d, d);
    blocks[unknown_nodes_[k]] +=
        g * inner * g.transpose() - cg * g.transpose() - g * cg.transpose();
  }
  return blocks;
}

std::vector<bool> RangeInformation::floppy_nodes() const {
  // Where a free motion reaches, the inverse grows as 1 / regularisation.
  constexpr double kFine = 1e-10;
  constexpr double kCoarse = 1e-9;
  constexpr double kGrowth = 2.0;  // between none (1) and full (10)
  std::vector<bool> floppy(problem_.nodes, false);
  if (unknown_nodes_.empty()) return floppy;
  const auto fine = diagonal_blocks(regularised(kFine));
  const auto coarse = diagonal_blocks(regularised(kCoarse));
  for (const Index v : unknown_nodes_) {
    floppy[v] = fine[v].trace() > kGrowth * coarse[v].trace();
  }
  return floppy;
}

}  // namespace isotherm::network::detail
