#pragma once

#include <optional>

#include <Eigen/Core>

#include "localize/problem/small_network.hpp"

namespace isotherm::network::detail {

/// The best place of one node among others that stay where they are, and how much
/// worse the next best is.
struct Multilateration {
  Point position;
  double cost = 0.0;        ///< as `place_cost` has it
  Point rival;              ///< the best place elsewhere
  double rival_cost = 0.0;  ///< infinite if there is none
};

/// Places the last node of `network`, all others being fixed and all ranges leading
/// to it. Every d of the ranges (an even sample where there are many) meet in two
/// candidates; the cheapest are refined and compared. Nothing if there are fewer
/// than d ranges or their far ends do not span a line (plane, in space). `limits` are
/// what a range that does not fit costs.
std::optional<Multilateration> multilaterate(SmallNetwork network, const Limits& limits);

}  // namespace isotherm::network::detail
