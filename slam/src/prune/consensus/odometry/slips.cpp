#include "prune/consensus/odometry/slips.hpp"

#include <algorithm>

namespace isotherm::slam::detail {
namespace {

// log of the share of slips that are of each size; of none nothing.
std::array<double, kSlipSizes> log_shares() {
  std::array<double, kSlipSizes> logs{};
  double sum = 0.0;
  for (std::size_t k = 1; k < kSlipSizes; ++k) {
    logs[k] = -0.5 * static_cast<double>(k * k);
    sum += std::exp(logs[k]);
  }
  for (std::size_t k = 1; k < kSlipSizes; ++k) logs[k] -= std::log(sum);
  return logs;
}

double count_of(const Slips& slips) {
  return static_cast<double>(slips.size()) -
         static_cast<double>(std::ranges::count(slips, std::uint8_t{0}));
}

}  // namespace

double log_prior_of(const Slips& slips) {
  const auto of_size = log_shares();
  const auto all = static_cast<double>(slips.size());
  const double count = count_of(slips);
  double sum = std::lgamma(count + 1.0) + std::lgamma(all - count + 1.0) - std::lgamma(all + 1.0);
  for (const std::uint8_t slip : slips) sum += of_size[slip];
  return sum;
}

std::array<double, kSlipSizes> log_slip_odds(const Slips& slips, std::size_t edges) {
  const double count = count_of(slips);
  const double others = std::max(static_cast<double>(edges) - count, 1.0);
  auto odds = log_shares();
  for (std::size_t k = 1; k < kSlipSizes; ++k) odds[k] += std::log((count + 1.0) / others);
  return odds;
}

}  // namespace isotherm::slam::detail
