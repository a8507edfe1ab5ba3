#include "prune/consensus/calibrate/calibration.hpp"

#include <algorithm>
#include <cmath>

#include "prune/consensus/calibrate/short_cycles.hpp"
#include "prune/consensus/calibrate/telling_loops.hpp"
#include "prune/consensus/calibrate/variance_components.hpp"
#include "prune/consensus/pairs/loop_pair.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr double kMargin = 5.0;         // over what short cycles say of odometry
constexpr double kDriftMargin = 10.0;   // the same, with room for drift
constexpr double kLeeway = 5.0;         // above that, where they find it better than stated
constexpr double kLargestChange = 2.0;  // of a factor, in one step
constexpr double kWorthRescaling = 1.1;
// Up to here a gate for one correct loop in 10,000 refutes three in 1,000 at most, and a
// few false loops among the accepted ones ask for as much.
constexpr double kWorthWidening = 1.5;
constexpr int kSteps = 6;  // of Gauss-Newton

double moved(double present, double wanted, double least, double most) {
  const double near = std::clamp(wanted, present / kLargestChange, present * kLargestChange);
  return std::clamp(near, least, most);
}

bool differ(double a, double b) { return std::abs(std::log(a / b)) >= std::log(kWorthRescaling); }

}  // namespace

template <class Pose>
void Calibration<Pose>::learn_from_cycles(const MapVolume<Pose>& map) {
  const auto evidence = compare_pairs(graph_, pairs_, map, {});
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const bool copied = is_copy(graph_.loops[pairs_[k].first], graph_.loops[pairs_[k].second]);
    cycle_chi2_.push_back(copied ? 0.0 : evidence[k].chi2);
  }
  least_odometry_ = least_odometry(cycle_chi2_);
  scale_.odometry = least_odometry_;
}

template <class Pose>
CovarianceScale Calibration<Pose>::wanted(const Estimate<Pose>& estimate,
                                          const std::vector<bool>& accepted,
                                          const std::vector<double>& probability) const {
  const auto telling = telling_loops(graph_, estimate, accepted, shown());
  Estimate<Pose> from_telling(graph_);
  from_telling.restore(estimate.layout());
  from_telling.update(telling, scale(), kSteps);
  return variance_components(graph_, from_telling, telling, probability, scale());
}

template <class Pose>
bool Calibration<Pose>::asks_for_wider(const Estimate<Pose>& estimate,
                                       const std::vector<bool>& accepted,
                                       const std::vector<double>& probability) const {
  const auto [odometry, loops] = wanted(estimate, accepted, probability);
  return std::max(odometry, loops) > kWorthWidening;
}

template <class Pose>
bool Calibration<Pose>::learn_from_accepted(const Estimate<Pose>& estimate,
                                            const std::vector<bool>& accepted,
                                            const std::vector<double>& probability,
                                            double tail_share) {
  std::vector<double> chi2;
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    if (accepted[pairs_[k].first] && accepted[pairs_[k].second]) chi2.push_back(cycle_chi2_[k]);
  }
  least_odometry_ = std::min(least_odometry_, least_odometry(chi2));

  const auto [odometry, loops] = wanted(estimate, accepted, probability);
  const CovarianceScale next = {moved(scale_.odometry, odometry, least_odometry_, most_odometry()),
                                moved(scale_.loops, loops, 1.0, most_)};
  const double level = std::min(most_, loops / next.loops);
  const bool rescaled = differ(next.odometry, scale_.odometry) || differ(next.loops, scale_.loops);
  const double tightened = std::clamp(tightened_ * tail_share, tightened_ / kLargestChange, 1.0);
  const bool changed = rescaled || differ(level, loop_level_) || differ(tightened, tightened_);
  if (rescaled) scale_ = next;
  tightened_ = tightened;
  loop_level_ = level;
  return changed;
}

template <class Pose>
double Calibration<Pose>::most_odometry() const {
  return std::min(most_, least_odometry_ < 1.0 ? kLeeway * least_odometry_ : kNoLimit);
}

template <class Pose>
void Calibration<Pose>::double_odometry() {
  scale_.odometry = std::min(2.0 * scale_.odometry, most_odometry());
}

template <class Pose>
double Calibration<Pose>::least_odometry(const std::vector<double>& chi2) const {
  return std::min(1.0, margin() * cycle_scale(chi2, Pose::kDof));
}

template <class Pose>
double Calibration<Pose>::margin() const {
  return drift_allowed_ ? kDriftMargin : kMargin;
}

template <class Pose>
bool Calibration<Pose>::allow_for_drift() {
  if (least_odometry_ >= 1.0) return false;
  const double before = margin();
  drift_allowed_ = true;
  least_odometry_ = std::min(1.0, least_odometry_ * margin() / before);
  scale_.odometry = std::max(scale_.odometry, least_odometry_);
  return true;
}

template class Calibration<Pose2>;
template class Calibration<Pose3>;

}  // namespace isotherm::slam::detail
