#include "localize/mirror_image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

void move_rigidly(TiedBody& body, const Motion& step) {
  const Point centre = centre_of(body.ties);
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
  const Block rotation = svd.matrixU() * svd.matrixV().transpose();
  const Point shift = step.head(d);
  const auto move = [&](Point& point) {
    const Point turned = rotation * (point - centre);
    point = turned + centre + shift;
  };
  for (auto& tie : body.ties) move(tie.own);
  for (auto& point : body.points) move(point);
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

double settled_cost(TiedBody body, const PointsCost& points_cost, double enough) {
  constexpr int kIterations = 6;
  double least = total_cost(body.ties);
  auto best = body.points;
  for (int k = 0; k < kIterations; ++k) {
    move_rigidly(body, rigid_step(body.ties));
    const double cost = total_cost(body.ties);
    if (cost >= least) continue;
    least = cost;
    best = body.points;
  }
  return points_cost && least < enough ? least + points_cost(best) : least;
}

// The body reflected in the line (plane, in space) through d points; as it is, if these
// do not span one.
TiedBody reflected(TiedBody body, const std::vector<Point>& through) {
  const auto d = through.front().size();
  Eigen::MatrixXd along(d, d - 1);
  for (Eigen::Index k = 1; k < d; ++k) along.col(k - 1) = through[k] - through.front();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(along);
  const Eigen::MatrixXd basis = qr.householderQ();
  const Point normal = basis.col(d - 1);
  const auto reflect = [&](Point& point) {
    point -= 2.0 * normal.dot(point - through.front()) * normal;
  };
  for (auto& tie : body.ties) reflect(tie.own);
  for (auto& point : body.points) reflect(point);
  return body;
}

// The body reflected in lines (planes, in space) through d of the ends of its ties, those
// first whose ties cost least as they are.
std::vector<TiedBody> mirror_images(const TiedBody& body) {
  const auto& ties = body.ties;
  const bool plane = ties.front().own.size() == 2;
  const std::size_t most_ends = plane ? 12 : 8;  // 66 lines, 56 planes
  std::vector<Point> ends;
  const std::size_t stride = (2 * ties.size() - 1) / most_ends + 1;
  for (std::size_t k = 0; k < 2 * ties.size(); k += stride) {
    ends.push_back(k % 2 == 0 ? ties[k / 2].own : ties[k / 2].other);
  }
  std::vector<TiedBody> images;
  for (std::size_t a = 0; a < ends.size(); ++a) {
    for (std::size_t b = a + 1; b < ends.size(); ++b) {
      if (plane) images.push_back(reflected(body, {ends[a], ends[b]}));
      for (std::size_t c = b + 1; !plane && c < ends.size(); ++c) {
        images.push_back(reflected(body, {ends[a], ends[b], ends[c]}));
      }
    }
  }
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t k = 0; k < images.size(); ++k) order.emplace_back(total_cost(images[k].ties), k);
  std::sort(order.begin(), order.end());
  std::vector<TiedBody> sorted;
  for (const auto& entry : order) sorted.push_back(std::move(images[entry.second]));
  return sorted;
}

}  // namespace

double Tie::limit() const { return limits((own - other).norm() - distance); }

double Tie::cost() const {
  const double r = ((own - other).norm() - distance) / sigma;
  return std::min(r * r, limits(r));
}

double mirror_image_cost(const TiedBody& body, const PointsCost& points_cost, double enough) {
  constexpr std::size_t kSettled = 8;
  double least = std::numeric_limits<double>::infinity();
  if (body.ties.empty()) return least;
  auto images = mirror_images(body);
  if (images.size() > kSettled) images.resize(kSettled);
  for (auto& image : images) {
    least = std::min(least, settled_cost(std::move(image), points_cost, std::min(enough, least)));
  }
  return least;
}

}  // namespace isotherm::geometry::detail
