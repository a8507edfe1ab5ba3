#include "localize/fold/mirror_image.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace isotherm::network::detail {
namespace {

double total_cost(const std::vector<Tie>& ties) {
  double sum = 0.0;
  for (const auto& tie : ties) sum += tie.cost();
  return sum;
}

Point centre_of(const std::vector<Tie>& ties) {
  Point sum = Point::Zero(ties.front().own.size());
  for (const auto& tie : ties) sum += tie.own;
  return sum / static_cast<double>(ties.size());
}

// By the coordinates of a small rigid motion, of which there are 6 at most.
using Motion = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;
using Motions = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 3, 6>;
using Normal = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

// The derivatives of a point by the coordinates of a small rigid motion about `centre`:
// translations, then rotations in each pair of axes.
Motions motions_at(const Point& point, const Point& centre) {
  const auto d = point.size();
  Motions motions = Motions::Zero(d, d + d * (d - 1) / 2);
  motions.leftCols(d).setIdentity();
  Eigen::Index column = d;
  for (Eigen::Index i = 0; i < d; ++i) {
    for (Eigen::Index j = i + 1; j < d; ++j, ++column) {
      motions(i, column) = -(point - centre)[j];
      motions(j, column) = (point - centre)[i];
    }
  }
  return motions;
}

// Turns points about a centre and shifts them.
struct RigidMove {
  Block rotation;
  Point centre;
  Point shift;

  void operator()(Point& point) const {
    const Point turned = rotation * (point - centre);
    point = turned + centre + shift;
  }
};

RigidMove rigid_move(const std::vector<Tie>& ties, const Motion& step) {
  const Point centre = centre_of(ties);
  const auto d = centre.size();
  Block linear = Block::Identity(d, d);
  Eigen::Index column = d;
  for (Eigen::Index i = 0; i < d; ++i) {
    for (Eigen::Index j = i + 1; j < d; ++j, ++column) {
      linear(i, j) -= step[column];
      linear(j, i) += step[column];
    }
  }
  const Eigen::JacobiSVD<Block> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.matrixU() * svd.matrixV().transpose(), centre, step.head(d)};
}

// A Gauss-Newton step of the ties that fit well enough to have a say.
Motion rigid_step(const std::vector<Tie>& ties) {
  const Point centre = centre_of(ties);
  const auto d = centre.size();
  const auto unknowns = d + d * (d - 1) / 2;
  Normal normal = Normal::Zero(unknowns, unknowns);
  Motion right = Motion::Zero(unknowns);
  for (const auto& tie : ties) {
    const Point arm = tie.own - tie.other;
    const double length = arm.norm();
    const double r = (length - tie.distance) / tie.sigma;
    const double share = 1.0 / (1.0 + r * r / tie.limit());
    const double weight = share * share / (tie.sigma * tie.sigma);
    const Motions motions = motions_at(tie.own, centre);
    if (tie.distance == 0.0) {
      normal += weight * motions.transpose() * motions;
      right -= weight * motions.transpose() * arm;
    } else if (length > 0.0) {
      const Motion slope = motions.transpose() * (arm / length);
      normal += weight * slope * slope.transpose();
      right -= weight * (length - tie.distance) * slope;
    }
  }
  constexpr double kDamping = 1e-3;
  normal.diagonal() *= 1.0 + kDamping;
  return normal.completeOrthogonalDecomposition().solve(right);
}

// In a line (plane, in space).
struct Reflection {
  Point through;
  Point normal;  // of unit length

  void operator()(Point& point) const { point -= 2.0 * normal.dot(point - through) * normal; }
};

// In the line (plane) through d points; in one of those through them if they span less.
Reflection reflection(const std::vector<Point>& through) {
  const auto d = through.front().size();
  Eigen::MatrixXd along(d, d - 1);
  for (Eigen::Index k = 1; k < d; ++k) along.col(k - 1) = through[k] - through.front();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(along);
  const Eigen::MatrixXd basis = qr.householderQ();
  return {through.front(), basis.col(d - 1)};
}

template <class Move>
void move_ends(const Move& move, std::vector<Tie>& ties) {
  for (auto& tie : ties) move(tie.own);
}

double reflected_cost(const std::vector<Tie>& ties, const Reflection& reflection) {
  double sum = 0.0;
  for (auto tie : ties) {
    reflection(tie.own);
    sum += tie.cost();
  }
  return sum;
}

// Whether a mirror image moved to where its ties fit best costs less. The points, which can be
// many, follow only if its ties leave that open.
bool settles_below(double limit, const TiedBody& body, const Reflection& reflection,
                   const PointsCost& points_cost) {
  constexpr int kIterations = 6;
  auto ties = body.ties;
  move_ends(reflection, ties);
  double least = total_cost(ties);
  std::vector<RigidMove> moves;
  std::size_t best = 0;  // moves
  for (int k = 0; k < kIterations; ++k) {
    moves.push_back(rigid_move(ties, rigid_step(ties)));
    move_ends(moves.back(), ties);
    const double cost = total_cost(ties);
    if (cost >= least) continue;
    least = cost;
    best = moves.size();
  }
  if (least >= limit || !points_cost) return least < limit;
  auto points = body.points;
  for (auto& point : points) {
    reflection(point);
    for (std::size_t k = 0; k < best; ++k) moves[k](point);
  }
  return least + points_cost(points) < limit;
}

// Lines (planes, in space) through d of the ends of the ties, those first in which the reflected
// ties cost least as they are.
std::vector<Reflection> mirrors(const std::vector<Tie>& ties) {
  const bool plane = ties.front().own.size() == 2;
  const std::size_t most_ends = plane ? 12 : 8;  // 66 lines, 56 planes
  std::vector<Point> ends;
  const std::size_t stride = (2 * ties.size() - 1) / most_ends + 1;
  for (std::size_t k = 0; k < 2 * ties.size(); k += stride) {
    ends.push_back(k % 2 == 0 ? ties[k / 2].own : ties[k / 2].other);
  }
  std::vector<Reflection> found;
  for (std::size_t a = 0; a < ends.size(); ++a) {
    for (std::size_t b = a + 1; b < ends.size(); ++b) {
      if (plane) found.push_back(reflection({ends[a], ends[b]}));
      for (std::size_t c = b + 1; !plane && c < ends.size(); ++c) {
        found.push_back(reflection({ends[a], ends[b], ends[c]}));
      }
    }
  }
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t k = 0; k < found.size(); ++k) {
    order.emplace_back(reflected_cost(ties, found[k]), k);
  }
  std::sort(order.begin(), order.end());
  std::vector<Reflection> sorted;
  for (const auto& entry : order) sorted.push_back(found[entry.second]);
  return sorted;
}

}  // namespace

double Tie::limit() const { return limits((own - other).norm() - distance); }

double Tie::cost() const {
  const double r = ((own - other).norm() - distance) / sigma;
  return std::min(r * r, limits(r));
}

bool has_mirror_image(const TiedBody& body, double limit, const PointsCost& points_cost) {
  constexpr std::size_t kSettled = 8;
  if (body.ties.empty()) return false;
  auto found = mirrors(body.ties);
  if (found.size() > kSettled) found.resize(kSettled);
  return std::any_of(found.begin(), found.end(), [&](const Reflection& mirror) {
    return settles_below(limit, body, mirror, points_cost);
  });
}

}  // namespace isotherm::network::detail
