#include "isotherm/slam/simulate/corrupt.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "isotherm/base/error.hpp"
#include "isotherm/base/random.hpp"
#include "isotherm/base/statistics.hpp"

namespace isotherm::slam {
namespace {

constexpr double kConsistentProbability = 0.999;

bool is_grouped(NoiseType type) {
  return type == NoiseType::random_grouped || type == NoiseType::local_grouped ||
         type == NoiseType::all_random;
}

bool is_local(NoiseType type) {
  return type == NoiseType::local || type == NoiseType::local_grouped;
}

// The largest distance, in vertices, of the ends of a local false loop.
Index local_reach(NoiseStyle style) { return style == NoiseStyle::vertigo ? 20 : 40; }

struct Ends {
  Index from = 0;
  Index to = 0;
};

// Ends at least two vertices apart, so that no false loop looks like odometry.
Ends draw_ends(Index vertex_count, const CorruptOptions& options, Random& random) {
  const auto n = static_cast<std::uint64_t>(vertex_count);
  while (true) {
    const auto from = static_cast<Index>(random.index(n));
    Index to = 0;
    if (is_local(options.type)) {
      const Index reach = local_reach(options.style);
      to = from + static_cast<Index>(random.index(2 * reach + 1)) - reach;
    } else {
      to = static_cast<Index>(random.index(n));
    }
    if (to >= 0 && to < vertex_count && std::abs(to - from) >= 2) return {from, to};
  }
}

template <class Pose>
typename Pose::Tangent vertigo_tangent(Random& random) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  typename Pose::Tangent xi;
  for (int k = 0; k < Pose::kDof; ++k) {
    xi[k] = random.normal(0.0, k < Pose::kDim ? 0.3 : 10.0 * kDegree);
  }
  return xi;
}

Pose2 make_pose(const Pose2::Tangent& coordinates) {
  return {coordinates[0], coordinates[1], wrap_angle(coordinates[2])};
}

Pose3 make_pose(const Pose3::Tangent& coordinates) {
  Pose3::Tangent rotation = coordinates;
  rotation.head<3>().setZero();
  return {coordinates.head<3>(), Pose3::exp(rotation).rotation()};
}

// Tens of metres to kilometres, any heading.
template <class Pose>
Pose wild_transform(Random& random) {
  auto coordinates = random.normal_vector<typename Pose::Tangent>();
  auto translation = coordinates.template head<Pose::kDim>();
  translation *= std::pow(10.0, random.uniform(1.0, 3.0)) / translation.norm();
  auto rotation = coordinates.template tail<Pose::kDof - Pose::kDim>();
  rotation *= random.uniform(0.0, std::numbers::pi) / rotation.norm();
  return make_pose(coordinates);
}

template <class Pose>
Pose draw_transform(NoiseStyle style, Random& random) {
  return style == NoiseStyle::vertigo ? make_pose(vertigo_tangent<Pose>(random))
                                      : wild_transform<Pose>(random);
}

// Makes the information matrices of false loops by the chosen policy.
template <class Pose>
class InformationPolicy {
 public:
  using Matrix = typename Pose::Matrix;

  InformationPolicy(const PoseGraph<Pose>& graph, const EdgeRoles& roles, NoiseInformation policy)
      : policy_(policy) {
    switch (policy) {
      case NoiseInformation::first:
        base_ = graph.constraints[roles.candidates.front()].information;
        break;
      case NoiseInformation::median:
        base_ = median_diagonal(graph, roles);
        break;
      case NoiseInformation::paper:
        base_ = mean(graph, roles);
        break;
    }
  }

  Matrix draw(Random& random) const {
    return policy_ == NoiseInformation::paper ? Matrix(base_ * random.uniform(-1.0, 3.0)) : base_;
  }

 private:
  static Matrix median_diagonal(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
    Matrix result = Matrix::Zero();
    for (int k = 0; k < Pose::kDof; ++k) {
      std::vector<double> entries;
      for (const Index c : roles.candidates) {
        entries.push_back(graph.constraints[c].information(k, k));
      }
      result(k, k) = median(std::move(entries));
    }
    return result;
  }

  static Matrix mean(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
    Matrix sum = Matrix::Zero();
    for (const Index c : roles.candidates) sum += graph.constraints[c].information;
    return sum / static_cast<double>(roles.candidates.size());
  }

