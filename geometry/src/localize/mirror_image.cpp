#include "localize/mirror_image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace isotherm::geometry::detail {
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

// The derivatives of a point by the coordinates of a small rigid motion about `centre`:
// translations, then rotations in each pair of axes.
Eigen::MatrixXd motions_at(const Point& point, const Point& centre) {
  const auto d = point.size();
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(d, d + d * (d - 1) / 2);
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

void move_rigidly(std::vector<Tie>& ties, const Eigen::VectorXd& step) {
  const Point centre = centre_of(ties);
  const auto d = centre.size();
  Eigen::MatrixXd linear = Eigen::MatrixXd::Identity(d, d);
  Eigen::Index column = d;
  for (Eigen::Index i = 0; i < d; ++i) {
    for (Eigen::Index j = i + 1; j < d; ++j, ++column) {
      linear(i, j) -= step[column];
      linear(j, i) += step[column];
    }
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::MatrixXd rotation = svd.matrixU() * svd.matrixV().transpose();
  for (auto& tie : ties) {
    const Point turned = rotation * (tie.own - centre);
    tie.own = turned + centre + step.head(d);
  }
}

// A Gauss-Newton step of the ties that fit well enough to have a say.
Eigen::VectorXd rigid_step(const std::vector<Tie>& ties) {
  const Point centre = centre_of(ties);
  const auto d = centre.size();
  const auto unknowns = d + d * (d - 1) / 2;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(unknowns, unknowns);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns);
  for (const auto& tie : ties) {
    const Point arm = tie.own - tie.other;
    const double length = arm.norm();
    const double r = (length - tie.distance) / tie.sigma;
    const double share = 1.0 / (1.0 + r * r / tie.limit);
    const double weight = share * share / (tie.sigma * tie.sigma);
    const auto motions = motions_at(tie.own, centre);
    if (tie.distance == 0.0) {
      normal += weight * motions.transpose() * motions;
      right -= weight * motions.transpose() * arm;
    } else if (length > 0.0) {
      const Eigen::VectorXd slope = motions.transpose() * (arm / length);
      normal += weight * slope * slope.transpose();
      right -= weight * (length - tie.distance) * slope;
    }
  }
  constexpr double kDamping = 1e-3;
  normal.diagonal() *= 1.0 + kDamping;
  return normal.completeOrthogonalDecomposition().solve(right);
}

double settled_cost(std::vector<Tie> ties) {
  constexpr int kIterations = 6;
  double least = total_cost(ties);
  for (int k = 0; k < kIterations; ++k) {
    move_rigidly(ties, rigid_step(ties));
    least = std::min(least, total_cost(ties));
  }
  return least;
}

// The body reflected in the line (plane, in space) through d points; as it is, if these
// do not span one.
std::vector<Tie> reflected(std::vector<Tie> ties, const std::vector<Point>& through) {
  const auto d = through.front().size();
  Eigen::MatrixXd along(d, d - 1);
  for (Eigen::Index k = 1; k < d; ++k) along.col(k - 1) = through[k] - through.front();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(along);
  const Eigen::MatrixXd basis = qr.householderQ();
  const Point normal = basis.col(d - 1);
  for (auto& tie : ties) tie.own -= 2.0 * normal.dot(tie.own - through.front()) * normal;
  return ties;
}

}  // namespace

double Tie::cost() const {
  const double r = ((own - other).norm() - distance) / sigma;
  return std::min(r * r, limit);
}

double mirror_image_cost(const std::vector<Tie>& ties) {
  constexpr std::size_t kMostEnds = 12;
  double least = std::numeric_limits<double>::infinity();
  if (ties.empty()) return least;
  std::vector<Point> ends;
  const std::size_t stride = (2 * ties.size() - 1) / kMostEnds + 1;
  for (std::size_t k = 0; k < 2 * ties.size(); k += stride) {
    ends.push_back(k % 2 == 0 ? ties[k / 2].own : ties[k / 2].other);
  }
  const bool plane = ties.front().own.size() == 2;
  for (std::size_t a = 0; a < ends.size(); ++a) {
    for (std::size_t b = a + 1; b < ends.size(); ++b) {
      if (plane) least = std::min(least, settled_cost(reflected(ties, {ends[a], ends[b]})));
      for (std::size_t c = b + 1; !plane && c < ends.size(); ++c) {
        least = std::min(least, settled_cost(reflected(ties, {ends[a], ends[b], ends[c]})));
      }
    }
  }
  return least;
}

}  // namespace isotherm::geometry::detail
