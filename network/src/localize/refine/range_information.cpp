#include "localize/refine/range_information.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/QR>

#include "isotherm/base/error.hpp"
#include "isotherm/spectral/sparse/block_covariance.hpp"

namespace isotherm::network::detail {
namespace {

// Regularisation, as a part of the largest diagonal entry: far below what ranges
// say, far above rounding.
constexpr double kRegularisation = 1e-11;

struct PairBlocks {
  Block first, second, cross;  // of the inverse
};

template <int Dimension>
std::vector<PairBlocks> pair_blocks_of(const spectral::BlockCholesky& factor,
                                       std::span<const std::pair<Index, Index>> pairs) {
  std::vector<PairBlocks> blocks;
  for (const auto& pair : spectral::pair_covariances<Dimension>(factor, pairs)) {
    blocks.push_back({pair.first, pair.second, pair.cross});
  }
  return blocks;
}

std::vector<PairBlocks> pair_blocks(const spectral::BlockCholesky& factor,
                                    std::span<const std::pair<Index, Index>> pairs) {
  return factor.block_size() == 2 ? pair_blocks_of<2>(factor, pairs)
                                  : pair_blocks_of<3>(factor, pairs);
}

}  // namespace

RangeInformation::RangeInformation(const RangeProblem& problem, const std::vector<bool>& use,
                                   const Placement& placement, bool unit_weights)
    : problem_(problem),
      use_(use),
      placement_(placement),
      unit_weights_(unit_weights),
      variable_(problem.nodes, -1),
      matrix_(problem.dimension, 0, {}) {
  set_up();
}

RangeInformation::RangeInformation(const RangeProblem& problem, const std::vector<bool>& use,
                                   const Placement& placement,
                                   const std::vector<double>& information)
    : problem_(problem),
      use_(use),
      placement_(placement),
      given_(&information),
      variable_(problem.nodes, -1),
      matrix_(problem.dimension, 0, {}) {
  set_up();
}

void RangeInformation::set_up() {
  for (Index v = 0; v < problem_.nodes; ++v) {
    if (!placement_.placed[v] || problem_.is_anchor[v]) continue;
    variable_[v] = static_cast<Index>(unknown_nodes_.size());
    unknown_nodes_.push_back(v);
  }
  Pairs pairs;
  for (std::size_t k = 0; k < problem_.ranges.size(); ++k) {
    const auto& range = problem_.ranges[k];
    if (use_[k] && between_unknowns(k))
      pairs.emplace_back(variable_[range.from], variable_[range.to]);
  }
  const std::size_t of_ranges = pairs.size();
  const auto frame = problem_.anchored() ? std::vector<Index>{} : frame_nodes();
  for (std::size_t a = 0; a < frame.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b)
      pairs.emplace_back(variable_[frame[a]], variable_[frame[b]]);
  }
  matrix_ = spectral::BlockCholesky(problem_.dimension, static_cast<Index>(unknown_nodes_.size()),
                                    pairs, spectral::FactorForm::supernodal);
  add_ranges();
  hold_frame(frame, of_ranges);
}

void RangeInformation::add_ranges() {
  std::size_t pair = 0;
  for (std::size_t k = 0; k < problem_.ranges.size(); ++k) {
    const auto& range = problem_.ranges[k];
    if (!use_[k] || !is_placed(placement_, problem_.ranges[k])) continue;
    const Point u = direction(range.from, range.to);
    const Block block = information(k) * u * u.transpose();
    for (const Index node : {range.from, range.to}) {
      if (variable_[node] >= 0) matrix_.add_diagonal(variable_[node], block);
    }
    if (between_unknowns(k)) matrix_.add_pair(pair++, -block);
  }
}

bool RangeInformation::between_unknowns(std::size_t k) const {
  return variable_[problem_.ranges[k].from] >= 0 && variable_[problem_.ranges[k].to] >= 0;
}

double RangeInformation::residual(std::size_t k) const {
  const auto& range = problem_.ranges[k];
  return range.distance - distance_of(placement_, range.from, range.to);
}

double RangeInformation::information(std::size_t k) const {
  return given_ != nullptr ? (*given_)[k] : 1.0 / noise(k);
}

double RangeInformation::noise(std::size_t k) const {
  return unit_weights_ ? 1.0 : problem_.sigmas[k] * problem_.sigmas[k];
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
      if (pair_used[edge] && variable_[vertex] >= 0) found.push_back(vertex);
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

void RangeInformation::hold_frame(const std::vector<Index>& nodes, std::size_t first_pair) {
  if (nodes.empty()) return;
  const int d = problem_.dimension;
  const Eigen::MatrixXd motions = rigid_motions(nodes);
  double scale = 0.0;
  for (std::size_t k = 0; k < problem_.ranges.size(); ++k) {
    if (use_[k]) scale = std::max(scale, information(k));
  }
  const Eigen::MatrixXd penalty = scale * motions * motions.transpose();
  const auto block = [&](std::size_t a, std::size_t b) -> Block {
    return penalty.block(static_cast<Eigen::Index>(a) * d, static_cast<Eigen::Index>(b) * d, d, d);
  };
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    matrix_.add_diagonal(variable_[nodes[a]], block(a, a));
    for (std::size_t b = 0; b < a; ++b) matrix_.add_pair(first_pair++, block(a, b));
  }
}