  NoiseInformation policy_;
  Matrix base_;
};

std::int64_t false_loop_count(const CorruptOptions& options, std::size_t candidates) {
  const auto loops = static_cast<double>(candidates);
  if (options.count >= 0) return options.count;
  if (options.ratio >= 0.0) return std::llround(options.ratio * loops);
  return std::llround(options.fraction / (1.0 - options.fraction) * loops);
}

std::int64_t draw_group_size(const CorruptOptions& options, Random& random) {
  if (!is_grouped(options.type)) return 1;
  const std::int64_t usual = options.group_size > 0                 ? options.group_size
                             : options.style == NoiseStyle::vertigo ? 10
                                                                    : 5;
  if (options.type != NoiseType::all_random) return usual;
  // The paper's files have groups of 2 to 7, which is 5 - 3 ... 5 + 2.
  const std::int64_t smallest = std::min<std::int64_t>(2, usual);
  const std::int64_t largest = std::max<std::int64_t>(smallest, usual + usual * 2 / 5);
  return smallest + static_cast<std::int64_t>(random.index(largest - smallest + 1));
}

// Share of the candidates that lead from an earlier to a later vertex. False
// loops follow it, so that direction gives nothing away.
template <class Pose>
double forward_share(const PoseGraph<Pose>& graph, const EdgeRoles& roles) {
  const auto forward =
      std::count_if(roles.candidates.begin(), roles.candidates.end(),
                    [&](Index k) { return graph.constraints[k].from < graph.constraints[k].to; });
  return static_cast<double>(forward) / static_cast<double>(roles.candidates.size());
}

template <class Pose>
std::vector<Constraint<Pose>> draw_false_loops(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                                               const CorruptOptions& options, Random& random) {
  const InformationPolicy<Pose> information(graph, roles, options.information);
  const double forward = forward_share(graph, roles);
  const auto wanted = static_cast<std::size_t>(false_loop_count(options, roles.candidates.size()));
  std::vector<Constraint<Pose>> loops;
  while (loops.size() < wanted) {
    const Ends seed = draw_ends(graph.vertex_count(), options, random);
    const Pose shared = draw_transform<Pose>(options.style, random);
    const bool goes_forward = random.uniform() < forward;
    const std::int64_t size = draw_group_size(options, random);
    for (Index k = 0; k < size && loops.size() < wanted; ++k) {
      Ends ends{seed.from + k, seed.to + k};
      if (std::max(ends.from, ends.to) >= graph.vertex_count()) break;
      if ((ends.from < ends.to) != goes_forward) std::swap(ends.from, ends.to);
      Constraint<Pose> loop;
      loop.from = ends.from;
      loop.to = ends.to;
      const bool first = k == 0 || options.style == NoiseStyle::vertigo;
      loop.T_from_to = first ? shared : draw_transform<Pose>(options.style, random);
      loop.information = information.draw(random);
      loops.push_back(loop);
    }
  }
  return loops;
}

template <class Pose>
Label label_of(const Constraint<Pose>& loop, const std::vector<Pose>& truth) {
  const auto r = residual(loop, truth[loop.from], truth[loop.to]);
  const double chi2 = r.dot(loop.information * r);
  static const double kQuantile = chi_squared_quantile(kConsistentProbability, Pose::kDof);
  // A matrix that is not positive definite says nothing: such a loop is false
  // by construction.
  return chi2 >= 0.0 && chi2 <= kQuantile ? Label::ignore : Label::incorrect;
}

template <class T>
void shuffle(std::vector<T>& values, Random& random) {
  for (std::size_t k = values.size(); k > 1; --k) std::swap(values[k - 1], values[random.index(k)]);
}

template <class Pose>
void check_input(const PoseGraph<Pose>& graph, const std::vector<Pose>& truth,
                 const EdgeRoles& roles) {
  if (truth.size() != graph.ids.size()) {
    throw InvalidArgument("truth", "must have one pose per vertex");
  }
  if (graph.vertex_count() < 3) {
    throw InvalidArgument("graph", "needs at least three vertices for a false loop closure");
  }
  if (roles.candidates.empty()) {
    throw InvalidArgument("graph", "has no loop closure to take the information matrix from");
  }
}

}  // namespace

void CorruptOptions::validate() const {
  require_fields_in_range(*this);
  const int amounts = (count >= 0) + (ratio >= 0.0) + (fraction >= 0.0);
  if (amounts != 1) {
    throw InvalidArgument("count", "give exactly one of count, ratio and fraction");
  }
}

template <class Pose>
Corrupted<Pose> corrupt(const PoseGraph<Pose>& graph, const std::vector<Pose>& truth,
                        const CorruptOptions& options) {
  options.validate();
  const auto roles = edge_roles(graph);
  check_input(graph, truth, roles);
  Random random(options.seed);

  struct Labelled {
    Constraint<Pose> constraint;
    Label label;
  };
  std::vector<Labelled> candidates;
  for (const Index k : roles.candidates) {
    candidates.push_back({graph.constraints[k], Label::correct});
  }
  for (const auto& loop : draw_false_loops(graph, roles, options, random)) {
    candidates.push_back({loop, label_of(loop, truth)});
  }
  if (options.shuffle) shuffle(candidates, random);

  Corrupted<Pose> result;
  result.graph = {graph.ids, graph.poses, {}, graph.fixed};
  auto& constraints = result.graph.constraints;
  for (const Index k : roles.odometry) constraints.push_back(graph.constraints[k]);
  for (const auto& candidate : candidates) {
    result.labels.push_back({static_cast<std::int64_t>(constraints.size()),
                             graph.ids[candidate.constraint.from],
                             graph.ids[candidate.constraint.to], candidate.label});
    constraints.push_back(candidate.constraint);
  }
  return result;
}

template Corrupted<Pose2> corrupt(const PoseGraph<Pose2>&, const std::vector<Pose2>&,
                                  const CorruptOptions&);
template Corrupted<Pose3> corrupt(const PoseGraph<Pose3>&, const std::vector<Pose3>&,
                                  const CorruptOptions&);

}  // namespace isotherm::slam
