#include "prune/consensus/pairs/agreement.hpp"

#include <algorithm>
#include <utility>

#include "isotherm/base/statistics.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr std::size_t kFewestPairs = 100;
constexpr double kNearlyAll = 0.95;
constexpr double kMargin = 4.0;  // on that quantile: the tails of real errors are heavy

}  // namespace

Agreement learn_agreement(std::vector<double> accepted, const std::vector<double>& refuted,
                          double gate) {
  double most = gate;
  if (accepted.size() >= kFewestPairs) {
    most = std::min(gate, kMargin * quantile(std::move(accepted), kNearlyAll));
  }
  const auto alike = static_cast<double>(
      std::ranges::count_if(refuted, [most](double chi2) { return chi2 <= most; }));
  return {most, (alike + 1.0) / (static_cast<double>(refuted.size()) + 5.0)};
}

}  // namespace isotherm::slam::detail