// `regularisation` is relative to the largest diagonal entry.
void RangeInformation::factorise(double regularisation) {
  const double largest = unknowns() > 0 ? matrix_.diagonal().maxCoeff() : 0.0;
  const double amount = regularisation * (largest > 0.0 ? largest : 1.0);
  if (matrix_.factorise(Eigen::VectorXd::Constant(unknowns(), amount))) return;
  throw NumericalError("localisation", "the information matrix is not positive definite");
}

double RangeInformation::log_determinant() {
  if (unknowns() == 0) return 0.0;
  factorise(kRegularisation);
  return matrix_.log_determinant();
}

std::vector<Eigen::MatrixXd> RangeInformation::diagonal_blocks() const {
  Pairs wanted;
  for (const Index v : unknown_nodes_) wanted.emplace_back(variable_[v], -1);
  const auto found = pair_blocks(matrix_, wanted);
  std::vector<Eigen::MatrixXd> blocks(problem_.nodes);
  for (const Index v : unknown_nodes_) blocks[v] = found[variable_[v]].first;
  return blocks;
}

std::vector<double> RangeInformation::predicted_variances() {
  // Beyond so many variances a range is hopeless, however well its ends are known.
  constexpr double kHopeless = 100.0;
  factorise(kRegularisation);
  const auto blocks = diagonal_blocks();
  const auto own_variance = [&](Index node, const Point& u) {
    return variable_[node] < 0 ? 0.0 : u.dot(blocks[node] * u);
  };
  std::vector<double> variances(problem_.ranges.size(), 0.0);
  std::vector<std::size_t> exact;
  for (std::size_t k = 0; k < problem_.ranges.size(); ++k) {
    if (!is_placed(placement_, problem_.ranges[k])) continue;
    const auto& range = problem_.ranges[k];
    const Point u = direction(range.from, range.to);
    const double a = own_variance(range.from, u);
    const double b = own_variance(range.to, u);
    // Exact where one end is known. Else a bound, which saves looking at both ends of a
    // hopeless range together.
    variances[k] = std::pow(std::sqrt(a) + std::sqrt(b), 2);
    if (!between_unknowns(k)) continue;
    const double own = noise(k);
    const bool hopeless =
        unit_weights_ || std::pow(residual(k), 2) > kHopeless * (variances[k] + own);
    if (use_[k] || !hopeless) {
      exact.push_back(k);
      variances[k] = a + b;
    }
  }
  subtract_cross_terms(exact, variances);
  return variances;
}

// Takes twice u' C_ab u off the variances of the ranges in `exact`.
void RangeInformation::subtract_cross_terms(const std::vector<std::size_t>& exact,
                                            std::vector<double>& variances) const {
  Pairs wanted;
  for (const auto k : exact) {
    wanted.emplace_back(variable_[problem_.ranges[k].from], variable_[problem_.ranges[k].to]);
  }
  const auto found = pair_blocks(matrix_, wanted);
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const auto k = exact[i];
    const Point u = direction(problem_.ranges[k].from, problem_.ranges[k].to);
    variances[k] = std::max(0.0, variances[k] - 2.0 * u.dot(found[i].cross * u));
  }
}

std::vector<RangeCheck> RangeInformation::check_ranges() {
  const auto variances = predicted_variances();
  std::vector<RangeCheck> checks(problem_.ranges.size());
  for (std::size_t k = 0; k < checks.size(); ++k) {
    auto& check = checks[k];
    check.checked = is_placed(placement_, problem_.ranges[k]);
    if (!check.checked) continue;
    const double own = noise(k);
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

std::vector<Eigen::MatrixXd> RangeInformation::covariances() {
  factorise(kRegularisation);
  auto blocks = diagonal_blocks();
  if (problem_.anchored() || unknown_nodes_.empty()) return blocks;
  // C+ = P C P with P = I - G G', G being the orthonormal rigid motions.
  const int d = problem_.dimension;
  const Eigen::MatrixXd motions = rigid_motions(unknown_nodes_);
  const Eigen::MatrixXd moved = matrix_.solve(motions);       // C G
  const Eigen::MatrixXd inner = motions.transpose() * moved;  // G' C G
  for (std::size_t k = 0; k < unknown_nodes_.size(); ++k) {
    const auto g = motions.middleRows(static_cast<Eigen::Index>(k) * d, d);
    const auto cg = moved.middleRows(static_cast<Eigen::Index>(k) * d, d);
    blocks[unknown_nodes_[k]] +=
        g * inner * g.transpose() - cg * g.transpose() - g * cg.transpose();
  }
  return blocks;
}

std::vector<bool> RangeInformation::floppy_nodes() {
  // Where a free motion reaches, the inverse grows as 1 / regularisation.
  constexpr double kFine = 1e-10;
  constexpr double kCoarse = 1e-9;
  constexpr double kGrowth = 2.0;  // between none (1) and full (10)
  std::vector<bool> floppy(problem_.nodes, false);
  if (unknown_nodes_.empty()) return floppy;
  factorise(kFine);
  const auto fine = diagonal_blocks();
  factorise(kCoarse);
  const auto coarse = diagonal_blocks();
  for (const Index v : unknown_nodes_) {
    floppy[v] = fine[v].trace() > kGrowth * coarse[v].trace();
  }
  return floppy;
}

}  // namespace isotherm::network::detail
