#pragma once

#include <vector>

#include "localize/evidence/evidence.hpp"
#include "localize/fold/part_move.hpp"
#include "localize/problem/map_task.hpp"

namespace isotherm::network::detail {

/// Parts of a map in the plane, of at most 200 nodes, that turn freely on what they hang on, since
/// trusted pairs that would hold them do not fit, and where they would fit: turned as they are or
/// in their mirror image, and shifted to where most of the pairs that tie them to the others meet.
/// A part is grown from an end of such a pair and takes in what two pairs that fit lead to, so that
/// it is rigid and ends where a single node or pair leads on. Empty in space.
/// O(pairs that do not fit * 200 * degree) and 720 multilaterations a part.
std::vector<PartMove> loose_parts(const MapTask& task, const Evidence& evidence,
                                  const Placement& placement);

}  // namespace isotherm::network::detail
